// A question that takes the answer before the picture comes: a choice, a number, a curve, a place in a picture.
// Then the truth is laid over the answer. The answer is kept in the notebook's own state, and nowhere else.

const [YOURS, TRUTH] = ["#0063a0", "#d55e00"];
const NEAR = 0.1; // of the scale: an answer this near counts
const HANDLES = 17; // of a curve: the keys move one after the other, a drag all that it passes

const digits = (value) => `${Number(value.toPrecision(3))}`;

// A question covers what follows it until the reader answers: in JupyterLab and Notebook the outputs of the next
// cells, up to and including the first answer that unfolds; a heading, another question or the end comes before it.
// The site does the same when a page is built. Where neither is the page around the widget, nothing is covered.
const SWITCH = "hdrlab-answers"; // in the browser's own memory: "shown" uncovers everything
const RECOUNT_DELAY = 100; // ms from a change of the notebook until its covers are counted again
const ASKS = /^(Predict|Think)\.$/; // in bold: how a question in the text begins

function allShown() {
  try {
    return localStorage.getItem(SWITCH) === "shown";
  } catch {
    return false; // a browser that remembers nothing
  }
}

function showAll(shown) {
  try {
    localStorage.setItem(SWITCH, shown ? "shown" : "covered");
  } catch {} // then the switch holds until the page is closed
  globalThis.dispatchEvent(new CustomEvent(SWITCH, { detail: shown }));
}

// Whether a cell of text is the answer, ends what a question covers ("end"), or stands between ("text").
function kindOfText(cell) {
  const rendered = cell.querySelector(".jp-RenderedMarkdown");
  if (!rendered?.childElementCount) return "end"; // not drawn yet: it is looked at again when it is
  for (const part of rendered.children) {
    if (part.tagName === "DETAILS") return "answer";
    const bold = [...part.querySelectorAll("strong")];
    if (/^H[1-6]$/.test(part.tagName) || bold.some(({ textContent }) => ASKS.test(textContent))) return "end";
  }
  return "text";
}

// Cover and uncover all cells of a notebook.
function coverCells(notebook, shown) {
  let question = null;
  let count = 0;
  const finish = () => {
    const notice = question?.querySelector(".hdrlab-cover");
    if (notice) notice.hidden = shown || count === 0;
    [question, count] = [null, 0];
  };
  for (const cell of notebook.querySelectorAll(".jp-Cell")) {
    const asking = cell.querySelector('.hdrlab[data-kind="predict"]');
    const text = cell.classList.contains("jp-MarkdownCell") ? kindOfText(cell) : "";
    if (asking || text === "end") finish();
    const covered = question !== null && text !== "text";
    cell.classList.toggle("hdrlab-covered", covered && !shown);
    if (covered) count += 1;
    if (text === "answer") finish();
    if (asking && !asking.dataset.done) question = asking;
  }
  finish();
}

// Keep a notebook's covers right while its cells are run, rendered, moved and answered.
function watch(el) {
  const notebook = el.closest(".jp-Notebook");
  if (!notebook) return () => {};
  const watched = (globalThis.hdrlabCovers ??= new WeakMap());
  if (!watched.has(notebook)) {
    let [waiting, shown] = [0, allShown()];
    const count = () => {
      waiting = 0;
      coverCells(notebook, shown);
    };
    new MutationObserver(() => (waiting ||= setTimeout(count, RECOUNT_DELAY))).observe(notebook, { childList: true, subtree: true });
    globalThis.addEventListener(SWITCH, ({ detail }) => {
      shown = detail;
      count();
    });
    watched.set(notebook, count);
  }
  watched.get(notebook)();
  return watched.get(notebook);
}

// How the answers on a page (in JupyterLab: in a notebook) went so far: question to whether it was near.
function tallyOf(el) {
  const page = el.closest(".jp-NotebookPanel") ?? document;
  const tallies = (globalThis.hdrlabTallies ??= new WeakMap());
  if (!tallies.has(page)) tallies.set(page, new Map());
  return tallies.get(page);
}

const PARTS = ["on the left", "in the middle", "on the right"];
const SAME_SLOPE = 0.35; // of the steepest part's slope: a smaller difference is right
const [FLAT, STEEP] = [0.25, 0.75]; // of the steepest part's slope

// The height at x of a curve through some points: straight between them, level beyond them.
function heightAt(points, x) {
  const after = points.findIndex(([at]) => at >= x);
  if (after <= 0) return points[after < 0 ? points.length - 1 : 0][1];
  const [[x0, y0], [x1, y1]] = [points[after - 1], points[after]];
  return y0 + ((y1 - y0) * (x - x0)) / (x1 - x0);
}

// Compare the slopes of a drawn curve and the true one, a third of the axis at a time: wherever the curve stands.
function compareShape(mine, truth, left, right) {
  const edges = [0, 1, 2, 3].map((k) => left + ((right - left) * k) / PARTS.length);
  const rises = (curve) => PARTS.map((_, k) => curve(edges[k + 1]) - curve(edges[k]));
  const [drawn, wanted] = [rises(mine), rises(truth)];
  const steepest = Math.max(...wanted.map(Math.abs)) || 1;
  const words = (rise) => {
    if (Math.abs(rise) < FLAT * steepest) return "nearly flat";
    const way = rise > 0 ? "rising" : "falling";
    return Math.abs(rise) > STEEP * steepest ? `${way} steeply` : way;
  };
  return PARTS.map((part, k) => {
    const isRight = Math.abs(drawn[k] - wanted[k]) <= SAME_SLOPE * steepest;
    const than = Math.abs(drawn[k]) > Math.abs(wanted[k]) ? "steeper" : "flatter";
    const yours = words(drawn[k]) === words(wanted[k]) ? than : words(drawn[k]);
    return { isRight, words: `${part} ${words(wanted[k])}: ${isRight ? "yes" : `yours is ${yours}`}` };
  });
}

// Each kind adds its controls, and returns: read() the answer or null, show(answer) it, reveal(answer) the truth
// over it, and compare(answer): [whether it is near, in words how far].
const KINDS = {
  choice(root, model) {
    const [labels, truth, pictures] = [model.get("labels"), model.get("truth"), model.get("pictures")];
    const { buttons, position, show } = radioRow(root, model.get("question"), labels);
    pictures.forEach((bytes, k) => {
      const { line } = buttons[k];
      line.classList.add("hdrlab-card");
      picture(line).show(decode(bytes, "image/webp"), model.get("alts")[k]);
    });
    const read = () => (position() < 0 ? null : position());
    return {
      read,
      show,
      reveal: () =>
        buttons.forEach(({ line, input, words }, k) => {
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
    const [ticks, marks] = [model.get("ticks"), model.get("marks")];
    element(root, "div", { className: "hdrlab-axis", textContent: `↑ ${up}` });
    const help = `${up} over ${across}: arrow keys left and right choose a point of your curve, up and down move it`;
    const { frame, canvas, context } = stage(root, help);
    const shown = clamp(innerWidth - 48, 280, 640); // pixels of the page; the canvas has twice as many, for sharp lines
    [canvas.width, canvas.height] = [2 * shown, Math.round(2 * shown * (shown < SMALL ? 0.8 : 0.6))];
    canvas.style.width = `${shown}px`;
    canvas.toggleAttribute("data-ink", true);
    element(root, "div", { className: "hdrlab-axis", textContent: `→ ${across}` });
    const tell = teller(root);
    const mine = new Array(HANDLES).fill(null);
    let [at, closed, last] = [0, false, null];

    // The field of the curve in the canvas; the numbers of the axes stand around it.
    const field = { left: 96, top: 24, width: canvas.width - 96 - 32, height: canvas.height - 24 - 56 };
    const point = ([x, y]) => [
      field.left + ((x - left) / (right - left)) * field.width,
      field.top + (1 - (y - low) / (high - low)) * field.height,
    ];
    const position = (k) => left + ((right - left) * k) / (HANDLES - 1);
    const level = (y) => clamp(low + (high - low) * (1 - y), low, high);
    const known = () => mine.map((y, k) => [position(k), y]).filter(([, y]) => y !== null);

    function line(points, colour, dashes, width = 6) {
      context.strokeStyle = colour;
      context.lineWidth = width;
      context.setLineDash(dashes);
      context.beginPath();
      points.map(point).forEach(([x, y]) => context.lineTo(x, y));
      context.stroke();
      context.setLineDash([]);
    }

    function paintAxes() {
      context.font = "26px system-ui, sans-serif";
      context.fillStyle = "#444";
      for (const x of ticks[0]) {
        line([[x, low], [x, high]], "#d8d8d8", [], 2);
        context.textAlign = "center";
        context.fillText(digits(x), point([x, low])[0], field.top + field.height + 36);
      }
      for (const y of ticks[1]) {
        line([[left, y], [right, y]], "#d8d8d8", [], 2);
        context.textAlign = "right";
        context.fillText(digits(y), field.left - 12, point([left, y])[1] + 9);
      }
      for (const { axis, value, name } of marks) {
        line(axis === "x" ? [[value, low], [value, high]] : [[left, value], [right, value]], "#767676", [4, 6], 3);
        const [x, y] = point(axis === "x" ? [value, high] : [left, value]);
        context.textAlign = "left";
        context.fillText(name, x + 8, axis === "x" ? y + 26 : y - 8);
      }
      context.strokeStyle = "#767676";
      context.lineWidth = 2;
      context.strokeRect(field.left, field.top, field.width, field.height);
    }

    function paint(truth = false) {
      context.fillStyle = "#fff";
      context.fillRect(0, 0, canvas.width, canvas.height);
      paintAxes();
      line(known(), YOURS, [18, 12]);
      context.fillStyle = YOURS;
      for (const one of known().map(point)) context.fillRect(one[0] - 7, one[1] - 7, 14, 14);
      if (truth) line(xs.map((x, k) => [x, ys[k]]), TRUTH, []);
      const drawn = known().length ? "with your curve, dashed" : "empty";
      canvas.setAttribute("aria-label", `${model.get("alts")[0]}, ${drawn}${truth ? ", and the true one" : ""}`);
    }

    function draw(event) {
      if (closed || (event.type === "pointermove" && last === null)) return;
      const [across, down] = place(event, canvas);
      const x = (across * canvas.width - field.left) / field.width;
      const y = (down * canvas.height - field.top) / field.height;
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
        const drawn = answer.map((y, k) => [position(k), y]).filter(([, y]) => y !== null);
        const [mine, truth] = [drawn, xs.map((x, k) => [x, ys[k]])].map((points) => (x) => heightAt(points, x));
        const parts = compareShape(mine, truth, left, right);
        const good = parts.filter(({ isRight }) => isRight).length;
        const shape = parts.map(({ words }) => words).join("; ");
        const places = Array.from({ length: 4 * HANDLES }, (_, k) => left + ((right - left) * k) / (4 * HANDLES - 1));
        const away = places.map((x) => mine(x) - truth(x));
        const mean = away.reduce((sum, one) => sum + one, 0) / away.length;
        const worst = away.reduce((best, one, k) => (Math.abs(one) > Math.abs(away[best]) ? k : best), 0);
        const side = (value) => `${digits(Math.abs(value))} too ${value > 0 ? "high" : "low"}`;
        const near = Math.abs(mean) <= NEAR * (high - low);
        const where = `${near ? "near" : "off"}, on average ${side(mean)}, most at ${digits(places[worst])}: ${side(away[worst])}`;
        return [near && good === parts.length, `Shape, ${good} of ${parts.length} parts: ${shape}. Position (${up}): ${where}`];
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

// The switch that uncovers everything, for those who teach; the browser remembers it.
function addSwitch(controls) {
  const line = element(controls, "label", { className: "hdrlab-all" });
  const box = element(line, "input", { type: "checkbox", checked: allShown() });
  element(line, "span", { textContent: "Show all answers" });
  box.addEventListener("change", () => showAll(box.checked));
  globalThis.addEventListener(SWITCH, ({ detail }) => (box.checked = detail));
  return line;
}

async function render({ model, el }) {
  const root = start(el, "predict");
  element(root, "p", { className: "hdrlab-question", textContent: model.get("question") });
  const answers = await KINDS[model.get("kind")](root, model);
  const controls = element(root, "div", { className: "hdrlab-controls" });
  const check = element(controls, "button", { type: "button", textContent: "Check my answer" });
  const show = element(controls, "button", { type: "button", textContent: "Show", className: "hdrlab-plain" });
  const all = addSwitch(controls);
  const note = element(root, "p", { className: "hdrlab-note", role: "status" });
  const cover = element(root, "p", { className: "hdrlab-cover", textContent: "What follows is covered until you answer or press Show." });
  cover.hidden = true;
  let recount = () => {};

  function reveal() {
    const answer = model.get("given");
    const hadFocus = controls.contains(document.activeElement);
    answers.reveal(answer);
    [check, show, all, cover].forEach((part) => part.remove());
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
    if (hadFocus) {
      note.tabIndex = -1; // the button is gone: the next Tab leads on from here
      note.focus();
    }
    root.dataset.done = "true";
    recount();
  }

  function keep(answer) {
    model.set("given", answer);
    model.set("done", true);
    model.save_changes();
    reveal();
  }

  check.addEventListener("click", () => {
    const answer = answers.read();
    if (answer === null) note.textContent = "Give an answer first, or press Show.";
    else keep(answer);
  });
  show.addEventListener("click", () => keep(null));
  if (model.get("done")) {
    if (model.get("given") !== null) answers.show(model.get("given"));
    reveal();
  }
  // The widget may stand in the page only after this: JupyterLab attaches it later.
  requestAnimationFrame(() => (recount = watch(el)));
}

export default { render };
