// Gradients of a line of pixels, attenuated and added up again: tonemap/fattal.py once more, in one dimension.

const STEPS_PER_OCTAVE = 4; // a key press changes alpha by a quarter of an octave,
const BETA_STEP = 0.02; // and beta by this much
const LEAST_DECADE = -3; // the axes of the curve begin at a thousandth of the mean slope
const HEADROOM = 1.4; // the axis of the steps, in units of the largest
const DECADE_NAMES = { "-3": "1/1000", "-2": "1/100", "-1": "1/10", 0: "mean" };

async function render({ model, el }) {
  const root = start(el, "gradients");
  const l = model.get("line");
  const [low, high] = model.get("span");
  const noise = model.get("noise");
  const [alpha, beta, at] = ["alpha", "beta", "at"].map((name) => () => model.get(name));
  const G = l.slice(1).map((value, q) => value - l[q]);
  const mean = G.reduce((sum, step) => sum + Math.abs(step), 0) / G.length;
  const ratios = G.map((step) => Math.abs(step) / mean);
  const topDecade = Math.ceil(Math.log10(Math.max(...ratios)) + 0.01);
  const attenuation = (ratio) => (Math.max(ratio, noise) / alpha()) ** (beta() - 1);
  const up = (value) => (high - value) / (high - low);
  const tallest = HEADROOM * Math.max(...G.map(Math.abs));
  const lowest = HEADROOM * Math.min(0, ...G);
  const upStep = (step) => (tallest - step) / (tallest - lowest);
  const along = (ratio) => (Math.log10(Math.max(ratio, 1e-9)) - LEAST_DECADE) / (topDecade - LEAST_DECADE);
  const ratioAt = (share) => 10 ** (LEAST_DECADE + share * (topDecade - LEAST_DECADE));
  const inBox = (share) => `${100 * clamp(share, 0, 1)}%`;
  const [before, after] = ["hdrlab-is-L", "hdrlab-is-Ld"];

  const columns = element(root, "div", { className: "hdrlab-columns hdrlab-gradients" });
  const left = element(columns, "div", { className: "hdrlab-column" });
  words(left, ["↑ ln of luminance, nats: ", ["before", before], " and ", ["after", `${after} hdrlab-bold`]]);
  const plot = element(left, "div", { className: "hdrlab-levels" });
  const [old, fresh] = paths(plot, [before, `${after} hdrlab-thick`]);
  old.setAttribute("d", linePath(l, up));
  sideLabels(plot, "", roundNumbers(low, high, 4).slice(1).map((value) => [up(value), String(value).replace("-", "−")]));
  words(left, ["↑ steps from pixel to pixel, nats: ", ["before", before], " and ", ["after", `${after} hdrlab-bold`]]);
  const steps = slidable(left, "hdrlab-levels hdrlab-steps", "Step from pixel to pixel", [0, G.length - 1]);
  const [oldBars, newBars, zero] = paths(steps.frame, [`${before} hdrlab-area`, `${after} hdrlab-area`, "hdrlab-thin"]);
  oldBars.setAttribute("d", barPath(G, upStep, upStep(0)));
  zero.setAttribute("d", `M0,${upStep(0)}H1`);
  sideLabels(steps.frame, "", roundNumbers(0, tallest, 2).slice(1).map((value) => [upStep(value), value]));
  const markers = [plot, steps.frame].map((frame) => element(frame, "i", { className: "hdrlab-white-line" }));
  const step = element(steps.frame, "b", { className: "hdrlab-held-here", ...HIDDEN });
  footLabels(left, roundNumbers(0, l.length - 1, 5).map((q) => [(q + 0.5) / l.length, q]));
  words(left, ["→ place, pixels"]);

  const right = element(columns, "div", { className: "hdrlab-column" });
  words(right, ["↑ ", ["step after", `${after} hdrlab-bold`], ": drag α and β on the curve"]);
  const box = element(right, "div", { className: "hdrlab-levels hdrlab-attenuation" });
  const [same, curve, dots] = paths(box, ["hdrlab-dashed", `${after} hdrlab-thick`, `${before} hdrlab-dots hdrlab-dots-1`]);
  same.setAttribute("d", "M0,1L1,0");
  element(box, "span", { className: "hdrlab-unchanged", textContent: "unchanged", ...HIDDEN });
  const ring = element(box, "i", { className: "hdrlab-mark" });
  const handle = (letter, label, range) => {
    const { frame, tell } = slidable(box, `hdrlab-knob ${after}`, label, range);
    frame.textContent = letter;
    return { frame, tell };
  };
  const alphaKnob = handle("α", "Alpha: the step that does not change, in mean steps", model.get("alpha_range"));
  const betaKnob = handle("β", "Beta: the power of the attenuation", model.get("beta_range"));
  const decades = Array.from({ length: topDecade - LEAST_DECADE + 1 }, (_, k) => LEAST_DECADE + k);
  const nameOf = (decade) => DECADE_NAMES[decade] ?? `${10 ** decade}×`;
  footLabels(right, decades.slice(1, -1).map((decade) => [along(10 ** decade), nameOf(decade)]));
  words(right, ["→ ", ["step before", before], " ÷ mean step; dots: this row"]);
  const [alphaWords, betaWords] = words(right, [["", `${after} hdrlab-bold`], ["", `${after} hdrlab-bold`]]);
  const say = teller(root);

  let aloud = false;
  function paint() {
    const phi = ratios.map(attenuation);
    const shrunk = G.map((step, q) => phi[q] * step);
    const sum = [l[0]];
    shrunk.forEach((step) => sum.push(sum.at(-1) + step));
    fresh.setAttribute("d", linePath(sum, up));
    newBars.setAttribute("d", barPath(shrunk, upStep, upStep(0)));
    const points = [-3, Math.log10(noise), topDecade].map((decade) => {
      const ratio = 10 ** decade;
      return point(along(ratio), 1 - along(ratio * attenuation(ratio)));
    });
    curve.setAttribute("d", `M${points.join("L")}`);
    const onCurve = (q) => [along(ratios[q]), 1 - along(ratios[q] * phi[q])];
    dots.setAttribute("d", dotPath([...ratios.keys()].filter((q) => along(ratios[q]) > 0).map(onCurve)));

    const pointed = onCurve(at());
    [ring.style.left, ring.style.top] = [inBox(pointed[0]), inBox(pointed[1])];
    step.textContent = `step ${at()}`;
    step.style.left = inBox((at() + 0.5) / G.length);
    step.style.transform = `translateX(-${step.style.left})`; // it stays inside the plot
    markers.forEach((marker) => (marker.style.left = step.style.left));
    const end = 10 ** topDecade * attenuation(10 ** topDecade);
    const places = [[alphaKnob, along(alpha()), 1 - along(alpha())], [betaKnob, 1, 1 - along(end)]];
    for (const [{ frame }, right, down] of places) [frame.style.left, frame.style.top] = [inBox(right), inBox(down)];
    alphaWords.textContent = `α: ${threeDigits(alpha())} × mean step stays. `;
    betaWords.textContent = `β: power ${beta().toFixed(2)}.`;
    alphaKnob.tell(alpha(), `${threeDigits(alpha())} of the mean step`);
    betaKnob.tell(beta(), beta().toFixed(2));

    const range = (values) => Math.max(...values) - Math.min(...values);
    const kept = `Step ${at()}, ${threeDigits(ratios[at()])} times the mean, becomes ${phi[at()].toFixed(2)} times as high.`;
    steps.tell(at(), `step ${at()}: ${signed(G[at()], 3)} nats becomes ${signed(shrunk[at()], 3)}`);
    say(`The line spans ${range(l).toFixed(2)} nats before and ${range(sum).toFixed(2)} after. ${kept}`, aloud);
  }
  const repaint = eachFrame(paint);

  function set(name, to, byKey) {
    aloud = byKey;
    model.set(name, to);
    model.save_changes();
    repaint();
  }

  const moveStep = (to, byKey) => set("at", clamp(Math.round(to), 0, G.length - 1), byKey);
  const setAlpha = (to, byKey) => set("alpha", clamp(Number(to.toPrecision(2)), ...model.get("alpha_range")), byKey);
  const setBeta = (to, byKey) => set("beta", clamp(Math.round(100 * to) / 100, ...model.get("beta_range")), byKey);

  draggable(steps.frame, steps.frame, {
    grab: () => steps.frame.focus({ preventScroll: true }),
    moveTo: ([right]) => moveStep(right * G.length - 0.5, false),
    stepBy: (right, down) => moveStep(at() + right - down, true),
  });
  // A point stays under the pointer's shadow on the diagonal.
  draggable(alphaKnob.frame, box, {
    grab: () => alphaKnob.frame.focus({ preventScroll: true }),
    moveTo: ([right, down]) => setAlpha(ratioAt((right + 1 - down) / 2), false),
    stepBy: (right, down) => setAlpha(alpha() * 2 ** ((right - down) / STEPS_PER_OCTAVE), true),
    farStep: STEPS_PER_OCTAVE,
  });
  // The right end of the curve is at the same height as the pointer.
  draggable(betaKnob.frame, box, {
    grab: () => betaKnob.frame.focus({ preventScroll: true }),
    moveTo: ([, down]) => setBeta(Math.log(ratioAt(1 - down) / alpha()) / Math.log(10 ** topDecade / alpha()), false),
    stepBy: (right, down) => setBeta(beta() + BETA_STEP * (right - down), true),
    farStep: 5,
  });
  const moved = ["at", "alpha", "beta"].map((name) => `change:${name}`);
  moved.forEach((event) => model.on(event, repaint));
  paint();
  return () => moved.forEach((event) => model.off(event, repaint));
}

export default { render };
