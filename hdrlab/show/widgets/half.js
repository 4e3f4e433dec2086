// Shared by the widgets that get radiance.

// Half floats as numbers, by a table: not every browser has Float16Array.
const HALF = Float32Array.from({ length: 65536 }, (_, bits) => {
  const [sign, power, part] = [bits >> 15 ? -1 : 1, (bits >> 10) & 31, bits & 1023];
  return sign * (power === 0 ? part * 2 ** -24 : (1024 + part) * 2 ** (power - 25));
});

// The bits of half floats, copied: a view into a larger buffer may start at an odd byte.
function halves(view) {
  return new Uint16Array(view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength));
}
