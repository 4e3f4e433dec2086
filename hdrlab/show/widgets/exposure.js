// The range of a photo as a window over a scene's histogram: capture/sensor.py and capture/ranges.py again.

const CERTAINLY_FULL = 4; // wells: as in capture/sensor.py
const NORMALS = normals(16384); // few enough for a processor's cache
const STRIPE = 8; // pixels from one stripe of the marks to the next
const [FULL, NOISE] = [[213, 94, 0], [0, 114, 178]]; // as in show/plots/lectures/sensors.py

// Random numbers of a normal distribution: the same ones in each photo, so that only the light changes.
function normals(count) {
  let state = 1;
  const uniform = () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return (state + 0.5) / 2 ** 32;
  };
  return Float32Array.from({ length: count }, () => {
    const radius = Math.sqrt(-2 * Math.log(uniform()));
    return radius * Math.cos(2 * Math.PI * uniform());
  });
}

async function render({ model, el }) {
  const root = start(el, "exposure");
  const [height, width, channels] = model.get("shape");
  const bits = await halves(model.get("radiance"), channels);
  const E = Float32Array.from(bits, (one) => HALF[one] / model.get("scale"));
  const L = luminances(E, channels);
  const [low, high] = model.get("span");
  const { full_well: fullWell, read_noise: readNoise, gain, black } = model.get("sensor");
  const view = model.get("pixel_values");
  const pixelValues = new Uint8Array(view.buffer, view.byteOffset, view.byteLength);
  const [shutters, times] = [model.get("shutters"), model.get("times")];
  const at = () => model.get("at");

  const columns = element(root, "div", { className: "hdrlab-columns" });
  const left = element(columns, "div", { className: "hdrlab-column" });
  const canvas = element(left, "canvas", { role: "img", "aria-label": "", className: "hdrlab-photo", width, height });
  const context = canvas.getContext("2d", { alpha: false });
  const image = context.createImageData(width, height);

  const right = element(columns, "div", { className: "hdrlab-column hdrlab-chart" });
  const scale = element(right, "div", { className: "hdrlab-scale", role: "slider", tabIndex: 0, "aria-label": "Shutter" });
  scale.setAttribute("aria-valuemin", 0);
  scale.setAttribute("aria-valuemax", times.length - 1);
  const bars = histogram(scale, L, [low, high]);
  const held = element(scale, "div", { className: "hdrlab-window" });
  const shutter = element(held, "b", { className: "hdrlab-is-t" });
  const luminanceText = (stop) => (stop < 0 ? `1/${2 ** -stop}` : 2 ** stop);
  ruler(right, [low, high], everyFew([low, high], 4).map((stop) => [stop, luminanceText(stop)]));
  element(right, "p", { className: "hdrlab-axis", textContent: "luminance, cd/m²; one mark is one stop" });
  const parts = element(right, "div", { className: "hdrlab-parts" });
  const [noisePart, heldPart, fullPart] = ["noise", "held", "full"].map((kind) => {
    const part = element(parts, "span");
    element(part, "i", { className: `hdrlab-swatch hdrlab-${kind}` });
    return element(part, "span");
  });
  const say = teller(root);

  // The luminances between which a photo of this time measures something.
  function limits(time) {
    return model.get("limits").map((X) => X / (model.get("sensitivity") * time));
  }

  // One channel of a pixel: photons, the amplifier's noise, and a level of the converter.
  function pixelValue(arriving, i) {
    const mean = Math.min(arriving, CERTAINLY_FULL * fullWell);
    const photons = Math.min(mean + Math.sqrt(mean) * NORMALS[i & 16383], fullWell);
    const electrons = photons + readNoise * NORMALS[(5 * i + 1) & 16383];
    const level = Math.floor(electrons / gain + black + 0.5);
    return pixelValues[clamp(level, 0, pixelValues.length - 1)];
  }

  // Write the photo of this time with its marks, and return how many pixels are lost in noise, and how many full.
  function expose(time) {
    const electronsPerRadiance = fullWell * model.get("sensitivity") * time;
    const [darkest, full] = limits(time);
    let [noiseCount, fullCount, to] = [0, 0, 0];
    for (let y = 0, i = 0; y < height; y++)
      for (let x = 0; x < width; x++, i++) {
        let mark = null;
        if (L[i] >= full) {
          fullCount++;
          if ((x + y) % STRIPE < STRIPE / 2) mark = FULL;
        } else if (L[i] < darkest) {
          noiseCount++;
          if ((x + height - y) % STRIPE < STRIPE / 2) mark = NOISE;
        }
        for (let c = 0; c < 3; c++) {
          const from = i * channels + (c % channels);
          image.data[to++] = mark ? mark[c] : pixelValue(electronsPerRadiance * E[from], from);
        }
        image.data[to++] = 255;
      }
    return [noiseCount / L.length, fullCount / L.length];
  }

  const across = (luminance) => (100 * (Math.log2(luminance) - low)) / (high - low);

  function paint() {
    const time = times[at()];
    const [noise, full] = expose(time);
    context.putImageData(image, 0, 0);
    const ends = limits(time);
    const [from, to] = ends.map((luminance) => clamp(across(luminance), 0, 100));
    held.style.left = `${from}%`;
    held.style.width = `${to - from}%`;
    bars.style.background = `linear-gradient(90deg, var(--noise) ${from}%, var(--held) 0 ${to}%, var(--full) 0)`;
    shutter.textContent = shutters[at()];
    noisePart.textContent = `lost in noise ${percent(noise)}`;
    heldPart.textContent = `recorded ${percent(1 - noise - full)}`;
    fullPart.textContent = `clipped ${percent(full)}`;
    const lost = `${percent(noise)} lost in noise, ${percent(full)} clipped`;
    scale.setAttribute("aria-valuenow", at());
    scale.setAttribute("aria-valuetext", `${shutters[at()]}: ${lost}`);
    canvas.setAttribute("aria-label", `${model.get("alt")}, ${shutters[at()]}: ${lost}`);
    const stops = Math.log2(ends[1] / ends[0]).toFixed(1);
    const [darkest, brightest] = ends.map(threeDigits);
    say(`${shutters[at()]} records ${stops} stops, from ${darkest} to ${brightest} cd/m².`);
  }
  const repaint = eachFrame(paint);

  function move(to) {
    model.set("at", clamp(to, 0, times.length - 1));
    model.save_changes();
    repaint();
  }

  // The mark of the dial whose window has its upper end nearest to this place.
  function nearest(share) {
    const away = times.map((time) => Math.abs(across(limits(time)[1]) - 100 * share));
    return away.indexOf(Math.min(...away));
  }

  let grip = 0; // from where the window is held to its upper end, as a share of the scale
  draggable(scale, bars, {
    grab: ([right]) => {
      const [from, to] = limits(times[at()]).map((luminance) => across(luminance) / 100);
      const isInside = from <= right && right <= to;
      grip = isInside ? to - right : (to - from) / 2;
    },
    moveTo: ([right]) => move(nearest(right + grip)),
    stepBy: (right, down) => move(at() + right - down),
    farStep: 3,
  });
  model.on("change:at", repaint);
  paint();
  return () => model.off("change:at", repaint);
}

export default { render };
