// The question "mark a place in an image" (predict.js). Python sends
//   pictures  WebP: the image, and a mask that is white at the true pixels
//   alts      the alternative text of the image
// and the answer is a pixel [x, y].

const PLACE_CANVAS_WIDTH = 960; // pixels at least, so that the cross is sharp
const PLACE_FAR_STEP = 20; // pixels of an arrow key with Shift
const PLACE_STEPS = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};
const MIN_TRUTH_SIDE = 3; // pixels of the canvas, so that a single true pixel can be seen

// Return the pixels [x, y] where the mask is white.
function truePixels(mask) {
  const { width, height } = mask;
  const context = new OffscreenCanvas(width, height).getContext("2d");
  context.drawImage(mask, 0, 0);
  const { data } = context.getImageData(0, 0, width, height);
  const pixels = [];
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      if (data[4 * (y * width + x)] > 127) pixels.push([x, y]);
    }
  }
  return pixels;
}

async function createPlaceQuestion(root, model) {
  const images = model.get("pictures").map((bytes) => decodeImage(bytes, "image/webp"));
  const [photo, mask] = await Promise.all(images);
  const { width, height } = photo;
  const { frame, canvas, context } = addStage(root, "arrow keys move the cross, Shift further");
  const enlargement = Math.max(1, Math.ceil(PLACE_CANVAS_WIDTH / width));
  canvas.width = width * enlargement;
  canvas.height = height * enlargement;
  const showStatus = addStatusLine(root);
  const truth = truePixels(mask);
  let cross = null; // the answer
  let isRevealed = false;

  function paintTruth() {
    const minSide = (MIN_TRUTH_SIDE * canvas.width) / PLACE_CANVAS_WIDTH;
    const side = Math.max(enlargement, minSide);
    context.fillStyle = TRUTH_COLOR;
    for (const [x, y] of truth) context.fillRect(x * enlargement, y * enlargement, side, side);
  }

  function paintCross() {
    const [x, y] = cross.map((pixel) => (pixel + 0.5) * enlargement);
    const half = canvas.width / 40;
    const strokes = [
      ["#fff", 9],
      [ANSWER_COLOR, 5],
    ];
    for (const [color, lineWidth] of strokes) {
      context.strokeStyle = color;
      context.lineWidth = (lineWidth * canvas.width) / PLACE_CANVAS_WIDTH;
      context.strokeRect(x - half, y - half, 2 * half, 2 * half);
    }
  }

  function paint() {
    // The true pixels are easier to see on a gray image.
    context.filter = isRevealed ? "grayscale(1) brightness(0.85)" : "none";
    context.drawImage(photo, 0, 0, canvas.width, canvas.height);
    context.filter = "none";
    if (isRevealed) paintTruth();
    if (cross) paintCross();
    const crossText = cross ? `, your mark at x ${cross[0]}, y ${cross[1]}` : "";
    const truthText = isRevealed ? ", the true pixels orange" : "";
    canvas.setAttribute("aria-label", `${model.get("alts")[0]}${crossText}${truthText}`);
  }

  function moveCross(x, y, isByKey) {
    if (isRevealed) return;
    cross = [clamp(Math.floor(x), 0, width - 1), clamp(Math.floor(y), 0, height - 1)];
    paint();
    showStatus(`x ${cross[0]}, y ${cross[1]}`, isByKey);
  }

  frame.addEventListener("pointerdown", (event) => {
    const [x, y] = pointerPosition(event, canvas);
    moveCross(x * width, y * height, false);
  });
  frame.addEventListener("keydown", (event) => {
    const step = PLACE_STEPS[event.key];
    if (!step) return;
    event.preventDefault();
    const length = event.shiftKey ? PLACE_FAR_STEP : 1;
    const [x, y] = cross ?? [width / 2, height / 2];
    moveCross(x + length * step[0], y + length * step[1], true);
  });
  paint();

  return {
    read: () => cross,
    show(answer) {
      cross = answer;
      paint();
    },
    reveal() {
      isRevealed = true;
      paint();
    },
    compare([x, y]) {
      const distances = truth.map(([trueX, trueY]) => Math.hypot(trueX - x, trueY - y));
      const nearest = distances.reduce((least, distance) => Math.min(least, distance), Infinity);
      const isRight = nearest < 1;
      return {
        isNear: nearest <= (NEAR_FRACTION * width) / 2,
        words: isRight ? "Yes" : `You were ${threeDigits(nearest)} pixels away`,
      };
    },
  };
}
