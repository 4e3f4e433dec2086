// gsolve by hand: pixels are dragged sideways, and the smoothest curve through their points follows.

const LEVELS = 256;
const MIDDLE = LEVELS / 2; // g(128) = 0
const KEY_STEP = 0.05; // of ln E
const MARGIN = 7; // levels above 255 and below 0 in the plot, so that no point is cut
const BEYOND = 3; // of ln E: how far past all solutions a pixel can be dragged
const ANIMATION_MS = 900;
const [DATA_ROW, SMOOTH_ROW, UNKNOWN_COLUMN] = [5, 0.25, 8]; // sizes of the matrix's parts in its picture

// Solve M x = r for a symmetric M with two bands beside its diagonal, by M = L D L'. A level in no equation gets NaN.
function solveBanded(diagonal, next, second, r) {
  const n = diagonal.length;
  const [D, L1, L2, x] = [[...diagonal], Array(n).fill(0), Array(n).fill(0), [...r]];
  for (let z = 0; z < n; z++) {
    const [a, b] = [next[z] ?? 0, second[z] ?? 0];
    if (diagonal[z] === 0) continue;
    const first = a - (z > 0 ? L1[z - 1] * L2[z - 1] * D[z - 1] : 0);
    [L1[z], L2[z]] = [first / D[z], b / D[z]];
    if (z + 1 < n) D[z + 1] -= L1[z] * first;
    if (z + 2 < n) D[z + 2] -= L2[z] * b;
  }
  for (let z = 0; z < n; z++) x[z] -= (L1[z - 1] ?? 0) * (x[z - 1] ?? 0) + (L2[z - 2] ?? 0) * (x[z - 2] ?? 0);
  for (let z = n - 1; z >= 0; z--) x[z] = x[z] / D[z] - L1[z] * (x[z + 1] ?? 0) - L2[z] * (x[z + 2] ?? 0);
  return x;
}

// The curve g that minimizes response/debevec.py's sum of squares if all ln E are given, and the parts of that sum.
function bestCurve({ Z, B, w }, lE, smoothness) {
  const zeros = () => Array(LEVELS).fill(0);
  const [diagonal, next, second, r] = [zeros(), zeros(), zeros(), zeros()];
  Z.forEach((row, i) =>
    row.forEach((z, j) => {
      diagonal[z] += w[z] ** 2;
      r[z] += w[z] ** 2 * (lE[i] + B[j]);
    })
  );
  diagonal[MIDDLE] += 1;
  const stiffness = w.map((weight) => (smoothness * weight) ** 2);
  for (let z = 1; z < LEVELS - 1; z++) {
    const s = stiffness[z];
    diagonal[z - 1] += s;
    diagonal[z] += 4 * s;
    diagonal[z + 1] += s;
    next[z - 1] -= 2 * s;
    next[z] -= 2 * s;
    second[z - 1] += s;
  }
  const g = solveBanded(diagonal, next, second, r);
  const sum = { points: 0, smoothness: 0, scale: g[MIDDLE] ** 2 };
  Z.forEach((row, i) => row.forEach((z, j) => (sum.points += (w[z] * (g[z] - lE[i] - B[j])) ** 2)));
  for (let z = 1; z < LEVELS - 1; z++) sum.smoothness += stiffness[z] * (g[z - 1] - 2 * g[z] + g[z + 1]) ** 2;
  return { g, sum, total: sum.points + sum.smoothness + sum.scale };
}

async function render({ model, el }) {
  const root = start(el, "gsolve");
  const [Z, B, w, shutters] = ["levels", "ln_times", "weights", "shutters"].map((name) => model.get(name));
  const samples = { Z, B, w };
  const [solutions, stiffnesses, [low, high]] = [model.get("solutions"), model.get("smoothness_values"), model.get("span")];
  const [N, P] = [Z.length, B.length];
  const pixels = [...Z.keys()];
  const [lE, index] = [() => model.get("ln_E"), () => model.get("smoothness_index")];
  const smoothness = () => stiffnesses[index()];
  const leastOf = stiffnesses.map((value, k) => bestCurve(samples, solutions[k], value).total);
  const ends = [Math.min(0, ...solutions.flat()) - BEYOND, Math.max(0, ...solutions.flat()) + BEYOND];
  const across = (ln) => `${(100 * (ln - low)) / (high - low)}%`;
  const fromTop = (z) => (LEVELS - 1 - z + MARGIN) / (LEVELS - 1 + 2 * MARGIN);
  const up = (z) => `${100 * fromTop(z)}%`;
  const signed = (value, digits = 2) => value.toFixed(digits).replace("-", "−");

  // The plot: polylines and the curve in SVG, points and words in HTML, so that both keep their size on a telephone.
  const columns = element(root, "div", { className: "hdrlab-columns" });
  const left = element(columns, "div", { className: "hdrlab-column" });
  element(left, "p", { className: "hdrlab-axis-name hdrlab-is-Z", textContent: "↑ level Z" });
  const keys = "The levels of the pixels. Left and right arrow keys move a pixel's levels, with Shift by 8 steps; up and down choose a pixel.";
  const frame = element(left, "div", { className: "hdrlab-levels", role: "application", tabIndex: 0, "aria-label": keys });
  const draw = (parent, tag, name) => {
    const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
    node.setAttribute("class", name);
    parent.append(node);
    return node;
  };
  const svg = draw(frame, "svg", "hdrlab-lines");
  svg.setAttribute("viewBox", "0 0 1 1");
  svg.setAttribute("preserveAspectRatio", "none");
  svg.setAttribute("aria-hidden", "true");
  const lines = pixels.map(() => draw(svg, "polyline", "hdrlab-polyline"));
  const curve = draw(svg, "polyline", "hdrlab-curve hdrlab-is-g");
  const svgPoint = (ln, z) => `${(ln - low) / (high - low)},${fromTop(z)}`;
  const points = pixels.map((i) =>
    Z[i].map((z) => {
      const point = element(frame, "b", { className: w[z] > 0 ? "" : "hdrlab-weightless" });
      point.style.top = up(z);
      return point;
    })
  );
  // A number beside the point that is nearest to the middle of the plot.
  const distance = (z) => Math.abs(z - MIDDLE);
  const numbered = Z.map((row) => row.indexOf(row.reduce((a, b) => (distance(b) < distance(a) ? b : a))));
  numbered.forEach((j, i) => element(points[i][j], "span", { textContent: i + 1 }));
  for (const z of [0, MIDDLE, LEVELS - 1])
    element(frame, "span", { className: "hdrlab-is-Z", textContent: z }).style.top = up(z);
  const origin = element(frame, "i", { className: "hdrlab-origin hdrlab-is-g" });
  [origin.style.left, origin.style.top] = [across(0), up(MIDDLE)];
  const ticks = element(left, "div", { className: "hdrlab-ticks hdrlab-is-g" });
  for (let ln = Math.ceil(low / 4) * 4; ln <= high; ln += 4)
    element(ticks, "span", { textContent: signed(ln, 0) }).style.left = across(ln);
  element(left, "p", { className: "hdrlab-axis-name hdrlab-is-g", textContent: "ln exposure, ln E + ln t; the curve is g" });

  const bar = element(left, "div", { className: "hdrlab-sum" });
  const parts = ["points", "smoothness", "scale"].map((name) => element(bar, "i", { className: `hdrlab-sum-${name}` }));
  const tick = element(bar, "b");
  const legend = element(left, "p", { className: "hdrlab-note", textContent: "Sum of squares: " });
  const shares = [["points", "E"], ["smoothness", "g"], ["scale", "t"]].map(([name, symbol]) => {
    const share = element(legend, "span", { className: `hdrlab-is-${symbol}` });
    if (name !== "scale") legend.append(" + ");
    return (value) => (share.textContent = `${name} ${threeDigits(value)}`);
  });
  const say = teller(left);
  const controls = element(left, "div", { className: "hdrlab-controls" });
  const stiffness = slider(controls, "smoothness λ", stiffnesses.length);
  stiffness.input.addEventListener("input", () => set("smoothness_index", Number(stiffness.input.value)));
  const solve = element(controls, "button", { textContent: "Let gsolve do it" });
  solve.addEventListener("click", () => glide(solutions[index()]));
  const again = element(controls, "button", { className: "hdrlab-plain", textContent: "Start again" });
  again.addEventListener("click", () => glide(pixels.map(() => 0)));


  const right = element(columns, "div", { className: "hdrlab-column" });
  const sheet = element(right, "div", { className: "hdrlab-sheet hdrlab-picked" });
  const canvas = element(sheet, "canvas", { role: "img", "aria-label": model.get("alt") });
  const photo = await decode(model.get("photo"), "image/webp");
  [canvas.width, canvas.height] = [photo.width, photo.height];
  canvas.getContext("2d").drawImage(photo, 0, 0);
  const dots = model.get("places").map(([down, rightwards], i) => {
    const dot = element(sheet, "button", { className: "hdrlab-dot", textContent: i + 1, "aria-label": `Pixel ${i + 1}` });
    [dot.style.top, dot.style.left] = [`${100 * down}%`, `${100 * rightwards}%`];
    dot.addEventListener("click", () => select(i));
    dot.addEventListener("pointerenter", () => select(i));
    return dot;
  });
  const matrix = element(right, "canvas", { className: "hdrlab-photo hdrlab-matrix", role: "img" });
  matrix.setAttribute("aria-label", "Matrix A: a row for each point, a row for the scale, and a band of rows for the smoothness");
  matrix.width = LEVELS + UNKNOWN_COLUMN * N;
  matrix.height = DATA_ROW * (N * P + 1) + SMOOTH_ROW * LEVELS;
  const equation = element(right, "p", { className: "hdrlab-note hdrlab-equation" });

  let [chosen, photoOfPoint, aloud] = [0, Math.floor(P / 2), false];
  const worst = Math.max(...stiffnesses.map((value) => bestCurve(samples, pixels.map(() => 0), value).total));

  function paint() {
    const { g, sum, total } = bestCurve(samples, lE(), smoothness());
    curve.setAttribute("points", g.map((ln, z) => svgPoint(ln, z)).join(" "));
    pixels.forEach((i) => {
      const x = B.map((ln) => lE()[i] + ln);
      lines[i].setAttribute("points", x.map((ln, j) => svgPoint(ln, Z[i][j])).join(" "));
      lines[i].classList.toggle("hdrlab-chosen", i === chosen);
      points[i].forEach((point, j) => {
        point.style.left = across(x[j]);
        point.classList.toggle("hdrlab-chosen", i === chosen);
        point.classList.toggle("hdrlab-pointed", i === chosen && j === photoOfPoint);
      });
      dots[i].setAttribute("aria-pressed", i === chosen);
    });
    // A square root, because the sum of squares falls by several powers of ten.
    const width = (value) => 100 * Math.min(Math.sqrt(value / worst), 1);
    ["points", "smoothness", "scale"].forEach((name, k) => {
      parts[k].style.width = `${(width(total) * sum[name]) / total}%`;
      shares[k](sum[name]);
    });
    tick.style.left = `${width(leastOf[index()])}%`;
    stiffness.show(index(), String(smoothness()));
    const words = `Pixel ${chosen + 1}: ln E = ${signed(lE()[chosen])}. Sum ${threeDigits(total)}`;
    say(`${words}, the least possible is ${threeDigits(leastOf[index()])}.`, aloud);
    paintMatrix();
    paintEquation(g);
  }

  function paintEquation(g) {
    const [i, j] = [chosen, photoOfPoint];
    const z = Z[i][j];
    equation.replaceChildren();
    const write = (text, symbol) => element(equation, "span", { textContent: text, className: symbol ? `hdrlab-is-${symbol}` : "" });
    write(`Row ${i * P + j + 1}: pixel ${i + 1} at ${shutters[j]}, `);
    write(`level ${z}`, "Z");
    write(", ");
    write(`weight ${w[z].toFixed(2)}`, "w");
    if (w[z] === 0) return write(": it does not count, because this level is only a bound.");
    write(": ");
    write(`g(${z})`, "g");
    write(" − ");
    write("ln E", "E");
    write(" − ");
    write("ln t", "t");
    write(` = ${signed(g[z])} − (${signed(lE()[i])}) − (${signed(B[j])}) = ${signed(g[z] - lE()[i] - B[j])}`);
  }

  function paintMatrix() {
    const context = matrix.getContext("2d");
    const styles = getComputedStyle(root);
    const ink = styles.color;
    const [marked, band] = [styles.getPropertyValue("--E"), styles.getPropertyValue("--g")];
    context.clearRect(0, 0, matrix.width, matrix.height);
    Z.forEach((row, i) =>
      row.forEach((z, j) => {
        if (w[z] === 0) return;
        const y = DATA_ROW * (i * P + j);
        context.fillStyle = i === chosen ? marked : ink;
        const size = i === chosen && j === photoOfPoint ? 5 : 3;
        context.fillRect(z - 1, y, size, size);
        context.fillRect(LEVELS + UNKNOWN_COLUMN * i, y, UNKNOWN_COLUMN - 1, size);
      })
    );
    context.fillStyle = band;
    context.fillRect(MIDDLE - 1, DATA_ROW * N * P, 3, 3);
    for (let z = 1; z < LEVELS - 1; z++) context.fillRect(z - 1, DATA_ROW * (N * P + 1) + SMOOTH_ROW * z, 3, 1);
  }
  const repaint = eachFrame(paint);

  function set(name, value) {
    model.set(name, value);
    model.save_changes();
    repaint();
  }

  function move(i, ln) {
    set("ln_E", lE().map((before, k) => (k === i ? clamp(ln, ...ends) : before)));
  }

  function select(i, j = photoOfPoint) {
    [chosen, photoOfPoint] = [i, j];
    repaint();
  }

  // All pixels glide to their places; a reader who wants no motion sees them jump.
  let run = 0;
  function glide(target) {
    const [from, began, turn] = [lE(), performance.now(), ++run];
    const duration = matchMedia("(prefers-reduced-motion: reduce)").matches ? 0 : ANIMATION_MS;
    aloud = true;
    const frameOf = (now) => {
      if (turn !== run) return;
      const part = duration ? clamp((now - began) / duration, 0, 1) : 1;
      const eased = part * part * (3 - 2 * part);
      set("ln_E", part === 1 ? [...target] : from.map((ln, i) => ln + eased * (target[i] - ln)));
      if (part < 1) requestAnimationFrame(frameOf);
    };
    requestAnimationFrame(frameOf);
  }

  // The point nearest to the pointer, and with it a pixel and a photo.
  function nearest([rightwards, down]) {
    const box = frame.getBoundingClientRect();
    let [best, found] = [Infinity, [0, 0]];
    pixels.forEach((i) =>
      Z[i].forEach((z, j) => {
        const dx = ((lE()[i] + B[j] - low) / (high - low) - rightwards) * box.width;
        const dy = (fromTop(z) - down) * box.height;
        if (dx * dx + dy * dy < best) [best, found] = [dx * dx + dy * dy, [i, j]];
      })
    );
    return found;
  }

  let grabbed = null;
  draggable(frame, frame, {
    grab: (at) => {
      run += 1;
      select(...nearest(at));
      grabbed = { at: at[0], ln: lE()[chosen] };
    },
    moveTo: ([rightwards]) => {
      aloud = false;
      move(chosen, grabbed.ln + (rightwards - grabbed.at) * (high - low));
    },
    stepBy: (rightwards, down) => {
      aloud = true;
      if (down) select(clamp(chosen + Math.sign(down), 0, N - 1));
      else move(chosen, lE()[chosen] + KEY_STEP * rightwards);
    },
  });
  frame.addEventListener("pointermove", (event) => {
    if (event.pointerType === "mouse" && event.buttons === 0) select(...nearest(place(event, frame)));
  });
  matrix.addEventListener("pointermove", (event) => {
    const row = Math.floor((place(event, matrix)[1] * matrix.height) / DATA_ROW);
    if (row >= 0 && row < N * P) select(Math.floor(row / P), row % P);
  });
  const names = ["change:ln_E", "change:smoothness_index"];
  names.forEach((name) => model.on(name, repaint));
  paint();
  repaint(); // once more when it is in the page, whose colors the matrix has
  return () => names.forEach((name) => model.off(name, repaint));
}

export default { render };
