// `widgets.pixel_mean`: what each photo claims about the radiance of one pixel, and the weighted
// mean. The formulas are those of radiance/merge.py.
//
// Python sends
//   levels    pixel values of the photos (P, C, H, W), see decodeRows
//   shape     (P, H, W, C)
//   shutters  the text of each exposure time
//   ln_times  B, the ln of each exposure time in seconds
//   response  g (256,), the ln exposure of each pixel value
//   weights   w (256,), the weight of each pixel value
//   top       the first clipped pixel value
//   channel   the channel whose values are shown
//   span      the ends of the axis, ln E
//   alt       what the photos show
// and both sides set
//   at        the pixel (y, x)

const MIN_RELATIVE_WEIGHT = 1e-6; // as in radiance/merge.py
const MIN_DOT_SIZE = 6; // pixels, for weight 0
const MAX_DOT_SIZE = 18; // for the largest weight
const CLAIM_CLASSES = { "": "", "at least": "hdrlab-least", "at most": "hdrlab-most" };

// The calculations of radiance/merge.py for one pixel.
async function createMerger(model) {
  const [count, height, width, channels] = model.get("shape");
  const levels = await decodeRows(model.get("levels"), width);
  const B = model.get("ln_times");
  const g = model.get("response");
  const w = model.get("weights");
  const top = model.get("top");
  const channel = model.get("channel");
  const maxWeight = Math.max(...w);
  const photos = [...Array(count).keys()];

  const levelOf = (photo, c, y, x) => levels[((photo * channels + c) * height + y) * width + x];
  const shownLevel = (photo, y, x) => levelOf(photo, channel, y, x);

  function isClippedInAnyChannel(photo, y, x) {
    for (let c = 0; c < channels; c++) {
      if (levelOf(photo, c, y, x) >= top) return true;
    }
    return false;
  }

  // A photo with a clipped channel counts only if no photo measures the pixel in all channels.
  function weigh(y, x) {
    const isUsable = photos.map((photo) => {
      const level = shownLevel(photo, y, x);
      return level > 0 && level < top;
    });
    const isWhole = photos.map((photo) => isUsable[photo] && !isClippedInAnyChannel(photo, y, x));
    const isCounted = isWhole.some(Boolean) ? isWhole : isUsable;
    const minWeight = MIN_RELATIVE_WEIGHT * maxWeight;
    return photos.map((photo) =>
      isCounted[photo] ? Math.max(w[shownLevel(photo, y, x)], minWeight) : 0,
    );
  }

  // What one photo claims about ln E: an estimate, or a bound if it is clipped or black.
  function claim(photo, y, x) {
    const level = shownLevel(photo, y, x);
    if (level >= top) return { kind: "at least", lnE: g[top] - B[photo] };
    if (level === 0) return { kind: "at most", lnE: g[1] - B[photo] };
    return { kind: "", lnE: g[level] - B[photo] };
  }

  // The weighted mean of the claims, or the mean of the tightest bounds if there is no estimate.
  function merge(claims, weights) {
    const total = sumOf(weights);
    if (total > 0) return sumOf(claims.map(({ lnE }, photo) => weights[photo] * lnE)) / total;
    const boundsOf = (kind) => claims.filter((bound) => bound.kind === kind).map(({ lnE }) => lnE);
    const lowerBounds = boundsOf("at least");
    const upperBounds = boundsOf("at most");
    const tightest = [];
    if (lowerBounds.length) tightest.push(Math.max(...lowerBounds));
    if (upperBounds.length) tightest.push(Math.min(...upperBounds));
    return sumOf(tightest) / tightest.length;
  }

  return { photos, levelOf, shownLevel, maxWeight, weigh, claim, merge };
}

// Append a table with a row for each photo: its time, level and weight, and its claim on an axis.
function addTable(parent, shutters, showPhoto) {
  const table = addElement(parent, "div", { className: "hdrlab-column hdrlab-bars" });
  const header = addElement(table, "div", { className: "hdrlab-bar-row hdrlab-bar-names" });
  const columns = [
    ["time", "t"],
    ["level", "Z"],
    ["weight", "w"],
    ["claims E =", "E"],
  ];
  for (const [name, symbol] of columns) {
    addElement(header, "span", { textContent: name, className: `hdrlab-is-${symbol}` });
  }

  const addBar = (row, symbol) => {
    const cell = addElement(row, "div", { className: `hdrlab-bar hdrlab-is-${symbol}` });
    const fill = addElement(cell, "i");
    return { fill, text: addElement(cell, "span") };
  };
  const rows = shutters.map((shutter, photo) => {
    const row = addElement(table, "div", { className: "hdrlab-bar-row" });
    const button = addElement(row, "button", { className: "hdrlab-plain", textContent: shutter });
    button.setAttribute("aria-label", `Show the photo of ${shutter}`);
    button.addEventListener("click", () => showPhoto(photo));
    const levelBar = addBar(row, "Z");
    const weightBar = addBar(row, "w");
    const axis = addElement(row, "div", { className: "hdrlab-claim hdrlab-is-E" });
    const meanLine = addElement(axis, "i", { className: "hdrlab-mean" });
    const dot = addElement(axis, "b");
    const text = addElement(axis, "span");
    return { row, button, levelBar, weightBar, meanLine, dot, text };
  });

  const footer = addElement(table, "div", { className: "hdrlab-bar-row" });
  const axis = addElement(footer, "div", {
    className: "hdrlab-claim hdrlab-mean-name hdrlab-is-E",
  });
  return { rows, meanText: addElement(axis, "span") };
}

async function render({ model, el }) {
  const root = createRoot(el, "pixel");
  const [count, height, width, channels] = model.get("shape");
  const shutters = model.get("shutters");
  const [low, high] = model.get("span");
  const at = () => model.get("at");
  const { photos, levelOf, shownLevel, maxWeight, weigh, claim, merge } = await createMerger(model);
  let shownPhoto = Math.floor(count / 2);

  const columns = addElement(root, "div", { className: "hdrlab-columns" });
  const leftColumn = addElement(columns, "div", { className: "hdrlab-column" });
  const help = "The pixel. Arrow keys move it, with Shift by 8 pixels.";
  const { frame, canvas, context } = addStage(leftColumn, help);
  canvas.width = width;
  canvas.height = height;
  canvas.className = "hdrlab-photo";
  const ring = addElement(frame, "i", { className: "hdrlab-ring" });
  const photoText = addElement(leftColumn, "p", { className: "hdrlab-note" });
  const { rows, meanText } = addTable(columns, shutters, showPhoto);
  const showStatus = addStatusLine(root);

  function describeCanvas() {
    const [y, x] = at();
    const text = `${model.get("alt")}, ${shutters[shownPhoto]}, pixel x ${x}, y ${y}`;
    canvas.setAttribute("aria-label", text);
  }

  function showPhoto(photo) {
    const image = context.createImageData(width, height);
    let position = 0;
    for (let y = 0; y < height; y++) {
      for (let x = 0; x < width; x++) {
        for (let c = 0; c < 3; c++) image.data[position + c] = levelOf(photo, c % channels, y, x);
        image.data[position + 3] = 255;
        position += 4;
      }
    }
    context.putImageData(image, 0, 0);
    rows.forEach(({ button }, index) => button.setAttribute("aria-pressed", index === photo));
    photoText.textContent = `The photo of ${shutters[photo]}. Press another time to see its photo.`;
    shownPhoto = photo;
    describeCanvas();
  }

  // The position of ln E on the axis of the claims.
  const axisPosition = (lnE) => `${clamp((100 * (lnE - low)) / (high - low), 0, 100)}%`;

  function paintRow({ row, levelBar, weightBar, meanLine, dot, text }, values) {
    const { level, weight, kind, lnE, mean } = values;
    const relativeWeight = weight / maxWeight;
    row.classList.toggle("hdrlab-unused", weight === 0);
    levelBar.fill.style.width = `${(100 * level) / 255}%`;
    levelBar.text.textContent = level;
    weightBar.fill.style.width = `${100 * relativeWeight}%`;
    weightBar.text.textContent = relativeWeight.toFixed(2);
    meanLine.style.left = axisPosition(mean);
    dot.style.left = axisPosition(lnE);
    dot.className = CLAIM_CLASSES[kind];
    const size = MIN_DOT_SIZE + (MAX_DOT_SIZE - MIN_DOT_SIZE) * Math.sqrt(relativeWeight);
    dot.style.setProperty("--size", `${size}px`);
    text.textContent = `${kind} ${threeDigits(Math.exp(lnE))}`.trim();
  }

  let isAloud = false;
  function paint() {
    const [y, x] = at();
    ring.style.left = `${(100 * (x + 0.5)) / width}%`;
    ring.style.top = `${(100 * (y + 0.5)) / height}%`;
    const weights = weigh(y, x);
    const claims = photos.map((photo) => claim(photo, y, x));
    const mean = merge(claims, weights);
    rows.forEach((row, photo) => {
      const level = shownLevel(photo, y, x);
      paintRow(row, { level, weight: weights[photo], mean, ...claims[photo] });
    });
    const used = weights.filter((weight) => weight > 0).length;
    const E = threeDigits(Math.exp(mean));
    meanText.textContent = used ? `weighted mean ${E}` : `only bounds: ${E}`;
    meanText.style.left = axisPosition(mean);
    // Shift the text to the left, so that it stays inside the column.
    meanText.style.transform = `translateX(-${axisPosition(mean)})`;
    describeCanvas();
    const status = used
      ? `Weighted mean of ${used} of ${count} photos: E = ${E}.`
      : `No photo measures this pixel. Its bounds give E = ${E}.`;
    showStatus(status, isAloud);
  }
  const repaint = oncePerFrame(paint);

  function moveTo(y, x, isByKey) {
    isAloud = isByKey;
    saveTrait(model, "at", [clamp(y, 0, height - 1), clamp(x, 0, width - 1)]);
    repaint();
  }

  makeDraggable(frame, canvas, {
    moveTo: ([x, y]) => moveTo(Math.floor(y * height), Math.floor(x * width), false),
    stepBy: (right, down) => moveTo(at()[0] + down, at()[1] + right, true),
  });
  const stopListening = onTraitChange(model, ["at"], repaint);
  showPhoto(shownPhoto);
  paint();
  return stopListening;
}

export default { render };
