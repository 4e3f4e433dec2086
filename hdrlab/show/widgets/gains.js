// `widgets.gain_screen`: a base image and its gain map on a screen whose peak the reader drags. The
// formulas are those of core/gainmap.py.
//
// Python sends
//   base      pixel values of the base image (3, H, W), see decodeRows
//   gains     codes of the gain map (3, H, W), see decodeRows
//   shape     (H, W)
//   low       log2 of the gain at code 0, for each channel
//   high      log2 of the gain at code 255, for each channel
//   offsets   what is added to the base and to the HDR image before they are divided
//   headroom  the peak for which the gain map was made, as a multiple of white
//   span      the first and the last stop of the axis, log2 of luminance; 0 is white
//   alt       what the image shows
// and both sides set
//   screen    the peak of the screen, as a multiple of white

const STEPS_PER_STOP = 6; // a key press changes the peak by a sixth of a stop
const LINEAR = Float32Array.from({ length: 256 }, (_, value) => decodeSrgb(value / 255));

// Luminance of the base image, whose channels are planes of `count` pixels.
function baseLuminance(base, count) {
  return Float32Array.from({ length: count }, (_, i) =>
    LUMINANCE_WEIGHTS.reduce((sum, weight, c) => sum + weight * LINEAR[base[c * count + i]], 0),
  );
}

// Paint pixel values or codes (3, H, W).
function paintPlanes(canvas, planes) {
  const { width, height } = canvas;
  const count = width * height;
  const context = canvas.getContext("2d", { alpha: false });
  const image = context.createImageData(width, height);
  for (let i = 0; i < count; i++) {
    image.data[4 * i] = planes[i];
    image.data[4 * i + 1] = planes[count + i];
    image.data[4 * i + 2] = planes[2 * count + i];
    image.data[4 * i + 3] = 255;
  }
  context.putImageData(image, 0, 0);
}

// The text of a stop of the axis.
function stopText(stop) {
  if (stop < 0) return `1/${2 ** -stop}`;
  return stop === 0 ? "white" : `${2 ** stop}×`;
}

async function render({ model, el }) {
  const root = createRoot(el, "gains");
  const [height, width] = model.get("shape");
  const base = await decodeRows(model.get("base"), width);
  const gains = await decodeRows(model.get("gains"), width);
  const count = height * width;
  const low = model.get("low");
  const high = model.get("high");
  const [baseOffset, lightOffset] = model.get("offsets");
  const headroom = model.get("headroom");
  const span = model.get("span");
  const [firstStop, lastStop] = span;
  const screen = () => model.get("screen");
  // The position of a stop on the axis, in percent.
  const percentOf = (stop) => (100 * (stop - firstStop)) / (lastStop - firstStop);

  const columns = addElement(root, "div", { className: "hdrlab-columns" });
  const leftColumn = addElement(columns, "div", { className: "hdrlab-column" });
  const screenCanvas = addPhotoCanvas(leftColumn, width, height);

  const rightColumn = addElement(columns, "div", { className: "hdrlab-column hdrlab-chart" });
  const scale = addElement(rightColumn, "div", { className: "hdrlab-scale" });
  const clip = addElement(scale, "div", { className: "hdrlab-clip" });
  const luminance = new Float32Array(count); // of the image on the screen
  addHistogram(clip, baseLuminance(base, count), span);
  const bars = addHistogram(clip, luminance, span);
  bars.classList.add("hdrlab-over");
  const whiteLine = addElement(scale, "i", { className: "hdrlab-white-line" });
  whiteLine.style.left = `${percentOf(0)}%`;
  const handle = addElement(scale, "div", {
    className: "hdrlab-handle hdrlab-is-Ld",
    role: "slider",
    tabIndex: 0,
  });
  handle.setAttribute("aria-label", "Peak of the screen, times its white");
  handle.setAttribute("aria-valuemin", 1);
  handle.setAttribute("aria-valuemax", 2 ** lastStop);
  const peak = addElement(handle, "b");
  // A label at each fourth stop below white, and at each stop above.
  const stops = [...multiplesBetween([firstStop, 0], 4), ...multiplesBetween([1, lastStop - 1], 1)];
  const labels = stops.map((stop) => [stop, stopText(stop)]);
  addRuler(rightColumn, span, labels);
  addElement(rightColumn, "p", {
    className: "hdrlab-axis",
    textContent: "luminance on the screen; gray: base image, colored: this screen",
  });

  const thumbnails = addElement(rightColumn, "div", { className: "hdrlab-thumbnails" });
  const addThumbnail = (name, planes) => {
    const figure = addElement(thumbnails, "div");
    const canvas = addPhotoCanvas(figure, width, height);
    canvas.setAttribute("aria-label", `${model.get("alt")}: ${name}`);
    addElement(figure, "span", { textContent: name });
    paintPlanes(canvas, planes);
    return canvas;
  };
  addThumbnail("base image", base);
  const gainCanvas = addThumbnail("gain map, as applied", gains);
  const showStatus = addStatusLine(root);

  // The fraction of the gain that the screen applies.
  const gainWeight = () => clamp(Math.log2(screen()) / Math.log2(headroom), 0, 1);

  // Apply the gain map with a weight: write the luminance, and return the pixel values.
  const values = new Uint8Array(base.length);
  function applyGains(weight) {
    luminance.fill(0);
    for (let c = 0; c < 3; c++) {
      const factors = Float32Array.from(
        { length: 256 },
        (_, code) => 2 ** (weight * (low[c] + ((high[c] - low[c]) * code) / 255)),
      );
      for (let i = 0; i < count; i++) {
        const k = c * count + i;
        const light = (LINEAR[base[k]] + baseOffset) * factors[gains[k]] - lightOffset;
        luminance[i] += LUMINANCE_WEIGHTS[c] * light;
        values[k] = pixelValue(light > 0 ? (LIGHT_STEPS * light) / headroom : 0);
      }
    }
    return values;
  }

  function paint() {
    const weight = gainWeight();
    paintPlanes(screenCanvas, applyGains(weight));
    gainCanvas.style.filter = `brightness(${weight})`;
    bars.style.clipPath = barShape(luminance, span);
    handle.style.left = `${percentOf(Math.log2(screen()))}%`;
    const times = Number(screen().toPrecision(2));
    peak.textContent = `peak ${times}×`;
    handle.setAttribute("aria-valuenow", screen());
    handle.setAttribute(
      "aria-valuetext",
      `${times} times white, ${percentText(weight)} of the gain`,
    );
    screenCanvas.setAttribute(
      "aria-label",
      `${model.get("alt")}, on a screen that shows ${times} times its white`,
    );
    showStatus(
      `A screen that can show ${times} times its white applies ${percentText(weight)} of the gain.`,
    );
  }
  const repaint = oncePerFrame(paint);

  // Set the peak, rounded to a sixth of a stop.
  function moveTo(value) {
    const steps = Math.round(Math.log2(value) * STEPS_PER_STOP);
    saveTrait(model, "screen", clamp(2 ** (steps / STEPS_PER_STOP), 1, 2 ** lastStop));
    repaint();
  }

  makeDraggable(scale, clip, {
    grab: () => handle.focus({ preventScroll: true }),
    moveTo: ([x]) => moveTo(2 ** (firstStop + x * (lastStop - firstStop))),
    stepBy: (right, down) => moveTo(screen() * 2 ** ((right - down) / STEPS_PER_STOP)),
    farStep: STEPS_PER_STOP,
  });
  const stopListening = onTraitChange(model, ["screen"], repaint);
  paint();
  return stopListening;
}

export default { render };
