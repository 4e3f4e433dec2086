// Shared by the figures whose object itself is dragged.

// Let a pointer and the arrow keys move what `surface` shows. `grab` and then `moveTo` get shares of its width and
// height, `stepBy` gets steps (right, down), of which Shift makes `farStep`.
function draggable(frame, surface, { grab = () => {}, moveTo, stepBy, farStep = 8 }) {
  const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  frame.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    frame.setPointerCapture(event.pointerId);
    grab(place(event, surface));
    moveTo(place(event, surface));
  });
  frame.addEventListener("pointermove", (event) => {
    if (frame.hasPointerCapture(event.pointerId)) moveTo(place(event, surface));
  });
  frame.addEventListener("keydown", (event) => {
    const step = steps[event.key];
    if (!step) return;
    event.preventDefault();
    const length = event.shiftKey ? farStep : 1;
    stepBy(step[0] * length, step[1] * length);
  });
}

// Bytes as Python's zlib.compress wrote them.
async function unzip(view) {
  const packed = new Blob([view]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(packed).arrayBuffer());
}

// Bytes as `pixel.deflate` wrote them: the differences of neighbours in a row.
async function inflate(view, width) {
  const bytes = await unzip(view);
  for (let i = 0; i < bytes.length; i++) if (i % width) bytes[i] += bytes[i - 1];
  return bytes;
}

// A number with three digits, as a reader writes it.
function threeDigits(value) {
  return value === 0 ? "0" : String(Number(value.toPrecision(3)));
}
