// `widgets.brush`: the Detail Brush over a radiance map. It equalizes the histogram of the window
// under it, with the formulas of tonemap/brush.py and core/colour.py, in each frame of the display.
//
// Python sends
//   radiance       half floats (H, W, channels), multiplied by `scale`: E, any linear unit
//   shape          (H, W, channels)
//   picture        WebP, the image around the brush
//   alt            what the map shows
//   bins           bins of the histogram
// and both sides set
//   centre         (y, x), pixels
//   size           the side of the brush, pixels
//   magnification  how much larger the brush shows its window
//   limit          no bin counts more than this multiple of the mean

const CLIPPED_FRACTION = 1e-4; // of the lit pixels at each end, as in core/extremes.py
const MIN_LUMINANCE_RATIO = 2; // that the bins span at least, as in tonemap/brush.py
const SMALLEST_FLOAT32 = 2 ** -126; // the smallest normal number
const MIN_LUMINANCE = 1e-30; // below this, a pixel has no color, as in core/colour.py
const MAX_RANK_STEP = 65535; // of ln L over the whole map: finds ranks without sorting
const MIN_LN_RANGE = 1e-9;
const LUMINANCE_WEIGHTS = [0.2126, 0.7152, 0.0722]; // of red, green, blue: core/colour.py
const NEAR_STEP = 16; // pixels that an arrow key moves the brush
const FAR_STEP = 64; // with Shift
const SIZES = Array.from({ length: 15 }, (_, k) => 64 + 32 * k); // 64 to 512 pixels
const MAGNIFICATIONS = [1, 2, 3, 4, 5, 6, 7, 8];
const LIMITS = [1, 2, 4, 8, 16];
const MOVES = {
  ArrowLeft: [0, -1],
  ArrowRight: [0, 1],
  ArrowUp: [-1, 0],
  ArrowDown: [1, 0],
};
// The keys that change a parameter, and by how many positions of its slider.
const PARAMETER_KEYS = {
  "[": ["size", -1],
  "]": ["size", 1],
  "-": ["magnification", -1],
  _: ["magnification", -1],
  "+": ["magnification", 1],
  "=": ["magnification", 1],
};

// Calculate what does not change while the brush moves: L, ln L, its rank step (0 for the darkest
// pixel, MAX_RANK_STEP for the brightest), and E / L of each channel.
function prepareMap(bits, scale, channels) {
  const count = bits.length / channels;
  const L = new Float32Array(count);
  const lnL = new Float32Array(count);
  const rankSteps = new Uint16Array(count);
  const ratios = new Float32Array(bits.length).fill(1);
  const [red, green, blue] = LUMINANCE_WEIGHTS;
  let low = Infinity;
  let high = -Infinity;
  for (let i = 0; i < count; i++) {
    const E = (c) => HALF_VALUES[bits[channels * i + c]] / scale;
    L[i] = channels === 1 ? E(0) : red * E(0) + green * E(1) + blue * E(2);
    lnL[i] = Math.log(Math.max(L[i], SMALLEST_FLOAT32));
    if (L[i] > 0) {
      low = Math.min(low, lnL[i]);
      high = Math.max(high, lnL[i]);
    }
    if (channels === 3 && L[i] >= MIN_LUMINANCE) {
      for (let c = 0; c < 3; c++) ratios[3 * i + c] = E(c) / L[i];
    }
  }
  const stepsPerLn = MAX_RANK_STEP / Math.max(high - low, MIN_LN_RANGE);
  for (let i = 0; i < count; i++) {
    rankSteps[i] = L[i] > 0 ? (lnL[i] - low) * stepsPerLn : 0;
  }
  return { L, lnL, rankSteps, ratios, channels };
}

// Call `run` with the first and the last + 1 index of each row of an area.
function forEachRow({ x, y, columns, rows }, width, run) {
  for (let row = y; row < y + rows; row++) {
    const first = row * width + x;
    run(first, first + columns);
  }
}

const rankCounts = new Uint32Array(MAX_RANK_STEP + 1); // kept between the frames of the display

// Count the lit pixels of an area at each rank step into `rankCounts`, and return their number.
function countLitPixels(map, area, width) {
  let litCount = 0;
  rankCounts.fill(0);
  forEachRow(area, width, (first, end) => {
    for (let i = first; i < end; i++) {
      if (map.L[i] > 0) {
        rankCounts[map.rankSteps[i]] += 1;
        litCount += 1;
      }
    }
  });
  return litCount;
}

// The luminance of a rank among the lit pixels of an area, from `rankCounts`.
function luminanceOfRank(map, area, width, rank) {
  let remaining = rank;
  let step = 0;
  while (remaining >= rankCounts[step]) {
    remaining -= rankCounts[step];
    step += 1;
  }
  const luminances = []; // of the pixels at this step
  forEachRow(area, width, (first, end) => {
    for (let i = first; i < end; i++) {
      if (map.rankSteps[i] === step && map.L[i] > 0) luminances.push(map.L[i]);
    }
  });
  return luminances.sort((a, b) => a - b)[remaining];
}

// The lowest and the highest luminance of an area: find_range in tonemap/brush.py.
function findRange(map, area, width) {
  const litCount = countLitPixels(map, area, width);
  let low = 1;
  let high = 1;
  if (litCount > 0) {
    const maxClipped = Math.floor((litCount - 1) / 2);
    const clipped = Math.min(Math.max(1, Math.floor(CLIPPED_FRACTION * litCount)), maxClipped);
    low = luminanceOfRank(map, area, width, clipped);
    high = luminanceOfRank(map, area, width, litCount - 1 - clipped);
  }
  const widening = Math.max(1, (MIN_LUMINANCE_RATIO * low) / high) ** 0.5;
  return [low / widening, high * widening];
}

// The fractions of the pixels in each bin: histogram in tonemap/brush.py. A pixel counts in the two
// bins whose centers it lies between.
function histogramOf(map, area, width, { lnLow, binsPerLn, bins }) {
  const counts = new Float64Array(bins + 1);
  forEachRow(area, width, (first, end) => {
    for (let i = first; i < end; i++) {
      const position = clamp((map.lnL[i] - lnLow) * binsPerLn - 0.5, 0, bins - 1);
      const left = position | 0; // rounded down
      counts[left] += 1 - (position - left);
      counts[left + 1] += position - left;
    }
  });
  return counts.subarray(0, bins).map((count) => count / (area.columns * area.rows));
}

// clip_histogram in tonemap/brush.py: no bin above the limit, and the excess distributed over the
// bins in proportion to the room below the limit.
function clipHistogram(h, limit) {
  const top = Math.min(limit / h.length, 1);
  const clipped = h.map((fraction) => Math.min(fraction, top));
  const room = clipped.map((fraction) => top - fraction);
  const excess = 1 - sumOf(clipped);
  const factor = excess / Math.max(sumOf(room), 1e-12);
  return clipped.map((fraction, bin) => fraction + room[bin] * factor);
}

// Display luminance at the edges of the bins: decode(P). The last value is there twice, because the
// curve is level beyond the last edge.
function curveOf(h) {
  const Ld = new Float64Array(h.length + 2);
  let P = 0;
  h.forEach((fraction, bin) => {
    P += fraction;
    Ld[bin + 1] = decodeSrgb(Math.min(P, 1));
  });
  Ld[h.length + 1] = Ld[h.length];
  return Ld;
}

// Equalize an area and write it into `pixels`, 32 bits each. Return the range of luminance.
function equalize(map, area, width, { bins, limit }, pixels) {
  const { lnL, ratios, channels } = map;
  const [low, high] = findRange(map, area, width);
  const lnLow = Math.fround(Math.log(low));
  const binsPerLn = Math.fround(bins / Math.log(high / low));
  const h = histogramOf(map, area, width, { lnLow, binsPerLn, bins });
  const lightAtEdge = curveOf(clipHistogram(h, limit)).map((Ld) => LIGHT_STEPS * Ld);

  function colorOf(i, light) {
    if (channels === 1) {
      const gray = pixelValue(light);
      return opaquePixel(gray, gray, gray);
    }
    const red = pixelValue(light * ratios[3 * i]);
    const green = pixelValue(light * ratios[3 * i + 1]);
    const blue = pixelValue(light * ratios[3 * i + 2]);
    return opaquePixel(red, green, blue);
  }

  let target = 0;
  forEachRow(area, width, (first, end) => {
    for (let i = first; i < end; i++) {
      const position = clamp((lnL[i] - lnLow) * binsPerLn, 0, bins);
      const left = position | 0; // rounded down
      const slope = lightAtEdge[left + 1] - lightAtEdge[left];
      pixels[target] = colorOf(i, lightAtEdge[left] + (position - left) * slope);
      target += 1;
    }
  });
  return [low, high];
}

// Along one axis: where the brush begins and how long it is, and the same for its window. The brush
// stays inside the image. The window is inside the brush, and begins where magnifying it does not
// move the pixel under the pointer.
function placeAlongAxis(centre, length, size, magnification) {
  const brushLength = Math.min(size, length);
  const brushStart = clamp(Math.round(centre - brushLength / 2), 0, length - brushLength);
  const windowLength = Math.min(Math.ceil(size / magnification), length);
  const before = (centre - brushStart) / magnification; // pixels of the window before the centre
  const windowStart = clamp(Math.round(centre - before), 0, length - windowLength);
  return { brushStart, brushLength, windowStart, windowLength };
}

const stopsText = ([low, high]) => Math.log2(high / low).toFixed(1);

async function render({ model, el }) {
  const root = createRoot(el, "brush");
  const keyHelp =
    `arrow keys move the brush by ${NEAR_STEP} pixels, with Shift by ${FAR_STEP}; ` +
    "brackets change its size, plus and minus its magnification";
  const { frame, canvas, context } = addStage(root, `Detail Brush: ${keyHelp}`);
  const showStatus = addStatusLine(root);
  const [height, width, channels] = model.get("shape");
  const picture = await decodeImage(model.get("picture"), "image/webp");
  const bits = await decodeHalves(model.get("radiance"), channels);
  const map = prepareMap(bits, model.get("scale"), channels);
  canvas.width = width;
  canvas.height = height;
  const wholeRange = findRange(map, { x: 0, y: 0, columns: width, rows: height }, width);
  const lens = document.createElement("canvas"); // the equalized window, not yet magnified
  let pixels = null; // the ImageData of the lens
  let isAloud = false;
  let isPointerUsed = false;

  // The rectangle of the brush, and that of its window.
  function findAreas() {
    const [y, x] = model.get("centre");
    const size = model.get("size");
    const magnification = model.get("magnification");
    const across = placeAlongAxis(x, width, size, magnification);
    const down = placeAlongAxis(y, height, size, magnification);
    return {
      brush: [across.brushStart, down.brushStart, across.brushLength, down.brushLength],
      window: {
        x: across.windowStart,
        y: down.windowStart,
        columns: across.windowLength,
        rows: down.windowLength,
      },
    };
  }

  function resizeLens({ columns, rows }) {
    if (pixels?.width === columns && pixels?.height === rows) return;
    lens.width = columns;
    lens.height = rows;
    pixels = new ImageData(columns, rows);
  }

  function drawOutline(brush) {
    const strokes = [
      ["#000", 4],
      ["#fff", 2],
    ];
    for (const [color, lineWidth] of strokes) {
      context.strokeStyle = color;
      context.lineWidth = (lineWidth * Math.max(width, 600)) / 800;
      context.strokeRect(...brush);
    }
  }

  function paint() {
    const areas = findAreas();
    const [x, y, columns, rows] = areas.brush;
    const magnification = model.get("magnification");
    resizeLens(areas.window);
    const parameters = { bins: model.get("bins"), limit: model.get("limit") };
    const target = new Uint32Array(pixels.data.buffer);
    const range = equalize(map, areas.window, width, parameters, target);
    lens.getContext("2d").putImageData(pixels, 0, 0);
    context.drawImage(picture, 0, 0);
    context.imageSmoothingEnabled = false;
    const source = [0, 0, columns / magnification, rows / magnification];
    context.drawImage(lens, ...source, x, y, columns, rows);
    drawOutline(areas.brush);
    describe(range);
  }

  function describe(range) {
    const [y, x] = model.get("centre");
    const magnification = model.get("magnification");
    let position = `x ${x}, y ${y}, size ${model.get("size")}`;
    if (magnification > 1) position += `, magnification ${magnification}`;
    canvas.setAttribute("aria-label", `${model.get("alt")}, the brush at ${position}`);
    const isUsed = isAloud || isPointerUsed;
    const hint = isUsed ? "" : " The pointer or the arrow keys move the brush.";
    const stops = `${stopsText(range)} of the map's ${stopsText(wholeRange)} stops`;
    showStatus(`${position}: ${stops}.${hint}`, isAloud);
  }
  const repaint = oncePerFrame(paint);

  // Append a slider for a trait. Its position is that of the value nearest to the trait.
  const controls = addElement(root, "div", { className: "hdrlab-controls" });
  function addParameter(name, values) {
    const slider = addSlider(controls, name, values.length);
    const position = () => {
      const value = model.get(name);
      return indexOfLeast(values.map((other) => Math.abs(other - value)));
    };
    const setPosition = (index) => change(name, values[clamp(index, 0, values.length - 1)]);
    slider.input.addEventListener("input", () => setPosition(slider.position()));
    return {
      show: () => slider.show(position(), `${model.get(name)}`),
      moveBy: (steps) => setPosition(position() + steps),
    };
  }
  const parameters = {
    size: addParameter("size", SIZES),
    magnification: addParameter("magnification", MAGNIFICATIONS),
    limit: addParameter("limit", LIMITS),
  };

  function change(name, value) {
    saveTrait(model, name, value);
    update();
  }

  function update() {
    for (const parameter of Object.values(parameters)) parameter.show();
    repaint();
  }

  function moveTo(y, x) {
    const row = clamp(Math.round(y), 0, height - 1);
    const column = clamp(Math.round(x), 0, width - 1);
    change("centre", [row, column]);
  }

  frame.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    isAloud = true;
    if (MOVES[event.key]) {
      const length = event.shiftKey ? FAR_STEP : NEAR_STEP;
      const [down, right] = MOVES[event.key];
      const [y, x] = model.get("centre");
      moveTo(y + length * down, x + length * right);
    } else if (PARAMETER_KEYS[event.key]) {
      const [name, steps] = PARAMETER_KEYS[event.key];
      parameters[name].moveBy(steps);
    } else {
      return;
    }
    event.preventDefault();
  });

  function followPointer(event) {
    const [x, y] = pointerPosition(event, canvas);
    isAloud = false;
    isPointerUsed = true;
    moveTo(y * height, x * width);
  }

  frame.addEventListener("pointerdown", (event) => {
    frame.setPointerCapture(event.pointerId);
    followPointer(event);
  });
  frame.addEventListener("pointermove", followPointer);

  const traits = ["centre", "size", "magnification", "limit"];
  const stopListening = onTraitChange(model, traits, update);
  update();
  return stopListening;
}

export default { render };
