// The Detail Brush: tonemap/brush.py and core/colour.py again, for the window under the brush, in each frame.

const CUT = 1e-4; // of the lit pixels: span() leaves them out
const LEAST = 2; // ratio of luminances that the bins span at least
const TINY = 2 ** -126; // the least normal float32
const DARK = 1e-30;
const FINE = 65535; // steps of ln L over the whole map, to find a rank without sorting
const [NEAR, FAR] = [16, 64]; // pixels that an arrow key moves the brush, alone and with Shift
const LIMITS = [1, 2, 4, 8, 16];


// What does not change while the brush moves: ln L, its step from dark to bright, and E / L of each channel.
function prepare(bits, scale, channels) {
  const count = bits.length / channels;
  const [L, lnL, steps] = [new Float32Array(count), new Float32Array(count), new Uint16Array(count)];
  const ratios = new Float32Array(bits.length).fill(1);
  let [low, high] = [Infinity, -Infinity];
  for (let i = 0; i < count; i++) {
    const E = (c) => HALF[bits[channels * i + c]] / scale;
    L[i] = channels === 1 ? E(0) : 0.2126 * E(0) + 0.7152 * E(1) + 0.0722 * E(2);
    lnL[i] = Math.log(Math.max(L[i], TINY));
    if (L[i] > 0) [low, high] = [Math.min(low, lnL[i]), Math.max(high, lnL[i])];
    if (channels === 3 && L[i] >= DARK) for (let c = 0; c < 3; c++) ratios[3 * i + c] = E(c) / L[i];
  }
  const perStep = FINE / Math.max(high - low, 1e-9);
  for (let i = 0; i < count; i++) steps[i] = L[i] > 0 ? (lnL[i] - low) * perStep : 0;
  return { L, lnL, steps, ratios, channels };
}

function forEachRow({ x, y, across, down }, width, run) {
  for (let row = y; row < y + down; row++) run(row * width + x, row * width + x + across);
}

// core.extremes: the value of a rank among the lit pixels, from the bottom or from the top.
function ranked(map, area, width, fromTop, lit, counts) {
  const leftOut = Math.min(Math.max(1, Math.floor(CUT * lit)), Math.floor((lit - 1) / 2));
  let [rank, step] = [fromTop ? lit - 1 - leftOut : leftOut, 0];
  while (rank >= counts[step]) rank -= counts[step++];
  const values = [];
  forEachRow(area, width, (from, to) => {
    for (let i = from; i < to; i++) if (map.steps[i] === step && map.L[i] > 0) values.push(map.L[i]);
  });
  return values.sort((a, b) => a - b)[rank];
}

const counts = new Uint32Array(FINE + 1);

function span(map, area, width) {
  let lit = 0;
  counts.fill(0);
  forEachRow(area, width, (from, to) => {
    for (let i = from; i < to; i++)
      if (map.L[i] > 0) {
        counts[map.steps[i]]++;
        lit++;
      }
  });
  const [low, high] = lit ? [false, true].map((top) => ranked(map, area, width, top, lit, counts)) : [1, 1];
  const widen = Math.max(1, (LEAST * low) / high) ** 0.5;
  return [low / widen, high * widen];
}

// histogram(): a pixel counts in the two bins whose centres it lies between.
function histogram(map, area, width, lnLow, perBin, bins) {
  const f = new Float64Array(bins + 1);
  forEachRow(area, width, (from, to) => {
    for (let i = from; i < to; i++) {
      const t = clamp((map.lnL[i] - lnLow) * perBin - 0.5, 0, bins - 1);
      const left = t | 0;
      f[left] += 1 - (t - left);
      f[left + 1] += t - left;
    }
  });
  return f.subarray(0, bins).map((count) => count / (area.across * area.down));
}

// clipped(): no bin above the limit, and what was cut off given to all as they have room.
function clipped(f, limit) {
  const top = Math.min(limit / f.length, 1);
  let [sum, room] = [0, 0];
  for (const share of f) sum += Math.min(share, top);
  for (const share of f) room += top - Math.min(share, top);
  const given = (1 - sum) / Math.max(room, 1e-12);
  return f.map((share) => Math.min(share, top) + (top - Math.min(share, top)) * given);
}

// decode(P) at the edges of the bins.
function curve(f) {
  const Ld = new Float64Array(f.length + 2);
  let P = 0;
  f.forEach((share, k) => (Ld[k + 1] = decodeSrgb(Math.min((P += share), 1))));
  Ld[f.length + 1] = Ld[f.length]; // beyond the last edge the curve is level
  return Ld;
}

// equalise() and recolour() of an area, written into the pixels of an ImageData, 32 bits each: A B G R.
function equalise(map, area, width, { bins, limit }, pixels) {
  const [low, high] = span(map, area, width);
  const [lnLow, perBin] = [Math.fround(Math.log(low)), Math.fround(bins / Math.log(high / low))];
  const Ld = curve(clipped(histogram(map, area, width, lnLow, perBin, bins), limit)).map((each) => 65535 * each);
  const { lnL, ratios, channels } = map;
  let to = 0;
  forEachRow(area, width, (from, end) => {
    for (let i = from; i < end; i++) {
      const t = clamp((lnL[i] - lnLow) * perBin, 0, bins);
      const left = t | 0;
      const light = Ld[left] + (t - left) * (Ld[left + 1] - Ld[left]);
      if (channels === 1) pixels[to++] = 0xff000000 | (0x10101 * code(light));
      else {
        const [r, g, b] = [code(light * ratios[3 * i]), code(light * ratios[3 * i + 1]), code(light * ratios[3 * i + 2])];
        pixels[to++] = 0xff000000 | (b << 16) | (g << 8) | r;
      }
    }
  });
  return [low, high];
}

async function render({ model, el }) {
  const root = start(el, "brush");
  const keys = `arrow keys move the brush by ${NEAR} pixels, with Shift by ${FAR}; brackets change its size, plus and minus its magnification`;
  const { frame, canvas, context } = stage(root, `Detail Brush: ${keys}`);
  const tell = teller(root);
  const [height, width, channels] = model.get("shape");
  const picture = await decode(model.get("picture"), "image/webp");
  const map = prepare(await halves(model.get("radiance"), channels), model.get("scale"), channels);
  [canvas.width, canvas.height] = [width, height];
  const whole = span(map, { x: 0, y: 0, across: width, down: height }, width);
  const lens = document.createElement("canvas");
  const stops = ([low, high]) => Math.log2(high / low).toFixed(1);
  let [pixels, aloud, pointed] = [null, false, false];

  // The brush lies inside the picture, and the window inside the brush: what is under the pointer stays there.
  function areas() {
    const [y, x] = model.get("centre");
    const [size, magnification] = [model.get("size"), model.get("magnification")];
    const within = (centre, length) => {
      const side = Math.min(size, length);
      const from = clamp(Math.round(centre - side / 2), 0, length - side);
      const few = Math.min(Math.ceil(size / magnification), length);
      return { from, side, few, first: clamp(Math.round(centre - (centre - from) / magnification), 0, length - few) };
    };
    const [h, v] = [within(x, width), within(y, height)];
    return { brush: [h.from, v.from, h.side, v.side], window: { x: h.first, y: v.first, across: h.few, down: v.few } };
  }

  function paint() {
    const { brush, window } = areas();
    const [size, magnification] = [model.get("size"), model.get("magnification")];
    if (pixels?.width !== window.across || pixels?.height !== window.down) {
      [lens.width, lens.height] = [window.across, window.down];
      pixels = new ImageData(window.across, window.down);
    }
    const seen = equalise(map, window, width, { bins: model.get("bins"), limit: model.get("limit") }, new Uint32Array(pixels.data.buffer));
    lens.getContext("2d").putImageData(pixels, 0, 0);
    context.drawImage(picture, 0, 0);
    context.imageSmoothingEnabled = false;
    const [x, y, across, down] = brush;
    context.drawImage(lens, 0, 0, across / magnification, down / magnification, x, y, across, down);
    for (const [colour, thick] of [["#000", 4], ["#fff", 2]]) {
      context.strokeStyle = colour;
      context.lineWidth = (thick * Math.max(width, 600)) / 800;
      context.strokeRect(x, y, across, down);
    }
    const [row, column] = model.get("centre");
    const said = `x ${column}, y ${row}, size ${size}${magnification > 1 ? `, magnification ${magnification}` : ""}`;
    canvas.setAttribute("aria-label", `${model.get("alt")}, the brush at ${said}`);
    const moved = aloud || pointed ? "" : " The pointer or the arrow keys move the brush.";
    tell(`${said}: ${stops(seen)} of the map's ${stops(whole)} stops.${moved}`, aloud);
  }

  const repaint = eachFrame(paint);
  const controls = element(root, "div", { className: "hdrlab-controls" });
  const sizes = { name: "size", values: Array.from({ length: 15 }, (_, k) => 64 + 32 * k) };
  const enlargements = { name: "magnification", values: [1, 2, 3, 4, 5, 6, 7, 8] };
  const bars = [sizes, enlargements, { name: "limit", values: LIMITS }].map(({ name, values }) => {
    const bar = slider(controls, name, values.length);
    const away = () => values.map((value) => Math.abs(value - model.get(name)));
    const position = () => away().indexOf(Math.min(...away()));
    const show = () => bar.show(position(), `${model.get(name)}`);
    const move = (to) => change(name, values[clamp(to, 0, values.length - 1)]);
    bar.input.addEventListener("input", () => move(Number(bar.input.value)));
    return { name, show, more: (by) => move(position() + by) };
  });

  function change(name, value) {
    model.set(name, value);
    model.save_changes();
    follow();
  }

  function follow() {
    for (const bar of bars) bar.show();
    repaint();
  }

  function moveTo(y, x) {
    change("centre", [clamp(Math.round(y), 0, height - 1), clamp(Math.round(x), 0, width - 1)]);
  }

  const moves = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] };
  const changes = { "[": [0, -1], "]": [0, 1], "-": [1, -1], _: [1, -1], "+": [1, 1], "=": [1, 1] };
  frame.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const by = event.shiftKey ? FAR : NEAR;
    aloud = true;
    if (moves[event.key]) moveTo(...model.get("centre").map((at, k) => at + by * moves[event.key][k]));
    else if (changes[event.key]) bars[changes[event.key][0]].more(changes[event.key][1]);
    else return;
    event.preventDefault();
  });

  function point(event) {
    const [across, down] = place(event, canvas);
    [aloud, pointed] = [false, true];
    moveTo(down * height, across * width);
  }

  frame.addEventListener("pointerdown", (event) => {
    frame.setPointerCapture(event.pointerId);
    point(event);
  });
  frame.addEventListener("pointermove", point);

  const traits = ["centre", "size", "magnification", "limit"].map((name) => `change:${name}`);
  for (const trait of traits) model.on(trait, follow);
  follow();
  return () => traits.forEach((trait) => model.off(trait, follow));
}

export default { render };
