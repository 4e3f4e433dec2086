// Shared by the widgets in which a reader drags something: pointer and arrow keys, and the decoding
// of the pixel values that Python sends.

const ARROW_STEPS = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

// Let a pointer and the arrow keys on `frame` move something. `grab` and then `moveTo` get the
// position of the pointer on `surface`, as fractions of its width and height. `stepBy` gets steps
// to the right and down: 1 for an arrow key, and `farStep` with Shift.
function makeDraggable(frame, surface, { grab = () => {}, moveTo, stepBy, farStep = 8 }) {
  frame.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    frame.setPointerCapture(event.pointerId);
    grab(pointerPosition(event, surface));
    moveTo(pointerPosition(event, surface));
  });
  frame.addEventListener("pointermove", (event) => {
    if (frame.hasPointerCapture(event.pointerId)) moveTo(pointerPosition(event, surface));
  });
  frame.addEventListener("keydown", (event) => {
    const step = ARROW_STEPS[event.key];
    if (!step) return;
    event.preventDefault();
    const length = event.shiftKey ? farStep : 1;
    stepBy(step[0] * length, step[1] * length);
  });
}

// Return pixel values that `pixel.deflate` in Python compressed: differences of neighbors in a row.
async function decodeRows(view, width) {
  const bytes = await decompress(view);
  for (let i = 0; i < bytes.length; i++) {
    if (i % width) bytes[i] += bytes[i - 1];
  }
  return bytes;
}
