// The boxes "Try it" of a page: a text field with the stub of a task, and the checks' feedback.
// Python runs in a worker (try_worker.js). The first check starts it, and all boxes share it.
(() => {
  const boxes = [...document.querySelectorAll(".try")];
  // A page that was opened from a folder cannot load Python.
  if (!boxes.length || location.protocol === "file:") return;

  const script = document.currentScript.src;
  const workerUrl = new URL("try_worker.js", script);
  const lite = new URL("../lite/", script).href;
  const NOT_SAVED = "This browser does not save your text. Copy it before you leave the page.";
  const FAILED = "Python could not be loaded. Check your connection, and press Check again.";
  let worker = null;
  let busy = null; // the box that is being checked

  const part = (box, name) => box.querySelector(name);
  const say = (box, text) => (part(box, ".state").textContent = text);

  function setBusy(box) {
    const previous = busy;
    busy = box;
    for (const other of boxes) {
      part(other, ".check").setAttribute("aria-disabled", String(box !== null));
    }
    if (box) part(box, ".stop").hidden = false;
    if (!box && previous) {
      const stop = part(previous, ".stop");
      if (document.activeElement === stop) part(previous, ".check").focus();
      stop.hidden = true;
      part(previous, "progress").hidden = true;
    }
  }

  const getWorker = () => worker;
  const failToLoad = () => endWorker(FAILED);

  function endWorker(text) {
    worker?.terminate();
    worker = null;
    if (busy) {
      busy.classList.remove("loading");
      say(busy, text);
    }
    setBusy(null);
  }

  function receive({ data }) {
    const box = busy;
    if (!box) return;
    if (data.kind === "progress") return showLoading(box, data);
    box.classList.remove("loading");
    part(box, "progress").hidden = true;
    if (data.kind === "checking") return say(box, "Checking");
    // The next check starts a new worker.
    if (data.kind === "failed") return endWorker(data.message || FAILED);
    const feedback = part(box, ".feedback");
    feedback.innerHTML = data.html;
    feedback.hidden = false;
    say(box, data.summary);
    if (data.isLast) setBusy(null);
  }

  function check(box) {
    if (busy) {
      if (busy !== box) say(box, "Python is checking another function on this page.");
      return;
    }
    if (!worker) worker = startWorker(workerUrl, getWorker, receive, failToLoad);
    setBusy(box);
    say(box, "Checking");
    const { task, packages } = box.dataset;
    const text = part(box, "textarea").value;
    worker.postMessage({ lite, task, text, packages: packages.split(" ").filter(Boolean) });
  }

  // Indent the new line like the current one, and by four more spaces after a colon.
  function breakLine(event) {
    const field = event.target;
    const line = field.value.slice(0, field.selectionStart).split("\n").pop();
    const indent = line.match(/^ */)[0] + (line.trimEnd().endsWith(":") ? "    " : "");
    event.preventDefault();
    document.execCommand("insertText", false, `\n${indent}`); // can be undone, unlike setRangeText
  }

  for (const box of boxes) {
    const field = part(box, "textarea");
    const key = `hdrlab-try:${box.dataset.task}`;
    const save = () => {
      try {
        localStorage.setItem(key, field.value);
      } catch {
        say(box, NOT_SAVED);
      }
    };
    try {
      field.value = localStorage.getItem(key) ?? field.defaultValue;
    } catch {
      say(box, NOT_SAVED);
    }
    field.addEventListener("input", save);
    field.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" || event.isComposing) return;
      if (event.ctrlKey || event.metaKey) check(box);
      else breakLine(event);
    });
    // Copy what a reader types into the same box of another tab, unless this text differs already.
    addEventListener("storage", (event) => {
      const before = event.oldValue ?? field.defaultValue;
      const isSaved = event.key === key && event.newValue !== null;
      if (isSaved && field.value === before) field.value = event.newValue;
    });
    part(box, ".check").addEventListener("click", () => check(box));
    part(box, ".stop").addEventListener("click", () => endWorker("Stopped."));
    part(box, ".again").addEventListener("click", () => {
      const isChanged = field.value !== field.defaultValue;
      const question = "Replace your text with the stub? You cannot undo this.";
      if (isChanged && !confirm(question)) return;
      field.value = field.defaultValue;
      save();
      field.focus();
    });
    box.hidden = false;
  }
})();
