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
  const row = element(view.controls, "div", { className: "hdrlab-choice", role: "radiogroup", "aria-label": "picture" });
  const button = element(view.controls, "button", { type: "button", textContent: "Blink" });
  view.controls.prepend(button, row);
  const group = `hdrlab-${Math.random()}`; // each widget has a script of its own: nothing can count them
  const choices = labels.map((label, k) => {
    const line = element(row, "label");
    const input = element(line, "input", { type: "radio", name: group });
    line.append(` ${label}`);
    input.addEventListener("change", () => {
      pause();
      choose(k);
    });
    return input;
  });

  function show() {
    choices.forEach((input, k) => (input.checked = k === index()));
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
