// The pixel of a report that is pressed, or reached with the arrow keys: what each photo shows there.
// The data come from pressed_pixels.py. Where no script runs, the page shows the first pixel.

const FAR_STEP = 8;

async function inflate(base64) {
  const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Planes of `count` numbers, which `_pack` stored as differences of neighbors.
async function unpack(base64, count, wide) {
  const bytes = await inflate(base64);
  const length = wide ? bytes.length / 2 : bytes.length;
  const numbers = wide ? new Uint16Array(length) : new Uint8Array(length);
  for (let i = 0; i < length; i++) {
    const step = wide ? bytes[i] | (bytes[i + length] << 8) : bytes[i];
    numbers[i] = i % count ? numbers[i - 1] + step : step;
  }
  return numbers;
}

function threeDigits(value) {
  return value === 0 ? "0" : String(Number(value.toPrecision(3)));
}

function describeShare(code) {
  const percent = (100 * code) / 65535;
  if (code === 0 || code === 65535) return `${percent} %`;
  return percent < 0.1 ? "< 0.1 %" : `${Math.min(percent, 99.9).toFixed(1)} %`;
}

async function start() {
  const data = JSON.parse(document.getElementById("pixels").textContent);
  const { rows, columns, channels, merges, verdicts } = data;
  const count = rows.length * columns.length;
  const [levels, radiance, shares, verdict] = await Promise.all([
    unpack(data.levels, count, data.wide),
    unpack(data.radiance, count, true),
    unpack(data.shares, count, true),
    unpack(data.verdict, count, false),
  ]);
  const sentences = new TextDecoder().decode(await inflate(data.sentences)).split("\n");
  const [surface, ring, place, sentence, others] = ["press", "ring", "place", "sentence", "others"].map((id) =>
    document.getElementById(id),
  );
  const image = surface.querySelector("img");
  const cells = [...document.querySelectorAll("#photos tbody tr")].map((row) => row.querySelectorAll("td"));
  const [height, width] = [Number(surface.dataset.height), Number(surface.dataset.width)];
  let [row, column] = data.at;

  const radianceAt = (plane, pixel) => {
    const code = radiance[plane * count + pixel];
    return code ? 2 ** (data.low + (code - 1) * data.octaves) : 0;
  };

  function paint() {
    const pixel = row * columns.length + column;
    cells.forEach(([level, share, claim, word], photo) => {
      const values = Array.from({ length: channels }, (_, c) => levels[(photo * channels + c) * count + pixel]);
      const [text, prefix] = verdicts[verdict[photo * count + pixel]];
      level.textContent = values.join(" ");
      share.textContent = describeShare(shares[photo * count + pixel]);
      claim.textContent = prefix === null ? "–" : prefix + threeDigits(radianceAt(photo, pixel));
      word.textContent = text;
    });
    const texts = merges.map((name, k) => `${name} ${threeDigits(radianceAt(cells.length + k, pixel))}`);
    others.textContent = texts.join(", ");
    place.textContent = `Pixel x ${columns[column]}, y ${rows[row]}`;
    sentence.textContent = sentences[pixel];
    ring.style.left = `${(100 * (columns[column] + 0.5)) / width}%`;
    ring.style.top = `${(100 * (rows[row] + 0.5)) / height}%`;
    ring.hidden = false;
  }

  function move(toRow, toColumn) {
    row = Math.max(0, Math.min(rows.length - 1, toRow));
    column = Math.max(0, Math.min(columns.length - 1, toColumn));
    paint();
  }

  const nearest = (places, target) =>
    places.reduce((best, at, i) => (Math.abs(at - target) < Math.abs(places[best] - target) ? i : best), 0);

  function moveTo(event) {
    const box = image.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * width - 0.5;
    const y = ((event.clientY - box.top) / box.height) * height - 0.5;
    move(nearest(rows, y), nearest(columns, x));
  }

  // A finger scrolls the page, and a tap is a click; a mouse can also be dragged.
  surface.addEventListener("click", moveTo);
  surface.addEventListener("pointermove", (event) => {
    if (event.pointerType === "mouse" && event.buttons === 1) moveTo(event);
  });
  image.draggable = false;
  const steps = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] };
  surface.addEventListener("keydown", (event) => {
    const step = steps[event.key];
    if (!step) return;
    event.preventDefault();
    const length = event.shiftKey ? FAR_STEP : 1;
    move(row + length * step[0], column + length * step[1]);
  });
  document.documentElement.classList.add("pressable");
  surface.tabIndex = 0;
  surface.setAttribute("role", "application");
  surface.setAttribute("aria-label", "The picture. Arrow keys move the pixel, with Shift by 8 steps.");
  paint();
}

start();
