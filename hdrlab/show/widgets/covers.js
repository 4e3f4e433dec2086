// Shared by questions (predict.js): a question covers the cells that follow it until the reader
// answers. In JupyterLab and Notebook, these are the outputs of the next code cells and the first
// answer that unfolds. A heading, another question or the end of the notebook ends this earlier.
//
// course/site/covers.py does the same when a page of the site is built. On a page that is neither,
// nothing is covered.

const ANSWERS_KEY = "hdrlab-answers"; // in localStorage: "shown" uncovers everything
const UPDATE_DELAY = 100; // ms from a change of the notebook until its covers are updated
const QUESTION_IN_TEXT = /^(Predict|Think)\.$/; // the bold words that begin a question in the text
const HEADING_TAG = /^H[1-6]$/;

function areAllAnswersShown() {
  try {
    return localStorage.getItem(ANSWERS_KEY) === "shown";
  } catch {
    return false; // this browser stores nothing
  }
}

// Show or cover all answers, in all notebooks that are open.
function showAllAnswers(isShown) {
  try {
    localStorage.setItem(ANSWERS_KEY, isShown ? "shown" : "covered");
  } catch {
    // This browser stores nothing: the choice holds until the page is closed.
  }
  globalThis.dispatchEvent(new CustomEvent(ANSWERS_KEY, { detail: isShown }));
}

// What a cell of text does: it is the "answer" itself, the "end" of what a question covers, or only
// "text" between them.
function roleOfTextCell(cell) {
  const rendered = cell.querySelector(".jp-RenderedMarkdown");
  if (!rendered?.childElementCount) return "end"; // not rendered yet; this will be called again
  for (const part of rendered.children) {
    if (part.tagName === "DETAILS") return "answer";
    if (HEADING_TAG.test(part.tagName)) return "end";
    const bold = [...part.querySelectorAll("strong")];
    if (bold.some(({ textContent }) => QUESTION_IN_TEXT.test(textContent))) return "end";
  }
  return "text";
}

// Cover and uncover all cells of a notebook.
function updateCovers(notebook, areAnswersShown) {
  let question = null; // the open question that covers the cells now
  let count = 0; // of the cells that it covers

  function endQuestion() {
    const notice = question?.querySelector(".hdrlab-cover");
    if (notice) notice.hidden = areAnswersShown || count === 0;
    question = null;
    count = 0;
  }

  for (const cell of notebook.querySelectorAll(".jp-Cell")) {
    const nextQuestion = cell.querySelector('.hdrlab[data-kind="predict"]');
    const role = cell.classList.contains("jp-MarkdownCell") ? roleOfTextCell(cell) : "code";
    if (nextQuestion || role === "end") endQuestion();
    const isCovered = question !== null && role !== "text";
    cell.classList.toggle("hdrlab-covered", isCovered && !areAnswersShown);
    if (isCovered) count += 1;
    if (role === "answer") endQuestion();
    if (nextQuestion && !nextQuestion.dataset.done) question = nextQuestion;
  }
  endQuestion();
}

// Update the covers of a notebook whenever its cells change, and when all answers are shown. Return
// a function that updates them now.
function watchNotebook(notebook) {
  let timer = null;
  let areAnswersShown = areAllAnswersShown();
  const update = () => {
    timer = null;
    updateCovers(notebook, areAnswersShown);
  };
  const observer = new MutationObserver(() => {
    timer ??= setTimeout(update, UPDATE_DELAY);
  });
  observer.observe(notebook, { childList: true, subtree: true });
  globalThis.addEventListener(ANSWERS_KEY, ({ detail }) => {
    areAnswersShown = detail;
    update();
  });
  return update;
}

// Keep the covers of the notebook around `el` up to date. Each question has its own copy of this
// script, so the notebooks that are already watched are stored globally.
function watchCovers(el) {
  const notebook = el.closest(".jp-Notebook");
  if (!notebook) return () => {};
  globalThis.hdrlabCovers ??= new WeakMap();
  const watched = globalThis.hdrlabCovers; // from a notebook to its update function
  if (!watched.has(notebook)) watched.set(notebook, watchNotebook(notebook));
  const update = watched.get(notebook);
  update();
  return update;
}

// Append the switch that shows all answers, for teachers. The browser remembers it.
function addAnswersSwitch(controls) {
  const label = addElement(controls, "label", { className: "hdrlab-all" });
  const box = addElement(label, "input", { type: "checkbox", checked: areAllAnswersShown() });
  addElement(label, "span", { textContent: "Show all answers" });
  box.addEventListener("change", () => showAllAnswers(box.checked));
  globalThis.addEventListener(ANSWERS_KEY, ({ detail }) => {
    box.checked = detail;
  });
  return label;
}
