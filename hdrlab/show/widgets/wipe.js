// Two pictures with a movable edge between them.

const NEAR = 24; // pixels of the page: how near to the edge a drag takes it, where the picture is zoomed

async function render({ model, el }) {
  const root = start(el, "wipe");
  const [first, second] = model.get("labels");
  const names = element(root, "div", { className: "hdrlab-names", "aria-hidden": "true" });
  element(names, "span", { textContent: `◧ ${first}` });
  element(names, "span", { textContent: `${second} ◨` });
  const percent = () => Math.round(100 * model.get("edge"));

  function compose(context, show) {
    const { width, height } = context.canvas;
    const edge = model.get("edge") * width;
    show(1);
    context.save();
    context.beginPath();
    context.rect(0, 0, edge, height);
    context.clip();
    show(0);
    context.restore();
    const thin = Math.max(1, width / 500);
    context.fillStyle = "#000";
    context.fillRect(edge - 2 * thin, 0, 4 * thin, height);
    context.fillStyle = "#fff";
    context.fillRect(edge - thin, 0, 2 * thin, height);
    return `${first} left of the edge at ${percent()} %, ${second} right of it`;
  }

  // At first every drag moves the edge; a zoomed picture is dragged along, but for the edge itself.
  function take([across], zoom, width) {
    const near = Math.abs(across - model.get("edge")) * width < NEAR;
    return zoom === 1 || near ? ([to]) => move(to) : null;
  }

  const hint = "Drag the edge. To zoom, click and turn the wheel, or pinch; the arrow keys read single pixels.";
  const view = await viewer(root, model, { help: `${first} and ${second}`, hint, compose, take });
  names.style.width = view.canvas.style.width || `${view.canvas.width}px`;
  const bar = slider(view.controls, "edge", 101);
  view.controls.prepend(bar.input.parentElement);

  function show() {
    bar.show(percent(), `${percent()} %`);
    view.repaint();
  }

  function move(to) {
    model.set("edge", clamp(to, 0, 1));
    model.save_changes();
    show();
  }

  bar.input.addEventListener("input", () => move(Number(bar.input.value) / 100));
  model.on("change:edge", show);
  show();
  return () => model.off("change:edge", show);
}

export default { render };
