// Shared by all widgets: HTML elements, native controls with names, images on a canvas, and numbers
// as text. `scripts.py` puts this file before the widget's own script, because a widget is one
// module, which loads no other file.

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

// A number with three significant digits, as a reader writes it.
const threeDigits = (value) => String(Number(value.toPrecision(3)));

const sumOf = (values) => values.reduce((sum, value) => sum + value, 0);

// A pixel as one number, for a Uint32Array over the bytes of an ImageData.
const opaquePixel = (red, green, blue) => (255 << 24) | (blue << 16) | (green << 8) | red;

const indexOfLeast = (values) => values.indexOf(Math.min(...values));

// Set a synced trait, and send it to Python if a kernel runs.
function saveTrait(model, name, value) {
  model.set(name, value);
  model.save_changes();
}

// Call `listener` when one of these traits changes. Return a function that ends this.
function onTraitChange(model, names, listener) {
  for (const name of names) model.on(`change:${name}`, listener);
  return () => {
    for (const name of names) model.off(`change:${name}`, listener);
  };
}

// Append a new element. A property whose name contains a hyphen, and `role`, become attributes.
function addElement(parent, tag, properties = {}) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes("-") || name === "role") node.setAttribute(name, value);
    else node[name] = value;
  }
  // JupyterLite looks for this attribute on the element that has the focus. Without it, the keys
  // are shortcuts of the page.
  if (tag === "input") node.setAttribute("data-lm-suppress-shortcuts", "true");
  parent.append(node);
  return node;
}

// Empty the element that anywidget gives, and return the root of the widget in it. JupyterLab has
// shortcuts for the keys that move a slider, so the root keeps the keys from it.
function createRoot(el, kind) {
  el.replaceChildren();
  const root = addElement(el, "div", {
    className: "hdrlab",
    "data-kind": kind,
    "data-lm-suppress-shortcuts": "true",
  });
  root.addEventListener("keydown", (event) => event.stopPropagation());
  return root;
}

// Append a slider for whole numbers from 0 to count - 1, with its name and the text of its value.
function addSlider(parent, name, count) {
  const row = addElement(parent, "label", { className: "hdrlab-slider" });
  addElement(row, "span", { textContent: name });
  const input = addElement(row, "input", {
    type: "range",
    min: 0,
    max: count - 1,
    step: 1,
    value: 0,
  });
  const value = addElement(row, "span", { className: "hdrlab-value", "aria-hidden": "true" });
  return {
    input,
    position: () => Number(input.value),
    // Reserve room for the text, so that the slider keeps its length when the text changes.
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

// Append a row of radio buttons, for choices without an order, such as operators.
function addRadioRow(parent, name, labels) {
  const row = addElement(parent, "div", {
    className: "hdrlab-choice",
    role: "radiogroup",
    "aria-label": name,
  });
  // Each widget on a page has its own copy of this script, so a counter would repeat the names.
  const group = `hdrlab-${Math.random()}`;
  const buttons = labels.map((label) => {
    const line = addElement(row, "label");
    const input = addElement(line, "input", { type: "radio", name: group });
    const caption = addElement(line, "span", { textContent: label });
    return { line, input, caption };
  });
  return {
    row,
    buttons,
    position: () => buttons.findIndex(({ input }) => input.checked), // -1: nothing is chosen
    show(position) {
      buttons.forEach(({ input }, index) => {
        input.checked = index === position;
      });
    },
  };
}

// Append a line of text. A screen reader reads it aloud if the reader used the keys; while a
// pointer moves, the text changes too often.
function addStatusLine(parent) {
  const line = addElement(parent, "p", { className: "hdrlab-note", role: "status" });
  return (text, isAloud = false) => {
    line.setAttribute("aria-live", isAloud ? "polite" : "off");
    line.textContent = text;
  };
}

// Decode an image. Binary traits arrive as a view into a larger buffer; a Blob takes only the view.
// Where a page of the site already shows the first image, `bytes` is that <img> element.
function decodeImage(bytes, type) {
  return createImageBitmap(bytes instanceof Element ? bytes : new Blob([bytes], { type }));
}

// Return the bytes that Python's zlib.compress compressed.
async function decompress(view) {
  const stream = new Blob([view]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

const INK_TEST_WIDTH = 96; // pixels of the reduced image in which isInk looks for white
const INK_TEST_HEIGHT = 64;
const MIN_WHITE_FRACTION = 0.72; // as in show/pictures.py
const MIN_WHITE_EDGE_FRACTION = 0.93;
const WHITE_PIXEL = 0xffffffff;

// Whether an image is lines on white paper, which a dark page inverts: show/pictures.py, is_ink.
function isInk(image) {
  const width = INK_TEST_WIDTH;
  const height = INK_TEST_HEIGHT;
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.imageSmoothingEnabled = false;
  context.drawImage(image, 0, 0, width, height);
  const { data } = context.getImageData(0, 0, width, height);
  const isWhite = Array.from(new Uint32Array(data.buffer), (pixel) => pixel === WHITE_PIXEL);
  const isEdge = (_, index) => {
    const x = index % width;
    const y = Math.floor(index / width);
    return x === 0 || x === width - 1 || y === 0 || y === height - 1;
  };
  const fractionOf = (flags) => sumOf(flags.map(Number)) / flags.length;
  return (
    fractionOf(isWhite) > MIN_WHITE_FRACTION &&
    fractionOf(isWhite.filter(isEdge)) > MIN_WHITE_EDGE_FRACTION
  );
}

// The shape of the white paper around the maps of a plot, which a dark page inverts: the unit
// square without these areas (left, top, width, height, as fractions).
function paperShape(areas) {
  const cornersOf = ([left, top, width, height]) => [
    [left, top],
    [left + width, top],
    [left + width, top + height],
    [left, top + height],
    [left, top],
    [0, 0],
  ];
  const corners = [...cornersOf([0, 0, 1, 1]), ...areas.flatMap(cornersOf)];
  const points = corners.map(([x, y]) => `${100 * x}% ${100 * y}%`);
  return `polygon(evenodd, ${points.join(", ")})`;
}

const SMALL_IMAGE = 480; // pixels: an image that is less wide is enlarged
const COLUMN_WIDTH = 640; // pixels of the page
const MAX_IMAGE_HEIGHT = "75vh"; // of the window, where widgets.css sets no other limit

// Show a canvas at this width in pixels of the page, but not higher than the window allows.
function setDisplayWidth(canvas, width) {
  const maxHeight = `var(--hdrlab-max-height, ${MAX_IMAGE_HEIGHT})`;
  canvas.style.width = `min(${width}px, calc(${maxHeight} * ${canvas.width / canvas.height}))`;
}

// Append a canvas that shows one image after another. `areas` are the maps in a plot, whose colors
// do not change on a dark page.
function addPicture(parent, areas = []) {
  const sheet = addElement(parent, "div", { className: "hdrlab-sheet" });
  const canvas = addElement(sheet, "canvas", { role: "img", "aria-label": "" });
  if (areas.length) {
    const paper = addElement(sheet, "i", { className: "hdrlab-paper" });
    paper.style.clipPath = paperShape(areas);
  }
  let isInkKnown = false;

  function paint(image, alt) {
    const width = image.displayWidth ?? image.width; // a VideoFrame has displayWidth
    const height = image.displayHeight ?? image.height;
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    // Enlarge a small image to the width of the column, but not beyond the height of the window.
    if (width < SMALL_IMAGE) setDisplayWidth(canvas, COLUMN_WIDTH);
    const context = canvas.getContext("2d");
    if (image instanceof ImageData) context.putImageData(image, 0, 0);
    else context.drawImage(image, 0, 0);
    canvas.setAttribute("aria-label", alt);
    // JupyterLab's theme can become dark at any time. A page of the site knows without this whether
    // the image is ink.
    if (document.body.dataset.jpThemeLight && !isInkKnown) {
      canvas.toggleAttribute("data-ink", isInk(canvas));
      isInkKnown = true;
    }
  }

  let lastRequest = 0;
  return {
    canvas,
    // Show an image, or a promise of one. An image that is decoded late must not replace one that
    // was requested after it.
    async show(image, alt) {
      lastRequest += 1;
      const request = lastRequest;
      const decoded = image instanceof Promise ? await image : image;
      if (request === lastRequest) paint(decoded, alt);
      if (decoded.displayWidth) decoded.close(); // a VideoFrame holds memory until it is closed
    },
  };
}

// Append a canvas of this size for a photo, which is as wide as its column.
function addPhotoCanvas(parent, width, height) {
  return addElement(parent, "canvas", {
    role: "img",
    "aria-label": "",
    className: "hdrlab-photo",
    width,
    height,
  });
}

// Append a frame that takes the focus, the keys and the pointer, with a canvas in it. For a screen
// reader the canvas is an image, and `help` is the name of the frame.
function addStage(parent, help) {
  const frame = addElement(parent, "div", {
    className: "hdrlab-stage",
    role: "application",
    tabIndex: 0,
    "aria-label": help,
  });
  const canvas = addElement(frame, "canvas", { role: "img", "aria-label": "" });
  return { frame, canvas, context: canvas.getContext("2d", { alpha: false }) };
}

// The position of a pointer on an element: fractions of its width and of its height.
function pointerPosition(event, surface) {
  const box = surface.getBoundingClientRect();
  return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
}

// Return a function that calls `paint` once before the next frame of the display.
function oncePerFrame(paint) {
  let isWaiting = false;
  return () => {
    if (isWaiting) return;
    isWaiting = true;
    requestAnimationFrame(() => {
      isWaiting = false;
      paint();
    });
  };
}
