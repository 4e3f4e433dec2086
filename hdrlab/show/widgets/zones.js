// `widgets.zone_scale`: Reinhard's global operator on a scale of zones, with handles for the key
// and the white point. The formulas are those of tonemap/reinhard.py and core/colour.py.
//
// Python sends
//   radiance     half floats (H, W, channels), multiplied by `scale`: E, any linear unit
//   shape        (H, W, channels)
//   log_average  the log average of the luminance L
//   zones        the first and the last zone of the axis
//   alt          what the scene shows
// and both sides set
//   key          the scaled luminance Lm of the log average
//   white        the scaled luminance Lm that becomes white

const MIDDLE_GRAY = 0.18; // the Lm of zone V
const MIDDLE_ZONE = 5;
const ZONE_LABELS = [
  [0, "0"],
  [2, "II"],
  [5, "V"],
  [8, "VIII"],
  [10, "X"],
];
const CURVE_POINTS = 120;
const TONE_STEPS = 40; // of the strip of tones
const STEPS_PER_STOP = 6; // a key press changes a value by a sixth of a stop
const KEY_RANGE = [0.0025, 1.44];
const WHITE_RANGE = [1, 64];
const GRIP_ZONES = 0.7; // a handle this near to the pointer does not jump to it
const MIN_LUMINANCE = 1e-30; // below this, a pixel has no color, as in core/colour.py
const STRIPE_PERIOD = 8; // pixels from one stripe of the marks to the next
const ABOVE_WHITE_COLOR = opaquePixel(213, 94, 0);
// Two curves in a square of 100 units, stretched over the parent.
const CURVES = `<svg viewBox="0 0 100 100" preserveAspectRatio="none" aria-hidden="true">
  <path class="hdrlab-plain-curve"/><path class="hdrlab-is-Ld"/></svg>`;

const zoneOf = (Lm) => MIDDLE_ZONE + Math.log2(Lm / MIDDLE_GRAY);
const scaledLuminance = (zone) => MIDDLE_GRAY * 2 ** (zone - MIDDLE_ZONE);
const displayLuminance = (Lm, white) => Math.min((Lm * (1 + Lm / white ** 2)) / (1 + Lm), 1);
const twoDigits = (value) => String(Number(value.toPrecision(2)));

// E / L of each channel: the color of a pixel.
function colorRatios(E, L, channels) {
  return E.map((radiance, i) => {
    const luminance = L[Math.floor(i / channels)];
    return luminance < MIN_LUMINANCE ? 1 : radiance / luminance;
  });
}

// Return a function that writes the tone-mapped image into `pixels`, 32 bits each, with stripes
// above the white point, and returns the fraction of pixels there.
function createToneMapper(model, E, L) {
  const [height, width, channels] = model.get("shape");
  const logAverage = model.get("log_average");
  const ratios = colorRatios(E, L, channels);

  function colorOf(i, Lm, white) {
    const light = LIGHT_STEPS * displayLuminance(Lm, white);
    const first = i * channels;
    const red = pixelValue(light * ratios[first]);
    const green = channels === 1 ? red : pixelValue(light * ratios[first + 1]);
    const blue = channels === 1 ? red : pixelValue(light * ratios[first + 2]);
    return opaquePixel(red, green, blue);
  }

  return (key, white, pixels) => {
    let aboveWhite = 0;
    let i = 0;
    for (let y = 0; y < height; y++) {
      for (let x = 0; x < width; x++) {
        const Lm = (key / logAverage) * L[i];
        const isAboveWhite = Lm >= white;
        const isStripe = (x + y) % STRIPE_PERIOD < STRIPE_PERIOD / 4;
        if (isAboveWhite) aboveWhite += 1;
        pixels[i] = isAboveWhite && isStripe ? ABOVE_WHITE_COLOR : colorOf(i, Lm, white);
        i += 1;
      }
    }
    return aboveWhite / L.length;
  };
}

// Append a handle on the scale for one of the two traits.
function addHandle(scale, name, label, range) {
  const line = addElement(scale, "div", {
    className: `hdrlab-handle hdrlab-handle-${name}`,
    role: "slider",
    tabIndex: 0,
  });
  line.setAttribute("aria-label", label);
  line.setAttribute("aria-valuemin", range[0]);
  line.setAttribute("aria-valuemax", range[1]);
  return { name, range, line, text: addElement(line, "b") };
}

async function render({ model, el }) {
  const root = createRoot(el, "zones");
  const [height, width, channels] = model.get("shape");
  const bits = await decodeHalves(model.get("radiance"), channels);
  const E = Float32Array.from(bits, (half) => HALF_VALUES[half] / model.get("scale"));
  const L = luminances(E, channels);
  const zones = model.get("zones");
  const [low, high] = zones;
  const logAverage = model.get("log_average");
  // The position of a zone on the axis, in percent.
  const percentOf = (zone) => (100 * (zone - low)) / (high - low);
  const zoneAt = (fraction) => low + fraction * (high - low);

  const columns = addElement(root, "div", { className: "hdrlab-columns" });
  const leftColumn = addElement(columns, "div", { className: "hdrlab-column" });
  const canvas = addPhotoCanvas(leftColumn, width, height);
  const context = canvas.getContext("2d", { alpha: false });
  const image = context.createImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);
  const tonemap = createToneMapper(model, E, L);

  const rightColumn = addElement(columns, "div", {
    className: "hdrlab-column hdrlab-chart hdrlab-two-handles",
  });
  const scale = addElement(rightColumn, "div", { className: "hdrlab-scale" });
  const clip = addElement(scale, "div", { className: "hdrlab-clip" });
  // The histogram for the key of middle gray. Another key moves it sideways.
  const Lm = L.map((luminance) => (luminance * MIDDLE_GRAY) / logAverage);
  const bars = addHistogram(clip, Lm, zones, zoneOf);
  clip.insertAdjacentHTML("beforeend", CURVES);
  const [plainCurve, curve] = clip.querySelectorAll("path");
  let active = null; // the handle that the pointer or the focus is on
  const handles = [
    addHandle(scale, "key", "Key", KEY_RANGE),
    addHandle(scale, "white", "White point", WHITE_RANGE),
  ];
  for (const handle of handles) {
    handle.line.addEventListener("focus", () => {
      active = handle;
    });
  }
  const tones = addElement(rightColumn, "div", {
    className: "hdrlab-tones",
    "aria-hidden": "true",
  });
  addRuler(rightColumn, zones, ZONE_LABELS);
  addElement(rightColumn, "p", {
    className: "hdrlab-axis",
    textContent:
      "One zone is one stop. The strip shows the tones of the picture; " +
      "the dashed curve has no white point.",
  });
  const showStatus = addStatusLine(root);

  // The curve from Lm to the encoded display luminance.
  function curvePath(white) {
    const points = Array.from({ length: CURVE_POINTS + 1 }, (_, k) => {
      const zone = zoneAt(k / CURVE_POINTS);
      const encoded = encodeSrgb(displayLuminance(scaledLuminance(zone), white));
      return `${percentOf(zone).toFixed(2)},${(100 * (1 - encoded)).toFixed(2)}`;
    });
    return `M${points.join("L")}`;
  }
  plainCurve.setAttribute("d", curvePath(Infinity));

  function paintScale(key, white) {
    const shift = percentOf(low + Math.log2(key / MIDDLE_GRAY));
    const whiteInBars = percentOf(zoneOf(white)) - shift;
    bars.style.transform = `translateX(${shift}%)`;
    bars.style.background = `linear-gradient(90deg, var(--held) ${whiteInBars}%, var(--full) 0)`;
    curve.setAttribute("d", curvePath(white));
    const grays = Array.from({ length: TONE_STEPS + 1 }, (_, k) => {
      const Ld = displayLuminance(scaledLuminance(zoneAt(k / TONE_STEPS)), white);
      const gray = Math.floor(255 * encodeSrgb(Ld) + 0.5);
      return `rgb(${gray} ${gray} ${gray})`;
    });
    tones.style.background = `linear-gradient(90deg, ${grays.join(", ")})`;
    for (const { name, line, text } of handles) {
      const value = model.get(name);
      line.style.left = `${percentOf(zoneOf(value))}%`;
      text.textContent = `${name} ${twoDigits(value)}`;
      line.setAttribute("aria-valuenow", value);
      line.setAttribute("aria-valuetext", `${twoDigits(value)}, zone ${zoneOf(value).toFixed(1)}`);
    }
  }

  function paint() {
    const key = model.get("key");
    const white = model.get("white");
    const aboveWhite = tonemap(key, white, pixels);
    context.putImageData(image, 0, 0);
    paintScale(key, white);
    const values = handles.map(({ text }) => text.textContent).join(", ");
    canvas.setAttribute("aria-label", `${model.get("alt")}, ${values}`);
    showStatus(
      `The log average of the scene lies in zone ${zoneOf(key).toFixed(1)}, ` +
        `and ${percentText(aboveWhite)} of the pixels are above white.`,
    );
  }
  const repaint = oncePerFrame(paint);

  // Set a value, rounded to a sixth of a stop from middle gray (key) or from 1 (white point).
  function moveTo(handle, value) {
    const origin = handle.name === "key" ? MIDDLE_GRAY : 1;
    const steps = Math.round(Math.log2(value / origin) * STEPS_PER_STOP);
    const rounded = origin * 2 ** (steps / STEPS_PER_STOP);
    saveTrait(model, handle.name, clamp(rounded, ...handle.range));
    repaint();
  }

  let grip = 0; // zones from the pointer to the handle
  makeDraggable(scale, clip, {
    grab([x]) {
      const zonesTo = (handle) => zoneOf(model.get(handle.name)) - zoneAt(x);
      const distanceTo = (handle) => Math.abs(zonesTo(handle));
      const [key, white] = handles;
      active = distanceTo(key) < distanceTo(white) ? key : white;
      active.line.focus({ preventScroll: true });
      grip = distanceTo(active) < GRIP_ZONES ? zonesTo(active) : 0;
    },
    moveTo: ([x]) => moveTo(active, scaledLuminance(zoneAt(x) + grip)),
    stepBy(right, down) {
      moveTo(active, model.get(active.name) * 2 ** ((right - down) / STEPS_PER_STOP));
    },
    farStep: STEPS_PER_STOP,
  });
  const stopListening = onTraitChange(model, ["key", "white"], repaint);
  paint();
  return stopListening;
}

export default { render };
