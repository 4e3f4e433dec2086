// `widgets.bitmap_difference`: the reader drags the median threshold bitmap of one photo over that
// of another. The widget counts the bits that differ, as align/mtb.py does.
//
// Python sends
//   bits          for each level of the pyramid, the bits (2 photos, 2 bitmaps, H, W), packed and
//                 compressed; the fixed photo is first, the exclusion bitmap second
//   sizes         (H, W) of each level
//   max_offset    the largest offset, pixels of the full size
//   alt           what the photos show
// and both sides set
//   level         0 is the full size; each level is half as large
//   offset        (dy, dx) of the moving photo, pixels of the level
//   is_excluding  whether pixels near the threshold are left out

// The code of a pixel: bitmap and exclusion bitmap of the fixed photo, then of the moving one.
const BITMAP = 1;
const EXCLUSION = 2; // this bit is 0 for a pixel that is left out
const MOVING_SHIFT = 2; // bits from the code of the fixed photo to that of the moving photo
const CODES = [...Array(16).keys()];

// The colors of show/plots/lectures/bitmaps.py.
const EQUAL_COLORS = [opaquePixel(26, 26, 26), opaquePixel(255, 255, 255)];
const DIFFERENT_COLOR = opaquePixel(230, 159, 0);
const EXCLUDED_COLOR = opaquePixel(0, 90, 160);
const OUTSIDE_COLORS = [opaquePixel(95, 95, 95), opaquePixel(175, 175, 175)];
const BEST_OFFSET_COLOR = [26, 26, 26]; // of the map of offsets: red, green, blue
const WORST_OFFSET_COLOR = [240, 190, 26];

// What to paint and what to count for each code.
function codeTables(isExcluding) {
  const isCompared = CODES.map((code) => {
    const isKept = (code & EXCLUSION) > 0 && ((code >> MOVING_SHIFT) & EXCLUSION) > 0;
    return !isExcluding || isKept;
  });
  const isDifferent = CODES.map((code) => {
    return (code & BITMAP) !== ((code >> MOVING_SHIFT) & BITMAP);
  });
  const colors = CODES.map((code) => {
    if (!isCompared[code]) return EXCLUDED_COLOR;
    return isDifferent[code] ? DIFFERENT_COLOR : EQUAL_COLORS[code & BITMAP];
  });
  return {
    colors: Uint32Array.from(colors),
    compared: Uint8Array.from(isCompared, Number),
    different: Uint8Array.from(CODES, (code) => Number(isCompared[code] && isDifferent[code])),
  };
}

// Unpack one level of the pyramid into a code for each pixel of both photos. Eight bits are in a
// byte, the lowest first.
async function unpackLevel(view, [height, width]) {
  const bytes = await decompress(view);
  const size = height * width;
  const bitAt = (index) => (bytes[index >> 3] >> (index & 7)) & 1;
  const codesOf = (photo, shift) =>
    Uint8Array.from({ length: size }, (_, pixel) => {
      const bitmap = bitAt(2 * photo * size + pixel);
      const exclusion = bitAt((2 * photo + 1) * size + pixel);
      return (BITMAP * bitmap + EXCLUSION * exclusion) << shift;
    });
  return { height, width, fixed: codesOf(0, 0), moving: codesOf(1, MOVING_SHIFT) };
}

// Count the bits that differ and the bits that are compared. Paint them if there are `pixels`.
function compareBitmaps({ height, width, fixed, moving }, [dy, dx], tables, pixels) {
  const { colors, compared, different } = tables;
  let count = 0;
  let total = 0;
  let i = 0;
  for (let y = 0; y < height; y++) {
    const isRowInside = y - dy >= 0 && y - dy < height;
    const movingRow = (y - dy) * width - dx;
    for (let x = 0; x < width; x++) {
      if (isRowInside && x - dx >= 0 && x - dx < width) {
        const code = fixed[i] | moving[movingRow + x];
        count += different[code];
        total += compared[code];
        if (pixels) pixels[i] = colors[code];
      } else if (pixels) {
        pixels[i] = OUTSIDE_COLORS[fixed[i] & BITMAP];
      }
      i += 1;
    }
  }
  return { count, total, error: count / Math.max(total, 1) };
}

const percentOf = (fraction) => `${(100 * fraction).toFixed(2)} %`;
const offsetText = ([dy, dx]) => `(${dy}, ${dx})`.replaceAll("-", "−");

// The offsets from one to the other, at most a pixel apart, with `to` but without `from`.
function offsetsBetween(from, to) {
  const displacement = to.map((pixels, axis) => pixels - from[axis]);
  const steps = Math.max(...displacement.map(Math.abs), 1);
  return Array.from({ length: steps }, (_, k) =>
    from.map((pixels, axis) => Math.round(pixels + (displacement[axis] * (k + 1)) / steps)),
  );
}

// Append the upper bitmap and its legend.
function addBitmap(parent) {
  const help = "The upper bitmap. Arrow keys move it, with Shift by 8 pixels.";
  const { frame, canvas, context } = addStage(parent, help);
  canvas.className = "hdrlab-photo";
  frame.classList.add("hdrlab-grab");
  const legend = addElement(parent, "p", { className: "hdrlab-legend" });
  const entries = [
    ["differs", "the bits differ"],
    ["excluded", "excluded"],
    ["outside", "no overlap"],
  ];
  for (const [name, textContent] of entries) {
    addElement(legend, "span", { textContent, className: `hdrlab-bit-${name}` });
  }
  addElement(parent, "p", {
    className: "hdrlab-note",
    textContent: "Drag the bitmap, or move it with the arrow keys.",
  });
  return { frame, canvas, context };
}

// Append a button for each level of the pyramid.
function addLevelButtons(parent, levels, changeLevel) {
  const group = addElement(parent, "div", {
    className: "hdrlab-buttons",
    role: "group",
    "aria-label": "Level of the pyramid",
  });
  return levels.map((_, level) => {
    const textContent = level === 0 ? "full size" : `1/${2 ** level}`;
    const button = addElement(group, "button", { className: "hdrlab-plain", textContent });
    button.addEventListener("click", () => changeLevel(level));
    return button;
  });
}

// Append the checkbox for the exclusion bitmaps.
function addExclusionBox(parent, isExcluding) {
  const choice = addElement(parent, "div", { className: "hdrlab-choice" });
  const label = addElement(choice, "label");
  const box = addElement(label, "input", { type: "checkbox", checked: isExcluding });
  label.append(" leave out the pixels near the threshold (exclusion bitmaps)");
  return box;
}

// Append the map of the offsets that the reader has tried.
function addOffsetMap(parent) {
  const row = addElement(parent, "div", { className: "hdrlab-tracks" });
  const box = addElement(row, "div", { className: "hdrlab-trace" });
  const canvas = addElement(box, "canvas", { className: "hdrlab-photo", role: "img" });
  const ring = addElement(box, "i", { className: "hdrlab-ring" });
  const text = addElement(row, "p", { className: "hdrlab-note" });
  const context = canvas.getContext("2d");

  // Paint a pixel for each offset, darker for a smaller error. `reach` is the largest offset.
  function paint({ errors, reach, maxError }, offset) {
    context.clearRect(0, 0, canvas.width, canvas.height);
    for (const { dy, dx, error } of errors.values()) {
      const fraction = Math.min(error / maxError || 0, 1);
      const channels = BEST_OFFSET_COLOR.map(
        (best, c) => best + fraction * (WORST_OFFSET_COLOR[c] - best),
      );
      context.fillStyle = `rgb(${channels.join(" ")})`;
      context.fillRect(dx + reach, dy + reach, 1, 1);
    }
    const positionOf = (pixels) => `${(100 * (pixels + reach + 0.5)) / canvas.width}%`;
    const [dy, dx] = offset;
    ring.style.top = positionOf(dy);
    ring.style.left = positionOf(dx);
    canvas.setAttribute("aria-label", `Map of the ${errors.size} offsets tried so far`);
  }
  return { canvas, text, paint };
}

async function render({ model, el }) {
  const root = createRoot(el, "bitmaps");
  const sizes = model.get("sizes");
  const levels = await Promise.all(model.get("bits").map((view, k) => unpackLevel(view, sizes[k])));
  const excludingTables = codeTables(true);
  const plainTables = codeTables(false);
  const level = () => model.get("level");
  const offset = () => model.get("offset");
  const tables = () => (model.get("is_excluding") ? excludingTables : plainTables);
  const maxOffsetOf = (k) => Math.ceil(model.get("max_offset") / 2 ** k);

  const columns = addElement(root, "div", { className: "hdrlab-columns" });
  const leftColumn = addElement(columns, "div", { className: "hdrlab-column" });
  const { frame, canvas, context } = addBitmap(leftColumn);
  const rightColumn = addElement(columns, "div", { className: "hdrlab-column" });
  const buttons = addLevelButtons(rightColumn, levels, changeLevel);
  const exclusionBox = addExclusionBox(rightColumn, model.get("is_excluding"));
  exclusionBox.addEventListener("change", () => save("is_excluding", exclusionBox.checked));
  const bar = addElement(rightColumn, "div", { className: "hdrlab-count" });
  const errorBar = addElement(bar, "i");
  const leastErrorMark = addElement(bar, "b");
  const showStatus = addStatusLine(rightColumn);
  const offsetMap = addOffsetMap(rightColumn);

  // The errors of the offsets that the reader has tried, separately for each level, and with and
  // without exclusion. `maxError` is the largest error of nine offsets all over the map.
  const histories = new Map();
  function currentHistory() {
    const key = `${level()} ${model.get("is_excluding")}`;
    if (!histories.has(key)) {
      const reach = maxOffsetOf(level());
      const ends = [-reach, 0, reach];
      const samples = ends.flatMap((dy) =>
        ends.map((dx) => compareBitmaps(levels[level()], [dy, dx], tables()).error),
      );
      histories.set(key, { reach, maxError: Math.max(...samples), errors: new Map() });
    }
    return histories.get(key);
  }

  let shownLevel = -1;
  let paintedOffset = null; // null: nothing is painted at this level
  let image = null;
  let isAloud = false;

  // The offsets since the last frame of the display: a hand is faster than the display.
  function takePassedOffsets() {
    const passed = offsetsBetween(paintedOffset ?? offset(), offset());
    paintedOffset = offset();
    return passed;
  }

  function resize() {
    shownLevel = level();
    paintedOffset = null;
    canvas.width = levels[shownLevel].width;
    canvas.height = levels[shownLevel].height;
    image = context.createImageData(canvas.width, canvas.height);
    offsetMap.canvas.width = 2 * maxOffsetOf(shownLevel) + 1;
    offsetMap.canvas.height = offsetMap.canvas.width;
    buttons.forEach((button, k) => button.setAttribute("aria-pressed", k === shownLevel));
  }

  // Add the offsets since the last frame to the history, and return it.
  function updateHistory() {
    const history = currentHistory();
    for (const passed of takePassedOffsets()) {
      const [dy, dx] = passed;
      const key = `${dy} ${dx}`;
      if (!history.errors.has(key)) {
        const { error } = compareBitmaps(levels[shownLevel], passed, tables());
        history.errors.set(key, { dy, dx, error });
      }
    }
    return history;
  }

  function paint() {
    if (shownLevel !== level()) resize();
    exclusionBox.checked = model.get("is_excluding");
    const pixels = new Uint32Array(image.data.buffer);
    const { count, total, error } = compareBitmaps(levels[shownLevel], offset(), tables(), pixels);
    context.putImageData(image, 0, 0);

    const history = updateHistory();
    const best = [...history.errors.values()].reduce((a, b) => (b.error < a.error ? b : a));
    const barLength = (value) => `${100 * Math.min(value / history.maxError || 0, 1)}%`;
    errorBar.style.width = barLength(error);
    leastErrorMark.style.left = barLength(best.error);
    offsetMap.paint(history, offset());
    offsetMap.text.textContent =
      "A square for each offset that you tried, darker where fewer bits differ. " +
      `Fewest so far: ${percentOf(best.error)} at ${offsetText([best.dy, best.dx])}.`;

    const moved = offsetText(offset());
    canvas.setAttribute("aria-label", `${model.get("alt")}, moved by ${moved}`);
    showStatus(
      `Moved by ${moved}: ${count} of ${total} compared bits differ, ${percentOf(error)}.`,
      isAloud,
    );
  }
  const repaint = oncePerFrame(paint);

  function save(name, value) {
    saveTrait(model, name, value);
    repaint();
  }

  function moveTo(newOffset, isByKey) {
    isAloud = isByKey;
    const reach = maxOffsetOf(level());
    const clamped = newOffset.map((pixels) => clamp(pixels, -reach, reach));
    save("offset", clamped);
  }

  // Scale the offset with the level: it is twice as large at the next finer one, as in the search.
  function changeLevel(newLevel) {
    const factor = 2 ** (level() - newLevel);
    const newOffset = offset().map((pixels) => Math.round(pixels * factor));
    model.set("level", newLevel);
    moveTo(newOffset, true);
  }

  let grabPosition = null; // of the pointer, and the offset at that moment
  let grabOffset = null;
  makeDraggable(frame, canvas, {
    grab(position) {
      grabPosition = position;
      grabOffset = offset();
    },
    moveTo([x, y]) {
      const dy = Math.round((y - grabPosition[1]) * canvas.height);
      const dx = Math.round((x - grabPosition[0]) * canvas.width);
      moveTo([grabOffset[0] + dy, grabOffset[1] + dx], false);
    },
    stepBy: (right, down) => moveTo([offset()[0] + down, offset()[1] + right], true),
  });
  const traits = ["offset", "level", "is_excluding"];
  const stopListening = onTraitChange(model, traits, repaint);
  paint();
  return stopListening;
}

export default { render };
