// Sliders and rows of buttons for the parameters of a function: Python computes each picture. Those that are stored are shown at once, and stay where no
// Python answers.

const PATIENCE = 3000; // ms without an answer before a page that had a kernel counts as one without

const JPEG = 0xffd8; // how one begins

const same = (a, b) => a.length === b.length && a.every((value, i) => value === b[i]);

// Runs of one colour, as `web.runs` wrote them: painted at once, where a JPEG would have to wait for its decoder.
function unroll(bytes) {
  const words = new Uint32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
  const image = new ImageData(words[0], words[1]);
  const pixels = new Uint32Array(image.data.buffer);
  for (let [k, at] = [2, 0]; k < words.length; k++) {
    const end = at + (words[k] >>> 24), colour = words[k] | 0xff000000;
    while (at < end) pixels[at++] = colour;
  }
  return image;
}

// A Blob goes through another process, which takes longer than to decode. Pages that are not secure have no other way.
async function decodeJpeg(bytes) {
  if (!globalThis.ImageDecoder) return decode(bytes, "image/jpeg");
  const decoder = new ImageDecoder({ data: bytes, type: "image/jpeg" });
  try {
    return (await decoder.decode()).image;
  } finally {
    decoder.close();
  }
}

function opened(bytes) {
  return bytes.getUint16(0) === JPEG ? decodeJpeg(bytes) : unroll(bytes);
}

function render({ model, el }) {
  const root = start(el, "tune");
  const [names, values] = [model.get("names"), model.get("values")];
  const labels = model.get("labels") ?? names; // a page that was saved earlier has none
  const view = picture(root, model.get("areas"));
  const note = element(root, "p", { className: "hdrlab-note", role: "status" });
  const controls = element(root, "div", { className: "hdrlab-controls" });
  const unordered = model.get("unordered") ?? []; // a page that was saved earlier has none
  const bars = names.map((name, k) => {
    if (!unordered.includes(name)) {
      const bar = slider(controls, labels[k], values[k].length);
      bar.reserve(Math.max(...values[k].map((text) => text.length)));
      return bar;
    }
    const { row, position, show } = radioRow(controls, labels[k], values[k]);
    row.prepend(element(row, "span", { textContent: labels[k], "aria-hidden": "true" }));
    return { input: row, position, show };
  });
  const texts = (at) => at.map((position, k) => `${labels[k]} ${values[k][position]}`).join(", ");
  let [answered, timer, first, ready] = [false, null, null, false];

  // Stored positions are a grid: the nearest one is so along each slider.
  function distance(a, b) {
    const share = (position, k) => Math.abs(position - b[k]) / (values[k].length - 1);
    return a.reduce((sum, position, k) => sum + share(position, k), 0);
  }

  // How many positions of a slider have a picture, where not all of them do.
  function thinned() {
    const counts = names.map((_, k) => new Set(model.get("stored_at").map((at) => at[k])).size);
    const told = labels.map((label, k) => `${counts[k]} of ${values[k].length} positions of ${label}`);
    return told.filter((_, k) => counts[k] < values[k].length).join(", ");
  }

  // A page of the site says where a reader finds how to run it.
  function tellStored(nearest) {
    const at = same(nearest, model.get("at")) ? "" : `, at ${thinned() || "other positions"}; the nearest: ${texts(nearest)}`;
    note.textContent = `Computed beforehand${at}.`;
    const address = globalThis.hdrlab?.running;
    if (address) note.append(" ", element(note, "a", { href: address, textContent: "Run it yourself" }));
  }

  const opening = (k) => decode(model.get("stored")[k], "image/webp");

  // A picture is painted over the first, of which it may be the changes alone.
  async function layered(k) {
    const [under, over] = await Promise.all([(first ??= opening(0)), opening(k)]);
    const canvas = Object.assign(document.createElement("canvas"), { width: over.width, height: over.height });
    const context = canvas.getContext("2d");
    context.drawImage(under, 0, 0);
    context.drawImage(over, 0, 0);
    return canvas;
  }

  const showOpened = (k) => view.show(layered(k), `${model.get("alt")}, ${texts(model.get("stored_at")[k])}`);

  function showStored() {
    const [at, stored] = [model.get("at"), model.get("stored_at")];
    const away = stored.map((other) => distance(other, at));
    const nearest = away.indexOf(Math.min(...away));
    showOpened(nearest);
    tellStored(stored[nearest]);
  }

  // Python's own picture of the same place follows; one of another place, asked for earlier, comes too late.
  function showReady() {
    const k = model.get("stored_at").findIndex((other) => same(other, model.get("at")));
    ready = k >= 0;
    if (ready) showOpened(k);
  }

  function showBars() {
    model.get("at").forEach((position, k) => bars[k].show(position, values[k][position]));
  }

  function showFrame() {
    view.show(opened(model.get("frame")), `${model.get("alt")}, ${texts(model.get("shown"))}`);
    note.textContent = model.get("problem");
  }

  function answer() {
    answered = true;
    const awaited = same(model.get("shown"), model.get("at"));
    if (awaited) clearTimeout(timer);
    if (awaited || !ready) showFrame();
  }

  function giveUp() {
    answered = false;
    showStored();
  }

  // A press on the picture, or a drag, moves two sliders at once: down and right, as shares of the pictured area.
  function point(event) {
    if (event.type === "pointermove" && !event.buttons) return;
    const [left, top, width, height] = model.get("areas")[0] ?? [0, 0, 1, 1];
    const [across, down] = place(event, view.canvas);
    const shares = [(down - top) / height, (across - left) / width];
    model.get("point").forEach((name, axis) => {
      const k = names.indexOf(name);
      const away = values[k].map((value) => Math.abs(parseFloat(value) - shares[axis]));
      bars[k].show(away.indexOf(Math.min(...away)), "");
    });
    move();
  }

  function move() {
    model.set("at", bars.map((bar) => bar.position()));
    model.save_changes();
    showBars();
    clearTimeout(timer);
    if (!answered) return showStored();
    showReady();
    timer = setTimeout(giveUp, PATIENCE);
  }

  bars.forEach((bar) => bar.input.addEventListener("input", move));
  if (model.get("point").length) {
    view.canvas.classList.add("hdrlab-point");
    ["pointerdown", "pointermove"].forEach((kind) => view.canvas.addEventListener(kind, point));
  }
  model.on("change:at", showBars);
  model.on("change:answers", answer);
  showBars();
  if (model.get("frame")) showFrame();
  else showStored(); // a page of the site holds the first picture once
  return () => {
    clearTimeout(timer);
    model.off("change:at", showBars);
    model.off("change:answers", answer);
  };
}

export default { render };
