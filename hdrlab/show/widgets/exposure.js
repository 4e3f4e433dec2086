// `widgets.exposure_window`: a photo with simulated noise, and its range as a window over the
// histogram of the scene. The formulas are those of capture/sensor.py and capture/ranges.py.
//
// Python sends
//   radiance      half floats (H, W, channels), multiplied by `scale`: E, cd/m²
//   shape         (H, W, channels)
//   span          the first and the last stop of the axis, log2 of luminance
//   sensor        full_well and read_noise, electrons; gain, electrons per level; black, levels
//   sensitivity   s, so that the exposure X = s L t is 1 where the well is full
//   pixel_values  the pixel value of each level of the converter, uint8
//   limits        the exposures X at which a pixel is lost in noise, and full
//   shutters      the text of each exposure time
//   times         the exposure times, s
//   alt           what the scene shows
// and both sides set
//   at            the index of the exposure time

const STRIPE_PERIOD = 8; // pixels from one stripe of the marks to the next
const FULL_COLOR = opaquePixel(213, 94, 0); // as in show/plots/lectures/sensors.py
const NOISE_COLOR = opaquePixel(0, 114, 178);
const RANDOM_COUNT = 16384; // few enough for the cache of a processor
const NORMAL_NUMBERS = normalNumbers(RANDOM_COUNT);

// Random numbers of a normal distribution. They are the same for each photo, so that only the light
// changes.
function normalNumbers(count) {
  let state = 1;
  const uniform = () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return (state + 0.5) / 2 ** 32;
  };
  return Float32Array.from({ length: count }, () => {
    const radius = Math.sqrt(-2 * Math.log(uniform()));
    return radius * Math.cos(2 * Math.PI * uniform());
  });
}

const normalNumber = (index) => NORMAL_NUMBERS[index & (RANDOM_COUNT - 1)];

// Return a function that writes the photo of an exposure time into `pixels`, 32 bits each, and
// returns the fractions of pixels that are lost in noise and full.
function createCamera(model, E, L, limitsOf) {
  const [height, width, channels] = model.get("shape");
  const { full_well: fullWell, read_noise: readNoise, gain, black } = model.get("sensor");
  const view = model.get("pixel_values");
  const pixelValues = new Uint8Array(view.buffer, view.byteOffset, view.byteLength);
  const maxLevel = pixelValues.length - 1;
  // The noise of the photons for one electron per radiance, and the noise of the amplifier.
  const shotNoise = E.map((radiance, i) => Math.sqrt(radiance) * normalNumber(i));
  const amplifierNoise = E.map((_, i) => readNoise * normalNumber(5 * i + 1));

  return (time, pixels) => {
    const electronsPerRadiance = fullWell * model.get("sensitivity") * time;
    const shotNoiseFactor = Math.sqrt(electronsPerRadiance);
    const [minLuminance, fullLuminance] = limitsOf(time);
    let noiseCount = 0;
    let fullCount = 0;

    function valueAt(i) {
      const electrons = electronsPerRadiance * E[i] + shotNoiseFactor * shotNoise[i];
      const signal = Math.min(electrons, fullWell) + amplifierNoise[i];
      const level = signal / gain + black + 0.5;
      return pixelValues[clamp(level, 0, maxLevel) | 0]; // rounded down
    }

    function colorAt(i) {
      if (channels === 1) {
        const gray = valueAt(i);
        return opaquePixel(gray, gray, gray);
      }
      return opaquePixel(valueAt(3 * i), valueAt(3 * i + 1), valueAt(3 * i + 2));
    }

    let i = 0;
    for (let y = 0; y < height; y++) {
      for (let x = 0; x < width; x++) {
        const isFull = L[i] >= fullLuminance;
        const isNoise = L[i] < minLuminance;
        if (isFull) fullCount += 1;
        if (isNoise) noiseCount += 1;
        const isFullStripe = (x + y) % STRIPE_PERIOD < STRIPE_PERIOD / 2;
        const isNoiseStripe = (x + height - y) % STRIPE_PERIOD < STRIPE_PERIOD / 2;
        if (isFull && isFullStripe) pixels[i] = FULL_COLOR;
        else if (isNoise && isNoiseStripe) pixels[i] = NOISE_COLOR;
        else pixels[i] = colorAt(i);
        i += 1;
      }
    }
    return { noise: noiseCount / L.length, full: fullCount / L.length };
  };
}

// Append the words below the ruler, each behind the color of its part of the histogram.
function addLegend(parent) {
  const legend = addElement(parent, "div", { className: "hdrlab-parts" });
  return ["noise", "held", "full"].map((kind) => {
    const part = addElement(legend, "span");
    addElement(part, "i", { className: `hdrlab-swatch hdrlab-${kind}` });
    return addElement(part, "span");
  });
}

async function render({ model, el }) {
  const root = createRoot(el, "exposure");
  const [height, width, channels] = model.get("shape");
  const bits = await decodeHalves(model.get("radiance"), channels);
  const E = Float32Array.from(bits, (half) => HALF_VALUES[half] / model.get("scale"));
  const L = luminances(E, channels);
  const span = model.get("span");
  const [low, high] = span;
  const shutters = model.get("shutters");
  const times = model.get("times");
  const at = () => model.get("at");

  // The luminances at which a photo of this time begins to measure, and ends.
  const limitsOf = (time) => model.get("limits").map((X) => X / (model.get("sensitivity") * time));
  // The position of a luminance on the axis, in percent.
  const percentOf = (luminance) => (100 * (Math.log2(luminance) - low)) / (high - low);

  const columns = addElement(root, "div", { className: "hdrlab-columns" });
  const leftColumn = addElement(columns, "div", { className: "hdrlab-column" });
  const canvas = addPhotoCanvas(leftColumn, width, height);
  const context = canvas.getContext("2d", { alpha: false });
  const image = context.createImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);
  const expose = createCamera(model, E, L, limitsOf);

  const rightColumn = addElement(columns, "div", { className: "hdrlab-column hdrlab-chart" });
  const scale = addElement(rightColumn, "div", {
    className: "hdrlab-scale",
    role: "slider",
    tabIndex: 0,
    "aria-label": "Shutter",
  });
  scale.setAttribute("aria-valuemin", 0);
  scale.setAttribute("aria-valuemax", times.length - 1);
  const bars = addHistogram(scale, L, span);
  const rangeBox = addElement(scale, "div", { className: "hdrlab-window" });
  const shutter = addElement(rangeBox, "b", { className: "hdrlab-is-t" });
  const stopText = (stop) => (stop < 0 ? `1/${2 ** -stop}` : 2 ** stop);
  const labels = multiplesBetween(span, 4).map((stop) => [stop, stopText(stop)]);
  addRuler(rightColumn, span, labels);
  addElement(rightColumn, "p", {
    className: "hdrlab-axis",
    textContent: "luminance, cd/m²; one mark is one stop",
  });
  const [noisePart, recordedPart, fullPart] = addLegend(rightColumn);
  const showStatus = addStatusLine(root);

  function paint() {
    const time = times[at()];
    const { noise, full } = expose(time, pixels);
    context.putImageData(image, 0, 0);

    const limits = limitsOf(time);
    const [from, to] = limits.map((luminance) => clamp(percentOf(luminance), 0, 100));
    rangeBox.style.left = `${from}%`;
    rangeBox.style.width = `${to - from}%`;
    const colors = `var(--noise) ${from}%, var(--held) 0 ${to}%, var(--full) 0`;
    bars.style.background = `linear-gradient(90deg, ${colors})`;

    shutter.textContent = shutters[at()];
    noisePart.textContent = `lost in noise ${percentText(noise)}`;
    recordedPart.textContent = `recorded ${percentText(1 - noise - full)}`;
    fullPart.textContent = `clipped ${percentText(full)}`;
    const lost = `${percentText(noise)} lost in noise, ${percentText(full)} clipped`;
    scale.setAttribute("aria-valuenow", at());
    scale.setAttribute("aria-valuetext", `${shutters[at()]}: ${lost}`);
    canvas.setAttribute("aria-label", `${model.get("alt")}, ${shutters[at()]}: ${lost}`);
    const stops = Math.log2(limits[1] / limits[0]).toFixed(1);
    const [darkest, brightest] = limits.map(threeDigits);
    showStatus(`${shutters[at()]} records ${stops} stops, from ${darkest} to ${brightest} cd/m².`);
  }
  const repaint = oncePerFrame(paint);

  function moveTo(index) {
    saveTrait(model, "at", clamp(index, 0, times.length - 1));
    repaint();
  }

  // The exposure time whose window has its upper end nearest to this fraction of the axis.
  function nearestTime(fraction) {
    const upperEnds = times.map((time) => percentOf(limitsOf(time)[1]));
    return indexOfLeast(upperEnds.map((end) => Math.abs(end - 100 * fraction)));
  }

  let grip = 0; // from the pointer to the upper end of the window, as a fraction of the axis
  makeDraggable(scale, bars, {
    // Outside the window, the window jumps so that its middle is under the pointer.
    grab([x]) {
      const [from, to] = limitsOf(times[at()]).map((luminance) => percentOf(luminance) / 100);
      const isInside = from <= x && x <= to;
      grip = isInside ? to - x : (to - from) / 2;
    },
    moveTo: ([x]) => moveTo(nearestTime(x + grip)),
    stepBy: (right, down) => moveTo(at() + right - down),
    farStep: 3, // a stop of the dial
  });
  const stopListening = onTraitChange(model, ["at"], repaint);
  paint();
  return stopListening;
}

export default { render };
