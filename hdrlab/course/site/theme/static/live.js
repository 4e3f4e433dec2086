// The widgets of a page, with no kernel: each is opened when it comes near the screen.
// A page from a folder may load scripts but read no files, so a widget's file is a script that calls `take`.
(() => {
  const places = new Map();
  const codes = new Map(); // of each kind of widget, its module

  // Bytes as `live.write_widget` packed them, fifteen bits a letter, or as base64 on a page that contains its widgets.
  function bytesOf({ base64, letters, length }) {
    if (base64 !== undefined) return new DataView(Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)).buffer);
    const bytes = new Uint8Array(length);
    for (let [k, at, bits, held] = [0, 0, 0, 0]; k < length; k++) {
      if (held < 8) [bits, held] = [((bits & 255) << 15) | (letters.charCodeAt(at++) - 0x3000), held + 15];
      bytes[k] = bits >> (held -= 8);
    }
    return new DataView(bytes.buffer);
  }

  // `shown` is the picture that stands on the page.
  const unpack = (value, shown) => {
    if (Array.isArray(value)) return value.map((each) => unpack(each, shown));
    if (value?.shown) return shown;
    return value?.letters === undefined && value?.base64 === undefined ? value : bytesOf(value);
  };

  // The browser's own memory. Where it keeps nothing for a file, what is remembered holds for this page alone.
  const recall = (key) => {
    try {
      return localStorage.getItem(key);
    } catch {
      return null;
    }
  };
  const remember = (key, value) => {
    try {
      localStorage.setItem(key, value);
    } catch {}
  };

  // The answer to a question survives a reload, as long as it is the same question.
  const keyOf = (name) => `hdrlab-answer:${name}`;
  const answerTo = ({ name, asks }) => {
    const kept = JSON.parse(recall(keyOf(name)) ?? "{}");
    return kept.question === asks ? kept : {};
  };

  // A question covers the marked cells after it, up to the next question.
  const questions = new Map([...document.querySelectorAll(".live[data-asks]")].map((place) => [place, []]));
  let asking = null;
  for (const part of document.querySelectorAll(".live[data-asks], .tag_covered, details.covered"))
    if (questions.has(part)) asking = part;
    else questions.get(asking)?.push(part);
  const uncover = (place) => questions.get(place)?.forEach((part) => part.classList.remove("tag_covered", "covered"));
  for (const place of questions.keys()) if (answerTo(place.dataset).done) uncover(place);

  // What a widget's script asks of its model: values, and who is told when one changes.
  function modelOf(state, place) {
    const listeners = {};
    const { name, asks } = place.dataset;
    if (asks) Object.assign(state, answerTo(place.dataset));
    return {
      get: (name) => state[name],
      set: (name, value) => {
        state[name] = value;
        for (const listener of listeners[`change:${name}`] ?? []) listener();
      },
      save_changes() {
        if (!asks || !state.done) return;
        remember(keyOf(name), JSON.stringify({ question: asks, given: state.given, done: true }));
        uncover(place);
        again.hidden = false;
      },
      on: (name, listener) => (listeners[name] ??= []).push(listener),
      off: (name, listener) => (listeners[name] = (listeners[name] ?? []).filter((one) => one !== listener)),
    };
  }

  function learn(code, { script, style }) {
    document.head.append(Object.assign(document.createElement("style"), { textContent: style }));
    codes.set(code, import(URL.createObjectURL(new Blob([script], { type: "text/javascript" }))));
  }

  const frame = () => new Promise(requestAnimationFrame);

  async function open(place, { code, state }) {
    const { default: widget } = await codes.get(code);
    const el = document.createElement("div");
    const shown = place.querySelector("img"); // a question may have none
    if (shown) shown.loading = "eager";
    await shown?.decode();
    el.toggleAttribute("data-ink", shown?.hasAttribute("data-ink") ?? false); // and so is what is drawn in its place
    const values = Object.fromEntries(Object.entries(state).map(([name, value]) => [name, unpack(value, shown)]));
    await widget.render({ model: modelOf(values, place), el });
    const notice = el.querySelector(".hdrlab-cover");
    if (notice) notice.hidden = !questions.get(place)?.length;
    const waiting = () => el.querySelector("canvas")?.getAttribute("aria-label") === "";
    for (let k = 0; k < 120 && waiting(); k++) await frame();
    place.replaceChildren(el); // the picture that stood here until now is what the canvas begins with
    place.dataset.state = "open";
  }

  const root = document.documentElement.dataset.content_root; // a page by itself has none
  window.hdrlab = {
    running: root === undefined ? undefined : `${root}installing.html`,
    take(name, content) {
      if (content.script) learn(name, content);
      for (const place of places.get(name) ?? [])
        open(place, content).catch((error) => {
          place.dataset.state = "failed";
          uncover(place);
          console.error(error);
        });
    },
  };

  // What is loaded runs in this order: a widget after the code of its kind. A page by itself contains the scripts.
  const asked = new Set();
  function load(src) {
    const contained = document.getElementById(src);
    const what = contained ? { textContent: contained.textContent } : { src, async: false };
    if (!asked.has(src)) document.head.append(Object.assign(document.createElement("script"), what));
    asked.add(src);
  }

  const near = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
      if (!isIntersecting) continue;
      near.unobserve(target);
      const { name, code, from } = target.dataset;
      places.set(name, [...(places.get(name) ?? []), target]);
      [code, from].forEach(load);
    }
  }, { rootMargin: "600px 0px" });

  // What is wider than the page is scrolled, so the keyboard must reach it.
  function reach() {
    for (const each of document.querySelectorAll("pre, table, div.math"))
      if (each.scrollWidth > each.clientWidth) each.tabIndex = 0;
      else each.removeAttribute("tabindex");
  }

  // A button that copies a cell; what stands behind a prompt is copied without it.
  function copyable(block) {
    const code = block.querySelector("pre");
    const button = Object.assign(document.createElement("button"), { className: "copy", textContent: "Copy" });
    button.addEventListener("click", async () => {
      const lines = code.textContent.trimEnd().split("\n");
      const asked = lines.filter((line) => /^(>>>|\.\.\.)( |$)/.test(line)).map((line) => line.slice(4));
      await navigator.clipboard.writeText((asked.length ? asked : lines).join("\n"));
      button.textContent = "Copied";
      setTimeout(() => (button.textContent = "Copy"), 2000);
    });
    block.append(button);
  }

  // A button below the title. One that switches remembers how it is, for this page and the next.
  const buttons = Object.assign(document.createElement("div"), { className: "switches" });
  function button(textContent, action) {
    const made = Object.assign(document.createElement("button"), { className: "codes", textContent });
    made.addEventListener("click", action);
    buttons.append(made);
    return made;
  }
  function switchable(key, [off, on], set) {
    let open = recall(key) === on.value;
    const apply = () => {
      made.textContent = (open ? on : off).label;
      set(open);
    };
    const made = button("", () => {
      open = !open;
      remember(key, (open ? on : off).value);
      apply();
    });
    apply();
  }

  // Cells that only draw are folded; a switch opens all of them.
  const folds = document.querySelectorAll("main details.hide");
  if (folds.length) {
    const labels = [{ label: "Show all code", value: "folded" }, { label: "Fold the code of pictures", value: "open" }];
    switchable("hdrlab-code", labels, (open) => {
      folds.forEach((fold) => (fold.open = open));
      if (open) reach();
    });
    for (const fold of folds) fold.querySelector("summary").removeAttribute("aria-label"); // its text says more
  }

  // Another switch shows what the questions cover.
  let again = null;
  if (questions.size) {
    const labels = [{ label: "Show all answers", value: "covered" }, { label: "Cover the answers", value: "shown" }];
    switchable("hdrlab-answers", labels, (shown) => {
      document.documentElement.classList.toggle("answers", shown);
      if (shown) reach();
    });
    again = button("Ask me again", () => {
      for (const { dataset } of questions.keys()) localStorage.removeItem(keyOf(dataset.name));
      location.reload();
    });
    again.hidden = ![...questions.keys()].some(({ dataset }) => answerTo(dataset).done);
  }
  if (buttons.childElementCount) document.querySelector("main h1").after(buttons);

  // On paper an answer cannot be opened, so all are; afterwards they are as they were.
  const closed = () => document.querySelectorAll("main details:not(.hide):not([open])");
  let opened = [];
  addEventListener("beforeprint", () => (opened = [...closed()]).forEach((each) => (each.open = true)));
  addEventListener("afterprint", () => opened.forEach((each) => (each.open = false)));

  if (navigator.clipboard)
    document.querySelectorAll("main .highlight:not(.cell_output *)").forEach(copyable);
  document.querySelectorAll(".live").forEach((place) => near.observe(place));
  reach();
  addEventListener("resize", reach);
})();
