// Pictures in one place, one after the other: what differs between them jumps to the eye.

async function render({ model, el }) {
  const root = start(el, "blink");
  const labels = model.get("labels");
  const index = () => model.get("index");
  let timer = null;

  function compose(_, show) {
    show(index());
    return labels[index()];
  }

  function key(event) {
    if (event.key !== " ") return false;
    pause();
    next();
    return true;
  }

  const hint = "To zoom, click and turn the wheel, or pinch; the arrow keys read single pixels, Space shows the next picture.";
  const help = `${labels.join(", ")}; Space shows the next`;
  const view = await viewer(root, model, { help, hint, compose, key });
  const { row, buttons, show: check } = radioRow(view.controls, "picture", labels);
  const button = element(view.controls, "button", { type: "button", textContent: "Blink" });
  view.controls.prepend(button, row);
  buttons.forEach(({ input }, k) => {
    input.addEventListener("change", () => {
      pause();
      choose(k);
    });
  });

  function show() {
    check(index());
    view.repaint();
  }

  function choose(k) {
    model.set("index", k);
    model.save_changes();
    show();
  }

  const next = () => choose((index() + 1) % labels.length);

  function pause() {
    clearInterval(timer);
    timer = null;
    button.textContent = "Blink";
  }

  button.addEventListener("click", () => {
    if (timer !== null) return pause();
    next();
    timer = setInterval(next, 1000 * model.get("period"));
    button.textContent = "Stop";
  });

  model.on("change:index", show);
  show();
  return () => {
    pause();
    model.off("change:index", show);
  };
}

export default { render };
