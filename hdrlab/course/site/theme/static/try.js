// The boxes "Try it" of a page: a text field with the stub of a task, and the feedback of its checks.
// Python runs in a worker (try_worker.js), which starts with the first check and serves all boxes.
(() => {
  const boxes = [...document.querySelectorAll(".try")];
  // a page that was opened from a folder can load no Python
  if (!boxes.length || location.protocol === "file:") return;

  const script = document.currentScript.src;
  const workerUrl = new URL("try_worker.js", script);
  const lite = new URL("../lite/", script).href;
  const NOT_KEPT = "This browser does not keep what you type: copy it before you leave the page.";
  const FAILED = "Python could not be loaded. Check your connection, and press Check again.";
  let worker = null;
  let busy = null; // the box that is being checked

  const part = (box, name) => box.querySelector(name);
  const say = (box, text) => (part(box, ".state").textContent = text);

  function setBusy(box) {
    const previous = busy;
    busy = box;
    for (const each of boxes) part(each, ".check").setAttribute("aria-disabled", String(box !== null));
    if (box) part(box, ".stop").hidden = false;
    if (!box && previous) {
      const stop = part(previous, ".stop");
      if (document.activeElement === stop) part(previous, ".check").focus();
      stop.hidden = true;
      part(previous, "progress").hidden = true;
    }
  }

  // Events of a worker that was ended may still arrive. They must not end its successor.
  function startWorker() {
    const started = new Worker(workerUrl);
    started.onmessage = (event) => {
      if (worker === started) receive(event);
    };
    started.onerror = () => {
      if (worker === started) endWorker(FAILED);
    };
    return started;
  }

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
    if (data.kind === "failed") return endWorker(data.message || FAILED); // the next check starts afresh
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
    if (!worker) worker = startWorker();
    setBusy(box);
    say(box, "Checking");
    const { task, packages } = box.dataset;
    const text = part(box, "textarea").value;
    worker.postMessage({ lite, task, text, packages: packages.split(" ").filter(Boolean) });
  }

  // Continue with the indentation of the line, and that of a new block.
  function breakLine(event) {
    const field = event.target;
    const line = field.value.slice(0, field.selectionStart).split("\n").pop();
    const indent = line.match(/^ */)[0] + (line.trimEnd().endsWith(":") ? "    " : "");
    event.preventDefault();
    document.execCommand("insertText", false, `\n${indent}`); // unlike setRangeText, it can be undone
  }

  for (const box of boxes) {
    const field = part(box, "textarea");
    const key = `hdrlab-try:${box.dataset.task}`;
    const keep = () => {
      try {
        localStorage.setItem(key, field.value);
      } catch {
        say(box, NOT_KEPT);
      }
    };
    try {
      field.value = localStorage.getItem(key) ?? field.defaultValue;
    } catch {
      say(box, NOT_KEPT);
    }
    field.addEventListener("input", keep);
    field.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" || event.isComposing) return;
      if (event.ctrlKey || event.metaKey) check(box);
      else breakLine(event);
    });
    // the same box in another tab; a text that is not the same as there stays
    addEventListener("storage", (event) => {
      const before = event.oldValue ?? field.defaultValue;
      if (event.key === key && event.newValue !== null && field.value === before) field.value = event.newValue;
    });
    part(box, ".check").addEventListener("click", () => check(box));
    part(box, ".stop").addEventListener("click", () => endWorker("Stopped."));
    part(box, ".again").addEventListener("click", () => {
      if (field.value !== field.defaultValue && !confirm("Replace your text with the stub? You cannot undo this.")) return;
      field.value = field.defaultValue;
      keep();
      field.focus();
    });
    box.hidden = false;
  }
})();
