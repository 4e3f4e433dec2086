// Shared by the widgets that compute with radiance: Python sends half floats (io/web.py,
// encode_halves), and this file decodes them.

// The value of a half float: 1 bit sign, 5 bits exponent, 10 bits fraction.
function halfValue(bits) {
  const sign = bits >> 15 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  return sign * (1024 + fraction) * 2 ** (exponent - 25);
}

// The values of all half floats, because not every browser has Float16Array.
const HALF_VALUES = Float32Array.from({ length: 65536 }, (_, bits) => halfValue(bits));

// Return the bits of half floats. The bytes are differences between neighboring pixels, compressed:
// all low bytes, then all high bytes.
async function decodeHalves(view, channels) {
  const bytes = await decompress(view);
  const bits = new Uint16Array(bytes.length / 2);
  for (let i = 0; i < bits.length; i++) {
    const difference = bytes[i] + (bytes[i + bits.length] << 8);
    bits[i] = difference + (bits[i - channels] ?? 0);
  }
  return bits;
}
