// Shared by the widgets about one line of pixels: plots in SVG, which stretch with the page, and
// text and handles in HTML, which keep their size.

const HIDDEN = { "aria-hidden": "true" };

// Append an SVG of 1 x 1 units, stretched over the parent, with a path for each class name.
function addPaths(parent, classNames) {
  const elements = classNames.map((className) => `<path class="${className}"/>`).join("");
  const attributes = 'viewBox="0 0 1 1" preserveAspectRatio="none" aria-hidden="true"';
  const svg = `<svg class="hdrlab-lines" ${attributes}>${elements}</svg>`;
  parent.insertAdjacentHTML("beforeend", svg);
  return [...parent.lastElementChild.children];
}

const pathPoint = (x, y) => `${x.toFixed(4)},${y.toFixed(4)}`;

// A line through the values, each in the middle of its pixel. `topOf` gives the distance of a value
// from the top of the plot, as a fraction.
function linePath(values, topOf) {
  const points = Array.from(values, (value, pixel) =>
    pathPoint((pixel + 0.5) / values.length, topOf(value)),
  );
  return `M${points.join("L")}`;
}

// A bar for each value, from `foot` to topOf(value), both distances from the top.
function barPath(values, topOf, foot) {
  const steps = Array.from(values, (value, pixel) => {
    const right = (pixel + 1) / values.length;
    return `V${topOf(value).toFixed(4)}H${right.toFixed(4)}`;
  });
  return `M0,${foot}${steps.join("")}V${foot}Z`;
}

// A dot at each point. A path of class hdrlab-dots draws each dot as wide as its line. Each dot has
// a length, because WebKit stretches a dot of length 0 over the whole plot.
function dotPath(points) {
  return points.map(([x, y]) => `M${pathPoint(x, y)}h0.0001`).join("");
}

// Append a part of a plot that is a slider: its frame takes the focus, the keys and the pointer.
function addPlotSlider(parent, className, label, [low, high]) {
  const frame = addElement(parent, "div", {
    className,
    role: "slider",
    tabIndex: 0,
    "aria-label": label,
  });
  frame.setAttribute("aria-valuemin", low);
  frame.setAttribute("aria-valuemax", high);
  return {
    frame,
    setValue(value, text) {
      frame.setAttribute("aria-valuenow", value);
      frame.setAttribute("aria-valuetext", text);
    },
  };
}

// Append numbers next to a vertical axis. `labels` are pairs: distance from the top, text.
function addSideLabels(frame, className, labels) {
  for (const [top, textContent] of labels) {
    const label = addElement(frame, "span", { className, textContent, ...HIDDEN });
    label.style.top = `${100 * top}%`;
  }
}

// Append numbers below a horizontal axis. `labels` are pairs: distance from the left, text.
function addFootLabels(parent, labels) {
  const ticks = addElement(parent, "div", { className: "hdrlab-ticks", ...HIDDEN });
  for (const [left, textContent] of labels) {
    const label = addElement(ticks, "span", { textContent });
    label.style.left = `${100 * left}%`;
  }
}

// Append a line of text, and return an element for each part. A part is a text, or a text and the
// class name that colors it.
function addAxisText(parent, parts) {
  const line = addElement(parent, "p", { className: "hdrlab-axis-name" });
  return parts.map((part) => {
    const [textContent, className] = Array.isArray(part) ? part : [part, ""];
    return addElement(line, "span", { textContent, className });
  });
}

// About `count` round numbers from `low` to `high`, for the ticks of an axis.
function roundNumbers(low, high, count) {
  const minStep = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(minStep));
  const step = [1, 2, 5, 10].find((factor) => factor * power >= minStep) * power;
  const first = Math.ceil(low / step);
  const last = Math.floor(high / step);
  return Array.from({ length: last - first + 1 }, (_, k) =>
    Number(((first + k) * step).toPrecision(6)),
  );
}

// A number with a fixed number of digits and a true minus sign, but no minus before zero.
function signedText(value, digits) {
  return value
    .toFixed(digits)
    .replace(/^-(?=[0.]+$)/, "")
    .replace("-", "−");
}
