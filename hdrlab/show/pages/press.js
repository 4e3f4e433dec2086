// The pixel of a report that the reader presses, or reaches with the arrow keys: what each photo
// claims about it. Where no script runs, the page shows the first pixel.
//
// The page contains the data as JSON in the element "pixels" (pressed_pixels.py). They are for a
// grid of pixels: `rows` and `columns` are the coordinates in the image, `at` is the first pixel.

const FAR_STEP = 8; // grid pixels of an arrow key with Shift
const MAX_CODE = 65535; // stands for a share of 1
const STEPS = {
  ArrowLeft: [0, -1],
  ArrowRight: [0, 1],
  ArrowUp: [-1, 0],
  ArrowDown: [1, 0],
};

// Return the bytes that zlib compressed.
async function decompress(base64) {
  const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Return planes of `count` numbers, of 8 or 16 bits. They are stored as differences of neighbors;
// of 16 bits, all low bytes come first.
async function decodePlanes(base64, count, hasTwoBytes) {
  const bytes = await decompress(base64);
  const length = hasTwoBytes ? bytes.length / 2 : bytes.length;
  const numbers = hasTwoBytes ? new Uint16Array(length) : new Uint8Array(length);
  for (let i = 0; i < length; i++) {
    const difference = hasTwoBytes ? bytes[i] | (bytes[i + length] << 8) : bytes[i];
    const isFirst = i % count === 0;
    numbers[i] = isFirst ? difference : numbers[i - 1] + difference;
  }
  return numbers;
}

const clamp = (value, low, high) => Math.max(low, Math.min(high, value));

const threeDigits = (value) => String(Number(value.toPrecision(3)));

function shareText(code) {
  const percent = (100 * code) / MAX_CODE;
  if (code === 0 || code === MAX_CODE) return `${percent} %`;
  return percent < 0.1 ? "< 0.1 %" : `${Math.min(percent, 99.9).toFixed(1)} %`;
}

// The index of the coordinate nearest to this one.
function nearestIndex(coordinates, target) {
  const distances = coordinates.map((coordinate) => Math.abs(coordinate - target));
  return distances.indexOf(Math.min(...distances));
}

// Decode the data of the page, and return functions that give them for a pixel of the grid.
async function decodeData(data) {
  const count = data.rows.length * data.columns.length;
  const [levels, radiance, shares, verdict] = await Promise.all([
    decodePlanes(data.levels, count, data.wide),
    decodePlanes(data.radiance, count, true),
    decodePlanes(data.shares, count, true),
    decodePlanes(data.verdict, count, false),
  ]);
  const sentences = new TextDecoder().decode(await decompress(data.sentences)).split("\n");
  const channels = [...Array(data.channels).keys()];
  return {
    levelsOf: (photo, pixel) =>
      channels.map((c) => levels[(photo * data.channels + c) * count + pixel]),
    shareOf: (photo, pixel) => shares[photo * count + pixel],
    // The words of a verdict, and the prefix of its claim: null if the photo claims nothing.
    verdictOf: (photo, pixel) => data.verdicts[verdict[photo * count + pixel]],
    // Planes of radiance: the photos, and then the merges. Code 0 stands for no radiance.
    radianceOf(plane, pixel) {
      const code = radiance[plane * count + pixel];
      return code ? 2 ** (data.low + (code - 1) * data.octaves) : 0;
    },
    sentenceOf: (pixel) => sentences[pixel],
  };
}

async function start() {
  const data = JSON.parse(document.getElementById("pixels").textContent);
  const { rows, columns, merges } = data;
  const { levelsOf, shareOf, verdictOf, radianceOf, sentenceOf } = await decodeData(data);
  const surface = document.getElementById("press");
  const ring = document.getElementById("ring");
  const place = document.getElementById("place");
  const sentence = document.getElementById("sentence");
  const others = document.getElementById("others");
  const image = surface.querySelector("img");
  const tableRows = [...document.querySelectorAll("#photos tbody tr")];
  const cells = tableRows.map((tableRow) => tableRow.querySelectorAll("td"));
  const height = Number(surface.dataset.height);
  const width = Number(surface.dataset.width);
  let [row, column] = data.at;

  function paintPhoto([levelCell, shareCell, claimCell, verdictCell], photo, pixel) {
    const [verdict, prefix] = verdictOf(photo, pixel);
    const radiance = threeDigits(radianceOf(photo, pixel));
    levelCell.textContent = levelsOf(photo, pixel).join(" ");
    shareCell.textContent = shareText(shareOf(photo, pixel));
    claimCell.textContent = prefix === null ? "–" : prefix + radiance;
    verdictCell.textContent = verdict;
  }

  function paint() {
    const pixel = row * columns.length + column;
    cells.forEach((cellsOfPhoto, photo) => paintPhoto(cellsOfPhoto, photo, pixel));
    const merged = merges.map((name, k) => {
      return `${name} ${threeDigits(radianceOf(cells.length + k, pixel))}`;
    });
    others.textContent = merged.join(", ");
    place.textContent = `Pixel x ${columns[column]}, y ${rows[row]}`;
    sentence.textContent = sentenceOf(pixel);
    ring.style.left = `${(100 * (columns[column] + 0.5)) / width}%`;
    ring.style.top = `${(100 * (rows[row] + 0.5)) / height}%`;
    ring.hidden = false;
  }

  function moveTo(newRow, newColumn) {
    row = clamp(newRow, 0, rows.length - 1);
    column = clamp(newColumn, 0, columns.length - 1);
    paint();
  }

  function moveToPointer(event) {
    const box = image.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * width - 0.5;
    const y = ((event.clientY - box.top) / box.height) * height - 0.5;
    moveTo(nearestIndex(rows, y), nearestIndex(columns, x));
  }

  // A mouse can be dragged. A finger scrolls the page, and a tap is a click.
  surface.addEventListener("click", moveToPointer);
  surface.addEventListener("pointermove", (event) => {
    if (event.pointerType === "mouse" && event.buttons === 1) moveToPointer(event);
  });
  image.draggable = false;
  surface.addEventListener("keydown", (event) => {
    const step = STEPS[event.key];
    if (!step) return;
    event.preventDefault();
    const length = event.shiftKey ? FAR_STEP : 1;
    moveTo(row + length * step[0], column + length * step[1]);
  });
  document.documentElement.classList.add("pressable");
  surface.tabIndex = 0;
  surface.setAttribute("role", "application");
  surface.setAttribute(
    "aria-label",
    "The picture. Arrow keys move the pixel, with Shift by 8 steps.",
  );
  paint();
}

start();
