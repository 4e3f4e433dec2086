// Shared by the figures in which something is dragged along the histogram of a scene, whose axis is log2 of luminance.

const BINS_PER_STOP = 3;

// Luminances of radiance, as core/colour.py computes them.
function luminances(E, channels) {
  if (channels === 1) return E;
  const red = (i) => 3 * i;
  return Float32Array.from({ length: E.length / 3 }, (_, i) =>
    0.2126 * E[red(i)] + 0.7152 * E[red(i) + 1] + 0.0722 * E[red(i) + 2]);
}

// The bars of a histogram as a shape. `toStops` gives the place of a luminance on the axis.
function barShape(L, [low, high], toStops = Math.log2) {
  const counts = new Float64Array((high - low) * BINS_PER_STOP);
  for (const each of L) {
    const bin = each > 0 ? Math.floor((toStops(each) - low) * BINS_PER_STOP) : 0;
    counts[clamp(bin, 0, counts.length - 1)]++;
  }
  const largest = Math.max(...counts);
  const corners = ["0% 100%"];
  counts.forEach((count, k) => {
    const top = `${100 * (1 - count / largest)}%`;
    corners.push(`${(100 * k) / counts.length}% ${top}`, `${(100 * (k + 1)) / counts.length}% ${top}`);
  });
  return `polygon(${corners.join(", ")}, 100% 100%)`;
}

// A histogram as an element of that shape, so that a change of its background colors the bars.
function histogram(parent, L, span, toStops) {
  const bars = element(parent, "div", { className: "hdrlab-histogram" });
  bars.style.clipPath = barShape(L, span, toStops);
  return bars;
}

// A ruler with a mark at each stop, and these labels: pairs of a stop and a text.
function ruler(parent, [low, high], labels) {
  const line = element(parent, "div", { className: "hdrlab-ruler", "aria-hidden": "true" });
  line.style.setProperty("--stop", `${100 / (high - low)}%`);
  for (const [stop, textContent] of labels) {
    const text = element(line, "span", { textContent });
    text.style.left = `${(100 * (stop - low)) / (high - low)}%`;
  }
}

// The stops of an axis that are multiples of this many.
function everyFew([low, high], stops) {
  const first = Math.ceil(low / stops);
  return Array.from({ length: Math.floor(high / stops) - first + 1 }, (_, k) => (first + k) * stops);
}

// A fraction in percent, as a reader writes it.
function percent(fraction) {
  const digits = fraction > 0 && fraction < 0.0995 ? 1 : 0;
  return `${(100 * fraction).toFixed(digits)}\u00a0%`;
}
