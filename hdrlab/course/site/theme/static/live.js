// The pages of the site and the slides: open widgets without a kernel when they come near to the
// window, cover the results that a question asks for, and add the buttons of a page.
//
// A page that is opened from a folder may load scripts, but it may not read files. So the code and
// the state of a widget are scripts that call `hdrlab.take` (live.py).
(() => {
  const ANSWER_PREFIX = "hdrlab-answer:"; // keys in localStorage
  const ANSWERS_KEY = "hdrlab-answers";
  const CODE_KEY = "hdrlab-code";
  const LETTER_BASE = 0x3000; // the letter that stands for 15 bits of 0
  const BITS_PER_LETTER = 15;
  const LOADING_DISTANCE = "600px 0px"; // from the window, at which a widget is loaded
  const MAX_WAITING_FRAMES = 120; // of the display, until a widget shows its first image
  const COPIED_TIME = 2000; // ms
  const PROMPT = /^(>>>|\.\.\.)( |$)/;

  const createElement = (tag, properties) => Object.assign(document.createElement(tag), properties);

  // Read and write localStorage. Without it, for example for a file, a choice holds for this page.
  function readSetting(key) {
    try {
      return localStorage.getItem(key);
    } catch {
      return null;
    }
  }
  function writeSetting(key, value) {
    try {
      localStorage.setItem(key, value);
    } catch {
      // This browser stores nothing.
    }
  }

  // ---- The state of a widget

  // Decode the bytes of a state: 15 bits a letter, as `live.write_widget` packs them, or base64 on
  // a page that contains its widgets.
  function decodeBytes({ base64, letters, length }) {
    if (base64 !== undefined) {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      return new DataView(bytes.buffer);
    }
    const bytes = new Uint8Array(length);
    let position = 0; // of the next letter
    let bits = 0; // of the letters so far, of which bitCount are not used yet
    let bitCount = 0;
    for (let k = 0; k < length; k++) {
      if (bitCount < 8) {
        const nextBits = letters.charCodeAt(position) - LETTER_BASE;
        bits = ((bits & 255) << BITS_PER_LETTER) | nextBits;
        bitCount += BITS_PER_LETTER;
        position += 1;
      }
      bitCount -= 8;
      bytes[k] = bits >> bitCount;
    }
    return new DataView(bytes.buffer);
  }

  // Decode a value of a state. `image` is the <img> on the page, which replaces the first image.
  function decodeValue(value, image) {
    if (Array.isArray(value)) return value.map((item) => decodeValue(item, image));
    if (value?.shown) return image;
    const isBytes = value?.letters !== undefined || value?.base64 !== undefined;
    return isBytes ? decodeBytes(value) : value;
  }

  // ---- Questions, and the cells that they cover

  const answerKey = (name) => `${ANSWER_PREFIX}${name}`;

  // The stored answer to a question, unless the question has changed.
  function storedAnswer({ name, asks }) {
    const stored = JSON.parse(readSetting(answerKey(name)) ?? "{}");
    return stored.question === asks ? stored : {};
  }

  // From each question to the cells that it covers: those after it, up to the next question.
  function findQuestions() {
    const questions = new Map();
    let current = null;
    const selector = ".live[data-asks], .tag_covered, details.covered";
    for (const part of document.querySelectorAll(selector)) {
      if (part.matches(".live[data-asks]")) {
        current = part;
        questions.set(part, []);
      } else if (current) {
        questions.get(current).push(part);
      }
    }
    return questions;
  }

  const questions = findQuestions();
  let resetButton = null; // "Ask me again"

  function uncover(place) {
    for (const part of questions.get(place) ?? []) part.classList.remove("tag_covered", "covered");
  }

  for (const place of questions.keys()) {
    if (storedAnswer(place.dataset).done) uncover(place);
  }

  // ---- Widgets

  const placesByName = new Map(); // where each widget is shown
  const modules = new Map(); // promises of the modules, by the name of their code

  // The model of a widget, as anywidget gives it to a script, but without Python.
  function createModel(state, place) {
    const { name, asks } = place.dataset;
    const listeners = {};
    const listenersOf = (event) => listeners[event] ?? [];
    if (asks) Object.assign(state, storedAnswer(place.dataset));
    return {
      get: (trait) => state[trait],
      set(trait, value) {
        state[trait] = value;
        for (const listener of listenersOf(`change:${trait}`)) listener();
      },
      // Store the answer to a question, and uncover what follows it.
      save_changes() {
        if (!asks || !state.done) return;
        const answer = { question: asks, given: state.given, done: true };
        writeSetting(answerKey(name), JSON.stringify(answer));
        uncover(place);
        resetButton.hidden = false;
      },
      on(event, listener) {
        listeners[event] = [...listenersOf(event), listener];
      },
      off(event, listener) {
        listeners[event] = listenersOf(event).filter((other) => other !== listener);
      },
    };
  }

  function addCode(name, { script, style }) {
    document.head.append(createElement("style", { textContent: style }));
    const blob = new Blob([script], { type: "text/javascript" });
    modules.set(name, import(URL.createObjectURL(blob)));
  }

  const nextFrame = () => new Promise(requestAnimationFrame);

  // Wait until the widget has painted its first image, which gives the canvas its description.
  async function waitForImage(el) {
    for (let k = 0; k < MAX_WAITING_FRAMES; k++) {
      if (el.querySelector("canvas")?.getAttribute("aria-label") !== "") return;
      await nextFrame();
    }
  }

  // Replace the image on the page with the widget.
  async function openWidget(place, { code, state }) {
    const { default: widget } = await modules.get(code);
    const el = document.createElement("div");
    const image = place.querySelector("img"); // a question may have none
    if (image) {
      image.loading = "eager";
      await image.decode();
    }
    // If the image is ink on white paper, the canvas is as well.
    el.toggleAttribute("data-ink", image?.hasAttribute("data-ink") ?? false);
    const decoded = Object.entries(state).map(([name, value]) => [name, decodeValue(value, image)]);
    await widget.render({ model: createModel(Object.fromEntries(decoded), place), el });
    const notice = el.querySelector(".hdrlab-cover");
    if (notice) notice.hidden = !questions.get(place)?.length;
    await waitForImage(el);
    place.replaceChildren(el);
    place.dataset.state = "open";
  }

  function reportFailure(place, error) {
    place.dataset.state = "failed";
    uncover(place);
    console.error(error);
  }

  const root = document.documentElement.dataset.content_root; // a single page has none
  window.hdrlab = {
    running: root === undefined ? undefined : `${root}installing.html`,
    // Take the code of a kind of widgets, or the state of one widget.
    take(name, content) {
      if (content.script) addCode(name, content);
      for (const place of placesByName.get(name) ?? []) {
        openWidget(place, content).catch((error) => reportFailure(place, error));
      }
    },
  };

  // Load a script once. A single page contains its scripts as text, in elements with their names.
  // Scripts run in the order of their loading: the code before the state of a widget.
  const loaded = new Set();
  function loadScript(src) {
    if (loaded.has(src)) return;
    loaded.add(src);
    const contained = document.getElementById(src);
    const source = contained ? { textContent: contained.textContent } : { src, async: false };
    document.head.append(createElement("script", source));
  }

  function loadWidget(place) {
    const { name, code, from } = place.dataset;
    placesByName.set(name, [...(placesByName.get(name) ?? []), place]);
    loadScript(code);
    loadScript(from);
  }

  const approachObserver = new IntersectionObserver(
    (entries) => {
      for (const { isIntersecting, target } of entries) {
        if (!isIntersecting) continue;
        approachObserver.unobserve(target);
        loadWidget(target);
      }
    },
    { rootMargin: LOADING_DISTANCE },
  );

  // ---- The rest of a page

  // Let the keyboard reach what is wider than the page, so that it can be scrolled.
  function makeWidePartsFocusable() {
    for (const part of document.querySelectorAll("pre, table, div.math")) {
      if (part.scrollWidth > part.clientWidth) part.tabIndex = 0;
      else part.removeAttribute("tabindex");
    }
  }

  // Return the code of a cell to copy. In a session with prompts, return only what stands behind them.
  function codeToCopy(code) {
    const lines = code.textContent.trimEnd().split("\n");
    const prompted = lines.filter((line) => PROMPT.test(line)).map((line) => line.slice(4));
    return (prompted.length ? prompted : lines).join("\n");
  }

  function addCopyButton(block) {
    const code = block.querySelector("pre");
    const button = createElement("button", { className: "copy", textContent: "Copy" });
    button.addEventListener("click", async () => {
      await navigator.clipboard.writeText(codeToCopy(code));
      button.textContent = "Copied";
      setTimeout(() => {
        button.textContent = "Copy";
      }, COPIED_TIME);
    });
    block.append(button);
  }

  // Add a button below the title.
  const buttonRow = createElement("div", { className: "switches" });
  function addButton(textContent, action) {
    const button = createElement("button", { className: "codes", textContent });
    button.addEventListener("click", action);
    buttonRow.append(button);
    return button;
  }

  // Add a button that turns something on and off, and stores this for all pages. `off` and `on` are
  // { label, value }: the label of the button in this state, and the value that is stored.
  function addSwitch(key, { off, on, apply }) {
    let isOn = readSetting(key) === on.value;
    const update = () => {
      button.textContent = isOn ? on.label : off.label;
      apply(isOn);
    };
    const button = addButton("", () => {
      isOn = !isOn;
      writeSetting(key, isOn ? on.value : off.value);
      update();
    });
    update();
  }

  // Cells that only draw are folded; a switch opens all of them.
  function addFoldSwitch() {
    const folds = document.querySelectorAll("main details.hide");
    if (folds.length === 0) return;
    addSwitch(CODE_KEY, {
      off: { label: "Show all code", value: "folded" },
      on: { label: "Fold the code of pictures", value: "open" },
      apply(isOpen) {
        for (const fold of folds) fold.open = isOpen;
        if (isOpen) makeWidePartsFocusable();
      },
    });
    // The text of the summary says more than the label that Sphinx gives it.
    for (const fold of folds) fold.querySelector("summary").removeAttribute("aria-label");
  }

  // Add a switch that uncovers all answers, and a button that forgets those of the reader.
  function addAnswerButtons() {
    if (questions.size === 0) return;
    addSwitch(ANSWERS_KEY, {
      off: { label: "Show all answers", value: "covered" },
      on: { label: "Cover the answers", value: "shown" },
      apply(isShown) {
        document.documentElement.classList.toggle("answers", isShown);
        if (isShown) makeWidePartsFocusable();
      },
    });
    const places = [...questions.keys()];
    resetButton = addButton("Ask me again", () => {
      for (const { dataset } of places) localStorage.removeItem(answerKey(dataset.name));
      location.reload();
    });
    resetButton.hidden = !places.some(({ dataset }) => storedAnswer(dataset).done);
  }

  // On paper nobody can open an answer: open all of them, and close them again after printing.
  let openedForPrint = [];
  addEventListener("beforeprint", () => {
    const closed = document.querySelectorAll("main details:not(.hide):not([open])");
    openedForPrint = [...closed];
    for (const answer of openedForPrint) answer.open = true;
  });
  addEventListener("afterprint", () => {
    for (const answer of openedForPrint) answer.open = false;
  });

  addFoldSwitch();
  addAnswerButtons();
  if (buttonRow.childElementCount) document.querySelector("main h1").after(buttonRow);
  if (navigator.clipboard) {
    const blocks = document.querySelectorAll("main .highlight:not(.cell_output *)");
    blocks.forEach(addCopyButton);
  }
  for (const place of document.querySelectorAll(".live")) approachObserver.observe(place);
  makeWidePartsFocusable();
  addEventListener("resize", makeWidePartsFocusable);
})();
