// A base image and its gain map on the screen whose peak is dragged: core/gainmap.py again, at each pixel.

const STEPS_PER_STOP = 6; // a key press moves a sixth of a stop
const SHARES = [0.2126, 0.7152, 0.0722]; // of the channels in luminance, as in core/colour.py
const LINEAR = Float32Array.from({ length: 256 }, (_, value) => decodeSrgb(value / 255));

async function render({ model, el }) {
  const root = start(el, "gains");
  const [height, width] = model.get("shape");
  const [base, gains] = await Promise.all(["base", "gains"].map((name) => inflate(model.get(name), width)));
  const count = height * width;
  const [low, high] = [model.get("low"), model.get("high")];
  const [baseOffset, lightOffset] = model.get("offsets");
  const headroom = model.get("headroom");
  const span = model.get("span");
  const screen = () => model.get("screen");
  const across = (stop) => (100 * (stop - span[0])) / (span[1] - span[0]);

  const columns = element(root, "div", { className: "hdrlab-columns" });
  const left = element(columns, "div", { className: "hdrlab-column" });
  const canvas = (parent) =>
    element(parent, "canvas", { role: "img", "aria-label": "", className: "hdrlab-photo", width, height });
  const shown = canvas(left);
  const right = element(columns, "div", { className: "hdrlab-column hdrlab-chart" });
  const scale = element(right, "div", { className: "hdrlab-scale" });
  const clip = element(scale, "div", { className: "hdrlab-clip" });
  const result = new Float32Array(count);
  const baseLight = result.map((_, i) => SHARES.reduce((sum, share, c) => sum + share * LINEAR[base[c * count + i]], 0));
  histogram(clip, baseLight, span);
  const bars = histogram(clip, result, span);
  bars.classList.add("hdrlab-over");
  const white = element(scale, "i", { className: "hdrlab-white-line" });
  white.style.left = `${across(0)}%`;
  const handle = element(scale, "div", { className: "hdrlab-handle hdrlab-is-Ld", role: "slider", tabIndex: 0 });
  handle.setAttribute("aria-label", "Peak of the screen, times its white");
  handle.setAttribute("aria-valuemin", 1);
  handle.setAttribute("aria-valuemax", 2 ** span[1]);
  const peak = element(handle, "b");
  const labelOf = (stop) => (stop < 0 ? `1/${2 ** -stop}` : stop === 0 ? "white" : `${2 ** stop}×`);
  const stops = everyFew([span[0], 0], 4).concat(everyFew([1, span[1] - 1], 1));
  ruler(right, span, stops.map((stop) => [stop, labelOf(stop)]));
  const axis = "luminance on the screen; gray: base image, colored: this screen";
  element(right, "p", { className: "hdrlab-axis", textContent: axis });
  const parts = element(right, "div", { className: "hdrlab-thumbnails" });
  const [basePart, gainPart] = ["base image", "gain map, as applied"].map((name) => {
    const figure = element(parts, "div");
    const part = canvas(figure);
    part.setAttribute("aria-label", `${model.get("alt")}: ${name}`);
    element(figure, "span", { textContent: name });
    return part;
  });
  const say = teller(root);

  // Paint the codes of an image (3, H, W).
  function paintCodes(canvas, codes) {
    const context = canvas.getContext("2d", { alpha: false });
    const image = context.createImageData(width, height);
    for (let i = 0, to = 0; i < count; i++) {
      for (let c = 0; c < 3; c++) image.data[to++] = codes[c * count + i];
      image.data[to++] = 255;
    }
    context.putImageData(image, 0, 0);
  }
  const codes = new Uint8Array(base.length);
  paintCodes(basePart, base);
  paintCodes(gainPart, gains);

  const weight = () => clamp(Math.log2(screen()) / Math.log2(headroom), 0, 1);

  function paint() {
    const W = weight();
    const factors = low.map((lowest, c) =>
      Float32Array.from({ length: 256 }, (_, k) => 2 ** (W * (lowest + ((high[c] - lowest) * k) / 255))));
    result.fill(0);
    for (let c = 0; c < 3; c++) {
      const factor = factors[c];
      for (let i = 0, at = c * count; i < count; i++, at++) {
        const light = (LINEAR[base[at]] + baseOffset) * factor[gains[at]] - lightOffset;
        result[i] += SHARES[c] * light;
        codes[at] = code(light > 0 ? (65535 * light) / headroom : 0);
      }
    }
    paintCodes(shown, codes);
    gainPart.style.filter = `brightness(${W})`;
    bars.style.clipPath = barShape(result, span);
    handle.style.left = `${across(Math.log2(screen()))}%`;
    const times = Number(screen().toPrecision(2));
    peak.textContent = `peak ${times}×`;
    handle.setAttribute("aria-valuenow", screen());
    handle.setAttribute("aria-valuetext", `${times} times white, ${percent(W)} of the gain`);
    shown.setAttribute("aria-label", `${model.get("alt")}, on a screen that shows ${times} times its white`);
    say(`A screen that can show ${times} times its white applies ${percent(W)} of the gain.`);
  }
  const repaint = eachFrame(paint);

  function move(value) {
    const rounded = 2 ** (Math.round(Math.log2(value) * STEPS_PER_STOP) / STEPS_PER_STOP);
    model.set("screen", clamp(rounded, 1, 2 ** span[1]));
    model.save_changes();
    repaint();
  }

  draggable(scale, clip, {
    grab: () => handle.focus({ preventScroll: true }),
    moveTo: ([share]) => move(2 ** (span[0] + share * (span[1] - span[0]))),
    stepBy: (right, down) => move(screen() * 2 ** ((right - down) / STEPS_PER_STOP)),
    farStep: STEPS_PER_STOP,
  });
  model.on("change:screen", repaint);
  paint();
  return () => model.off("change:screen", repaint);
}

export default { render };
