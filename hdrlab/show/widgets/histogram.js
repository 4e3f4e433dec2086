// Shared by the widgets in which a reader drags something along the histogram of a scene. Its axis
// is log2 of luminance; `span` is the first and the last stop of the axis.

const BINS_PER_STOP = 3;
const LUMINANCE_WEIGHTS = [0.2126, 0.7152, 0.0722]; // of red, green, blue: core/colour.py

// Luminances of radiance, whose channels are next to each other.
function luminances(E, channels) {
  if (channels === 1) return E;
  const [red, green, blue] = LUMINANCE_WEIGHTS;
  return Float32Array.from(
    { length: E.length / 3 },
    (_, i) => red * E[3 * i] + green * E[3 * i + 1] + blue * E[3 * i + 2],
  );
}

// The bars of the histogram of `L` as a CSS shape. `stopOf` gives the position of a luminance on
// the axis. Luminance 0 counts in the first bin.
function barShape(L, [low, high], stopOf = Math.log2) {
  const counts = new Float64Array((high - low) * BINS_PER_STOP);
  for (const luminance of L) {
    const bin = luminance > 0 ? Math.floor((stopOf(luminance) - low) * BINS_PER_STOP) : 0;
    counts[clamp(bin, 0, counts.length - 1)] += 1;
  }
  const maxCount = Math.max(...counts);
  const corners = ["0% 100%"];
  counts.forEach((count, bin) => {
    const left = `${(100 * bin) / counts.length}%`;
    const right = `${(100 * (bin + 1)) / counts.length}%`;
    const top = `${100 * (1 - count / maxCount)}%`;
    corners.push(`${left} ${top}`, `${right} ${top}`);
  });
  corners.push("100% 100%");
  return `polygon(${corners.join(", ")})`;
}

// Append a histogram: an element with the shape of the bars, so that its background colors them.
function addHistogram(parent, L, span, stopOf) {
  const bars = addElement(parent, "div", { className: "hdrlab-histogram" });
  bars.style.clipPath = barShape(L, span, stopOf);
  return bars;
}

// Append a ruler with a mark at each stop. `labels` are pairs: stop, text.
function addRuler(parent, [low, high], labels) {
  const ruler = addElement(parent, "div", { className: "hdrlab-ruler", "aria-hidden": "true" });
  ruler.style.setProperty("--stop", `${100 / (high - low)}%`);
  for (const [stop, textContent] of labels) {
    const label = addElement(ruler, "span", { textContent });
    label.style.left = `${(100 * (stop - low)) / (high - low)}%`;
  }
}

// The multiples of `step` from `low` to `high`.
function multiplesBetween([low, high], step) {
  const first = Math.ceil(low / step);
  const last = Math.floor(high / step);
  return Array.from({ length: last - first + 1 }, (_, k) => (first + k) * step);
}

// A fraction in percent, with one digit after the point below 10 %.
function percentText(fraction) {
  const digits = fraction > 0 && fraction < 0.0995 ? 1 : 0;
  return `${(100 * fraction).toFixed(digits)}\u00a0%`;
}
