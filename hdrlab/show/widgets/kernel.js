// `widgets.bilateral_kernel`: the kernel of the bilateral filter on one line of pixels. The reader
// moves the kernel and changes its widths. The formulas are those of core/filters/bilateral.py.
//
// Python sends
//   signal   v (N,), such as log luminance along a row
//   span     the ends of the vertical axis, in the unit of the signal
//   name     what the signal is
//   unit     its unit
// and both sides set
//   at       p, the pixel in the middle of the kernel
//   sigma_s  the width of the weights by place g, pixels
//   sigma_r  the width of the weights by value w, in the unit of the signal

const REACH_IN_SIGMAS = 3; // the kernel ends at this many sigma_s
const STEPS_PER_OCTAVE = 4; // a key press changes a width by a quarter of an octave
const SIGMA_S_RANGE = [1, 32]; // pixels
const SIGMA_R_RANGE = [1 / 64, 2]; // fractions of the height of the plot
const DOT_WEIGHTS = [0.02, 0.2, 0.4, 0.6, 0.8]; // a neighbor with more weight has a larger dot
const CURVE_POINTS = 80;
const MAX_CURVE = 0.94; // the largest weight, as a fraction of the size of its plot
const WEIGHT_AT_SIGMA = Math.exp(-0.5); // of a Gaussian, at a distance of sigma

const gaussian = (distance, sigma) => Math.exp(-(distance ** 2) / (2 * sigma ** 2));
const reachOf = (v, sigmaS) => Math.min(Math.ceil(REACH_IN_SIGMAS * sigmaS), v.length);

// The weights of all pixels for the pixel p, by place g, by value w and both, with their sums and
// the weighted mean of v.
function weighPixels(v, p, sigmaS, sigmaR) {
  const reach = reachOf(v, sigmaS);
  const g = v.map((_, q) => (Math.abs(q - p) <= reach ? gaussian(q - p, sigmaS) : 0));
  const w = v.map((value) => gaussian(value - v[p], sigmaR));
  const product = g.map((weight, q) => weight * w[q]);
  const productSum = sumOf(product);
  const mean = sumOf(v.map((value, q) => product[q] * value)) / productSum;
  return { g, w, product, gSum: sumOf(g), productSum, mean };
}

// The filtered line. A table holds the weights by place, because this runs for each frame of the
// display.
function filterLine(v, sigmaS, sigmaR) {
  const reach = reachOf(v, sigmaS);
  const g = Array.from({ length: reach + 1 }, (_, distance) => gaussian(distance, sigmaS));
  const factor = -1 / (2 * sigmaR ** 2);
  return v.map((center, p) => {
    let weightedSum = 0;
    let weightSum = 0;
    const last = Math.min(p + reach, v.length - 1);
    for (let q = Math.max(p - reach, 0); q <= last; q++) {
      const weight = g[Math.abs(q - p)] * Math.exp(factor * (v[q] - center) ** 2);
      weightedSum += weight * v[q];
      weightSum += weight;
    }
    return weightedSum / weightSum;
  });
}

const percentInBox = (fraction) => `${100 * clamp(fraction, 0, 1)}%`;
const minusText = (number) => String(number).replace("-", "−");

// Append the plot of the line, with the bands of the kernel and a mark at the mean.
function addLinePlot(grid, v, ticks) {
  const side = addElement(grid, "div", { className: "hdrlab-side-labels" });
  addSideLabels(side, "hdrlab-is-L", ticks);
  const label = "Pixel in the middle of the kernel";
  const plot = addPlotSlider(grid, "hdrlab-levels", label, [0, v.length - 1]);
  const addBand = (name) =>
    addElement(plot.frame, "i", { className: `hdrlab-band hdrlab-band-${name}` });
  const placeBand = addBand("place");
  const valueBand = addBand("value");
  const dotClasses = DOT_WEIGHTS.map((_, k) => `hdrlab-is-L hdrlab-dots hdrlab-dots-${k}`);
  const [signal, blurred, filtered, ...dots] = addPaths(plot.frame, [
    "hdrlab-is-L",
    "hdrlab-is-g hdrlab-dashed",
    "hdrlab-strong",
    ...dotClasses,
  ]);
  const meanMark = addElement(plot.frame, "i", { className: "hdrlab-mark" });
  const pixelName = addElement(plot.frame, "b", { className: "hdrlab-held-here", ...HIDDEN });
  return { plot, placeBand, valueBand, signal, blurred, filtered, dots, meanMark, pixelName };
}

// Append a row of bars, for weights that no reader changes.
function addWeightBars(grid, className) {
  const [bars] = addPaths(addElement(grid, "div", { className }), ["hdrlab-area"]);
  return bars;
}

async function render({ model, el }) {
  const root = createRoot(el, "kernel");
  const v = model.get("signal");
  const [low, high] = model.get("span");
  const unit = model.get("unit");
  const at = () => model.get("at");
  const sigmaS = () => model.get("sigma_s");
  const sigmaR = () => model.get("sigma_r");
  const sigmaRRange = SIGMA_R_RANGE.map((fraction) => fraction * (high - low));
  // Positions in the plot, as fractions from the left and from the top.
  const leftOf = (q) => (q + 0.5) / v.length;
  const topOf = (value) => (high - value) / (high - low);

  // The plot, with the weights by value at its right. Below: weights by place, by value, and both.
  addAxisText(root, [
    `↑ ${model.get("name")}, ${unit}: `,
    ["the pixels", "hdrlab-is-L"],
    ", ",
    ["means by place only", "hdrlab-is-g"],
    " (Gaussian blur), ",
    ["means by both", "hdrlab-strong"],
  ]);
  const grid = addElement(root, "div", { className: "hdrlab-kernel" });
  const ticks = roundNumbers(low, high, 4).map((value) => [topOf(value), minusText(value)]);
  const line = addLinePlot(grid, v, ticks);
  line.signal.setAttribute("d", linePath(v, topOf));

  const valueLabel = `Height of the kernel in value, ${unit}`;
  const valueSlider = addPlotSlider(grid, "hdrlab-side hdrlab-is-w", valueLabel, sigmaRRange);
  valueSlider.frame.setAttribute("aria-orientation", "vertical");
  const [valueCurve] = addPaths(valueSlider.frame, ["hdrlab-area"]);
  const valueKnob = addElement(valueSlider.frame, "i", {
    className: "hdrlab-knob",
    textContent: "↕",
  });

  const [placeText] = addAxisText(grid, [["", "hdrlab-is-g"]]);
  const placeLabel = "Width of the kernel in place, pixels";
  const placeClass = "hdrlab-weights hdrlab-is-g";
  const placeSlider = addPlotSlider(grid, placeClass, placeLabel, SIGMA_S_RANGE);
  const [placeBars] = addPaths(placeSlider.frame, ["hdrlab-area"]);
  const placeKnob = addElement(placeSlider.frame, "i", {
    className: "hdrlab-knob",
    textContent: "↔",
  });
  const [valueText] = addAxisText(grid, [["", "hdrlab-is-w"]]);
  const valueBars = addWeightBars(grid, "hdrlab-weights hdrlab-is-w");
  const [bothText] = addAxisText(grid, [["", "hdrlab-strong"]]);
  const bothBars = addWeightBars(grid, "hdrlab-weights");
  const places = roundNumbers(0, v.length - 1, 5).map((q) => [leftOf(q), q]);
  addFootLabels(grid, places);
  addAxisText(grid, ["→ place, pixels"]);
  const showStatus = addStatusLine(root);

  // Paint the filtered lines, unless the widths are those of the lines that are painted.
  let paintedWidths = null;
  function paintFilteredLines() {
    const widths = `${sigmaS()} ${sigmaR()}`;
    if (paintedWidths === widths) return;
    paintedWidths = widths;
    line.filtered.setAttribute("d", linePath(filterLine(v, sigmaS(), sigmaR()), topOf));
    line.blurred.setAttribute("d", linePath(filterLine(v, sigmaS(), Infinity), topOf));
  }

  // Paint a dot at each neighbor, in the size class of its weight.
  function paintDots(weights) {
    DOT_WEIGHTS.forEach((minWeight, k) => {
      const maxWeight = DOT_WEIGHTS[k + 1] ?? Infinity;
      const isInClass = (q) => weights[q] > minWeight && weights[q] <= maxWeight;
      const points = [...v.keys()].filter(isInClass).map((q) => [leftOf(q), topOf(v[q])]);
      line.dots[k].setAttribute("d", dotPath(points));
    });
  }

  // Paint the curve of the weights by value, at the right of the plot.
  function paintValueCurve() {
    const points = Array.from({ length: CURVE_POINTS + 1 }, (_, k) => {
      const down = k / CURVE_POINTS;
      const value = high - down * (high - low);
      return pathPoint(MAX_CURVE * gaussian(value - v[at()], sigmaR()), down);
    });
    valueCurve.setAttribute("d", `M0,0L${points.join("L")}L0,1Z`);
  }

  // The distance from the top of a weight in a row of bars.
  const barTop = (weight) => 1 - MAX_CURVE * weight;
  // The side of the middle that has more room for a knob: 1 right or down, -1 left or up.
  const roomierSide = (fraction) => (fraction < 0.5 ? 1 : -1);

  // Place the bands, the marks and the knobs of the kernel.
  function placeParts(mean) {
    const x = leftOf(at());
    const y = topOf(v[at()]);
    const halfWidth = sigmaS() / v.length;
    const halfHeight = sigmaR() / (high - low);
    line.placeBand.style.left = percentInBox(x - halfWidth);
    line.placeBand.style.right = percentInBox(1 - x - halfWidth);
    line.valueBand.style.top = percentInBox(y - halfHeight);
    line.valueBand.style.bottom = percentInBox(1 - y - halfHeight);
    line.pixelName.textContent = `pixel ${at()}`;
    line.pixelName.style.left = percentInBox(x);
    line.pixelName.style.transform = `translateX(-${percentInBox(x)})`; // it stays inside the plot
    line.meanMark.style.left = percentInBox(x);
    line.meanMark.style.top = percentInBox(topOf(mean));
    placeKnob.style.left = percentInBox(x + roomierSide(x) * halfWidth);
    placeKnob.style.top = `${100 * barTop(WEIGHT_AT_SIGMA)}%`;
    valueKnob.style.top = percentInBox(y + roomierSide(y) * halfHeight);
    valueKnob.style.left = `${100 * MAX_CURVE * WEIGHT_AT_SIGMA}%`;
  }

  let isAloud = false;
  function paint() {
    paintFilteredLines();
    const { g, w, product, gSum, productSum, mean } = weighPixels(v, at(), sigmaS(), sigmaR());
    placeBars.setAttribute("d", barPath(g, barTop, 1));
    valueBars.setAttribute("d", barPath(w, barTop, 1));
    bothBars.setAttribute("d", barPath(product, barTop, 1));
    paintValueCurve();
    paintDots(product);
    placeParts(mean);

    const width = threeDigits(sigmaS());
    const height = threeDigits(sigmaR());
    placeText.textContent = `near in place: width σs = ${width} pixels`;
    valueText.textContent = `near in value: height σr = ${height} ${unit}`;
    bothText.textContent = `both: place × value, ${productSum.toFixed(1)} pixels`;
    line.plot.setValue(at(), `pixel ${at()}, mean ${mean.toFixed(2)} ${unit}`);
    placeSlider.setValue(sigmaS(), `${width} pixels`);
    valueSlider.setValue(sigmaR(), `${height} ${unit}`);
    showStatus(
      `Around pixel ${at()}, the weights by place add up to ${gSum.toFixed(1)} pixels, ` +
        `and with the weights by value to ${productSum.toFixed(1)}. ` +
        `Their mean is ${signedText(mean, 2)} ${unit}.`,
      isAloud,
    );
  }
  const repaint = oncePerFrame(paint);

  function save(name, value, isByKey) {
    isAloud = isByKey;
    saveTrait(model, name, value);
    repaint();
  }

  const clampTwoDigits = (value, range) => clamp(Number(value.toPrecision(2)), ...range);
  const setPixel = (q, isByKey) => save("at", clamp(Math.round(q), 0, v.length - 1), isByKey);
  const setSigmaS = (value, isByKey) =>
    save("sigma_s", clampTwoDigits(value, SIGMA_S_RANGE), isByKey);
  const setSigmaR = (value, isByKey) =>
    save("sigma_r", clampTwoDigits(value, sigmaRRange), isByKey);
  const growth = (steps) => 2 ** (steps / STEPS_PER_OCTAVE);

  makeDraggable(line.plot.frame, line.plot.frame, {
    grab: () => line.plot.frame.focus({ preventScroll: true }),
    moveTo: ([x]) => setPixel(x * v.length - 0.5, false),
    stepBy: (right, down) => setPixel(at() + right - down, true),
  });
  makeDraggable(placeSlider.frame, placeSlider.frame, {
    grab: () => placeSlider.frame.focus({ preventScroll: true }),
    moveTo: ([x]) => setSigmaS(Math.abs(x - leftOf(at())) * v.length, false),
    stepBy: (right, down) => setSigmaS(sigmaS() * growth(right - down), true),
    farStep: STEPS_PER_OCTAVE,
  });
  makeDraggable(valueSlider.frame, valueSlider.frame, {
    grab: () => valueSlider.frame.focus({ preventScroll: true }),
    moveTo: ([, y]) => setSigmaR(Math.abs(y - topOf(v[at()])) * (high - low), false),
    stepBy: (right, down) => setSigmaR(sigmaR() * growth(right - down), true),
    farStep: STEPS_PER_OCTAVE,
  });
  const stopListening = onTraitChange(model, ["at", "sigma_s", "sigma_r"], repaint);
  paint();
  return stopListening;
}

export default { render };
