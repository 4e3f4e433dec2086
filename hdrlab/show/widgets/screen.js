// `widgets.screen_match`: measure the gamma and the black of this screen by two matches, and show a
// scene with settings that suit it. The formulas are those of calibration/matching.py,
// tonemap/ward.py and core/colour.py.
//
// Python sends
//   thresholds   smallest, usual and largest threshold of the eye, as a fraction of the black
//   match_error  relative difference between two lights that look equal
//   radiance     half floats (H, W, channels), multiplied by `scale`: E, any linear unit
//   shape        (H, W, channels)
//   stops        log2 of the contrast of each curve, in steps of half a stop, and then of the
//                picture for comparison
//   spans        ln L at the first and the last edge of each curve
//   curves       ln Ld at the edges of each curve; 0 is the black of the screen
//   usual        the curve of the picture for comparison
//   alt          what the scene shows
// and both sides set
//   gray         pixel value, 0 to 1, that is as bright as rows of black and white
//   dark         mean pixel value, 0 to 1, of the darkest patch that can be told from black

const MAX_CODE = 255;
const GRAY_CODES = Array.from({ length: 104 }, (_, k) => 128 + k);
// The slider of the dark patch: a step is about 10 %, and at least a sixteenth of a code.
const DARK_SIXTEENTHS = Array.from({ length: 70 }, (_, k) => Math.round(2 ** (k / 7)));
const DARK_CODES = [...new Set(DARK_SIXTEENTHS)].map((sixteenth) => sixteenth / 16);
const PATCH_FRACTION = 0.45; // side of a patch as a fraction of the smaller side of its field
// Which of 4 x 4 pixels have the higher of two codes: those below a threshold of 0 to 16.
const DITHER_ORDER = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5];
const SRGB_GAMMA = Math.log(0.5) / Math.log(encodeSrgb(0.5)); // of the match on an sRGB screen
const MIN_LUMINANCE = 1e-30; // below this, a pixel has no color, as in core/colour.py
const DARK_ROOM_STOPS = 6; // with fewer stops, the light of the room matters most

const gammaOfMatch = (gray) => Math.log(0.5) / Math.log(gray);

// The mean light of a patch whose pixels have the two codes next to v; black is left out.
function ditheredLight(v, gamma) {
  const code = Math.floor(MAX_CODE * v);
  const fraction = MAX_CODE * v - code;
  const light = (c) => (c / MAX_CODE) ** gamma;
  return (1 - fraction) * light(code) + fraction * light(code + 1);
}

// log2(1 / b) for the black b = x / (x + threshold).
function stopsOf(dark, gamma, threshold) {
  const light = ditheredLight(dark, gamma);
  return Math.log2((light + threshold) / light);
}

// Paint a patch of mean pixel value v in the middle of a field. `around` gives the code of a row.
function paintField(canvas, v, around) {
  const { width, height } = canvas;
  const context = canvas.getContext("2d", { alpha: false });
  const image = context.createImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);
  const half = Math.round((PATCH_FRACTION * Math.min(width, height)) / 2);
  const code = Math.floor(MAX_CODE * v + 1e-6);
  const fraction = MAX_CODE * v - code;
  for (let y = 0; y < height; y++) {
    const surround = around(y);
    const isPatchRow = Math.abs(y + 0.5 - height / 2) < half;
    for (let x = 0; x < width; x++) {
      let value = surround;
      if (isPatchRow && Math.abs(x + 0.5 - width / 2) < half) {
        const order = DITHER_ORDER[4 * (y % 4) + (x % 4)];
        value = order < Math.round(16 * fraction) ? code + 1 : code;
      }
      pixels[y * width + x] = opaquePixel(value, value, value);
    }
  }
  context.putImageData(image, 0, 0);
}

// Give a canvas one pixel for each pixel of the screen, and paint it whenever its size changes.
function followDevicePixels(canvas, paint) {
  const observer = new ResizeObserver(([entry]) => {
    const { width, height } = entry.contentRect;
    const [box] = entry.devicePixelContentBoxSize ?? []; // WebKit has none
    // The box is exact, but a browser that only simulates the pixels of a screen reports others.
    const pixelCount = (exact, size) => {
      const pixels = Math.max(Math.round(size * devicePixelRatio), 1);
      return Math.abs(exact - pixels) <= 1 ? exact : pixels;
    };
    canvas.width = pixelCount(box?.inlineSize, width);
    canvas.height = pixelCount(box?.blockSize, height);
    paint();
  });
  try {
    observer.observe(canvas, { box: "device-pixel-content-box" });
  } catch {
    observer.observe(canvas);
  }
  return () => observer.disconnect();
}

// Return a function that gives Ld, from 0 to 1, for ln L: Ward's curve number k without the black.
function wardCurve(model, k) {
  const [low, high] = model.get("spans")[k];
  const lnLd = model.get("curves")[k];
  const last = lnLd.length - 1;
  const white = 2 ** model.get("stops")[k];
  return (lnL) => {
    const position = clamp((last * (lnL - low)) / (high - low), 0, last);
    const edge = Math.min(Math.floor(position), last - 1);
    const between = lnLd[edge] + (position - edge) * (lnLd[edge + 1] - lnLd[edge]);
    return clamp((Math.exp(between) - 1) / (white - 1), 0, 1);
  };
}

// The pixel values of light from 0 to LIGHT_STEPS on a screen with this gamma.
function pixelValuesOf(gamma) {
  return Uint8Array.from({ length: LIGHT_STEPS + 1 }, (_, step) =>
    Math.floor(MAX_CODE * (step / LIGHT_STEPS) ** (1 / gamma) + 0.5),
  );
}

// Paint the scene: `tone` gives Ld for ln L, and `codes` the pixel value for each step of light.
function paintScene(canvas, { L, ratios, channels }, tone, codes) {
  const context = canvas.getContext("2d", { alpha: false });
  const image = context.createImageData(canvas.width, canvas.height);
  L.forEach((luminance, i) => {
    const light = LIGHT_STEPS * tone(Math.log(Math.max(luminance, MIN_LUMINANCE)));
    for (let c = 0; c < 3; c++) {
      const ratio = ratios[i * channels + Math.min(c, channels - 1)];
      image.data[4 * i + c] = codes[Math.min(Math.round(light * ratio), LIGHT_STEPS)];
    }
    image.data[4 * i + 3] = 255;
  });
  context.putImageData(image, 0, 0);
}

// The nearest of the slider's codes to a pixel value.
const nearestPosition = (codes, v) => indexOfLeast(codes.map((c) => Math.abs(c - MAX_CODE * v)));

async function render({ model, el }) {
  const root = createRoot(el, "screen");
  const [height, width, channels] = model.get("shape");
  const bits = await decodeHalves(model.get("radiance"), channels);
  const E = Float32Array.from(bits, (half) => HALF_VALUES[half] / model.get("scale"));
  const L = luminances(E, channels);
  const ratios = E.map((radiance, i) => {
    const luminance = L[Math.floor(i / channels)];
    return luminance < MIN_LUMINANCE ? 1 : radiance / luminance;
  });
  const scene = { L, ratios, channels };
  const [smallest, usual, largest] = model.get("thresholds");

  const fields = addElement(root, "div", { className: "hdrlab-columns" });
  // A field with a patch, its slider, and what to do with it.
  function addField({ trait, name, task, codes, around }) {
    const column = addElement(fields, "div", { className: "hdrlab-column" });
    addElement(column, "p", { className: "hdrlab-axis", textContent: task });
    const canvas = addPhotoCanvas(column, 1, 1);
    canvas.className = "hdrlab-field";
    const slider = addSlider(column, name, codes.length);
    slider.reserve(12);
    const paintPatch = () => paintField(canvas, model.get(trait), around);
    const show = () => {
      const code = MAX_CODE * model.get(trait);
      slider.show(nearestPosition(codes, model.get(trait)), `${threeDigits(code)} of 255`);
      canvas.setAttribute("aria-label", `${task} The ${name} is at ${threeDigits(code)} of 255.`);
      paintPatch();
    };
    slider.input.addEventListener("input", () => {
      saveTrait(model, trait, codes[slider.position()] / MAX_CODE);
    });
    return { show, stop: followDevicePixels(canvas, paintPatch) };
  }
  const grayField = addField({
    trait: "gray",
    name: "gray",
    task: "1. Step back or squint. Make the square as bright as the rows around it.",
    codes: GRAY_CODES,
    around: (y) => (y % 2 ? MAX_CODE : 0),
  });
  const darkField = addField({
    trait: "dark",
    name: "dark",
    task: "2. Darken the square in the middle until you only just see it.",
    codes: DARK_CODES,
    around: () => 0,
  });

  const showStatus = addStatusLine(root);
  const button = addElement(root, "button", { textContent: "Fill the screen" });
  button.hidden = !document.fullscreenEnabled;
  button.addEventListener("click", () => {
    if (document.fullscreenElement) document.exitFullscreen();
    else root.requestFullscreen();
  });
  const nameButton = () => {
    button.textContent = document.fullscreenElement ? "Back to the page" : "Fill the screen";
  };
  root.addEventListener("fullscreenchange", nameButton);

  const photos = addElement(root, "div", { className: "hdrlab-columns hdrlab-results" });
  const addScene = () => {
    const column = addElement(photos, "div", { className: "hdrlab-column" });
    const canvas = addPhotoCanvas(column, width, height);
    const caption = addElement(column, "p", { className: "hdrlab-axis" });
    return { canvas, caption };
  };
  const before = addScene();
  const after = addScene();
  const advice = addElement(root, "p", { className: "hdrlab-note hdrlab-results" });

  const comparison = model.get("usual");
  paintScene(before.canvas, scene, wardCurve(model, comparison), PIXEL_VALUES);
  before.caption.textContent = "For any screen: ward with white 100, sRGB";
  before.canvas.setAttribute("aria-label", `${model.get("alt")}, for any screen`);

  function adviceText(gamma, stops) {
    const error = gamma * (model.get("match_error") / Math.LN2);
    const texts = [];
    if (Math.abs(gamma - SRGB_GAMMA) <= error) texts.push("sRGB files have the right gamma here.");
    else if (gamma > SRGB_GAMMA) texts.push("sRGB files look too dark here.");
    else texts.push("sRGB files look too pale here.");
    if (stops < DARK_ROOM_STOPS) texts.push("Draw the curtains: half the black is one stop more.");
    const isBright = matchMedia("(dynamic-range: high)").matches;
    texts.push(
      isBright
        ? "The browser reports light beyond white, but not how much: try an Ultra HDR file."
        : "The browser reports no light beyond white.",
    );
    return texts.join(" ");
  }

  const matched = new Set(); // the sliders that the reader has moved

  function paintResult() {
    if (matched.size < 2) {
      showStatus("Make both matches. Then this line shows the result.");
      paintScene(after.canvas, scene, wardCurve(model, comparison), PIXEL_VALUES);
      after.caption.textContent = "For this screen: make both matches first";
      after.canvas.setAttribute("aria-label", `${model.get("alt")}, not yet for this screen`);
      return;
    }
    const dark = model.get("dark");
    const gamma = gammaOfMatch(model.get("gray"));
    const stops = stopsOf(dark, gamma, usual);
    const fewest = stopsOf(dark, gamma, smallest);
    const most = stopsOf(dark, gamma, largest);
    const error = gamma * (model.get("match_error") / Math.LN2);
    const candidates = model.get("stops").slice(0, comparison);
    // The darkest patch of the slider, and the darkest black that matters, are only a bound.
    const maxStops = candidates[comparison - 1];
    const isBound = MAX_CODE * dark <= DARK_CODES[0] + 1e-6 || stops > maxStops;
    const shownStops = Math.min(stops, maxStops);
    const blackText = `${Number((100 * 2 ** -shownStops).toPrecision(2))}\u00a0% of white`;
    const range = `${fewest.toFixed(1)} to ${most.toFixed(1)}`;
    showStatus(
      `Gamma ${gamma.toFixed(2)} ± ${error.toFixed(2)}. ` +
        `Black ${isBound ? "at most " : ""}${blackText}, with the light of the room: ` +
        `${isBound ? "at least " : ""}${shownStops.toFixed(1)} stops` +
        `${isBound ? "" : ` (${range})`}.`,
    );
    const k = indexOfLeast(candidates.map((candidate) => Math.abs(candidate - stops)));
    paintScene(after.canvas, scene, wardCurve(model, k), pixelValuesOf(gamma));
    const settings = `ward with white ${Math.round(2 ** candidates[k])}, gamma ${gamma.toFixed(2)}`;
    after.caption.textContent = `For this screen: ${settings}`;
    after.canvas.setAttribute("aria-label", `${model.get("alt")}, for this screen: ${settings}`);
    advice.textContent = adviceText(gamma, stops);
  }

  function paint() {
    grayField.show();
    darkField.show();
    paintResult();
  }
  const repaint = oncePerFrame(paint);
  const follow = (trait) =>
    onTraitChange(model, [trait], () => {
      matched.add(trait);
      repaint();
    });
  const ends = [follow("gray"), follow("dark"), grayField.stop, darkField.stop];
  paint();
  return () => ends.forEach((end) => end());
}

export default { render };
