// The weighted mean at the pixel that is pressed: radiance/merge.py again, for one pixel.

const MIN_RELATIVE_WEIGHT = 1e-6; // as in radiance/merge.py

async function render({ model, el }) {
  const root = start(el, "pixel");
  const [count, height, width, channels] = model.get("shape");
  const levels = await inflate(model.get("levels"), width);
  const [shutters, B, g, w] = ["shutters", "ln_times", "response", "weights"].map((name) => model.get(name));
  const [top, channel, [low, high]] = [model.get("top"), model.get("channel"), model.get("span")];
  const heaviest = Math.max(...w);

  // Planes of channels, so that neighbours in a row are neighbours in memory.
  const level = (photo, c, y, x) => levels[((photo * channels + c) * height + y) * width + x];
  const everyChannel = (test) => Array.from({ length: channels }, (_, c) => c).every(test);

  // weigh(): a photo with a clipped channel counts only if no photo measures the pixel in all channels.
  function weigh(y, x) {
    const photos = [...shutters.keys()];
    const usable = photos.map((j) => level(j, channel, y, x) > 0 && level(j, channel, y, x) < top);
    const whole = photos.map((j) => usable[j] && everyChannel((c) => level(j, c, y, x) < top));
    const inUse = whole.some(Boolean) ? whole : usable;
    const weight = (j) => Math.max(w[level(j, channel, y, x)], MIN_RELATIVE_WEIGHT * heaviest);
    return photos.map((j) => (inUse[j] ? weight(j) : 0));
  }

  // What one photo says of ln E: an estimate, or a bound where its level measures nothing.
  function claim(photo, Z) {
    if (Z >= top) return { kind: "at least", lnE: g[top] - B[photo] };
    if (Z === 0) return { kind: "at most", lnE: g[1] - B[photo] };
    return { kind: "", lnE: g[Z] - B[photo] };
  }

  // merge(): the weighted mean of the claims, or what the tightest bounds say.
  function merge(claims, W) {
    const total = W.reduce((sum, weight) => sum + weight, 0);
    if (total > 0) return claims.reduce((sum, { lnE }, j) => sum + W[j] * lnE, 0) / total;
    const bounds = (kind) => claims.filter((one) => one.kind === kind).map((one) => one.lnE);
    const ends = [];
    if (bounds("at least").length) ends.push(Math.max(...bounds("at least")));
    if (bounds("at most").length) ends.push(Math.min(...bounds("at most")));
    return ends.reduce((sum, lnE) => sum + lnE, 0) / ends.length;
  }

  const columns = element(root, "div", { className: "hdrlab-columns" });
  const left = element(columns, "div", { className: "hdrlab-column" });
  const keys = "The pixel. Arrow keys move it, with Shift by 8 pixels.";
  const { frame, canvas, context } = stage(left, keys);
  canvas.width = width;
  canvas.height = height;
  canvas.className = "hdrlab-photo";
  const ring = element(frame, "i", { className: "hdrlab-ring" });
  const shownPhoto = element(left, "p", { className: "hdrlab-note" });

  const table = element(columns, "div", { className: "hdrlab-column hdrlab-bars" });
  const header = element(table, "div", { className: "hdrlab-bar-row hdrlab-bar-names" });
  const names = [["time", "t"], ["level", "Z"], ["weight", "w"], ["claims E =", "E"]];
  for (const [name, symbol] of names) element(header, "span", { textContent: name, className: `hdrlab-is-${symbol}` });
  const rows = shutters.map((shutter, photo) => {
    const row = element(table, "div", { className: "hdrlab-bar-row" });
    const button = element(row, "button", { className: "hdrlab-plain", textContent: shutter });
    button.setAttribute("aria-label", `Show the photo of ${shutter}`);
    button.addEventListener("click", () => showPhoto(photo));
    const bar = (symbol) => {
      const cell = element(row, "div", { className: `hdrlab-bar hdrlab-is-${symbol}` });
      const fill = element(cell, "i");
      return { fill, text: element(cell, "span") };
    };
    const [Z, weight] = [bar("Z"), bar("w")];
    const line = element(row, "div", { className: "hdrlab-claim hdrlab-is-E" });
    const mean = element(line, "i", { className: "hdrlab-mean" });
    const dot = element(line, "b");
    return { row, button, Z, weight, mean, dot, text: element(line, "span") };
  });
  const footer = element(table, "div", { className: "hdrlab-bar-row" });
  const end = element(footer, "div", { className: "hdrlab-claim hdrlab-mean-name hdrlab-is-E" });
  const meanName = element(end, "span");
  const say = teller(root);

  function showPhoto(photo) {
    const image = context.createImageData(width, height);
    for (let y = 0, at = 0; y < height; y++)
      for (let x = 0; x < width; x++) {
        for (let c = 0; c < 3; c++) image.data[at++] = level(photo, c % channels, y, x);
        image.data[at++] = 255;
      }
    context.putImageData(image, 0, 0);
    rows.forEach(({ button }, j) => button.setAttribute("aria-pressed", j === photo));
    shownPhoto.textContent = `The photo of ${shutters[photo]}. Press another time to see its photo.`;
    shown = photo;
    canvas.setAttribute("aria-label", describePlace());
  }

  let shown = Math.floor(count / 2);
  const describePlace = () => `${model.get("alt")}, ${shutters[shown]}, pixel x ${at()[1]}, y ${at()[0]}`;
  const at = () => model.get("at");
  const across = (lnE) => `${clamp((100 * (lnE - low)) / (high - low), 0, 100)}%`;

  let aloud = false;
  function paint() {
    const [y, x] = at();
    ring.style.left = `${(100 * (x + 0.5)) / width}%`;
    ring.style.top = `${(100 * (y + 0.5)) / height}%`;
    const W = weigh(y, x);
    const claims = rows.map((_, j) => claim(j, level(j, channel, y, x)));
    const lnE = merge(claims, W);
    rows.forEach(({ row, Z, weight, mean, dot, text }, j) => {
      const { kind, lnE: claimed } = claims[j];
      const value = level(j, channel, y, x);
      row.classList.toggle("hdrlab-unused", W[j] === 0);
      Z.fill.style.width = `${(100 * value) / 255}%`;
      Z.text.textContent = value;
      weight.fill.style.width = `${(100 * W[j]) / heaviest}%`;
      weight.text.textContent = (W[j] / heaviest).toFixed(2);
      mean.style.left = across(lnE);
      dot.style.left = across(claimed);
      dot.className = { "": "", "at least": "hdrlab-least", "at most": "hdrlab-most" }[kind];
      dot.style.setProperty("--size", `${6 + 12 * Math.sqrt(W[j] / heaviest)}px`);
      text.textContent = `${kind} ${threeDigits(Math.exp(claimed))}`.trim();
    });
    const used = W.filter((weight) => weight > 0).length;
    const E = threeDigits(Math.exp(lnE));
    meanName.textContent = used ? `weighted mean ${E}` : `only bounds: ${E}`;
    meanName.style.left = across(lnE);
    meanName.style.transform = `translateX(-${across(lnE)})`; // it stays inside the column
    canvas.setAttribute("aria-label", describePlace());
    const measured = `Weighted mean of ${used} of ${count} photos: E = ${E}.`;
    say(used ? measured : `No photo measures this pixel. Its bounds give E = ${E}.`, aloud);
  }
  const repaint = eachFrame(paint);

  function move(y, x, byKey) {
    aloud = byKey;
    model.set("at", [clamp(y, 0, height - 1), clamp(x, 0, width - 1)]);
    model.save_changes();
    repaint();
  }

  draggable(frame, canvas, {
    moveTo: ([right, down]) => move(Math.floor(down * height), Math.floor(right * width), false),
    stepBy: (right, down) => move(at()[0] + down, at()[1] + right, true),
  });
  model.on("change:at", repaint);
  showPhoto(shown);
  paint();
  return () => model.off("change:at", repaint);
}

export default { render };
