// Reinhard's global operator on a zone scale: tonemap/reinhard.py and core/colour.py again, at each pixel.

const MIDDLE_GRAY = 0.18;
const NUMERALS = [[0, "0"], [2, "II"], [5, "V"], [8, "VIII"], [10, "X"]];
const CURVE_POINTS = 120;
const TONES = 40; // steps of the strip of tones
const STEPS_PER_STOP = 6; // a key press moves a sixth of a stop
const KEY_RANGE = [0.0025, 1.44];
const WHITE_RANGE = [1, 64];
const DARK = 1e-30; // below this luminance a pixel has no color, as in core/colour.py
const STRIPE = 8; // pixels from one stripe of the marks to the next
const MARK = 0xff005ed5; // A B G R of the stripes above white

const zoneOf = (Lm) => 5 + Math.log2(Lm / MIDDLE_GRAY);
const scaledOf = (zone) => MIDDLE_GRAY * 2 ** (zone - 5);
const display = (Lm, white) => Math.min((Lm * (1 + Lm / white ** 2)) / (1 + Lm), 1);
const grayCode = (Ld) => Math.floor(255 * encodeSrgb(Ld) + 0.5);

// Two curves in a square of 100 units, stretched over the parent.
const PLOT = `<svg viewBox="0 0 100 100" preserveAspectRatio="none" aria-hidden="true">
  <path class="hdrlab-plain-curve"/><path class="hdrlab-is-Ld"/></svg>`;

async function render({ model, el }) {
  const root = start(el, "zones");
  const [height, width, channels] = model.get("shape");
  const bits = await halves(model.get("radiance"), channels);
  const E = Float32Array.from(bits, (one) => HALF[one] / model.get("scale"));
  const L = luminances(E, channels);
  const ratios = E.map((value, i) => {
    const luminance = L[Math.floor(i / channels)];
    return luminance < DARK ? 1 : value / luminance;
  });
  const [low, high] = model.get("zones");
  const logAverage = model.get("log_average");
  const across = (zone) => (100 * (zone - low)) / (high - low);

  const columns = element(root, "div", { className: "hdrlab-columns" });
  const left = element(columns, "div", { className: "hdrlab-column" });
  const canvas = element(left, "canvas", { role: "img", "aria-label": "", className: "hdrlab-photo", width, height });
  const context = canvas.getContext("2d", { alpha: false });
  const image = context.createImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);

  const right = element(columns, "div", { className: "hdrlab-column hdrlab-chart hdrlab-two-handles" });
  const scale = element(right, "div", { className: "hdrlab-scale" });
  const clip = element(scale, "div", { className: "hdrlab-clip" });
  const bars = histogram(clip, L.map((luminance) => (luminance * MIDDLE_GRAY) / logAverage), [low, high], zoneOf);
  clip.insertAdjacentHTML("beforeend", PLOT);
  const [plain, curve] = clip.querySelectorAll("path");
  let active = null; // the handle that the pointer or the focus is on
  const handles = [["key", "Key", KEY_RANGE], ["white", "White point", WHITE_RANGE]].map(([name, label, range]) => {
    const line = element(scale, "div", { className: `hdrlab-handle hdrlab-handle-${name}`, role: "slider", tabIndex: 0 });
    line.setAttribute("aria-label", label);
    line.setAttribute("aria-valuemin", range[0]);
    line.setAttribute("aria-valuemax", range[1]);
    const handle = { name, range, line, text: element(line, "b") };
    line.addEventListener("focus", () => (active = handle));
    return handle;
  });
  const tones = element(right, "div", { className: "hdrlab-tones", "aria-hidden": "true" });
  ruler(right, [low, high], NUMERALS);
  element(right, "p", {
    className: "hdrlab-axis",
    textContent: "One zone is one stop. The strip shows the tones of the picture; the dashed curve has no white point.",
  });
  const say = teller(root);
  plain.setAttribute("d", path(Infinity));

  // Write the picture, with stripes above the white point, and return how many pixels lie there.
  function tonemap(key, white) {
    let above = 0;
    for (let y = 0, i = 0; y < height; y++)
      for (let x = 0; x < width; x++, i++) {
        const Lm = (key / logAverage) * L[i];
        if (Lm >= white) above++;
        if (Lm >= white && (x + y) % STRIPE < STRIPE / 4) {
          pixels[i] = MARK;
          continue;
        }
        const light = 65535 * display(Lm, white);
        const from = i * channels;
        const red = code(light * ratios[from]);
        const green = channels === 1 ? red : code(light * ratios[from + 1]);
        const blue = channels === 1 ? red : code(light * ratios[from + 2]);
        pixels[i] = 0xff000000 | (blue << 16) | (green << 8) | red;
      }
    return above / L.length;
  }

  function path(white) {
    const points = Array.from({ length: CURVE_POINTS + 1 }, (_, k) => {
      const zone = low + ((high - low) * k) / CURVE_POINTS;
      return `${across(zone).toFixed(2)},${(100 * (1 - encodeSrgb(display(scaledOf(zone), white)))).toFixed(2)}`;
    });
    return `M${points.join("L")}`;
  }

  function paint() {
    const [key, white] = [model.get("key"), model.get("white")];
    const above = tonemap(key, white);
    context.putImageData(image, 0, 0);
    bars.style.transform = `translateX(${across(low + Math.log2(key / MIDDLE_GRAY))}%)`;
    const whiteInBars = across(zoneOf(white)) - across(low + Math.log2(key / MIDDLE_GRAY));
    bars.style.background = `linear-gradient(90deg, var(--held) ${whiteInBars}%, var(--full) 0)`;
    curve.setAttribute("d", path(white));
    const grays = Array.from({ length: TONES + 1 }, (_, k) => {
      const gray = grayCode(display(scaledOf(low + ((high - low) * k) / TONES), white));
      return `rgb(${gray} ${gray} ${gray})`;
    });
    tones.style.background = `linear-gradient(90deg, ${grays.join(", ")})`;
    for (const { name, line, text } of handles) {
      const value = model.get(name);
      line.style.left = `${across(zoneOf(value))}%`;
      text.textContent = `${name} ${Number(value.toPrecision(2))}`;
      line.setAttribute("aria-valuenow", value);
      line.setAttribute("aria-valuetext", `${Number(value.toPrecision(2))}, zone ${zoneOf(value).toFixed(1)}`);
    }
    const share = percent(above);
    canvas.setAttribute("aria-label", `${model.get("alt")}, ${handles.map(({ text }) => text.textContent).join(", ")}`);
    say(`The log average of the scene lies in zone ${zoneOf(key).toFixed(1)}, and ${share} of the pixels are above white.`);
  }
  const repaint = eachFrame(paint);

  // Values are a sixth of a stop apart, counted from middle gray and from 1.
  function move(handle, value) {
    const origin = handle.name === "key" ? MIDDLE_GRAY : 1;
    const rounded = origin * 2 ** (Math.round(Math.log2(value / origin) * STEPS_PER_STOP) / STEPS_PER_STOP);
    model.set(handle.name, clamp(rounded, ...handle.range));
    model.save_changes();
    repaint();
  }

  const zoneAt = (share) => low + share * (high - low);
  let grip = 0; // zones from the pointer to the handle
  draggable(scale, clip, {
    grab: ([share]) => {
      const away = ({ name }) => Math.abs(zoneOf(model.get(name)) - zoneAt(share));
      active = away(handles[0]) < away(handles[1]) ? handles[0] : handles[1];
      active.line.focus({ preventScroll: true });
      grip = away(active) < 0.7 ? zoneOf(model.get(active.name)) - zoneAt(share) : 0;
    },
    moveTo: ([share]) => move(active, scaledOf(zoneAt(share) + grip)),
    stepBy: (right, down) => move(active, model.get(active.name) * 2 ** ((right - down) / STEPS_PER_STOP)),
    farStep: STEPS_PER_STOP,
  });
  for (const { name } of handles) model.on(`change:${name}`, repaint);
  paint();
  return () => handles.forEach(({ name }) => model.off(`change:${name}`, repaint));
}

export default { render };
