// Shared by the widgets that get radiance.

// Half floats as numbers, by a table: not every browser has Float16Array.
const HALF = Float32Array.from({ length: 65536 }, (_, bits) => {
  const [sign, power, part] = [bits >> 15 ? -1 : 1, (bits >> 10) & 31, bits & 1023];
  return sign * (power === 0 ? part * 2 ** -24 : (1024 + part) * 2 ** (power - 25));
});

// The bits of half floats, as `web.encode_halves` wrote them: their steps, the low bytes before the high ones.
async function halves(view, channels) {
  const packed = new Blob([view]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(packed).arrayBuffer());
  const bits = new Uint16Array(bytes.length / 2);
  for (let i = 0; i < bits.length; i++) bits[i] = bytes[i] + (bytes[i + bits.length] << 8) + (bits[i - channels] ?? 0);
  return bits;
}
