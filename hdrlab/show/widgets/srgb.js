// Shared by the widgets that show light: core/colour.py again.

const decodeSrgb = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
const encodeSrgb = (c) => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);
const CODES = Uint8Array.from({ length: 65536 }, (_, k) => Math.floor(255 * encodeSrgb(k / 65535) + 0.5));

// The code of a channel: light is in units of the table, 1 / 65535 of white.
const code = (light) => CODES[light < 65535 ? (light + 0.5) | 0 : 65535];
