// The bilateral filter on a line of pixels, under the reader's hand: core/filters/bilateral.py again.

const REACH = 3; // the kernel ends at this many sigma_s
const STEPS_PER_OCTAVE = 4; // a key press changes a width by a quarter of an octave
const SIGMA_S_RANGE = [1, 32]; // pixels
const SIGMA_R_RANGE = [1 / 64, 2]; // fractions of the height of the plot
const DOT_CLASSES = [0.02, 0.2, 0.4, 0.6, 0.8]; // a neighbor of more weight is drawn as a larger dot
const CURVE_POINTS = 80;

const bell = (distance, sigma) => Math.exp(-(distance ** 2) / (2 * sigma ** 2));

// The weights of all pixels for the pixel p, and the mean with both and with those by place only.
function weigh(v, p, sigmaS, sigmaR) {
  const reach = Math.min(Math.ceil(REACH * sigmaS), v.length);
  const g = v.map((_, q) => (Math.abs(q - p) <= reach ? bell(q - p, sigmaS) : 0));
  const w = v.map((value) => bell(value - v[p], sigmaR));
  const product = g.map((weight, q) => weight * w[q]);
  const sum = (weights) => weights.reduce((total, weight) => total + weight, 0);
  const mean = (weights) => v.reduce((total, value, q) => total + weights[q] * value, 0) / sum(weights);
  return { g, w, product, near: sum(g), k: sum(product), mean: mean(product), blur: mean(g) };
}

// The means of all pixels; a table of weights by place, because this runs for each frame of the display.
function filterLine(v, sigmaS, sigmaR) {
  const reach = Math.min(Math.ceil(REACH * sigmaS), v.length);
  const near = Array.from({ length: reach + 1 }, (_, distance) => bell(distance, sigmaS));
  const factor = -1 / (2 * sigmaR ** 2);
  return v.map((center, p) => {
    let [total, k] = [0, 0];
    for (let q = Math.max(p - reach, 0); q <= Math.min(p + reach, v.length - 1); q++) {
      const weight = near[Math.abs(q - p)] * Math.exp(factor * (v[q] - center) ** 2);
      total += weight * v[q];
      k += weight;
    }
    return total / k;
  });
}

async function render({ model, el }) {
  const root = start(el, "kernel");
  const v = model.get("signal");
  const [low, high] = model.get("span");
  const unit = model.get("unit");
  const [p, sigmaS, sigmaR] = ["at", "sigma_s", "sigma_r"].map((name) => () => model.get(name));
  const across = (q) => (q + 0.5) / v.length;
  const up = (value) => (high - value) / (high - low);
  const rangeR = SIGMA_R_RANGE.map((fraction) => fraction * (high - low));

  // The plot, and at its right the weights by value; below it the weights by place, by value, and both.
  const line = "hdrlab-is-L";
  words(root, [`↑ ${model.get("name")}, ${unit}: `, ["the pixels", line], ", ", ["means by place only", "hdrlab-is-g"], " (Gaussian blur), ", ["means by both", "hdrlab-strong"]]);
  const grid = element(root, "div", { className: "hdrlab-kernel" });
  const heights = roundNumbers(low, high, 4).map((height) => [up(height), String(height).replace("-", "−")]);
  sideLabels(element(grid, "div", { className: "hdrlab-side-labels" }), line, heights);
  const plot = slidable(grid, "hdrlab-levels", "Pixel in the middle of the kernel", [0, v.length - 1]);
  const [column, band] = ["place", "value"].map((name) => element(plot.frame, "i", { className: `hdrlab-band hdrlab-band-${name}` }));
  const dotNames = DOT_CLASSES.map((_, k) => `${line} hdrlab-dots hdrlab-dots-${k}`);
  const [signal, blurred, filtered, ...dots] = paths(plot.frame, [line, "hdrlab-is-g hdrlab-dashed", "hdrlab-strong", ...dotNames]);
  signal.setAttribute("d", linePath(v, up));
  const mark = element(plot.frame, "i", { className: "hdrlab-mark" });
  const pixel = element(plot.frame, "b", { className: "hdrlab-held-here", ...HIDDEN });

  const value = slidable(grid, "hdrlab-side hdrlab-is-w", `Height of the kernel in value, ${unit}`, rangeR);
  value.frame.setAttribute("aria-orientation", "vertical");
  const [valueCurve] = paths(value.frame, ["hdrlab-area"]);
  const valueKnob = element(value.frame, "i", { className: "hdrlab-knob", textContent: "↕" });

  const [placeWords] = words(grid, [["", "hdrlab-is-g"]]);
  const place = slidable(grid, "hdrlab-weights hdrlab-is-g", "Width of the kernel in place, pixels", SIGMA_S_RANGE);
  const [placeBars] = paths(place.frame, ["hdrlab-area"]);
  const placeKnob = element(place.frame, "i", { className: "hdrlab-knob", textContent: "↔" });
  const [valueWords] = words(grid, [["", "hdrlab-is-w"]]);
  const [valueBars] = paths(element(grid, "div", { className: "hdrlab-weights hdrlab-is-w" }), ["hdrlab-area"]);
  const [bothWords] = words(grid, [["", "hdrlab-strong"]]);
  const [bothBars] = paths(element(grid, "div", { className: "hdrlab-weights" }), ["hdrlab-area"]);
  const ends = roundNumbers(0, v.length - 1, 5).map((q) => [across(q), q]);
  footLabels(grid, ends);
  words(grid, ["→ place, pixels"]);
  const say = teller(root);

  const inBox = (share) => `${100 * clamp(share, 0, 1)}%`;
  // Where a width can be held: on the side that has more room.
  const side = (share) => (share < 0.5 ? 1 : -1);
  let widths = null; // those of the lines that are drawn

  function paintLines() {
    const asked = `${sigmaS()} ${sigmaR()}`;
    if (widths === asked) return;
    widths = asked;
    filtered.setAttribute("d", linePath(filterLine(v, sigmaS(), sigmaR()), up));
    blurred.setAttribute("d", linePath(filterLine(v, sigmaS(), Infinity), up));
  }

  let aloud = false;
  function paint() {
    paintLines();
    const [middle, height] = [v[p()], sigmaR()];
    const { g, w, product, near, k, mean } = weigh(v, p(), sigmaS(), height);
    const half = (weight) => 1 - 0.94 * weight;
    placeBars.setAttribute("d", barPath(g, half, 1));
    valueBars.setAttribute("d", barPath(w, half, 1));
    bothBars.setAttribute("d", barPath(product, half, 1));
    const curve = Array.from({ length: CURVE_POINTS + 1 }, (_, i) => {
      const down = i / CURVE_POINTS;
      return point(0.94 * bell(high - down * (high - low) - middle, height), down);
    });
    valueCurve.setAttribute("d", `M0,0L${curve.join("L")}L0,1Z`);
    DOT_CLASSES.forEach((least, c) => {
      const isHere = (_, q) => product[q] > least && !(product[q] > DOT_CLASSES[c + 1]);
      dots[c].setAttribute("d", dotPath([...v.keys()].filter((q) => isHere(null, q)).map((q) => [across(q), up(v[q])])));
    });
    const reach = sigmaS() / v.length;
    [column.style.left, column.style.right] = [inBox(across(p()) - reach), inBox(1 - across(p()) - reach)];
    const tall = height / (high - low);
    [band.style.top, band.style.bottom] = [inBox(up(middle) - tall), inBox(1 - up(middle) - tall)];
    pixel.textContent = `pixel ${p()}`;
    pixel.style.left = inBox(across(p()));
    pixel.style.transform = `translateX(-${inBox(across(p()))})`; // it stays inside the plot
    [mark.style.left, mark.style.top] = [inBox(across(p())), inBox(up(mean))];
    placeKnob.style.left = inBox(across(p()) + side(across(p())) * reach);
    placeKnob.style.top = `${100 * half(Math.exp(-0.5))}%`;
    valueKnob.style.top = inBox(up(middle) + side(up(middle)) * tall);
    valueKnob.style.left = `${94 * Math.exp(-0.5)}%`;
    const width = threeDigits(sigmaS());
    placeWords.textContent = `near in place: width σs = ${width} pixels`;
    valueWords.textContent = `near in value: height σr = ${threeDigits(height)} ${unit}`;
    bothWords.textContent = `both: place × value, ${k.toFixed(1)} pixels`;
    plot.tell(p(), `pixel ${p()}, mean ${mean.toFixed(2)} ${unit}`);
    place.tell(sigmaS(), `${width} pixels`);
    value.tell(height, `${threeDigits(height)} ${unit}`);
    const counted = `the weights by place add up to ${near.toFixed(1)} pixels, and with the weights by value to ${k.toFixed(1)}`;
    say(`Around pixel ${p()}, ${counted}. Their mean is ${signed(mean, 2)} ${unit}.`, aloud);
  }
  const repaint = eachFrame(paint);

  function set(name, to, byKey) {
    aloud = byKey;
    model.set(name, to);
    model.save_changes();
    repaint();
  }

  const movePixel = (to, byKey) => set("at", clamp(Math.round(to), 0, v.length - 1), byKey);
  const twoDigits = (number, range) => clamp(Number(number.toPrecision(2)), ...range);
  const setPlace = (to, byKey) => set("sigma_s", twoDigits(to, SIGMA_S_RANGE), byKey);
  const setValue = (to, byKey) => set("sigma_r", twoDigits(to, rangeR), byKey);
  const grow = (steps) => 2 ** (steps / STEPS_PER_OCTAVE);

  draggable(plot.frame, plot.frame, {
    grab: () => plot.frame.focus({ preventScroll: true }),
    moveTo: ([right]) => movePixel(right * v.length - 0.5, false),
    stepBy: (right, down) => movePixel(p() + right - down, true),
  });
  draggable(place.frame, place.frame, {
    grab: () => place.frame.focus({ preventScroll: true }),
    moveTo: ([right]) => setPlace(Math.abs(right - across(p())) * v.length, false),
    stepBy: (right, down) => setPlace(sigmaS() * grow(right - down), true),
    farStep: STEPS_PER_OCTAVE,
  });
  draggable(value.frame, value.frame, {
    grab: () => value.frame.focus({ preventScroll: true }),
    moveTo: ([, down]) => setValue(Math.abs(down - up(v[p()])) * (high - low), false),
    stepBy: (right, down) => setValue(sigmaR() * grow(right - down), true),
    farStep: STEPS_PER_OCTAVE,
  });
  const moved = ["at", "sigma_s", "sigma_r"].map((name) => `change:${name}`);
  moved.forEach((event) => model.on(event, repaint));
  paint();
  return () => moved.forEach((event) => model.off(event, repaint));
}

export default { render };
