// `widgets.tune`: sliders and rows of buttons for the parameters of a function. Python computes the
// image of each position. Without a kernel, the widget shows the nearest of the stored images.
//
// Python sends
//   names      the parameters
//   labels     the words next to each slider; a page that was saved by an older version has none
//   values     the text of each position of each slider
//   unordered  the parameters with a row of buttons; an older page has none
//   point      the two parameters (down, right) that a press on the image sets, or none
//   stored_at  the positions for which there are stored images; the first one is the start
//   stored     the stored images as WebP; all but the first hold only the changes against the first
//   areas      the maps in the image, see addPicture
//   alt        what the image shows
//   frame      the image that Python computed last: JPEG or runs of one color (io/web.py)
//   shown      the positions of that image
//   problem    the error of the function, or ""
//   answers    counts the images of Python, and so announces a new one
// and the widget sends
//   at         the position of each slider

const ANSWER_TIMEOUT = 3000; // ms: after this time without an answer, there is no kernel any more
const JPEG_START = 0xffd8; // the first two bytes of a JPEG
const OPAQUE = 255 << 24; // the alpha of a pixel

const isSame = (a, b) => a.length === b.length && a.every((value, i) => value === b[i]);

// Return the image of runs of one color (io/web.py, encode_runs). This needs no decoder and is
// ready at once.
function decodeRuns(bytes) {
  const copy = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
  const words = new Uint32Array(copy);
  const [width, height] = words;
  const image = new ImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);
  let position = 0;
  for (const run of words.subarray(2)) {
    const end = position + (run >>> 24);
    const color = run | OPAQUE;
    while (position < end) {
      pixels[position] = color;
      position += 1;
    }
  }
  return image;
}

// Decode a JPEG. ImageDecoder is faster than a Blob, which passes through another process, but only
// secure pages have it.
async function decodeJpeg(bytes) {
  if (!globalThis.ImageDecoder) return decodeImage(bytes, "image/jpeg");
  const decoder = new ImageDecoder({ data: bytes, type: "image/jpeg" });
  try {
    const { image } = await decoder.decode();
    return image;
  } finally {
    decoder.close();
  }
}

function decodeFrame(bytes) {
  return bytes.getUint16(0) === JPEG_START ? decodeJpeg(bytes) : decodeRuns(bytes);
}

// Append a slider, or a row of buttons if the values have no order.
function addControl(parent, label, texts, isUnordered) {
  if (isUnordered) {
    const { row, position, show } = addRadioRow(parent, label, texts);
    row.prepend(addElement(row, "span", { textContent: label, "aria-hidden": "true" }));
    return { input: row, position, show };
  }
  const slider = addSlider(parent, label, texts.length);
  slider.reserve(Math.max(...texts.map((text) => text.length)));
  return slider;
}

// The images that Python stored beforehand.
function createStore(model) {
  const positions = model.get("stored_at");
  const values = model.get("values");
  const decodeStored = (index) => decodeImage(model.get("stored")[index], "image/webp");
  let first = null;

  // The distance of two positions. The stored positions are a grid, so the nearest of them is also
  // the nearest along each slider.
  function distance(a, b) {
    const fractions = a.map((position, k) => Math.abs(position - b[k]) / (values[k].length - 1));
    return sumOf(fractions);
  }

  return {
    indexOf: (at) => positions.findIndex((position) => isSame(position, at)),
    nearestIndex: (at) => indexOfLeast(positions.map((position) => distance(position, at))),
    position: (index) => positions[index],
    // How many positions of slider k have an image.
    countAlong: (k) => new Set(positions.map((position) => position[k])).size,
    // Draw a stored image over the first, because it may hold only the changes.
    async decode(index) {
      first ??= decodeStored(0);
      const [background, changes] = await Promise.all([first, decodeStored(index)]);
      const canvas = document.createElement("canvas");
      canvas.width = changes.width;
      canvas.height = changes.height;
      const context = canvas.getContext("2d");
      context.drawImage(background, 0, 0);
      context.drawImage(changes, 0, 0);
      return canvas;
    },
  };
}

function render({ model, el }) {
  const root = createRoot(el, "tune");
  const names = model.get("names");
  const values = model.get("values");
  const labels = model.get("labels") ?? names;
  const unordered = model.get("unordered") ?? [];
  const store = createStore(model);
  const view = addPicture(root, model.get("areas"));
  const note = addElement(root, "p", { className: "hdrlab-note", role: "status" });
  const controlRow = addElement(root, "div", { className: "hdrlab-controls" });
  const controls = names.map((name, k) =>
    addControl(controlRow, labels[k], values[k], unordered.includes(name)),
  );

  let hasKernel = false; // whether Python answered the last move in time
  let isStoredShown = false; // whether the current position shows a stored image
  let timer = null;

  const describe = (at) =>
    at.map((position, k) => `${labels[k]} ${values[k][position]}`).join(", ");
  const altAt = (at) => `${model.get("alt")}, ${describe(at)}`;

  function showControls() {
    model.get("at").forEach((position, k) => controls[k].show(position, values[k][position]));
  }

  // Which sliders have positions without a stored image.
  function describeGaps() {
    const parts = labels.map((label, k) => {
      const stored = store.countAlong(k);
      const all = values[k].length;
      return stored < all ? `${stored} of ${all} positions of ${label}` : "";
    });
    return parts.filter(Boolean).join(", ");
  }

  // Say that the image was stored, and where. A page of the site links to how to run it.
  function noteStored(position) {
    let text = "Computed beforehand";
    if (!isSame(position, model.get("at"))) {
      text += `, at ${describeGaps() || "other positions"}; the nearest: ${describe(position)}`;
    }
    note.textContent = `${text}.`;
    const address = globalThis.hdrlab?.running; // live.js sets it
    if (!address) return;
    const link = addElement(note, "a", { href: address, textContent: "Run it yourself" });
    note.append(" ", link);
  }

  function showStoredImage(index) {
    view.show(store.decode(index), altAt(store.position(index)));
  }

  function showNearestStored() {
    const index = store.nearestIndex(model.get("at"));
    showStoredImage(index);
    noteStored(store.position(index));
  }

  // Show the stored image of exactly this position, until the image of Python arrives.
  function showStoredMeanwhile() {
    const index = store.indexOf(model.get("at"));
    isStoredShown = index >= 0;
    if (isStoredShown) showStoredImage(index);
  }

  function showFrame() {
    view.show(decodeFrame(model.get("frame")), altAt(model.get("shown")));
    note.textContent = model.get("problem");
  }

  // Show an image of Python, unless it belongs to an earlier position and a stored image of the
  // current position is already shown.
  function handleAnswer() {
    hasKernel = true;
    const isCurrent = isSame(model.get("shown"), model.get("at"));
    if (isCurrent) clearTimeout(timer);
    if (isCurrent || !isStoredShown) showFrame();
  }

  function handleTimeout() {
    hasKernel = false;
    showNearestStored();
  }

  function handleInput() {
    saveTrait(
      model,
      "at",
      controls.map((control) => control.position()),
    );
    showControls();
    clearTimeout(timer);
    if (!hasKernel) {
      showNearestStored();
      return;
    }
    showStoredMeanwhile();
    timer = setTimeout(handleTimeout, ANSWER_TIMEOUT);
  }

  // A press or a drag on the image sets two sliders to the position of the pointer in the first
  // area, as fractions down and right.
  function handlePointer(event) {
    if (event.type === "pointermove" && !event.buttons) return;
    const [left, top, width, height] = model.get("areas")[0] ?? [0, 0, 1, 1];
    const [x, y] = pointerPosition(event, view.canvas);
    const fractions = [(y - top) / height, (x - left) / width];
    model.get("point").forEach((name, axis) => {
      const k = names.indexOf(name);
      const distances = values[k].map((value) => Math.abs(parseFloat(value) - fractions[axis]));
      controls[k].show(indexOfLeast(distances), "");
    });
    handleInput();
  }

  for (const control of controls) control.input.addEventListener("input", handleInput);
  if (model.get("point").length) {
    view.canvas.classList.add("hdrlab-point");
    view.canvas.addEventListener("pointerdown", handlePointer);
    view.canvas.addEventListener("pointermove", handlePointer);
  }
  const stopFollowing = onTraitChange(model, ["at"], showControls);
  const stopAnswering = onTraitChange(model, ["answers"], handleAnswer);
  showControls();
  if (model.get("frame")) showFrame();
  else showNearestStored(); // a page of the site has only stored images
  return () => {
    clearTimeout(timer);
    stopFollowing();
    stopAnswering();
  };
}

export default { render };
