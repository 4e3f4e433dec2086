// The page for a reader's own photos: a list of the photos with their exposure times, and the
// radiance map. Python runs in a worker (photos_worker.js). The first photo starts it.
(() => {
  const box = document.querySelector(".own");
  if (!box) return;
  if (location.protocol === "file:") {
    document.querySelector(".own-closed").hidden = false;
    return;
  }

  const script = document.currentScript.src;
  const workerUrl = new URL("photos_worker.js", script);
  const lite = new URL("../lite/", script).href;
  const MIN_PHOTOS = 2;
  const MAX_PHOTOS = 9; // as in own_photos.py
  const MAX_FILE_BYTES = 100e6;
  const FAILED = "Python could not be loaded. Check your connection, and press Start again.";
  const OPERATOR = "photograph";

  const part = (name) => box.querySelector(name);
  const say = (text) => (part(".state").textContent = text);
  const element = (tag, properties) => Object.assign(document.createElement(tag), properties);

  // Each photo has name, file, row, size, input and thumbnail. isRead: hdrlab has read its header.
  // isSent: the worker has its file.
  let photos = [];
  let worker = null;
  let pending = []; // the messages that the worker has not answered
  let isStarted = false; // hdrlab is merging
  let startsWhenRead = false; // Start was pressed while hdrlab read the photos
  let doneText = ""; // how long the map took
  let waitingStops = null; // the position of the slider that is shown after the image in progress
  const addresses = new Map(); // class of a link -> address of its file

  // ---- the worker

  function ask(kind, details) {
    if (!worker) worker = startWorker(workerUrl, getWorker, receive, failToLoad);
    const id = crypto.randomUUID?.() ?? `${Math.random()}`;
    pending.push({ id, kind, ...details });
    worker.postMessage({ lite, id, kind, ...details });
    update();
  }

  const getWorker = () => worker;
  const failToLoad = () => endWorker(FAILED);

  function endWorker(text) {
    worker?.terminate();
    worker = null;
    pending = [];
    isStarted = false;
    startsWhenRead = false;
    waitingStops = null;
    for (const photo of photos) photo.isSent = false;
    closeMap();
    hideProgress();
    say(text);
    update();
  }

  function hideProgress() {
    box.classList.remove("loading");
    part("progress").hidden = true;
  }

  function showStage({ text, done, total }) {
    box.classList.remove("loading");
    const bar = part("progress");
    bar.hidden = false;
    bar.removeAttribute("title");
    bar.removeAttribute("aria-valuetext");
    if (total) {
      bar.max = total;
      bar.value = done;
    } else {
      bar.removeAttribute("value");
    }
    say(text);
  }

  function receive({ data }) {
    if (data.kind === "progress") return showLoading(box, data);
    if (data.kind === "stage") return showStage(data);
    if (data.kind === "failed") return endWorker(data.message || FAILED);
    const question = pending.find(({ id }) => id === data.id);
    pending = pending.filter(({ id }) => id !== data.id);
    if (!pending.length) {
      hideProgress();
      say("");
    }
    if (question) ANSWERS[data.kind](question, data);
    update();
  }

  const ANSWERS = {
    add({ name, isAgain }, answer) {
      const photo = photos.find((added) => added.name === name);
      if (!photo) return; // the reader has removed it
      if (answer.error) {
        discard(photo);
        complain(answer.error);
      } else {
        photo.isSent = true;
        photo.isRead = true;
      }
      if (!answer.error && !isAgain) {
        photo.size.textContent = answer.reducedTo
          ? `${answer.size}, reduced to ${answer.reducedTo}`
          : answer.size;
        photo.input.value = answer.time;
        photo.input.disabled = false;
      }
      if (pending.length) return;
      say(describeList());
      if (startsWhenRead) start();
    },
    remove() {},
    assemble(question, answer) {
      isStarted = false;
      if (answer.error) return say(`Stopped: ${answer.error}.`);
      showResult(answer);
      doneText = `Done in ${((performance.now() - question.started) / 1000).toFixed(0)} seconds.`;
      say(doneText);
      ask("map");
    },
    map(question, answer) {
      if (answer.error) return say(answer.error);
      link("hdr", answer.map);
      say(doneText);
    },
    toneMap({ operator }, answer) {
      if (answer.error) return say(answer.error);
      showPicture(answer.png, `Tone mapping: ${answer.settings}`);
      link("jpg", answer.jpg);
      link("png", answer.png);
      press(operator);
    },
    expose(question, answer) {
      if (answer.error) return say(answer.error);
      showPicture(
        answer.jpg,
        `Without tone mapping: ${answer.settings}. White is clipped, as in a photo.`,
      );
      press("");
      const stops = waitingStops;
      waitingStops = null;
      if (stops !== null) ask("expose", { stops });
    },
  };

  // ---- the list

  function complain(text) {
    part(".problems").append(element("li", { textContent: text }));
  }

  function describeList() {
    const count = photos.filter((photo) => photo.isRead).length;
    if (!count) return "";
    if (count < MIN_PHOTOS) return "One photo is no bracket: add photos of other exposure times.";
    return `${count} photos are ready. Press Start.`;
  }

  function choose(files) {
    part(".problems").replaceChildren();
    for (const file of files) {
      const problem = describeProblem(file);
      if (problem) complain(`${file.name}: ${problem}`);
      else addPhoto(file);
    }
    update();
  }

  // Return why a file cannot be added, or "".
  function describeProblem(file) {
    const isInList = photos.some((photo) => photo.name === file.name);
    if (isInList) return "a photo of this name is in the list";
    if (photos.length >= MAX_PHOTOS) return `left out, because ${MAX_PHOTOS} photos are enough`;
    if (file.size > MAX_FILE_BYTES) return `larger than ${MAX_FILE_BYTES / 1e6} MB`;
    return "";
  }

  function addPhoto(file) {
    const row = element("tr", {});
    const thumbnail = element("img", { alt: "", src: URL.createObjectURL(file) });
    thumbnail.onerror = () => thumbnail.remove();
    const name = element("th", { scope: "row" });
    name.append(thumbnail, element("span", { textContent: file.name }));
    const size = element("td", { textContent: "reading" });
    const input = element("input", {
      type: "text",
      size: 9,
      disabled: true,
      placeholder: "unknown",
      autocomplete: "off",
      spellcheck: false,
    });
    input.setAttribute("aria-label", `Exposure time of ${file.name}, such as 1/60 s`);
    input.addEventListener("input", update);
    const remove = element("button", { type: "button", textContent: "Remove" });
    remove.setAttribute("aria-label", `Remove ${file.name}`);
    const photo = {
      name: file.name,
      file,
      row,
      size,
      input,
      thumbnail,
      isRead: false,
      isSent: false,
    };
    remove.addEventListener("click", () => {
      if (isStarted) return say("Press Stop first.");
      const next = (row.nextElementSibling ?? row.previousElementSibling)?.querySelector("button");
      discard(photo);
      if (worker) ask("remove", { name: photo.name });
      else say(photos.length ? describeList() : "");
      (next ?? part("input[type=file]")).focus();
    });
    const cells = [input, remove].map((content) => element("td", {}));
    cells[0].append(input);
    cells[1].append(remove);
    row.append(name, size, ...cells);
    part("tbody").append(row);
    photos.push(photo);
    ask("add", { name: file.name, file });
  }

  function discard(photo) {
    photos = photos.filter((other) => other !== photo);
    URL.revokeObjectURL(photo.thumbnail.src);
    photo.row.remove();
    update();
  }

  function update() {
    const unknown = photos
      .filter((photo) => photo.isRead && !photo.input.value.trim())
      .map((photo) => photo.name);
    const advice = "type it, or leave it out. Then hdrlab estimates all times from the pixels.";
    part(".times").textContent = unknown.length
      ? `No exposure time in ${unknown.join(", ")}: ${advice}`
      : "";
    const isReady = photos.length >= MIN_PHOTOS && !isStarted;
    part(".go").setAttribute("aria-disabled", String(!isReady));
    part(".list").hidden = !photos.length;
    part(".clear").hidden = !photos.length;
    const stop = part(".stop");
    const isBusy = pending.some(({ kind }) => kind !== "expose" && kind !== "remove");
    if (!isBusy && document.activeElement === stop) part(".go").focus();
    stop.hidden = !isBusy;
  }

  function start() {
    if (isStarted) return;
    if (photos.length < MIN_PHOTOS) {
      say(photos.length ? describeList() : "Choose some photos first.");
      return;
    }
    sendMissingPhotos();
    startsWhenRead = photos.some((photo) => !photo.isRead);
    if (startsWhenRead) return;
    isStarted = true;
    closeMap();
    part(".result").hidden = true;
    const times = Object.fromEntries(photos.map((photo) => [photo.name, photo.input.value]));
    ask("assemble", { times, started: performance.now() });
    say("Starting");
  }

  // After Stop, a new worker has no photos.
  function sendMissingPhotos() {
    const messages = pending.filter(({ kind }) => kind === "add");
    const namesBeingSent = new Set(messages.map(({ name }) => name));
    for (const photo of photos) {
      if (!photo.isSent && !namesBeingSent.has(photo.name)) {
        ask("add", { name: photo.name, file: photo.file, isAgain: photo.isRead });
      }
    }
  }

  // ---- the result

  function link(kind, blob) {
    URL.revokeObjectURL(addresses.get(kind));
    addresses.set(kind, URL.createObjectURL(blob));
    const anchor = part(`.downloads .${kind}`);
    anchor.href = addresses.get(kind);
    anchor.hidden = false;
  }

  function showPicture(blob, caption) {
    URL.revokeObjectURL(addresses.get("shown"));
    addresses.set("shown", URL.createObjectURL(blob));
    part("figure img").src = addresses.get("shown");
    part("figcaption").textContent = caption;
  }

  function press(operator) {
    for (const button of box.querySelectorAll("[data-operator]")) {
      button.setAttribute("aria-pressed", String(button.dataset.operator === operator));
    }
  }

  // The worker has no map any more. The image and the links stay.
  function closeMap() {
    for (const controls of box.querySelectorAll("fieldset")) controls.disabled = true;
  }

  function listOf(place, texts) {
    part(place).replaceChildren(...texts.map((text) => element("li", { textContent: text })));
  }

  function showResult(answer) {
    part(".summary").textContent = answer.summary;
    const remarks = [
      ...answer.warnings.map((text) => `warning: ${text}`),
      ...answer.notes.map((text) => `note: ${text}`),
    ];
    listOf(".remarks", remarks);
    listOf(".details", answer.details);
    showPicture(answer.png, answer.isFusion ? answer.settings : `Tone mapping: ${answer.settings}`);
    link("png", answer.png);
    link("jpg", answer.jpg);
    part(".downloads .hdr").hidden = true; // until the worker has written the new map
    press(OPERATOR);
    for (const controls of box.querySelectorAll("fieldset")) controls.disabled = answer.isFusion;
    part(".result").hidden = false;
  }

  for (const button of box.querySelectorAll("[data-operator]")) {
    button.addEventListener("click", () => {
      ask("toneMap", { operator: button.dataset.operator });
      say(`Tone mapping by ${button.textContent}`);
    });
  }
  const slider = part("input[type=range]");
  slider.addEventListener("input", () => {
    const stops = slider.valueAsNumber;
    const words = `${stops > 0 ? "+" : ""}${stops} stops`.replace("-", "\u2212");
    part("output").textContent = words;
    slider.setAttribute("aria-valuetext", words);
    if (pending.some(({ kind }) => kind === "expose")) waitingStops = stops;
    else ask("expose", { stops });
  });

  // ---- the buttons, and dropped files

  part(".go").addEventListener("click", start);
  part(".stop").addEventListener("click", () => endWorker("Stopped."));
  part(".clear").addEventListener("click", () => {
    if (isStarted) return say("Press Stop first.");
    for (const photo of [...photos]) {
      discard(photo);
      if (worker) ask("remove", { name: photo.name });
    }
    part(".problems").replaceChildren();
    say("");
    part("input[type=file]").focus();
  });
  part("input[type=file]").addEventListener("change", ({ target }) => {
    const files = [...target.files];
    target.value = ""; // so that the same file can be chosen again
    choose(files);
  });
  const hasFiles = (event) => event.dataTransfer?.types.includes("Files");
  const drop = part(".drop");
  addEventListener("dragover", (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault(); // or the browser would leave the page and open the file
    drop.classList.add("over");
  });
  addEventListener("dragleave", (event) => event.relatedTarget || drop.classList.remove("over"));
  addEventListener("drop", (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    drop.classList.remove("over");
    if (isStarted) return say("Press Stop first.");
    choose([...event.dataTransfer.files]);
  });

  box.hidden = false;
})();
