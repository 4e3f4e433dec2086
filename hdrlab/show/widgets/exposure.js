// The range of a photo as a window over a scene's histogram: capture/sensor.py and capture/ranges.py again.

const NORMALS = normals(16384); // few enough for a processor's cache
const STRIPE = 8; // pixels from one stripe of the marks to the next
const [FULL, NOISE] = [0xff005ed5, 0xffb27200]; // A B G R, as in show/plots/lectures/sensors.py

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
  const pixels = new Uint32Array(image.data.buffer);

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

  // The noise of each channel of a pixel: of the photons, for one electron per radiance, and of the amplifier.
  const shotNoise = E.map((radiance, i) => Math.sqrt(radiance) * NORMALS[i & 16383]);
  const amplifierNoise = E.map((_, i) => readNoise * NORMALS[(5 * i + 1) & 16383]);
  const topLevel = pixelValues.length - 1;

  // Write the photo of this time with its marks, and return how many pixels are lost in noise, and how many full.
  function expose(time) {
    const electronsPerRadiance = fullWell * model.get("sensitivity") * time;
    const rootOfGain = Math.sqrt(electronsPerRadiance);
    const [darkest, full] = limits(time);
    let [noiseCount, fullCount] = [0, 0];

    function pixelValue(k) {
      const photons = Math.min(electronsPerRadiance * E[k] + rootOfGain * shotNoise[k], fullWell);
      const level = (photons + amplifierNoise[k]) / gain + black + 0.5;
      return pixelValues[level < 0 ? 0 : level > topLevel ? topLevel : level | 0];
    }

    for (let y = 0, i = 0; y < height; y++)
      for (let x = 0; x < width; x++, i++) {
        const isFull = L[i] >= full;
        const isNoise = L[i] < darkest;
        if (isFull) fullCount++;
        if (isNoise) noiseCount++;
        if (isFull && (x + y) % STRIPE < STRIPE / 2) pixels[i] = FULL;
        else if (isNoise && (x + height - y) % STRIPE < STRIPE / 2) pixels[i] = NOISE;
        else if (channels === 1) pixels[i] = 0xff000000 | (0x10101 * pixelValue(i));
        else pixels[i] = 0xff000000 | (pixelValue(3 * i + 2) << 16) | (pixelValue(3 * i + 1) << 8) | pixelValue(3 * i);
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
