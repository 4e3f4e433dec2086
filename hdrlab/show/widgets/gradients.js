// `widgets.gradient_line`: Fattal's attenuation of the gradients of one line of pixels. The reader
// drags the curve of attenuation. The formula is that of tonemap/fattal.py, in one dimension.
//
// Python sends
//   line         lL (N,), ln of luminance, nats
//   span         the ends of the vertical axis of the line
//   noise        smaller ratios of slope and mean slope are not amplified more than this one
//   alpha_range  the smallest and the largest alpha
//   beta_range   the smallest and the largest beta
// and both sides set
//   alpha        the slope that does not change, as a multiple of the mean slope
//   beta         the power of the attenuation
//   at           the step between pixels that is pointed at, from 0

const STEPS_PER_OCTAVE = 4; // a key press changes alpha by a quarter of an octave
const BETA_STEP = 0.02; // of a key press
const MIN_DECADE = -3; // the axes of the curve begin at a thousandth of the mean slope
const MIN_RATIO = 1e-9; // so that a flat step has a logarithm
const AXIS_FACTOR = 1.4; // the axis of the steps ends at this multiple of the largest step
const DECADE_NAMES = { "-3": "1/1000", "-2": "1/100", "-1": "1/10", 0: "mean" };
const BEFORE_CLASS = "hdrlab-is-L"; // the color of the line before, and after the attenuation
const AFTER_CLASS = "hdrlab-is-Ld";

const percentInBox = (fraction) => `${100 * clamp(fraction, 0, 1)}%`;
const rangeOf = (values) => Math.max(...values) - Math.min(...values);

// The line that begins at `first` and has these steps.
function addUp(first, steps) {
  const line = [first];
  for (const step of steps) line.push(line.at(-1) + step);
  return line;
}

// Append "↑ quantity: before and after".
function addBeforeAndAfter(parent, quantity) {
  addAxisText(parent, [
    `↑ ${quantity}: `,
    ["before", BEFORE_CLASS],
    " and ",
    ["after", `${AFTER_CLASS} hdrlab-bold`],
  ]);
}

// Append the plot of the line, and below it the plot of its steps. `topOf` and `stepTop` give the
// distances of a value and of a step from the top.
function addLinePlots(parent, { lL, G, span, maxStep, topOf, stepTop }) {
  addBeforeAndAfter(parent, "ln of luminance, nats");
  const plot = addElement(parent, "div", { className: "hdrlab-levels" });
  const [lineBefore, lineAfter] = addPaths(plot, [BEFORE_CLASS, `${AFTER_CLASS} hdrlab-thick`]);
  lineBefore.setAttribute("d", linePath(lL, topOf));
  const values = roundNumbers(...span, 4).slice(1);
  const valueLabels = values.map((value) => [topOf(value), String(value).replace("-", "−")]);
  addSideLabels(plot, "", valueLabels);

  addBeforeAndAfter(parent, "steps from pixel to pixel, nats");
  const stepLabel = "Step from pixel to pixel";
  const stepRange = [0, G.length - 1];
  const steps = addPlotSlider(parent, "hdrlab-levels hdrlab-steps", stepLabel, stepRange);
  const [barsBefore, barsAfter, zeroLine] = addPaths(steps.frame, [
    `${BEFORE_CLASS} hdrlab-area`,
    `${AFTER_CLASS} hdrlab-area`,
    "hdrlab-thin",
  ]);
  barsBefore.setAttribute("d", barPath(G, stepTop, stepTop(0)));
  zeroLine.setAttribute("d", `M0,${stepTop(0)}H1`);
  const stepLabels = roundNumbers(0, maxStep, 2)
    .slice(1)
    .map((value) => [stepTop(value), value]);
  addSideLabels(steps.frame, "", stepLabels);
  const markers = [plot, steps.frame].map((frame) =>
    addElement(frame, "i", { className: "hdrlab-white-line" }),
  );
  const stepName = addElement(steps.frame, "b", { className: "hdrlab-held-here", ...HIDDEN });
  const pixels = roundNumbers(0, lL.length - 1, 5);
  const pixelLabels = pixels.map((q) => [(q + 0.5) / lL.length, q]);
  addFootLabels(parent, pixelLabels);
  addAxisText(parent, ["→ place, pixels"]);
  return { lineAfter, barsAfter, steps, markers, stepName };
}

// Append the curve of attenuation, with a knob for alpha and one for beta.
function addCurvePlot(parent, model, { maxDecade, axisFraction }) {
  addAxisText(parent, [
    "↑ ",
    ["step after", `${AFTER_CLASS} hdrlab-bold`],
    ": drag α and β on the curve",
  ]);
  const box = addElement(parent, "div", { className: "hdrlab-levels hdrlab-attenuation" });
  const [diagonal, curve, dots] = addPaths(box, [
    "hdrlab-dashed",
    `${AFTER_CLASS} hdrlab-thick`,
    `${BEFORE_CLASS} hdrlab-dots hdrlab-dots-1`,
  ]);
  diagonal.setAttribute("d", "M0,1L1,0");
  addElement(box, "span", {
    className: "hdrlab-unchanged",
    textContent: "unchanged",
    ...HIDDEN,
  });
  const ring = addElement(box, "i", { className: "hdrlab-mark" });
  const addKnob = (letter, label, range) => {
    const knob = addPlotSlider(box, `hdrlab-knob ${AFTER_CLASS}`, label, range);
    knob.frame.textContent = letter;
    return knob;
  };
  const alphaLabel = "Alpha: the step that does not change, in mean steps";
  const betaLabel = "Beta: the power of the attenuation";
  const alphaKnob = addKnob("α", alphaLabel, model.get("alpha_range"));
  const betaKnob = addKnob("β", betaLabel, model.get("beta_range"));

  const count = maxDecade - MIN_DECADE - 1; // of the decades between the ends of the axis
  const decades = Array.from({ length: count }, (_, k) => MIN_DECADE + 1 + k);
  const nameOf = (decade) => DECADE_NAMES[decade] ?? `${10 ** decade}×`;
  const labels = decades.map((decade) => [axisFraction(10 ** decade), nameOf(decade)]);
  addFootLabels(parent, labels);
  addAxisText(parent, ["→ ", ["step before", BEFORE_CLASS], " ÷ mean step; dots: this row"]);
  const [alphaText, betaText] = addAxisText(parent, [
    ["", `${AFTER_CLASS} hdrlab-bold`],
    ["", `${AFTER_CLASS} hdrlab-bold`],
  ]);
  return { box, curve, dots, ring, alphaKnob, betaKnob, alphaText, betaText };
}

async function render({ model, el }) {
  const root = createRoot(el, "gradients");
  const lL = model.get("line");
  const span = model.get("span");
  const [low, high] = span;
  const noise = model.get("noise");
  const alpha = () => model.get("alpha");
  const beta = () => model.get("beta");
  const at = () => model.get("at");

  const G = lL.slice(1).map((value, q) => value - lL[q]); // steps from pixel to pixel
  const slopes = G.map(Math.abs);
  const meanSlope = sumOf(slopes) / G.length;
  const ratios = slopes.map((slope) => slope / meanSlope);
  const attenuation = (ratio) => (Math.max(ratio, noise) / alpha()) ** (beta() - 1);

  // Distances from the top, as fractions of the plot.
  const maxStep = AXIS_FACTOR * Math.max(...slopes);
  const minStep = AXIS_FACTOR * Math.min(0, ...G);
  const topOf = (value) => (high - value) / (high - low);
  const stepTop = (step) => (maxStep - step) / (maxStep - minStep);
  // The axes of the curve are log10 of a ratio: its fraction of the axis, and back.
  const maxDecade = Math.ceil(Math.log10(Math.max(...ratios)) + 0.01);
  const decadeCount = maxDecade - MIN_DECADE;
  const axisFraction = (ratio) =>
    (Math.log10(Math.max(ratio, MIN_RATIO)) - MIN_DECADE) / decadeCount;
  const ratioAt = (fraction) => 10 ** (MIN_DECADE + fraction * decadeCount);
  const maxRatio = 10 ** maxDecade; // at the right end of the curve

  const columns = addElement(root, "div", { className: "hdrlab-columns hdrlab-gradients" });
  const leftColumn = addElement(columns, "div", { className: "hdrlab-column" });
  const plots = addLinePlots(leftColumn, { lL, G, span, maxStep, topOf, stepTop });
  const rightColumn = addElement(columns, "div", { className: "hdrlab-column" });
  const curvePlot = addCurvePlot(rightColumn, model, { maxDecade, axisFraction });
  const showStatus = addStatusLine(root);

  function paintCurve(phi) {
    // The curve is straight between these decades.
    const decades = [MIN_DECADE, Math.log10(noise), maxDecade];
    const points = decades.map((decade) => {
      const ratio = 10 ** decade;
      return pathPoint(axisFraction(ratio), 1 - axisFraction(ratio * attenuation(ratio)));
    });
    curvePlot.curve.setAttribute("d", `M${points.join("L")}`);
    const pointOf = (q) => [axisFraction(ratios[q]), 1 - axisFraction(ratios[q] * phi[q])];
    const visible = [...ratios.keys()].filter((q) => axisFraction(ratios[q]) > 0);
    curvePlot.dots.setAttribute("d", dotPath(visible.map(pointOf)));
    placeOnCurve(curvePlot.ring, ...pointOf(at()));
    placeOnCurve(curvePlot.alphaKnob.frame, axisFraction(alpha()), 1 - axisFraction(alpha()));
    placeOnCurve(curvePlot.betaKnob.frame, 1, 1 - axisFraction(maxRatio * attenuation(maxRatio)));
  }

  function placeOnCurve(node, x, y) {
    node.style.left = percentInBox(x);
    node.style.top = percentInBox(y);
  }

  function paintMarkers() {
    const x = percentInBox((at() + 0.5) / G.length);
    plots.stepName.textContent = `step ${at()}`;
    plots.stepName.style.left = x;
    plots.stepName.style.transform = `translateX(-${x})`; // it stays inside the plot
    for (const marker of plots.markers) marker.style.left = x;
  }

  let isAloud = false;
  function paint() {
    const phi = ratios.map(attenuation);
    const newSteps = G.map((step, q) => phi[q] * step);
    const newLine = addUp(lL[0], newSteps);
    plots.lineAfter.setAttribute("d", linePath(newLine, topOf));
    plots.barsAfter.setAttribute("d", barPath(newSteps, stepTop, stepTop(0)));
    paintCurve(phi);
    paintMarkers();

    const alphaText = threeDigits(alpha());
    curvePlot.alphaText.textContent = `α: ${alphaText} × mean step stays. `;
    curvePlot.betaText.textContent = `β: power ${beta().toFixed(2)}.`;
    curvePlot.alphaKnob.setValue(alpha(), `${alphaText} of the mean step`);
    curvePlot.betaKnob.setValue(beta(), beta().toFixed(2));
    const q = at();
    const change = `${signedText(G[q], 3)} nats becomes ${signedText(newSteps[q], 3)}`;
    plots.steps.setValue(q, `step ${q}: ${change}`);
    const before = rangeOf(lL).toFixed(2);
    const after = rangeOf(newLine).toFixed(2);
    showStatus(
      `The line spans ${before} nats before and ${after} after. Step ${q}, ` +
        `${threeDigits(ratios[q])} times the mean, becomes ${phi[q].toFixed(2)} times as high.`,
      isAloud,
    );
  }
  const repaint = oncePerFrame(paint);

  function save(name, value, isByKey) {
    isAloud = isByKey;
    saveTrait(model, name, value);
    repaint();
  }

  function setStep(q, isByKey) {
    save("at", clamp(Math.round(q), 0, G.length - 1), isByKey);
  }

  function setAlpha(value, isByKey) {
    const rounded = Number(value.toPrecision(2));
    save("alpha", clamp(rounded, ...model.get("alpha_range")), isByKey);
  }

  function setBeta(value, isByKey) {
    const rounded = Math.round(100 * value) / 100;
    save("beta", clamp(rounded, ...model.get("beta_range")), isByKey);
  }

  const { steps } = plots;
  const { box, alphaKnob, betaKnob } = curvePlot;
  makeDraggable(steps.frame, steps.frame, {
    grab: () => steps.frame.focus({ preventScroll: true }),
    moveTo: ([x]) => setStep(x * G.length - 0.5, false),
    stepBy: (right, down) => setStep(at() + right - down, true),
  });
  // Alpha moves along the diagonal: to the point of it that is nearest to the pointer.
  makeDraggable(alphaKnob.frame, box, {
    grab: () => alphaKnob.frame.focus({ preventScroll: true }),
    moveTo: ([x, y]) => setAlpha(ratioAt((x + 1 - y) / 2), false),
    stepBy: (right, down) => setAlpha(alpha() * 2 ** ((right - down) / STEPS_PER_OCTAVE), true),
    farStep: STEPS_PER_OCTAVE,
  });
  // Beta is the power for which the right end of the curve is at the height of the pointer.
  makeDraggable(betaKnob.frame, box, {
    grab: () => betaKnob.frame.focus({ preventScroll: true }),
    moveTo: ([, y]) =>
      setBeta(Math.log(ratioAt(1 - y) / alpha()) / Math.log(maxRatio / alpha()), false),
    stepBy: (right, down) => setBeta(beta() + BETA_STEP * (right - down), true),
    farStep: 5,
  });
  const stopListening = onTraitChange(model, ["at", "alpha", "beta"], repaint);
  paint();
  return stopListening;
}

export default { render };
