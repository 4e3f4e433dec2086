// The difference of two bitmaps, one of which is dragged: align/mtb.py's error again, for the offset under the hand.

// Bytes red, green, blue, alpha as one number: as show/plots/lectures/bitmaps.py colours them.
const colour = (red, green, blue) => (255 << 24) | (blue << 16) | (green << 8) | red;
const EQUAL_BITS = [colour(26, 26, 26), colour(255, 255, 255)];
const DIFFERENT_BITS = colour(230, 159, 0);
const EXCLUDED_BITS = colour(0, 90, 160);
const OUTSIDE_OVERLAP = [colour(95, 95, 95), colour(175, 175, 175)];
const [KEPT, MOVING] = [2, 4]; // weights of a code's bits: bit and exclusion of the fixed photo, then of the moving one

// What to paint, and what to count, for each code of a pair of pixels.
function tables(isExcluding) {
  const codes = [...Array(16).keys()];
  const isCompared = codes.map((code) => !isExcluding || ((code & KEPT) > 0 && (code & (KEPT * MOVING)) > 0));
  const differs = codes.map((code) => (code & 1) !== ((code >> 2) & 1));
  const colours = codes.map((code) => {
    if (!isCompared[code]) return EXCLUDED_BITS;
    return differs[code] ? DIFFERENT_BITS : EQUAL_BITS[code & 1];
  });
  return {
    colours: Uint32Array.from(colours),
    compared: Uint8Array.from(isCompared, Number),
    different: Uint8Array.from(codes, (code) => Number(isCompared[code] && differs[code])),
  };
}

// One level of the pyramid: a code for each pixel of both photos.
async function unpack(view, [height, width]) {
  const bytes = await unzip(view);
  const size = height * width;
  const bit = (index) => (bytes[index >> 3] >> (index & 7)) & 1;
  const codes = (photo) =>
    Uint8Array.from({ length: size }, (_, k) => bit(2 * photo * size + k) + KEPT * bit((2 * photo + 1) * size + k));
  return { height, width, fixed: codes(0), moving: codes(1).map((code) => MOVING * code) };
}

// Count the bits that differ and those that are compared; paint them into `pixels`, if there are any.
function compare({ height, width, fixed, moving }, [dy, dx], { colours, compared, different }, pixels) {
  let [count, total] = [0, 0];
  for (let y = 0, at = 0; y < height; y++) {
    const isRowInside = y - dy >= 0 && y - dy < height;
    const from = (y - dy) * width - dx;
    for (let x = 0; x < width; x++, at++) {
      if (isRowInside && x - dx >= 0 && x - dx < width) {
        const code = fixed[at] | moving[from + x];
        count += different[code];
        total += compared[code];
        if (pixels) pixels[at] = colours[code];
      } else if (pixels) pixels[at] = OUTSIDE_OVERLAP[fixed[at] & 1];
    }
  }
  return { count, total, error: count / Math.max(total, 1) };
}

async function render({ model, el }) {
  const root = start(el, "bitmaps");
  const levels = await Promise.all(model.get("bits").map((view, k) => unpack(view, model.get("sizes")[k])));
  const [byExclusion, byAll] = [tables(true), tables(false)];
  const [level, offset] = [() => model.get("level"), () => model.get("offset")];
  const rules = () => (model.get("is_excluding") ? byExclusion : byAll);
  const reachOf = (k) => Math.ceil(model.get("max_offset") / 2 ** k);

  const columns = element(root, "div", { className: "hdrlab-columns" });
  const left = element(columns, "div", { className: "hdrlab-column" });
  const { frame, canvas, context } = stage(left, "The upper bitmap. Arrow keys move it, with Shift by 8 pixels.");
  canvas.className = "hdrlab-photo";
  frame.classList.add("hdrlab-grab");
  const legend = element(left, "p", { className: "hdrlab-legend" });
  for (const [name, words] of [["differs", "the bits differ"], ["excluded", "excluded"], ["outside", "no overlap"]])
    element(legend, "span", { textContent: words, className: `hdrlab-bit-${name}` });
  element(left, "p", { className: "hdrlab-note", textContent: "Drag the bitmap, or move it with the arrow keys." });

  const right = element(columns, "div", { className: "hdrlab-column" });
  const sizes = element(right, "div", { className: "hdrlab-buttons", role: "group", "aria-label": "Level of the pyramid" });
  const buttons = levels.map((_, k) => {
    const name = k === 0 ? "full size" : `1/${2 ** k}`;
    const button = element(sizes, "button", { className: "hdrlab-plain", textContent: name });
    button.addEventListener("click", () => changeLevel(k));
    return button;
  });
  const choice = element(right, "div", { className: "hdrlab-choice" });
  const label = element(choice, "label");
  const exclude = element(label, "input", { type: "checkbox", checked: model.get("is_excluding") });
  label.append(" leave out the pixels near the threshold (exclusion bitmaps)");
  exclude.addEventListener("change", () => set("is_excluding", exclude.checked));
  const bar = element(right, "div", { className: "hdrlab-count" });
  const fill = element(bar, "i");
  const least = element(bar, "b");
  const say = teller(right);
  const tracks = element(right, "div", { className: "hdrlab-tracks" });
  const box = element(tracks, "div", { className: "hdrlab-trace" });
  const map = element(box, "canvas", { className: "hdrlab-photo", role: "img" });
  const ring = element(box, "i", { className: "hdrlab-ring" });
  const ink = map.getContext("2d");
  const best = element(tracks, "p", { className: "hdrlab-note" });

  // The errors of the offsets that were tried, and the largest of the map: for each level, with and without exclusion.
  const traces = new Map();
  function trace() {
    const key = `${level()} ${model.get("is_excluding")}`;
    if (!traces.has(key)) {
      const reach = reachOf(level());
      const ends = [-reach, 0, reach];
      const around = ends.flatMap((dy) => ends.map((dx) => compare(levels[level()], [dy, dx], rules()).error));
      traces.set(key, { reach, worst: Math.max(...around), tried: new Map() });
    }
    return traces.get(key);
  }

  // A hand is faster than the display: these offsets lie between the one painted last and the present one.
  let [shown, last] = [-1, null];
  function passedOffsets() {
    const from = last ?? offset();
    last = offset();
    const way = last.map((pixels, k) => pixels - from[k]);
    const steps = Math.max(...way.map(Math.abs), 1);
    return Array.from({ length: steps }, (_, k) => from.map((pixels, axis) => Math.round(pixels + (way[axis] * (k + 1)) / steps)));
  }

  let [image, aloud] = [null, false];
  function resize() {
    [shown, last] = [level(), null];
    [canvas.width, canvas.height] = [levels[shown].width, levels[shown].height];
    image = context.createImageData(canvas.width, canvas.height);
    map.width = map.height = 2 * reachOf(shown) + 1;
    buttons.forEach((button, k) => button.setAttribute("aria-pressed", k === shown));
  }

  function paint() {
    if (shown !== level()) resize();
    exclude.checked = model.get("is_excluding");
    const [dy, dx] = offset();
    const found = compare(levels[shown], [dy, dx], rules(), new Uint32Array(image.data.buffer));
    context.putImageData(image, 0, 0);
    const { reach, worst, tried } = trace();
    for (const passed of passedOffsets()) {
      const [down, right] = passed;
      const key = `${down} ${right}`;
      if (!tried.has(key)) tried.set(key, { dy: down, dx: right, error: compare(levels[shown], passed, rules()).error });
    }
    const bestTried = [...tried.values()].reduce((a, b) => (b.error < a.error ? b : a));
    const across = (error) => `${100 * Math.min(error / worst || 0, 1)}%`;
    fill.style.width = across(found.error);
    least.style.left = across(bestTried.error);
    paintMap(tried, reach, worst);
    const percent = (error) => `${(100 * error).toFixed(2)} %`;
    best.textContent = `A square for each offset that you tried, darker where fewer bits differ. Fewest so far: ${percent(bestTried.error)} at ${inWords([bestTried.dy, bestTried.dx])}.`;
    canvas.setAttribute("aria-label", `${model.get("alt")}, moved by ${inWords([dy, dx])}`);
    map.setAttribute("aria-label", `Map of the ${tried.size} offsets tried so far`);
    say(`Moved by ${inWords([dy, dx])}: ${found.count} of ${found.total} compared bits differ, ${percent(found.error)}.`, aloud);
  }
  const inWords = ([dy, dx]) => `(${dy}, ${dx})`.replaceAll("-", "−");

  function paintMap(tried, reach, worst) {
    ink.clearRect(0, 0, map.width, map.height);
    for (const { dy, dx, error } of tried.values()) {
      const part = Math.min(error / worst || 0, 1);
      const [red, green] = [26, 26].map((dark, k) => dark + part * ([240, 190][k] - dark));
      ink.fillStyle = `rgb(${red} ${green} 26)`;
      ink.fillRect(dx + reach, dy + reach, 1, 1);
    }
    const across = (pixels) => `${(100 * (pixels + reach + 0.5)) / map.width}%`;
    [ring.style.top, ring.style.left] = offset().map(across);
  }
  const repaint = eachFrame(paint);

  function set(name, value) {
    model.set(name, value);
    model.save_changes();
    repaint();
  }

  function moveTo(wanted, byKey) {
    aloud = byKey;
    const reach = reachOf(level());
    set("offset", wanted.map((pixels) => clamp(pixels, -reach, reach)));
  }

  // As the search does: an offset of one level is twice as large at the next finer one.
  function changeLevel(k) {
    const factor = 2 ** (level() - k);
    model.set("level", k);
    moveTo(offset().map((pixels) => Math.round(pixels * factor)), true);
  }

  let grabbed = null;
  draggable(frame, canvas, {
    grab: (at) => (grabbed = { at, offset: offset() }),
    moveTo: ([right, down]) => {
      const dy = grabbed.offset[0] + Math.round((down - grabbed.at[1]) * canvas.height);
      const dx = grabbed.offset[1] + Math.round((right - grabbed.at[0]) * canvas.width);
      moveTo([dy, dx], false);
    },
    stepBy: (right, down) => moveTo([offset()[0] + down, offset()[1] + right], true),
  });
  const names = ["change:offset", "change:level", "change:is_excluding"];
  names.forEach((name) => model.on(name, repaint));
  paint();
  return () => names.forEach((name) => model.off(name, repaint));
}

export default { render };
