// A question that takes the answer before the picture comes: a choice, a number, a curve, a place in a picture.
// Then the truth is laid over the answer. The answer is kept in the notebook's own state, and nowhere else.

const [YOURS, TRUTH] = ["#0063a0", "#d55e00"];
const NEAR = 0.1; // of the scale: an answer this near counts
const HANDLES = 17; // of a curve: the keys move one after the other, a drag all that it passes

const digits = (value) => `${Number(value.toPrecision(3))}`;

// How the answers on a page (in JupyterLab: in a notebook) went so far: question to whether it was near.
function tallyOf(el) {
  const page = el.closest(".jp-NotebookPanel") ?? document;
  const tallies = (globalThis.hdrlabTallies ??= new WeakMap());
  if (!tallies.has(page)) tallies.set(page, new Map());
  return tallies.get(page);
}

// Each kind adds its controls, and returns: read() the answer or null, show(answer) it, reveal(answer) the truth
// over it, and compare(answer): [whether it is near, in words how far].
const KINDS = {
  choice(root, model) {
    const [labels, truth, pictures] = [model.get("labels"), model.get("truth"), model.get("pictures")];
    const attributes = { className: "hdrlab-choice", role: "radiogroup", "aria-label": model.get("question") };
    const row = element(root, "div", attributes);
    const group = `hdrlab-${Math.random()}`;
    const choices = labels.map((label, k) => {
      const line = element(row, "label");
      const input = element(line, "input", { type: "radio", name: group });
      const words = element(line, "span", { textContent: label });
      if (pictures.length) {
        line.classList.add("hdrlab-card");
        picture(line).show(decode(pictures[k], "image/webp"), model.get("alts")[k]);
      }
      return { line, input, words };
    });
    const read = () => {
      const k = choices.findIndex(({ input }) => input.checked);
      return k < 0 ? null : k;
    };
    return {
      read,
      show: (answer) => choices.forEach(({ input }, k) => (input.checked = k === answer)),
      reveal: () =>
        choices.forEach(({ line, input, words }, k) => {
          input.disabled = true;
          line.classList.toggle("hdrlab-true", k === truth);
          if (k === truth) words.textContent = `✓ ${labels[k]}`;
        }),
      compare: (answer) => [answer === truth, answer === truth ? "Yes" : `You said: ${labels[answer]}`],
    };
  },

  number(root, model) {
    const [low, high, step] = model.get("scale");
    const [unit, truth] = [model.get("unit") && ` ${model.get("unit")}`, model.get("truth")];
    const count = Math.round((high - low) / step) + 1;
    const value = (position) => low + step * position;
    const rows = element(root, "div", { className: "hdrlab-rows" });
    const bar = slider(rows, "your answer", count);
    let touched = false;
    const text = () => `${digits(value(Number(bar.input.value)))}${unit}`;
    bar.show(Math.floor(count / 2), "");
    bar.input.setAttribute("aria-valuetext", "no answer yet");
    bar.input.addEventListener("input", () => {
      touched = true;
      bar.show(bar.input.value, text());
    });
    return {
      read: () => (touched ? value(Number(bar.input.value)) : null),
      show(answer) {
        bar.show(Math.round((answer - low) / step), `${digits(answer)}${unit}`);
      },
      reveal() {
        bar.input.disabled = true;
        const below = slider(rows, "the truth", count);
        below.input.classList.add("hdrlab-truth");
        below.input.inert = true; // not disabled, which would take its colour
        below.show(Math.round((truth - low) / step), model.get("told").slice(0, -1));
      },
      compare(answer) {
        const away = truth - answer;
        const words = `You said ${digits(answer)}${unit}, ${digits(Math.abs(away))} too ${away > 0 ? "low" : "high"}`;
        return [Math.abs(away) <= NEAR * (high - low), Math.abs(away) < step / 2 ? "Yes" : words];
      },
    };
  },

  curve(root, model) {
    const [left, right, low, high] = model.get("scale");
    const [across, up] = model.get("labels");
    const [xs, ys] = model.get("truth");
    element(root, "div", { className: "hdrlab-axis", textContent: `↑ ${up}, ${digits(low)} to ${digits(high)}` });
    const help = `${up} over ${across}: arrow keys left and right choose a point of your curve, up and down move it`;
    const { frame, canvas, context } = stage(root, help);
    [canvas.width, canvas.height] = [1280, 720];
    canvas.style.width = "640px"; // sharp on screens with two pixels for one
    canvas.toggleAttribute("data-ink", true);
    element(root, "div", { className: "hdrlab-axis", textContent: `→ ${across}, ${digits(left)} to ${digits(right)}` });
    const tell = teller(root);
    const mine = new Array(HANDLES).fill(null);
    let [at, closed, last] = [0, false, null];

    const point = ([x, y]) => [((x - left) / (right - left)) * canvas.width, (1 - (y - low) / (high - low)) * canvas.height];
    const position = (k) => left + ((right - left) * k) / (HANDLES - 1);
    const level = (y) => clamp(low + (high - low) * (1 - y), low, high);
    const known = () => mine.map((y, k) => [position(k), y]).filter(([, y]) => y !== null);

    function line(points, colour, dashes) {
      context.strokeStyle = colour;
      context.lineWidth = 6;
      context.setLineDash(dashes);
      context.beginPath();
      points.map(point).forEach(([x, y]) => context.lineTo(x, y));
      context.stroke();
      context.setLineDash([]);
    }

    function paint(truth = false) {
      context.fillStyle = "#fff";
      context.fillRect(0, 0, canvas.width, canvas.height);
      context.strokeStyle = "#d0d0d0";
      context.lineWidth = 2;
      for (let k = 0; k <= 4; k++) {
        context.strokeRect(0, (canvas.height * k) / 4, canvas.width, 0);
        context.strokeRect((canvas.width * k) / 4, 0, 0, canvas.height);
      }
      line(known(), YOURS, [18, 12]);
      context.fillStyle = YOURS;
      for (const one of known().map(point)) context.fillRect(one[0] - 7, one[1] - 7, 14, 14);
      if (truth) line(xs.map((x, k) => [x, ys[k]]), TRUTH, []);
      const drawn = known().length ? "with your curve, dashed" : "empty";
      canvas.setAttribute("aria-label", `${model.get("alts")[0]}, ${drawn}${truth ? ", and the true one" : ""}`);
    }

    function draw(event) {
      if (closed || (event.type === "pointermove" && last === null)) return;
      const [x, y] = place(event, canvas);
      const k = clamp(Math.round(x * (HANDLES - 1)), 0, HANDLES - 1);
      const [from, to] = [last ?? k, k];
      for (let j = Math.min(from, to); j <= Math.max(from, to); j++) mine[j] = level(y);
      [last, at] = [k, k];
      paint();
    }

    frame.addEventListener("pointerdown", (event) => {
      frame.setPointerCapture(event.pointerId);
      draw(event);
    });
    frame.addEventListener("pointermove", draw);
    ["pointerup", "pointercancel"].forEach((kind) => frame.addEventListener(kind, () => (last = null)));
    frame.addEventListener("keydown", (event) => {
      const sideways = { ArrowLeft: -1, ArrowRight: 1 }[event.key] ?? 0;
      const upwards = { ArrowUp: 1, ArrowDown: -1 }[event.key] ?? 0;
      if (closed || !(sideways || upwards)) return;
      event.preventDefault();
      const before = mine[at];
      at = clamp(at + sideways, 0, HANDLES - 1);
      mine[at] = clamp((mine[at] ?? before ?? (low + high) / 2) + (upwards * (high - low)) / 40, low, high);
      paint();
      tell(`${across} ${digits(position(at))}: ${up} ${digits(mine[at])}`, true);
    });
    paint();

    // My curve at x, straight between the points I drew, level beyond them.
    function yours(answer, x) {
      const points = answer.map((y, k) => [position(k), y]).filter(([, y]) => y !== null);
      const after = points.findIndex(([at]) => at >= x);
      if (after <= 0) return points[after < 0 ? points.length - 1 : 0][1];
      const [[x0, y0], [x1, y1]] = [points[after - 1], points[after]];
      return y0 + ((y1 - y0) * (x - x0)) / (x1 - x0);
    }

    return {
      read: () => (known().length > 1 ? [...mine] : null),
      show(answer) {
        answer.forEach((y, k) => (mine[k] = y));
        paint();
      },
      reveal() {
        closed = true;
        paint(true);
      },
      compare(answer) {
        const away = xs.reduce((sum, x, k) => sum + Math.abs(yours(answer, x) - ys[k]), 0) / xs.length;
        const near = away <= NEAR * (high - low);
        return [near, `${near ? "Near: your" : "Your"} curve is off by ${digits(away)} on average (${up})`];
      },
    };
  },

  async place(root, model) {
    const [photograph, mask] = await Promise.all(model.get("pictures").map((bytes) => decode(bytes, "image/webp")));
    const { width, height } = photograph;
    const help = "arrow keys move the cross, Shift further";
    const { frame, canvas, context } = stage(root, help);
    const larger = Math.max(1, Math.ceil(960 / width));
    [canvas.width, canvas.height] = [width * larger, height * larger];
    const tell = teller(root);
    const read = new OffscreenCanvas(width, height).getContext("2d");
    read.drawImage(mask, 0, 0);
    const { data } = read.getImageData(0, 0, width, height);
    const inside = (x, y) => data[4 * (y * width + x)] > 127;
    let [cross, closed] = [null, false];

    function paint(truth = false) {
      context.filter = truth ? "grayscale(1) brightness(0.85)" : "none"; // so that the truth stands out
      context.drawImage(photograph, 0, 0, canvas.width, canvas.height);
      context.filter = "none";
      if (truth) {
        context.fillStyle = TRUTH;
        const side = Math.max(larger, (3 * canvas.width) / 960); // a single pixel is to be seen, too
        for (let y = 0; y < height; y++)
          for (let x = 0; x < width; x++) if (inside(x, y)) context.fillRect(x * larger, y * larger, side, side);
      }
      if (cross) {
        const [x, y] = cross.map((one) => (one + 0.5) * larger);
        for (const [colour, thick] of [["#fff", 9], [YOURS, 5]]) {
          context.strokeStyle = colour;
          context.lineWidth = (thick * canvas.width) / 960;
          context.strokeRect(x - canvas.width / 40, y - canvas.width / 40, canvas.width / 20, canvas.width / 20);
        }
      }
      const drawn = cross ? `, your mark at x ${cross[0]}, y ${cross[1]}` : "";
      canvas.setAttribute("aria-label", `${model.get("alts")[0]}${drawn}${truth ? ", the true pixels orange" : ""}`);
    }

    function mark(x, y, aloud) {
      if (closed) return;
      cross = [clamp(Math.floor(x), 0, width - 1), clamp(Math.floor(y), 0, height - 1)];
      paint();
      tell(`x ${cross[0]}, y ${cross[1]}`, aloud);
    }

    frame.addEventListener("pointerdown", (event) => {
      const [across, down] = place(event, canvas);
      mark(across * width, down * height, false);
    });
    frame.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (!step) return;
      event.preventDefault();
      const far = event.shiftKey ? 20 : 1;
      const [x, y] = cross ?? [width / 2, height / 2];
      mark(x + far * step[0], y + far * step[1], true);
    });
    paint();

    return {
      read: () => cross,
      show(answer) {
        cross = answer;
        paint();
      },
      reveal() {
        closed = true;
        paint(true);
      },
      compare([x, y]) {
        let nearest = Infinity;
        for (let v = 0; v < height; v++)
          for (let u = 0; u < width; u++) if (inside(u, v)) nearest = Math.min(nearest, Math.hypot(u - x, v - y));
        return [nearest <= (NEAR * width) / 2, nearest < 1 ? "Yes" : `You were ${digits(nearest)} pixels away`];
      },
    };
  },
};

async function render({ model, el }) {
  const root = start(el, "predict");
  element(root, "p", { className: "hdrlab-question", textContent: model.get("question") });
  const answers = await KINDS[model.get("kind")](root, model);
  const controls = element(root, "div", { className: "hdrlab-controls" });
  const say = element(controls, "button", { type: "button", textContent: "Show" });
  const skip = element(controls, "button", { type: "button", textContent: "Skip", className: "hdrlab-plain" });
  const note = element(root, "p", { className: "hdrlab-note", role: "status" });

  function reveal() {
    const answer = model.get("given");
    answers.reveal(answer);
    [say, skip].forEach((button) => button.remove());
    const told = [`The truth: ${model.get("told") || "what is orange."}`, model.get("because")];
    if (answer !== null) {
      const [near, words] = answers.compare(answer);
      const tally = tallyOf(el);
      tally.set(model.get("question"), near);
      const good = [...tally.values()].filter(Boolean).length;
      told.unshift(`${words}.`);
      told.push(`On this page so far: ${good} of ${tally.size} near.`);
    }
    note.textContent = told.filter(Boolean).join(" ");
  }

  function keep(answer) {
    model.set("given", answer);
    model.set("done", true);
    model.save_changes();
    reveal();
  }

  say.addEventListener("click", () => {
    const answer = answers.read();
    if (answer === null) note.textContent = "First your answer, or skip it.";
    else keep(answer);
  });
  skip.addEventListener("click", () => keep(null));
  if (model.get("done")) {
    if (model.get("given") !== null) answers.show(model.get("given"));
    reveal();
  }
}

export default { render };
