// Shared by the widgets that show light: the sRGB transfer functions of core/colour.py.

const decodeSrgb = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
const encodeSrgb = (c) => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);

const LIGHT_STEPS = 65535; // of the table, from black to white
const PIXEL_VALUES = Uint8Array.from({ length: LIGHT_STEPS + 1 }, (_, step) =>
  Math.floor(255 * encodeSrgb(step / LIGHT_STEPS) + 0.5),
);

// The pixel value of a channel. `light` is in steps: 0 is black, LIGHT_STEPS is white. It is
// rounded to the nearest step.
const pixelValue = (light) => PIXEL_VALUES[light < LIGHT_STEPS ? (light + 0.5) | 0 : LIGHT_STEPS];
