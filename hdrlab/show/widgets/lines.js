// Shared by the figures of one line of pixels: plots in SVG that stretch with the page, words and handles in HTML.

const HIDDEN = { "aria-hidden": "true" };

// Paths in a box of 1 x 1, stretched over the parent, with these class names.
function paths(parent, names) {
  const inside = names.map((name) => `<path class="${name}"/>`).join("");
  const svg = `<svg class="hdrlab-lines" viewBox="0 0 1 1" preserveAspectRatio="none" aria-hidden="true">${inside}</svg>`;
  parent.insertAdjacentHTML("beforeend", svg);
  return [...parent.lastElementChild.children];
}

const point = (x, y) => `${x.toFixed(4)},${y.toFixed(4)}`;

// A line through these heights, each in the middle of its pixel; `up` gives its place from the top.
function linePath(heights, up) {
  return `M${Array.from(heights, (height, q) => point((q + 0.5) / heights.length, up(height))).join("L")}`;
}

// A bar for each height, from `foot` to its place from the top.
function barPath(heights, up, foot) {
  const steps = Array.from(heights, (height, q) => `V${up(height).toFixed(4)}H${((q + 1) / heights.length).toFixed(4)}`);
  return `M0,${foot}${steps.join("")}V${foot}Z`;
}

// A dot at each of these points; a path of class hdrlab-dots draws it as wide as its line. Each dot has a length, because
// WebKit stretches one of no length over the whole plot.
function dotPath(points) {
  return points.map(([x, y]) => `M${point(x, y)}h0.0001`).join("");
}

// A part of a plot that is a slider: its frame takes the focus, the keys and the pointer.
function slidable(parent, className, label, [low, high]) {
  const frame = element(parent, "div", { className, role: "slider", tabIndex: 0, "aria-label": label });
  frame.setAttribute("aria-valuemin", low);
  frame.setAttribute("aria-valuemax", high);
  return {
    frame,
    tell(value, text) {
      frame.setAttribute("aria-valuenow", value);
      frame.setAttribute("aria-valuetext", text);
    },
  };
}

// Numbers beside a vertical axis: pairs of a place from the top and a text.
function sideLabels(frame, className, labels) {
  for (const [top, textContent] of labels)
    element(frame, "span", { className, textContent, ...HIDDEN }).style.top = `${100 * top}%`;
}

// Numbers under a horizontal axis: pairs of a place from the left and a text.
function footLabels(parent, labels) {
  const ticks = element(parent, "div", { className: "hdrlab-ticks", ...HIDDEN });
  for (const [left, textContent] of labels) element(ticks, "span", { textContent }).style.left = `${100 * left}%`;
}

// A line of words, some in the color of their symbol: texts, and pairs of a text and a class name.
function words(parent, parts) {
  const line = element(parent, "p", { className: "hdrlab-axis-name" });
  return parts.map((part) => {
    const [textContent, className] = Array.isArray(part) ? part : [part, ""];
    return element(line, "span", { textContent, className });
  });
}

// Round numbers between two ends, about this many.
function roundNumbers(low, high, count) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((times) => times * power >= rough) * power;
  const first = Math.ceil(low / step);
  return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, k) => Number(((first + k) * step).toPrecision(6)));
}

const signed = (value, digits) => value.toFixed(digits).replace(/^-(?=[0.]+$)/, "").replace("-", "−");
