// `widgets.wipe`: two images with an edge between them that the reader drags.
//
// Python sends the traits of viewer.js, and both sides set
//   edge  where the edge is, as a fraction of the width

const EDGE_GRIP = 24; // pixels of the page: a drag that starts this near to the edge moves the edge

async function render({ model, el }) {
  const root = createRoot(el, "wipe");
  const [first, second] = model.get("labels");
  const names = addElement(root, "div", { className: "hdrlab-names", "aria-hidden": "true" });
  addElement(names, "span", { textContent: `◧ ${first}` });
  addElement(names, "span", { textContent: `${second} ◨` });
  const percent = () => Math.round(100 * model.get("edge"));

  // Draw both images and the edge, and return the words that describe what is drawn.
  function compose(context, drawImage) {
    const { width, height } = context.canvas;
    const edge = model.get("edge") * width;
    drawImage(1);
    context.save();
    context.beginPath();
    context.rect(0, 0, edge, height);
    context.clip();
    drawImage(0);
    context.restore();
    const lineWidth = Math.max(1, width / 500);
    context.fillStyle = "#000";
    context.fillRect(edge - 2 * lineWidth, 0, 4 * lineWidth, height);
    context.fillStyle = "#fff";
    context.fillRect(edge - lineWidth, 0, 2 * lineWidth, height);
    return `${first} left of the edge at ${percent()} %, ${second} right of it`;
  }

  // Without zoom, each drag moves the edge. With zoom, a drag moves the image unless it starts near
  // the edge. `pageWidth` is the width of the canvas in pixels of the page.
  function startDrag([x], zoom, pageWidth) {
    const isNearEdge = Math.abs(x - model.get("edge")) * pageWidth < EDGE_GRIP;
    return zoom === 1 || isNearEdge ? ([pointerX]) => moveEdge(pointerX) : null;
  }

  const view = await createViewer(root, model, {
    help: `${first} and ${second}`,
    hint:
      "Drag the edge. To zoom, click and turn the wheel, or pinch; " +
      "the arrow keys read single pixels.",
    compose,
    startDrag,
  });
  names.style.width = view.canvas.style.width;
  const slider = addSlider(view.controls, "edge", 101);
  view.controls.prepend(slider.input.parentElement);

  function show() {
    slider.show(percent(), `${percent()} %`);
    view.repaint();
  }

  function moveEdge(fraction) {
    saveTrait(model, "edge", clamp(fraction, 0, 1));
    show();
  }

  slider.input.addEventListener("input", () => moveEdge(slider.position() / 100));
  const stopListening = onTraitChange(model, ["edge"], show);
  show();
  return stopListening;
}

export default { render };
