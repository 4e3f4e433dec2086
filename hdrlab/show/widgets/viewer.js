// Shared by the comparisons: pictures of one size under one zoom, and the pixel that is read out.

const MOST_ZOOM = 32;
const TALL = 80; // percent of the screen's height at most, so that an upright one is seen as a whole
const WIDE = 960; // pixels of the page where it has them: a small picture fills the column
const KEYS = "arrow keys move the cross, Shift further; plus and minus zoom, 0 shows all";

// What stands in one picture's pixels: its levels, copied out once.
function levelsOf(bitmap) {
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(bitmap, 0, 0);
  const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
  return (pixel) => {
    const [r, g, b] = data.subarray(4 * pixel);
    return r === g && g === b ? `${r}` : `${r} ${g} ${b}`;
  };
}

// What the pixels stand for: three digits are what half floats hold for certain.
async function valuesOf(model, k) {
  const [scale, channels] = [model.get("scales")[k], model.get("channels")[k]];
  const bits = await halves(model.get("values")[k], channels);
  return (pixel) => {
    const each = Array.from(bits.subarray(channels * pixel, channels * (pixel + 1)), (one) => HALF[one] / scale);
    return each.map((value) => `${Number(value.toPrecision(3))}`).join(" ");
  };
}

// compose(context, show) draws with show(k); take(share) may claim a drag that starts there; key(event) a key.
async function viewer(root, model, { help, hint, compose, take = () => null, key = () => false }) {
  const surface = stage(root, `${help}; ${KEYS}`);
  const { frame, canvas, context } = surface;
  const tell = teller(root);
  const bitmaps = await Promise.all(model.get("pictures").map((bytes) => decode(bytes, "image/webp")));
  const [labels, unit] = [model.get("labels"), model.get("unit")];
  const levels = bitmaps.map(levelsOf);
  const values = await Promise.all(model.get("values").map((_, k) => valuesOf(model, k)));
  const { width, height } = bitmaps[0];
  const enlarged = Math.max(1, Math.floor(WIDE / width));
  [canvas.width, canvas.height] = [width * enlarged, height * enlarged];
  if (width < WIDE) canvas.style.width = `min(${WIDE}px, ${(TALL * width) / height}vh)`;
  let [zoom, left, top, cross, drag] = [1, 0, 0, null, null];
  const pointers = new Map();

  const controls = element(root, "div", { className: "hdrlab-controls" });
  const bar = slider(controls, "zoom", 1 + Math.log2(MOST_ZOOM));

  function describe([x, y]) {
    const pixel = y * width + x;
    const own = (k) => (values.length > 1 ? `, ${unit} ${values[k](pixel)}` : "");
    const each = labels.map((label, k) => `${label} ${levels[k](pixel)}${own(k)}`);
    if (values.length === 1) each.push(`${unit} ${values[0](pixel)}`);
    return `x ${x}, y ${y}: ${each.join("; ")}`;
  }

  const inside = ([x, y]) => [clamp(Math.floor(x), 0, width - 1), clamp(Math.floor(y), 0, height - 1)];
  const at = ([across, down]) => [left + (across * width) / zoom, top + (down * height) / zoom];

  function paintCross() {
    const side = enlarged * zoom;
    const [x, y] = [(cross[0] + 0.5 - left) * side, (cross[1] + 0.5 - top) * side];
    const half = Math.max(side / 2, 8 * enlarged) + 2;
    for (const [colour, thick] of [["#000", 5], ["#fff", 2]]) {
      context.strokeStyle = colour;
      context.lineWidth = thick * Math.max(1, canvas.width / 800);
      context.strokeRect(x - half, y - half, 2 * half, 2 * half);
    }
  }

  const repaint = eachFrame(() => {
    context.imageSmoothingEnabled = false;
    const show = (k) =>
      context.drawImage(bitmaps[k], left, top, width / zoom, height / zoom, 0, 0, canvas.width, canvas.height);
    const said = compose(context, show);
    if (cross) paintCross();
    canvas.setAttribute("aria-label", `${model.get("alt")}, ${said}${zoom > 1 ? `, zoom ${zoom.toPrecision(2)}` : ""}`);
  });

  function look(newLeft, newTop) {
    left = clamp(newLeft, 0, width - width / zoom);
    top = clamp(newTop, 0, height - height / zoom);
    repaint();
  }

  // What is at these shares of the canvas stays there.
  function zoomTo(wanted, [across, down]) {
    const [x, y] = at([across, down]);
    zoom = clamp(wanted, 1, MOST_ZOOM);
    look(x - (across * width) / zoom, y - (down * height) / zoom);
    bar.show(Math.round(Math.log2(zoom)), `${Number(zoom.toPrecision(2))} times`);
  }

  const shares = ([x, y]) => [((x + 0.5 - left) * zoom) / width, ((y + 0.5 - top) * zoom) / height];
  const middle = () => (cross ? shares(cross).map((share) => clamp(share, 0, 1)) : [0.5, 0.5]);

  function step(dx, dy) {
    const one = Math.max(1, Math.round(width / zoom / 64));
    cross = cross ? inside([cross[0] + dx * one, cross[1] + dy * one]) : inside(at([0.5, 0.5]));
    const [across, down] = shares(cross);
    const pan = (share, size) => (share < 0 ? share - 0.25 : share > 1 ? share - 0.75 : 0) * (size / zoom);
    look(left + pan(across, width), top + pan(down, height));
    tell(describe(cross), true);
  }

  const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const zooms = { "+": 2, "=": 2, "-": 0.5, _: 0.5, 0: 0 };
  frame.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (moves[event.key]) step(...moves[event.key].map((by) => by * (event.shiftKey ? 8 : 1)));
    else if (event.key in zooms) zoomTo(zoom * zooms[event.key], middle());
    else if (!key(event)) return;
    event.preventDefault();
  });

  function spread() {
    const [[ax, ay], [bx, by]] = pointers.values();
    return { apart: Math.hypot((ax - bx) * width, (ay - by) * height), centre: [(ax + bx) / 2, (ay + by) / 2] };
  }

  frame.addEventListener("pointerdown", (event) => {
    const share = place(event, canvas);
    frame.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, share);
    if (pointers.size === 1) drag = take(share, zoom, canvas.getBoundingClientRect().width) ?? pan(share);
    else if (pointers.size === 2) drag = pinch();
    drag(share);
  });

  function pan(from) {
    const [x, y] = [left + (from[0] * width) / zoom, top + (from[1] * height) / zoom];
    return ([across, down]) => look(x - (across * width) / zoom, y - (down * height) / zoom);
  }

  function pinch() {
    let before = spread();
    return () => {
      const now = spread();
      const [x, y] = at(before.centre);
      zoomTo((zoom * now.apart) / Math.max(before.apart, 1), now.centre);
      look(x - (now.centre[0] * width) / zoom, y - (now.centre[1] * height) / zoom);
      before = now;
    };
  }

  frame.addEventListener("pointermove", (event) => {
    const share = place(event, canvas);
    if (pointers.has(event.pointerId)) {
      pointers.set(event.pointerId, share);
      drag?.(share);
    }
    if (cross) {
      cross = null;
      repaint();
    }
    tell(describe(inside(at(share))));
  });

  for (const end of ["pointerup", "pointercancel"])
    frame.addEventListener(end, (event) => {
      pointers.delete(event.pointerId);
      drag = pointers.size === 1 ? pan([...pointers.values()][0]) : null;
    });

  // A page is scrolled by the wheel: a picture takes it only after a click on it, or with Ctrl, as a pinch does.
  frame.addEventListener("wheel", (event) => {
    const wanted = zoom * 2 ** clamp(-event.deltaY / 100, -1, 1);
    if (!(event.ctrlKey || frame.contains(document.activeElement)) || (wanted < 1 && zoom === 1)) return;
    event.preventDefault();
    zoomTo(wanted, place(event, canvas));
  }, { passive: false });

  bar.input.addEventListener("input", () => zoomTo(2 ** Number(bar.input.value), middle()));
  bar.show(0, "1 times");
  tell(hint);
  return { canvas, controls, repaint };
}
