// Shared by the widgets: a canvas that is an image to a screen reader, and native, named controls.
// Prepended to each widget's own script, because a widget is one module and loads nothing from elsewhere.

function element(parent, tag, properties = {}) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes("-") || name === "role") node.setAttribute(name, value);
    else node[name] = value;
  }
  // JupyterLite asks the element with the focus itself whether its keys are shortcuts of the page
  if (tag === "input") node.setAttribute("data-lm-suppress-shortcuts", "true");
  parent.append(node);
  return node;
}

// The page around a widget (JupyterLab) has shortcuts for the keys that move a slider: keep them here.
function start(el, kind) {
  el.replaceChildren();
  const root = element(el, "div", { className: "hdrlab", "data-kind": kind, "data-lm-suppress-shortcuts": "true" });
  root.addEventListener("keydown", (event) => event.stopPropagation());
  return root;
}

function slider(parent, name, count) {
  const row = element(parent, "label", { className: "hdrlab-slider" });
  element(row, "span", { textContent: name });
  const input = element(row, "input", { type: "range", min: 0, max: count - 1, step: 1, value: 0 });
  const value = element(row, "span", { className: "hdrlab-value", "aria-hidden": "true" });
  return {
    input,
    position: () => Number(input.value),
    // So that the bar keeps its length while the text of its value changes.
    reserve(characters) {
      value.style.minWidth = `min(${characters}ch, 35%)`;
    },
    show(position, text) {
      input.value = position;
      input.setAttribute("aria-valuetext", text);
      value.textContent = text;
    },
  };
}

// A row of radio buttons, for things without an order, such as operators.
function radioRow(parent, name, labels) {
  const row = element(parent, "div", { className: "hdrlab-choice", role: "radiogroup", "aria-label": name });
  const group = `hdrlab-${Math.random()}`; // each widget has a script of its own: nothing can count them
  const buttons = labels.map((label) => {
    const line = element(row, "label");
    const input = element(line, "input", { type: "radio", name: group });
    const words = element(line, "span", { textContent: label });
    return { line, input, words };
  });
  return {
    row,
    buttons,
    position: () => buttons.findIndex(({ input }) => input.checked),
    show: (k) => buttons.forEach(({ input }, other) => (input.checked = other === k)),
  };
}

const [SMALL, COLUMN] = [480, 640]; // pixels of the page
const TALLEST = 75; // percent of the screen's height

// Whether a picture is ink on white paper, as `pictures.is_ink` tells it, by a few of its pixels.
function isInk(pixels) {
  const [width, height] = [96, 64];
  const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  context.imageSmoothingEnabled = false;
  context.drawImage(pixels, 0, 0, width, height);
  const white = new Uint32Array(context.getImageData(0, 0, width, height).data.buffer).map((one) => one === 0xffffffff);
  const share = (some) => some.reduce((sum, one) => sum + one, 0) / some.length;
  const edge = (_, k) => k < width || k >= white.length - width || k % width === 0 || (k + 1) % width === 0;
  return share(white) > 0.72 && share(white.filter(edge)) > 0.93;
}

// The paper around pictures, which a dark page turns about: all but these areas (left, top, width, height).
function paperAround(areas) {
  const corners = ([x, y, w, h]) => [[x, y], [x + w, y], [x + w, y + h], [x, y + h], [x, y], [0, 0]];
  const path = [...corners([0, 0, 1, 1]), ...areas.flatMap(corners)];
  return `polygon(evenodd, ${path.map((point) => point.map((share) => `${100 * share}%`).join(" ")).join(", ")})`;
}

function picture(parent, areas = []) {
  const sheet = element(parent, "div", { className: "hdrlab-sheet" });
  const canvas = element(sheet, "canvas", { role: "img", "aria-label": "" });
  if (areas.length) element(sheet, "i", { className: "hdrlab-paper" }).style.clipPath = paperAround(areas);
  let [asked, inked] = [0, null];
  function paint(pixels, alt) {
    const [width, height] = [pixels.displayWidth ?? pixels.width, pixels.displayHeight ?? pixels.height];
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    // A photograph as wide as a column of text, and no taller than the screen.
    if (width < SMALL) canvas.style.width = `min(${COLUMN}px, ${(TALLEST * width) / height}vh)`;
    if (pixels instanceof ImageData) canvas.getContext("2d").putImageData(pixels, 0, 0);
    else canvas.getContext("2d").drawImage(pixels, 0, 0);
    canvas.setAttribute("aria-label", alt);
    // JupyterLab may be dark, and turn about at any time. The site knows what is ink before it shows it.
    if (document.body.dataset.jpThemeLight) inked ??= canvas.toggleAttribute("data-ink", isInk(canvas));
  }
  return {
    canvas,
    // Decoding takes its time: a picture asked for earlier must not land on one asked for later.
    async show(bitmap, alt) {
      const turn = ++asked;
      const decoded = bitmap instanceof Promise ? await bitmap : bitmap;
      if (turn === asked) paint(decoded, alt);
      if (decoded.displayWidth) decoded.close(); // a VideoFrame is shown once, and holds memory until then
    },
  };
}

// Binary traits arrive as a view into a larger buffer: Blob takes the view, not the whole buffer. A page of the site
// has the first picture already.
function decode(bytes, type) {
  return createImageBitmap(bytes instanceof Element ? bytes : new Blob([bytes], { type }));
}

// Where a pointer and the keys work on a picture. The canvas inside stays an image to a screen reader.
function stage(parent, keys) {
  const frame = element(parent, "div", { className: "hdrlab-stage", role: "application", tabIndex: 0, "aria-label": keys });
  const canvas = element(frame, "canvas", { role: "img", "aria-label": "" });
  return { frame, canvas, context: canvas.getContext("2d", { alpha: false }) };
}

// Where a pointer is on the canvas, as shares of its width and height.
function place(event, canvas) {
  const box = canvas.getBoundingClientRect();
  return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
}

// A line of text that is read aloud when the keys change it, and not while a pointer hurries over the picture.
function teller(parent) {
  const node = element(parent, "p", { className: "hdrlab-note", role: "status" });
  return (text, aloud = false) => {
    node.setAttribute("aria-live", aloud ? "polite" : "off");
    node.textContent = text;
  };
}

// Run a function at most once for each frame of the display.
function eachFrame(paint) {
  let waiting = 0;
  return () => {
    waiting ||= requestAnimationFrame(() => {
      waiting = 0;
      paint();
    });
  };
}

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
