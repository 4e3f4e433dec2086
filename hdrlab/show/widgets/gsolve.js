// `widgets.gsolve_by_hand`: the reader drags pixels sideways until their points lie on one response
// curve. For the reader's ln E, the widget computes the curve g that minimizes the sum of squares
// of response/debevec.py.
//
// Python sends
//   levels             Z (N, P), the pixel value of pixel i in photo j
//   places             where each pixel is in the photo: fractions (down, right)
//   shutters           the text of each exposure time
//   ln_times           B (P,), the ln of each exposure time in seconds
//   weights            w (256,), the weight of each pixel value
//   smoothness_values  the positions of the slider for lambda
//   solutions          for each of them, the ln E that gsolve finds
//   span               the ends of the horizontal axis, ln exposure
//   photo              WebP
//   alt                what the photo shows
// and both sides set
//   ln_E               (N,), how far the reader has moved each pixel to the right
//   smoothness_index   the position of the slider

const LEVELS = 256;
const MIDDLE_LEVEL = LEVELS / 2; // g(128) = 0 sets the scale
const KEY_STEP = 0.05; // of ln E
const MARGIN_LEVELS = 7; // above 255 and below 0 in the plot, so that no point is cut
const MARGIN_LN = 3; // a pixel can be dragged this far beyond all solutions
const TICK_STEP = 4; // of ln exposure
const ANIMATION_MS = 900;
const DATA_ROW_HEIGHT = 5; // pixels of the image of the matrix
const SMOOTHNESS_ROW_HEIGHT = 0.25;
const UNKNOWN_COLUMN_WIDTH = 8; // of the columns for ln E
// The parts of the sum of squares, and the symbol whose color they have.
const SUM_PARTS = [
  { name: "points", symbol: "E" },
  { name: "smoothness", symbol: "g" },
  { name: "scale", symbol: "t" },
];

// Solve M x = r by M = L D L', for a symmetric M with two bands next to its diagonal. A level that
// is in no equation gets NaN.
function solveBanded({ diagonal, firstBand, secondBand, r }) {
  const n = diagonal.length;
  const D = [...diagonal];
  const L1 = Array(n).fill(0); // bands of L
  const L2 = Array(n).fill(0);
  for (let z = 0; z < n; z++) {
    if (diagonal[z] === 0) continue;
    const filled = z > 0 ? L1[z - 1] * L2[z - 1] * D[z - 1] : 0;
    const first = firstBand[z] - filled;
    L1[z] = first / D[z];
    L2[z] = secondBand[z] / D[z];
    if (z + 1 < n) D[z + 1] -= L1[z] * first;
    if (z + 2 < n) D[z + 2] -= L2[z] * secondBand[z];
  }
  const x = [...r];
  for (let z = 0; z < n; z++) {
    const first = z >= 1 ? L1[z - 1] * x[z - 1] : 0;
    const second = z >= 2 ? L2[z - 2] * x[z - 2] : 0;
    x[z] -= first + second;
  }
  for (let z = n - 1; z >= 0; z--) {
    x[z] /= D[z];
    if (z + 1 < n) x[z] -= L1[z] * x[z + 1];
    if (z + 2 < n) x[z] -= L2[z] * x[z + 2];
  }
  return x;
}

// The normal equations of g if all ln E are given. `stiffness` is the weight of the curvature at
// each level, squared.
function normalEquations({ Z, B, w }, lE, stiffness) {
  const zeros = () => Array(LEVELS).fill(0);
  const diagonal = zeros();
  const firstBand = zeros();
  const secondBand = zeros();
  const r = zeros();
  Z.forEach((levels, i) => {
    levels.forEach((z, j) => {
      diagonal[z] += w[z] ** 2;
      r[z] += w[z] ** 2 * (lE[i] + B[j]);
    });
  });
  diagonal[MIDDLE_LEVEL] += 1;
  // g(z - 1) - 2 g(z) + g(z + 1), squared
  for (let z = 1; z < LEVELS - 1; z++) {
    const s = stiffness[z];
    diagonal[z - 1] += s;
    diagonal[z] += 4 * s;
    diagonal[z + 1] += s;
    firstBand[z - 1] -= 2 * s;
    firstBand[z] -= 2 * s;
    secondBand[z - 1] += s;
  }
  return { diagonal, firstBand, secondBand, r };
}

// The curve g with the least sum of squares if all ln E are given, and the parts of that sum.
function bestCurve(samples, lE, smoothness) {
  const { Z, B, w } = samples;
  const stiffness = w.map((weight) => (smoothness * weight) ** 2);
  const g = solveBanded(normalEquations(samples, lE, stiffness));
  const sum = { points: 0, smoothness: 0, scale: g[MIDDLE_LEVEL] ** 2 };
  Z.forEach((levels, i) => {
    levels.forEach((z, j) => {
      sum.points += (w[z] * (g[z] - lE[i] - B[j])) ** 2;
    });
  });
  for (let z = 1; z < LEVELS - 1; z++) {
    sum.smoothness += stiffness[z] * (g[z - 1] - 2 * g[z] + g[z + 1]) ** 2;
  }
  return { g, sum, total: sum.points + sum.smoothness + sum.scale };
}

const signedText = (value, digits = 2) => value.toFixed(digits).replace("-", "−");
const isNearerToMiddle = (z, other) => Math.abs(z - MIDDLE_LEVEL) < Math.abs(other - MIDDLE_LEVEL);

function addSvgElement(parent, tag, className) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  node.setAttribute("class", className);
  parent.append(node);
  return node;
}

// Append the plot of level over ln exposure. Polylines and the curve are SVG, points and text are
// HTML, so that both keep their size on a narrow page.
function addPlot(parent, { Z, w, span, leftOf, topOf }) {
  addElement(parent, "p", {
    className: "hdrlab-axis-name hdrlab-is-Z",
    textContent: "↑ level Z",
  });
  const frame = addElement(parent, "div", {
    className: "hdrlab-levels",
    role: "application",
    tabIndex: 0,
    "aria-label":
      "The levels of the pixels. Left and right arrow keys move a pixel's levels, " +
      "with Shift by 8 steps; up and down choose a pixel.",
  });
  const svg = addSvgElement(frame, "svg", "hdrlab-lines");
  svg.setAttribute("viewBox", "0 0 1 1");
  svg.setAttribute("preserveAspectRatio", "none");
  svg.setAttribute("aria-hidden", "true");
  const polylines = Z.map(() => addSvgElement(svg, "polyline", "hdrlab-polyline"));
  const curve = addSvgElement(svg, "polyline", "hdrlab-curve hdrlab-is-g");
  const points = Z.map((levels) =>
    levels.map((z) => {
      const className = w[z] > 0 ? "" : "hdrlab-weightless";
      const point = addElement(frame, "b", { className });
      point.style.top = `${100 * topOf(z)}%`;
      return point;
    }),
  );
  // The number of each pixel, at its point nearest to the middle of the plot.
  Z.forEach((levels, i) => {
    const middle = levels.reduce((best, z) => (isNearerToMiddle(z, best) ? z : best));
    addElement(points[i][levels.indexOf(middle)], "span", { textContent: i + 1 });
  });
  for (const z of [0, MIDDLE_LEVEL, LEVELS - 1]) {
    const label = addElement(frame, "span", { className: "hdrlab-is-Z", textContent: z });
    label.style.top = `${100 * topOf(z)}%`;
  }
  const origin = addElement(frame, "i", { className: "hdrlab-origin hdrlab-is-g" });
  origin.style.left = `${100 * leftOf(0)}%`;
  origin.style.top = `${100 * topOf(MIDDLE_LEVEL)}%`;

  const ticks = addElement(parent, "div", { className: "hdrlab-ticks hdrlab-is-g" });
  const [low, high] = span;
  for (let ln = Math.ceil(low / TICK_STEP) * TICK_STEP; ln <= high; ln += TICK_STEP) {
    const label = addElement(ticks, "span", { textContent: signedText(ln, 0) });
    label.style.left = `${100 * leftOf(ln)}%`;
  }
  addElement(parent, "p", {
    className: "hdrlab-axis-name hdrlab-is-g",
    textContent: "ln exposure, ln E + ln t; the curve is g",
  });
  return { frame, polylines, curve, points };
}

// Append the bar of the sum of squares. `maxTotal` fills the bar.
function addSumBar(parent, maxTotal) {
  const bar = addElement(parent, "div", { className: "hdrlab-sum" });
  const segments = SUM_PARTS.map(({ name }) =>
    addElement(bar, "i", { className: `hdrlab-sum-${name}` }),
  );
  const leastMark = addElement(bar, "b");
  const legend = addElement(parent, "p", {
    className: "hdrlab-note",
    textContent: "Sum of squares: ",
  });
  const texts = SUM_PARTS.map(({ symbol }, k) => {
    const text = addElement(legend, "span", { className: `hdrlab-is-${symbol}` });
    if (k < SUM_PARTS.length - 1) legend.append(" + ");
    return text;
  });
  // A square root, because the sum changes by several powers of ten.
  const percentOf = (total) => 100 * Math.min(Math.sqrt(total / maxTotal), 1);
  return (sum, total, leastTotal) => {
    SUM_PARTS.forEach(({ name }, k) => {
      segments[k].style.width = `${(percentOf(total) * sum[name]) / total}%`;
      texts[k].textContent = `${name} ${threeDigits(sum[name])}`;
    });
    leastMark.style.left = `${percentOf(leastTotal)}%`;
  };
}

// Append the photo with a numbered button at each pixel.
async function addPhoto(parent, model, select) {
  const sheet = addElement(parent, "div", { className: "hdrlab-sheet hdrlab-picked" });
  const canvas = addElement(sheet, "canvas", { role: "img", "aria-label": model.get("alt") });
  const photo = await decodeImage(model.get("photo"), "image/webp");
  canvas.width = photo.width;
  canvas.height = photo.height;
  canvas.getContext("2d").drawImage(photo, 0, 0);
  return model.get("places").map(([down, right], i) => {
    const dot = addElement(sheet, "button", {
      className: "hdrlab-dot",
      textContent: i + 1,
      "aria-label": `Pixel ${i + 1}`,
    });
    dot.style.top = `${100 * down}%`;
    dot.style.left = `${100 * right}%`;
    dot.addEventListener("click", () => select(i));
    dot.addEventListener("pointerenter", () => select(i));
    return dot;
  });
}

// Append the image of the matrix A. Its rows: a row for each point, a row for the scale, and a band
// for the smoothness. Its columns: the levels, and the ln E of each pixel.
function addMatrix(parent, root, { Z, w }) {
  const photoCount = Z[0].length;
  const pointCount = Z.length * photoCount;
  const canvas = addElement(parent, "canvas", {
    className: "hdrlab-photo hdrlab-matrix",
    role: "img",
  });
  canvas.setAttribute(
    "aria-label",
    "Matrix A: a row for each point, a row for the scale, " +
      "and a band of rows for the smoothness",
  );
  canvas.width = LEVELS + UNKNOWN_COLUMN_WIDTH * Z.length;
  canvas.height = DATA_ROW_HEIGHT * (pointCount + 1) + SMOOTHNESS_ROW_HEIGHT * LEVELS;
  const context = canvas.getContext("2d");

  function paintRow(i, j, size) {
    const z = Z[i][j];
    if (w[z] === 0) return;
    const y = DATA_ROW_HEIGHT * (i * photoCount + j);
    context.fillRect(z - 1, y, size, size);
    context.fillRect(LEVELS + UNKNOWN_COLUMN_WIDTH * i, y, UNKNOWN_COLUMN_WIDTH - 1, size);
  }

  function paint(pixel, photo) {
    const styles = getComputedStyle(root);
    const chosenColor = styles.getPropertyValue("--E");
    context.clearRect(0, 0, canvas.width, canvas.height);
    Z.forEach((levels, i) => {
      context.fillStyle = i === pixel ? chosenColor : styles.color;
      levels.forEach((_, j) => paintRow(i, j, i === pixel && j === photo ? 5 : 3));
    });
    context.fillStyle = styles.getPropertyValue("--g");
    context.fillRect(MIDDLE_LEVEL - 1, DATA_ROW_HEIGHT * pointCount, 3, 3);
    const firstSmoothnessRow = DATA_ROW_HEIGHT * (pointCount + 1);
    for (let z = 1; z < LEVELS - 1; z++) {
      context.fillRect(z - 1, firstSmoothnessRow + SMOOTHNESS_ROW_HEIGHT * z, 3, 1);
    }
  }

  // The point (pixel, photo) whose row is under the pointer, or null.
  function pointAt(event) {
    const [, y] = pointerPosition(event, canvas);
    const row = Math.floor((y * canvas.height) / DATA_ROW_HEIGHT);
    if (row < 0 || row >= pointCount) return null;
    return [Math.floor(row / photoCount), row % photoCount];
  }
  return { canvas, paint, pointAt };
}

async function render({ model, el }) {
  const root = createRoot(el, "gsolve");
  const Z = model.get("levels");
  const B = model.get("ln_times");
  const w = model.get("weights");
  const samples = { Z, B, w };
  const shutters = model.get("shutters");
  const solutions = model.get("solutions");
  const smoothnessValues = model.get("smoothness_values");
  const span = model.get("span");
  const [low, high] = span;
  const photoCount = B.length;
  const lE = () => model.get("ln_E");
  const smoothnessIndex = () => model.get("smoothness_index");
  const smoothness = () => smoothnessValues[smoothnessIndex()];
  const start = Z.map(() => 0); // ln E before the reader moves anything
  const totalOf = (lnE, value) => bestCurve(samples, lnE, value).total;
  const leastTotals = smoothnessValues.map((value, k) => totalOf(solutions[k], value));
  const maxTotal = Math.max(...smoothnessValues.map((value) => totalOf(start, value)));
  const minLnE = Math.min(0, ...solutions.flat()) - MARGIN_LN;
  const maxLnE = Math.max(0, ...solutions.flat()) + MARGIN_LN;
  // Positions in the plot, as fractions from the left and from the top.
  const leftOf = (ln) => (ln - low) / (high - low);
  const topOf = (z) => (LEVELS - 1 - z + MARGIN_LEVELS) / (LEVELS - 1 + 2 * MARGIN_LEVELS);

  const columns = addElement(root, "div", { className: "hdrlab-columns" });
  const leftColumn = addElement(columns, "div", { className: "hdrlab-column" });
  const plot = addPlot(leftColumn, { Z, w, span, leftOf, topOf });
  const showSum = addSumBar(leftColumn, maxTotal);
  const showStatus = addStatusLine(leftColumn);
  const controls = addElement(leftColumn, "div", { className: "hdrlab-controls" });
  const slider = addSlider(controls, "smoothness λ", smoothnessValues.length);
  slider.input.addEventListener("input", () => save("smoothness_index", slider.position()));
  const solveButton = addElement(controls, "button", { textContent: "Let gsolve do it" });
  solveButton.addEventListener("click", () => animateTo(solutions[smoothnessIndex()]));
  const restartButton = addElement(controls, "button", {
    className: "hdrlab-plain",
    textContent: "Start again",
  });
  restartButton.addEventListener("click", () => animateTo(start));

  const rightColumn = addElement(columns, "div", { className: "hdrlab-column" });
  const dots = await addPhoto(rightColumn, model, select);
  const matrix = addMatrix(rightColumn, root, samples);
  const equation = addElement(rightColumn, "p", { className: "hdrlab-note hdrlab-equation" });

  let chosenPixel = 0;
  let chosenPhoto = Math.floor(photoCount / 2); // the photo of the point that is pointed at
  let isAloud = false;

  function paintPlot(g) {
    const pointText = (ln, z) => `${leftOf(ln)},${topOf(z)}`;
    plot.curve.setAttribute("points", g.map(pointText).join(" "));
    Z.forEach((levels, i) => {
      const isChosen = i === chosenPixel;
      const exposures = B.map((ln) => lE()[i] + ln);
      const polyline = plot.polylines[i];
      polyline.setAttribute("points", exposures.map((ln, j) => pointText(ln, levels[j])).join(" "));
      polyline.classList.toggle("hdrlab-chosen", isChosen);
      plot.points[i].forEach((point, j) => {
        point.style.left = `${100 * leftOf(exposures[j])}%`;
        point.classList.toggle("hdrlab-chosen", isChosen);
        point.classList.toggle("hdrlab-pointed", isChosen && j === chosenPhoto);
      });
      dots[i].setAttribute("aria-pressed", isChosen);
    });
  }

  // Write the row of the matrix for the chosen point as an equation.
  function writeEquation(g) {
    const i = chosenPixel;
    const j = chosenPhoto;
    const z = Z[i][j];
    equation.replaceChildren();
    const write = (textContent, symbol) => {
      const className = symbol ? `hdrlab-is-${symbol}` : "";
      addElement(equation, "span", { textContent, className });
    };
    write(`Row ${i * photoCount + j + 1}: pixel ${i + 1} at ${shutters[j]}, `);
    write(`level ${z}`, "Z");
    write(", ");
    write(`weight ${w[z].toFixed(2)}`, "w");
    if (w[z] === 0) {
      write(": it does not count, because this level is only a bound.");
      return;
    }
    write(": ");
    write(`g(${z})`, "g");
    write(" − ");
    write("ln E", "E");
    write(" − ");
    write("ln t", "t");
    const residual = signedText(g[z] - lE()[i] - B[j]);
    write(
      ` = ${signedText(g[z])} − (${signedText(lE()[i])}) − (${signedText(B[j])}) = ${residual}`,
    );
  }

  function paint() {
    const { g, sum, total } = bestCurve(samples, lE(), smoothness());
    const leastTotal = leastTotals[smoothnessIndex()];
    paintPlot(g);
    showSum(sum, total, leastTotal);
    slider.show(smoothnessIndex(), String(smoothness()));
    const pixelText = `Pixel ${chosenPixel + 1}: ln E = ${signedText(lE()[chosenPixel])}`;
    const sumText = `Sum ${threeDigits(total)}, the least possible is ${threeDigits(leastTotal)}`;
    showStatus(`${pixelText}. ${sumText}.`, isAloud);
    matrix.paint(chosenPixel, chosenPhoto);
    writeEquation(g);
  }
  const repaint = oncePerFrame(paint);

  function save(name, value) {
    saveTrait(model, name, value);
    repaint();
  }

  // Move the levels of a pixel to this ln E.
  function movePixel(pixel, ln) {
    const clamped = clamp(ln, minLnE, maxLnE);
    const moved = lE().map((before, i) => (i === pixel ? clamped : before));
    save("ln_E", moved);
  }

  function select(pixel, photo = chosenPhoto) {
    chosenPixel = pixel;
    chosenPhoto = photo;
    repaint();
  }

  // Move all pixels to their targets within a second, or at once if the reader wants no motion.
  let lastAnimation = 0;
  function animateTo(target) {
    lastAnimation += 1;
    const animation = lastAnimation;
    const from = lE();
    const begin = performance.now();
    const isReduced = matchMedia("(prefers-reduced-motion: reduce)").matches;
    isAloud = true;
    const moveToNextFrame = (now) => {
      if (animation !== lastAnimation) return; // a drag or another animation has begun
      const time = isReduced ? 1 : clamp((now - begin) / ANIMATION_MS, 0, 1);
      const eased = time * time * (3 - 2 * time);
      const between = from.map((ln, i) => ln + eased * (target[i] - ln));
      save("ln_E", time === 1 ? [...target] : between);
      if (time < 1) requestAnimationFrame(moveToNextFrame);
    };
    requestAnimationFrame(moveToNextFrame);
  }

  // The point (pixel, photo) nearest to a position on the plot.
  function nearestPoint([x, y]) {
    const box = plot.frame.getBoundingClientRect();
    let nearest = [0, 0];
    let leastDistance = Infinity;
    Z.forEach((levels, i) => {
      levels.forEach((z, j) => {
        const dx = (leftOf(lE()[i] + B[j]) - x) * box.width;
        const dy = (topOf(z) - y) * box.height;
        const distance = dx * dx + dy * dy; // squared
        if (distance < leastDistance) {
          leastDistance = distance;
          nearest = [i, j];
        }
      });
    });
    return nearest;
  }

  let grabX = 0; // of the pointer, and the ln E of the chosen pixel at that moment
  let grabLnE = 0;
  makeDraggable(plot.frame, plot.frame, {
    grab(position) {
      lastAnimation += 1; // ends an animation
      select(...nearestPoint(position));
      grabX = position[0];
      grabLnE = lE()[chosenPixel];
    },
    moveTo([x]) {
      isAloud = false;
      movePixel(chosenPixel, grabLnE + (x - grabX) * (high - low));
    },
    stepBy(right, down) {
      isAloud = true;
      if (down) select(clamp(chosenPixel + Math.sign(down), 0, Z.length - 1));
      else movePixel(chosenPixel, lE()[chosenPixel] + KEY_STEP * right);
    },
  });
  plot.frame.addEventListener("pointermove", (event) => {
    const isHovering = event.pointerType === "mouse" && event.buttons === 0;
    if (isHovering) select(...nearestPoint(pointerPosition(event, plot.frame)));
  });
  matrix.canvas.addEventListener("pointermove", (event) => {
    const point = matrix.pointAt(event);
    if (point) select(...point);
  });
  const stopListening = onTraitChange(model, ["ln_E", "smoothness_index"], repaint);
  paint();
  repaint(); // again when the widget is in the page, because the matrix has the colors of the page
  return stopListening;
}

export default { render };
