// `widgets.predict`: a question that the reader answers before the result is shown: a choice, a
// number on a scale or typed, a curve or a place in an image. Then the widget shows the truth over the answer. The
// answer stays in the notebook and is sent nowhere.
//
// Python sends
//   kind      choice, number, entry, curve or place
//   question  the question
//   code      lines of Python that the question is about, or ""
//   covers    whether it covers the cells that follow, and counts on the page
//   truth     the true answer
//   told      the true answer in words, "" for a place
//   because   the explanation
//   labels, scale, unit, ticks, marks, pictures, alts  see the kinds of questions
// and the widget sends
//   given     the reader's answer, or null if the reader asked for the truth
//   done      true once the truth is shown

// A choice. `labels` are the answers, and `truth` is the position of the right one. `pictures` is
// empty, or holds an image for each label, with its alternative text in `alts`.
function createChoiceQuestion(root, model) {
  const labels = model.get("labels");
  const alts = model.get("alts");
  const truth = model.get("truth");
  const { buttons, position, show } = addRadioRow(root, model.get("question"), labels);
  model.get("pictures").forEach((bytes, k) => {
    const { line } = buttons[k];
    line.classList.add("hdrlab-card");
    addPicture(line).show(decodeImage(bytes, "image/webp"), alts[k]);
  });
  return {
    read: () => (position() < 0 ? null : position()),
    show,
    reveal() {
      for (const { input } of buttons) input.disabled = true;
      const { line, caption } = buttons[truth];
      line.classList.add("hdrlab-true");
      caption.textContent = `✓ ${labels[truth]}`;
    },
    compare(answer) {
      const isRight = answer === truth;
      return { isNear: isRight, words: isRight ? "Yes" : `You said: ${labels[answer]}` };
    },
  };
}

// A number. `scale` is low, high and step of the slider; `unit` may be "".
function createNumberQuestion(root, model) {
  const [low, high, step] = model.get("scale");
  const truth = model.get("truth");
  const unit = model.get("unit") ? ` ${model.get("unit")}` : "";
  const count = Math.round((high - low) / step) + 1;
  const positionOf = (number) => Math.round((number - low) / step);
  const textOf = (number) => `${threeDigits(number)}${unit}`;
  const rows = addElement(root, "div", { className: "hdrlab-rows" });
  const slider = addSlider(rows, "your answer", count);
  const currentNumber = () => low + step * slider.position();
  let isMoved = false; // whether the reader moved the slider
  slider.show(Math.floor(count / 2), "");
  slider.input.setAttribute("aria-valuetext", "no answer yet");
  slider.input.addEventListener("input", () => {
    isMoved = true;
    slider.show(slider.position(), textOf(currentNumber()));
  });
  return {
    read: () => (isMoved ? currentNumber() : null),
    show: (answer) => slider.show(positionOf(answer), textOf(answer)),
    reveal() {
      slider.input.disabled = true;
      const truthSlider = addSlider(rows, "the truth", count);
      truthSlider.input.classList.add("hdrlab-truth");
      truthSlider.input.inert = true; // a disabled slider would be gray
      const sentence = model.get("told");
      truthSlider.show(positionOf(truth), sentence.slice(0, -1)); // without the full stop
    },
    compare(answer) {
      const error = truth - answer;
      const isRight = Math.abs(error) < step / 2;
      const direction = error > 0 ? "low" : "high";
      const difference = `${threeDigits(Math.abs(error))} too ${direction}`;
      return {
        isNear: Math.abs(error) <= NEAR_FRACTION * (high - low),
        words: isRight ? "Yes" : `You said: ${textOf(answer)}, ${difference}`,
      };
    },
  };
}

const WHOLE_TOLERANCE = 1e-6; // a whole number must be right
const ENTRY_TOLERANCE = 0.02; // relative error of another number that counts as near

// The number that a text says, such as "0.5", "0,5" or "1/2", or null.
function numberIn(text) {
  const plain = text.trim().replace(",", ".").replace("\u2212", "-");
  const parts = plain.split("/");
  if (parts.length > 2 || parts.some((part) => part.trim() === "")) return null;
  const [numerator, denominator] = parts;
  const number = Number(numerator) / Number(denominator ?? 1);
  return Number.isFinite(number) ? number : null;
}

// A number that the reader types. Enter submits it.
function createEntryQuestion(root, model, submit) {
  const truth = model.get("truth");
  const row = addElement(root, "label", { className: "hdrlab-entry" });
  addElement(row, "span", { textContent: "your answer" });
  const input = addElement(row, "input", {
    type: "text",
    inputMode: "decimal",
    autocomplete: "off",
    spellcheck: false,
  });
  input.addEventListener("keydown", (event) => {
    if (event.key === "Enter") submit();
  });
  return {
    request: "Type a number first, such as 0.5 or 1/2, or press Show.",
    read: () => numberIn(input.value),
    show(answer) {
      input.value = String(answer);
    },
    reveal() {
      input.disabled = true;
    },
    compare(answer) {
      const error = truth - answer;
      const isWhole = Number.isInteger(truth);
      const tolerance = isWhole ? WHOLE_TOLERANCE : ENTRY_TOLERANCE * Math.abs(truth);
      const isNear = Math.abs(error) <= tolerance;
      return { isNear, words: isNear ? "Yes" : `You said: ${answer}` };
    },
  };
}

const CREATE_QUESTION = {
  choice: createChoiceQuestion,
  number: createNumberQuestion,
  entry: createEntryQuestion,
  curve: createCurveQuestion,
  place: createPlaceQuestion,
};

// The results on a page (in JupyterLab: in a notebook), from a question to whether the answer was
// near. Each question has its own copy of this script, so the results are stored globally.
function resultsOnPage(el) {
  const page = el.closest(".jp-NotebookPanel") ?? document;
  globalThis.hdrlabTallies ??= new WeakMap();
  const results = globalThis.hdrlabTallies;
  if (!results.has(page)) results.set(page, new Map());
  return results.get(page);
}

// In a dialogue, Python adds the next steps below a question. Scroll to the last one.
function followDialogue(el) {
  const dialogue = el.closest(".widget-vbox");
  if (!dialogue || dialogue.dataset.hdrlabFollows) return;
  dialogue.dataset.hdrlabFollows = "true";
  const scrollToLast = () => {
    const block = "nearest"; // do not move what is visible already
    requestAnimationFrame(() => dialogue.lastElementChild.scrollIntoView({ block }));
  };
  new MutationObserver(scrollToLast).observe(dialogue, { childList: true });
}

async function render({ model, el }) {
  const isCovering = model.get("covers");
  // covers.js looks for the kind "predict"
  const root = createRoot(el, isCovering ? "predict" : "ask");
  addElement(root, "p", { className: "hdrlab-question", textContent: model.get("question") });
  if (model.get("code")) {
    addElement(root, "pre", { className: "hdrlab-code", textContent: model.get("code") });
  }
  const question = await CREATE_QUESTION[model.get("kind")](root, model, submit);
  const controls = addElement(root, "div", { className: "hdrlab-controls" });
  const checkButton = addElement(controls, "button", {
    type: "button",
    textContent: "Check my answer",
  });
  const showButton = addElement(controls, "button", {
    type: "button",
    textContent: "Show",
    className: "hdrlab-plain",
  });
  if (isCovering) addAnswersSwitch(controls);
  const note = addElement(root, "p", { className: "hdrlab-note", role: "status" });
  const cover = addElement(root, "p", {
    className: "hdrlab-cover",
    textContent: "What follows is covered until you answer or press Show.",
  });
  cover.hidden = true; // covers.js and live.js show it
  let updateCoversNow = () => {};

  // Remember whether an answer was near, and return the results of the page so far as a sentence.
  function countResult(isNear) {
    const results = resultsOnPage(el);
    results.set(model.get("question"), isNear);
    const nearCount = [...results.values()].filter(Boolean).length;
    return `On this page so far: ${nearCount} of ${results.size} near.`;
  }

  // The sentences below the truth: how near the answer was, the truth, and the results so far.
  function describeResult(answer) {
    const name = isCovering ? "The truth" : "The right value";
    const truth = `${name}: ${model.get("told") || "what is orange."}`;
    const sentences = [truth, model.get("because")];
    if (answer !== null) {
      const { isNear, words } = question.compare(answer);
      sentences.unshift(`${words}.`);
      note.classList.add(isNear ? "hdrlab-near" : "hdrlab-far");
      if (isCovering) sentences.push(countResult(isNear));
    }
    return sentences.filter(Boolean).join(" ");
  }

  function reveal() {
    const hadFocus = root.contains(document.activeElement);
    question.reveal();
    controls.remove();
    cover.remove();
    note.textContent = describeResult(model.get("given"));
    // The control that had the focus is gone: Tab continues from the note.
    if (hadFocus) {
      note.tabIndex = -1;
      note.focus();
    }
    root.dataset.done = "true";
    updateCoversNow();
  }

  function saveAnswer(answer) {
    model.set("given", answer);
    model.set("done", true);
    model.save_changes();
    reveal();
  }

  function submit() {
    const answer = question.read();
    if (answer === null) note.textContent = question.request ?? "Give an answer first, or press Show.";
    else saveAnswer(answer);
  }

  checkButton.addEventListener("click", submit);
  showButton.addEventListener("click", () => saveAnswer(null));
  if (model.get("done")) {
    if (model.get("given") !== null) question.show(model.get("given"));
    reveal();
  }
  if (!isCovering) {
    requestAnimationFrame(() => followDialogue(el));
    return;
  }
  // JupyterLab attaches the widget to the page only after this function.
  requestAnimationFrame(() => {
    updateCoversNow = watchCovers(el);
  });
}

export default { render };
