// The question "draw a curve" (predict.js). Python sends
//   truth   the true curve: its x and its y
//   scale   the ends of both axes: left, right, low, high
//   labels  the names of both axes
//   ticks   the numbers on both axes
//   marks   lines that are named: axis, value, name
//   alts    the alternative text
// and the answer is a list of 17 heights, null where nothing was drawn.

const HANDLE_COUNT = 17; // points of the reader's curve: keys move one, a drag all that it passes
const SAMPLE_COUNT = 4 * HANDLE_COUNT; // where the two curves are compared
const KEY_STEPS = 40; // from the lower to the upper end of the scale
const PARTS = ["on the left", "in the middle", "on the right"];
// Fractions of the slope of the steepest part of the true curve.
const MAX_SLOPE_ERROR = 0.35;
const MAX_FLAT_SLOPE = 0.25;
const MIN_STEEP_SLOPE = 0.75;
// Sizes on the canvas, which has two pixels for each pixel of the page, so that lines are sharp.
const CANVAS_DENSITY = 2;
const FIELD_LEFT = 96;
const FIELD_RIGHT = 32;
const FIELD_TOP = 24;
const FIELD_BOTTOM = 56;
const HANDLE_SIZE = 14;
const CURVE_WIDTH = 6;
const GRID_COLOR = "#d8d8d8";
const MARK_COLOR = "#767676";

// The function through some points: straight between them, level beyond the first and the last.
function interpolate(points) {
  return (x) => {
    const next = points.findIndex(([pointX]) => pointX >= x);
    if (next === -1) return points.at(-1)[1];
    if (next === 0) return points[0][1];
    const [x0, y0] = points[next - 1];
    const [x1, y1] = points[next];
    return y0 + ((y1 - y0) * (x - x0)) / (x1 - x0);
  };
}

// Compare the slopes of the drawn and the true curve in each third of the axis.
function compareShapes(drawn, truth, left, right) {
  const edges = [0, 1, 2, 3].map((k) => left + ((right - left) * k) / PARTS.length);
  const risesOf = (curve) => PARTS.map((_, k) => curve(edges[k + 1]) - curve(edges[k]));
  const drawnRises = risesOf(drawn);
  const trueRises = risesOf(truth);
  const steepest = Math.max(...trueRises.map(Math.abs)) || 1;

  function describe(rise) {
    const slope = Math.abs(rise) / steepest;
    const direction = rise > 0 ? "rising" : "falling";
    if (slope < MAX_FLAT_SLOPE) return "nearly flat";
    return slope > MIN_STEEP_SLOPE ? `${direction} steeply` : direction;
  }

  return PARTS.map((part, k) => {
    const isRight = Math.abs(drawnRises[k] - trueRises[k]) <= MAX_SLOPE_ERROR * steepest;
    const trueWords = describe(trueRises[k]);
    let drawnWords = describe(drawnRises[k]);
    if (drawnWords === trueWords) {
      const isSteeper = Math.abs(drawnRises[k]) > Math.abs(trueRises[k]);
      drawnWords = isSteeper ? "steeper" : "flatter";
    }
    const verdict = isRight ? "yes" : `yours is ${drawnWords}`;
    return { isRight, words: `${part} ${trueWords}: ${verdict}` };
  });
}

// Return the functions that paint the axes and the curves on a canvas.
function createCurvePainter(canvas, context, model) {
  const [left, right, low, high] = model.get("scale");
  const [xTicks, yTicks] = model.get("ticks");
  const field = {
    left: FIELD_LEFT,
    top: FIELD_TOP,
    width: canvas.width - FIELD_LEFT - FIELD_RIGHT,
    height: canvas.height - FIELD_TOP - FIELD_BOTTOM,
  };
  const toCanvas = ([x, y]) => [
    field.left + ((x - left) / (right - left)) * field.width,
    field.top + (1 - (y - low) / (high - low)) * field.height,
  ];

  function paintLine(points, { color, lineWidth, dashes = [] }) {
    context.strokeStyle = color;
    context.lineWidth = lineWidth;
    context.setLineDash(dashes);
    context.beginPath();
    for (const point of points) context.lineTo(...toCanvas(point));
    context.stroke();
    context.setLineDash([]);
  }

  function paintTicks() {
    const style = { color: GRID_COLOR, lineWidth: 2 };
    context.font = "26px system-ui, sans-serif";
    context.fillStyle = "#444";
    for (const x of xTicks) {
      const ends = [
        [x, low],
        [x, high],
      ];
      paintLine(ends, style);
      const [canvasX] = toCanvas([x, low]);
      context.textAlign = "center";
      context.fillText(threeDigits(x), canvasX, field.top + field.height + 36);
    }
    for (const y of yTicks) {
      const ends = [
        [left, y],
        [right, y],
      ];
      paintLine(ends, style);
      const [, canvasY] = toCanvas([left, y]);
      context.textAlign = "right";
      context.fillText(threeDigits(y), field.left - 12, canvasY + 9);
    }
  }

  function paintMark({ axis, value, name }) {
    const verticalEnds = [
      [value, low],
      [value, high],
    ];
    const horizontalEnds = [
      [left, value],
      [right, value],
    ];
    const isVertical = axis === "x";
    const style = { color: MARK_COLOR, lineWidth: 3, dashes: [4, 6] };
    paintLine(isVertical ? verticalEnds : horizontalEnds, style);
    const [x, y] = toCanvas(isVertical ? [value, high] : [left, value]);
    context.textAlign = "left";
    context.fillText(name, x + 8, isVertical ? y + 26 : y - 8);
  }

  return {
    paintAxes() {
      context.fillStyle = "#fff";
      context.fillRect(0, 0, canvas.width, canvas.height);
      paintTicks();
      model.get("marks").forEach(paintMark);
      context.strokeStyle = MARK_COLOR;
      context.lineWidth = 2;
      context.strokeRect(field.left, field.top, field.width, field.height);
    },
    paintAnswer(points) {
      paintLine(points, { color: ANSWER_COLOR, lineWidth: CURVE_WIDTH, dashes: [18, 12] });
      context.fillStyle = ANSWER_COLOR;
      for (const [x, y] of points.map(toCanvas)) {
        const half = HANDLE_SIZE / 2;
        context.fillRect(x - half, y - half, HANDLE_SIZE, HANDLE_SIZE);
      }
    },
    paintTruth(points) {
      paintLine(points, { color: TRUTH_COLOR, lineWidth: CURVE_WIDTH });
    },
    // The position of a pointer in the field, as fractions from the left and from the top.
    fieldPosition(event) {
      const [x, y] = pointerPosition(event, canvas);
      return [
        (x * canvas.width - field.left) / field.width,
        (y * canvas.height - field.top) / field.height,
      ];
    },
  };
}

function createCurveQuestion(root, model) {
  const [left, right, low, high] = model.get("scale");
  const [xName, yName] = model.get("labels");
  const [xs, ys] = model.get("truth");
  const truth = xs.map((x, k) => [x, ys[k]]);

  addElement(root, "div", { className: "hdrlab-axis", textContent: `↑ ${yName}` });
  const help =
    `${yName} over ${xName}: arrow keys left and right choose a point of your curve, ` +
    "up and down move it";
  const { frame, canvas, context } = addStage(root, help);
  const pageWidth = clamp(innerWidth - 48, 280, 640);
  const aspect = pageWidth < SMALL_IMAGE ? 0.8 : 0.6;
  canvas.width = CANVAS_DENSITY * pageWidth;
  canvas.height = Math.round(CANVAS_DENSITY * pageWidth * aspect);
  setDisplayWidth(canvas, pageWidth);
  canvas.toggleAttribute("data-ink", true);
  addElement(root, "div", { className: "hdrlab-axis", textContent: `→ ${xName}` });
  const showStatus = addStatusLine(root);
  const painter = createCurvePainter(canvas, context, model);

  const heights = new Array(HANDLE_COUNT).fill(null); // the answer; null: not drawn yet
  let current = 0; // the handle that the keys move
  let isRevealed = false;
  let lastDragged = null; // the handle that the drag passed last; null: no drag

  const xOf = (handle) => left + ((right - left) * handle) / (HANDLE_COUNT - 1);
  const drawnPoints = (answer) =>
    answer.map((y, handle) => [xOf(handle), y]).filter(([, y]) => y !== null);

  function paint() {
    const points = drawnPoints(heights);
    painter.paintAxes();
    painter.paintAnswer(points);
    if (isRevealed) painter.paintTruth(truth);
    const answerText = points.length ? "with your curve, dashed" : "empty";
    const truthText = isRevealed ? ", and the true one" : "";
    canvas.setAttribute("aria-label", `${model.get("alts")[0]}, ${answerText}${truthText}`);
  }

  // Set the handle at the pointer, and all handles since the last move.
  function drawTo(event) {
    if (isRevealed) return;
    const [x, y] = painter.fieldPosition(event);
    const height = clamp(low + (high - low) * (1 - y), low, high);
    const handle = clamp(Math.round(x * (HANDLE_COUNT - 1)), 0, HANDLE_COUNT - 1);
    const first = Math.min(lastDragged ?? handle, handle);
    const last = Math.max(lastDragged ?? handle, handle);
    heights.fill(height, first, last + 1);
    lastDragged = handle;
    current = handle;
    paint();
  }

  function endDrag() {
    lastDragged = null;
  }

  frame.addEventListener("pointerdown", (event) => {
    frame.setPointerCapture(event.pointerId);
    drawTo(event);
  });
  frame.addEventListener("pointermove", (event) => {
    if (lastDragged !== null) drawTo(event);
  });
  frame.addEventListener("pointerup", endDrag);
  frame.addEventListener("pointercancel", endDrag);
  frame.addEventListener("keydown", (event) => {
    const stepRight = { ArrowLeft: -1, ArrowRight: 1 }[event.key] ?? 0;
    const stepUp = { ArrowUp: 1, ArrowDown: -1 }[event.key] ?? 0;
    if (isRevealed || (stepRight === 0 && stepUp === 0)) return;
    event.preventDefault();
    const before = heights[current];
    current = clamp(current + stepRight, 0, HANDLE_COUNT - 1);
    // A new handle begins at the height of the one before it.
    const height = heights[current] ?? before ?? (low + high) / 2;
    heights[current] = clamp(height + (stepUp * (high - low)) / KEY_STEPS, low, high);
    paint();
    const text = `${xName} ${threeDigits(xOf(current))}: ${yName} ${threeDigits(heights[current])}`;
    showStatus(text, true);
  });
  paint();

  // Compare the heights of both curves.
  function comparePositions(drawnCurve, trueCurve) {
    const places = Array.from(
      { length: SAMPLE_COUNT },
      (_, k) => left + ((right - left) * k) / (SAMPLE_COUNT - 1),
    );
    const errors = places.map((x) => drawnCurve(x) - trueCurve(x));
    const mean = sumOf(errors) / errors.length;
    const isNear = Math.abs(mean) <= NEAR_FRACTION * (high - low);
    const sizes = errors.map(Math.abs);
    const worst = sizes.indexOf(Math.max(...sizes));
    const describe = (error) => `${threeDigits(Math.abs(error))} too ${error > 0 ? "high" : "low"}`;
    const words =
      `${isNear ? "near" : "off"}, on average ${describe(mean)}, ` +
      `most at ${threeDigits(places[worst])}: ${describe(errors[worst])}`;
    return { isNear, words };
  }

  return {
    read: () => (drawnPoints(heights).length > 1 ? [...heights] : null),
    show(answer) {
      answer.forEach((y, handle) => {
        heights[handle] = y;
      });
      paint();
    },
    reveal() {
      isRevealed = true;
      paint();
    },
    compare(answer) {
      const drawnCurve = interpolate(drawnPoints(answer));
      const trueCurve = interpolate(truth);
      const parts = compareShapes(drawnCurve, trueCurve, left, right);
      const rightCount = parts.filter(({ isRight }) => isRight).length;
      const shape = parts.map(({ words }) => words).join("; ");
      const position = comparePositions(drawnCurve, trueCurve);
      return {
        isNear: position.isNear && rightCount === parts.length,
        words:
          `Shape, ${rightCount} of ${parts.length} parts: ${shape}. ` +
          `Position (${yName}): ${position.words}`,
      };
    },
  };
}
