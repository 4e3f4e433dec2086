// Shared by wipe.js and blink.js: images of one size that zoom and move together, and a line of
// text with the values of one pixel.
//
// Python sends
//   pictures  WebP without loss, all of one size
//   labels    the name of each image
//   alt       what all images show
//   values    half floats that belong to the pixels: for each image, for all together, or none
//   scales    the factor that Python multiplied each of `values` with
//   channels  1 or 3, for each of `values`
//   unit      what the values are, such as "radiance"

const MAX_ZOOM = 32;
const MIN_CANVAS_WIDTH = 960; // pixels: a smaller image is enlarged
const PAN_STEPS = 64; // steps of the arrow keys across the visible part of a large image
const FAR_STEP = 8; // steps of an arrow key with Shift
const PAN_MARGIN = 0.25; // fraction of the canvas between its edge and a cross that left it
const WHEEL_NOTCH = 100; // deltaY that doubles the zoom
const KEY_HELP = "arrow keys move the cross, Shift further; plus and minus zoom, 0 shows all";
const MOVES = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};
const ZOOM_FACTORS = { "+": 2, "=": 2, "-": 0.5, _: 0.5, 0: 0 }; // 0 becomes the smallest zoom, 1

// Return a function that gives the pixel values of an image as text.
function pixelValueReader(bitmap) {
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(bitmap, 0, 0);
  const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
  return (pixel) => {
    const [red, green, blue] = data.subarray(4 * pixel);
    return red === green && green === blue ? `${red}` : `${red} ${green} ${blue}`;
  };
}

// Return a function that gives `values` at a pixel as text, with the three digits that a half float
// has.
async function valueReader(model, index) {
  const scale = model.get("scales")[index];
  const channels = model.get("channels")[index];
  const bits = await decodeHalves(model.get("values")[index], channels);
  return (pixel) => {
    const bitsOfPixel = bits.subarray(channels * pixel, channels * (pixel + 1));
    return Array.from(bitsOfPixel, (half) => threeDigits(HALF_VALUES[half] / scale)).join(" ");
  };
}

// Return a function that describes a pixel: its position, and its values in each image.
async function pixelDescriber(model, bitmaps) {
  const labels = model.get("labels");
  const unit = model.get("unit");
  const pixelValues = bitmaps.map(pixelValueReader);
  const values = await Promise.all(
    model.get("values").map((_, index) => valueReader(model, index)),
  );
  return ([x, y]) => {
    const pixel = y * bitmaps[0].width + x;
    const parts = labels.map((label, index) => {
      const text = `${label} ${pixelValues[index](pixel)}`;
      return values.length > 1 ? `${text}, ${unit} ${values[index](pixel)}` : text;
    });
    if (values.length === 1) parts.push(`${unit} ${values[0](pixel)}`);
    return `x ${x}, y ${y}: ${parts.join("; ")}`;
  };
}

// Append the images, the line of text and a slider for the zoom.
//
//   compose(context, drawImage)  draws with drawImage(index), and returns a description
//   startDrag(position, zoom, pageWidth)  returns a function of the position that follows a drag,
//       or null if the drag is to move the image
//   handleKey(event)  returns whether it used the key
async function createViewer(root, model, options) {
  const { help, hint, compose, startDrag = () => null, handleKey = () => false } = options;
  const { frame, canvas, context } = addStage(root, `${help}; ${KEY_HELP}`);
  const showStatus = addStatusLine(root);
  const bitmaps = await Promise.all(
    model.get("pictures").map((bytes) => decodeImage(bytes, "image/webp")),
  );
  const describe = await pixelDescriber(model, bitmaps);
  const { width, height } = bitmaps[0];
  const enlargement = Math.max(1, Math.floor(MIN_CANVAS_WIDTH / width));
  canvas.width = width * enlargement;
  canvas.height = height * enlargement;
  setDisplayWidth(canvas, Math.max(width, MIN_CANVAS_WIDTH));
  const controls = addElement(root, "div", { className: "hdrlab-controls" });
  const slider = addSlider(controls, "zoom", 1 + Math.log2(MAX_ZOOM));

  let zoom = 1;
  let left = 0; // the pixel at the left edge of the canvas, and at its top
  let top = 0;
  let cross = null; // the pixel (x, y) that the arrow keys read
  let drag = null; // what a move of the pointer calls
  const pointers = new Map(); // positions of the pointers that are down

  const pixelAt = ([x, y]) => [
    clamp(Math.floor(x), 0, width - 1),
    clamp(Math.floor(y), 0, height - 1),
  ];
  // From a position on the canvas, as fractions, to coordinates in the image.
  const toImage = ([x, y]) => [left + (x * width) / zoom, top + (y * height) / zoom];
  // From a pixel to the position of its middle on the canvas, as fractions.
  const toCanvas = ([x, y]) => [
    ((x + 0.5 - left) * zoom) / width,
    ((y + 0.5 - top) * zoom) / height,
  ];

  function paintCross() {
    const side = enlargement * zoom; // of a pixel on the canvas
    const x = (cross[0] + 0.5 - left) * side;
    const y = (cross[1] + 0.5 - top) * side;
    const half = Math.max(side / 2, 8 * enlargement) + 2;
    const strokes = [
      ["#000", 5],
      ["#fff", 2],
    ];
    for (const [color, lineWidth] of strokes) {
      context.strokeStyle = color;
      context.lineWidth = lineWidth * Math.max(1, canvas.width / 800);
      context.strokeRect(x - half, y - half, 2 * half, 2 * half);
    }
  }

  function drawImage(index) {
    const { width: canvasWidth, height: canvasHeight } = canvas;
    const visible = [left, top, width / zoom, height / zoom];
    context.drawImage(bitmaps[index], ...visible, 0, 0, canvasWidth, canvasHeight);
  }

  const repaint = oncePerFrame(() => {
    context.imageSmoothingEnabled = false;
    const description = compose(context, drawImage);
    if (cross) paintCross();
    const zoomText = zoom > 1 ? `, zoom ${zoom.toPrecision(2)}` : "";
    canvas.setAttribute("aria-label", `${model.get("alt")}, ${description}${zoomText}`);
  });

  function scrollTo(newLeft, newTop) {
    left = clamp(newLeft, 0, width - width / zoom);
    top = clamp(newTop, 0, height - height / zoom);
    repaint();
  }

  // Zoom so that the part of the image at this position of the canvas stays there.
  function zoomTo(newZoom, position) {
    const [x, y] = toImage(position);
    zoom = clamp(newZoom, 1, MAX_ZOOM);
    scrollTo(x - (position[0] * width) / zoom, y - (position[1] * height) / zoom);
    slider.show(Math.round(Math.log2(zoom)), `${Number(zoom.toPrecision(2))} times`);
  }

  // Where the keys and the slider zoom: at the cross, or else in the middle.
  function zoomCenter() {
    if (!cross) return [0.5, 0.5];
    return toCanvas(cross).map((fraction) => clamp(fraction, 0, 1));
  }

  // How far to scroll, so that a position which left the canvas is on it again.
  function scrollDistance(fraction, size) {
    if (fraction < 0) return (fraction - PAN_MARGIN) * (size / zoom);
    if (fraction > 1) return (fraction - (1 - PAN_MARGIN)) * (size / zoom);
    return 0;
  }

  function moveCross(stepsRight, stepsDown) {
    const step = Math.max(1, Math.round(width / zoom / PAN_STEPS)); // pixels
    cross = cross
      ? pixelAt([cross[0] + stepsRight * step, cross[1] + stepsDown * step])
      : pixelAt(toImage([0.5, 0.5]));
    const [x, y] = toCanvas(cross);
    scrollTo(left + scrollDistance(x, width), top + scrollDistance(y, height));
    showStatus(describe(cross), true);
  }

  frame.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (MOVES[event.key]) {
      const length = event.shiftKey ? FAR_STEP : 1;
      const [right, down] = MOVES[event.key];
      moveCross(length * right, length * down);
    } else if (event.key in ZOOM_FACTORS) {
      zoomTo(zoom * ZOOM_FACTORS[event.key], zoomCenter());
    } else if (!handleKey(event)) {
      return;
    }
    event.preventDefault();
  });

  // Return a drag that keeps the image under the pointer.
  function startPan(start) {
    const [x, y] = toImage(start);
    return (position) =>
      scrollTo(x - (position[0] * width) / zoom, y - (position[1] * height) / zoom);
  }

  // The distance of two fingers, and the middle between them.
  function measureFingers() {
    const [[x0, y0], [x1, y1]] = pointers.values();
    return {
      distance: Math.hypot((x0 - x1) * width, (y0 - y1) * height),
      center: [(x0 + x1) / 2, (y0 + y1) / 2],
    };
  }

  // Return a drag of two fingers, which zooms and moves the image.
  function startPinch() {
    let before = measureFingers();
    return () => {
      const now = measureFingers();
      const [x, y] = toImage(before.center);
      zoomTo((zoom * now.distance) / Math.max(before.distance, 1), now.center);
      scrollTo(x - (now.center[0] * width) / zoom, y - (now.center[1] * height) / zoom);
      before = now;
    };
  }

  frame.addEventListener("pointerdown", (event) => {
    const position = pointerPosition(event, canvas);
    frame.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, position);
    if (pointers.size === 1) {
      const pageWidth = canvas.getBoundingClientRect().width;
      drag = startDrag(position, zoom, pageWidth) ?? startPan(position);
    } else if (pointers.size === 2) {
      drag = startPinch();
    }
    drag(position);
  });

  frame.addEventListener("pointermove", (event) => {
    const position = pointerPosition(event, canvas);
    if (pointers.has(event.pointerId)) {
      pointers.set(event.pointerId, position);
      drag?.(position);
    }
    if (cross) {
      cross = null;
      repaint();
    }
    showStatus(describe(pixelAt(toImage(position))));
  });

  function endDrag(event) {
    pointers.delete(event.pointerId);
    const [remaining] = pointers.values();
    drag = pointers.size === 1 ? startPan(remaining) : null;
  }
  frame.addEventListener("pointerup", endDrag);
  frame.addEventListener("pointercancel", endDrag);

  // The wheel scrolls the page. It zooms only after a click on the image, or with Ctrl, which
  // browsers also report for a pinch on a touchpad.
  function zoomByWheel(event) {
    const newZoom = zoom * 2 ** clamp(-event.deltaY / WHEEL_NOTCH, -1, 1);
    const isForZoom = event.ctrlKey || frame.contains(document.activeElement);
    const isSmallest = newZoom < 1 && zoom === 1;
    if (!isForZoom || isSmallest) return;
    event.preventDefault();
    zoomTo(newZoom, pointerPosition(event, canvas));
  }
  frame.addEventListener("wheel", zoomByWheel, { passive: false });

  slider.input.addEventListener("input", () => zoomTo(2 ** slider.position(), zoomCenter()));
  slider.show(0, "1 times");
  showStatus(hint);
  return { canvas, controls, repaint };
}
