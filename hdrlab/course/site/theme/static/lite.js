// The links with which a reader runs the notebook of a page in the browser. JupyterLite stores the
// reader's copies of a notebook in a database of the browser. This script lists the copies, with a
// link to continue each of them and a button to download it.
//
// Each edition of the notebooks has its own folder, so an older copy never hides a newer notebook.
(() => {
  const DATABASE = "hdrlab notebooks"; // as in lite/build.py
  const STORE = "files";
  const DOWNLOAD_TIME = 60_000; // ms, after which the address of a download is released
  // as in lite/download/static/download.js
  const KERNEL = { display_name: "Python 3 (ipykernel)", language: "python", name: "python3" };
  const place = document.querySelector(".run");
  if (!place) return;
  const { lite, path } = place.dataset;
  const [edition, ...rest] = path.split("/");
  const name = rest.join("/");
  const start = place.querySelector(".start");

  if (location.protocol === "file:") {
    start.parentElement.nextElementSibling.textContent =
      "A page that was opened from a folder cannot run. Open it from a web server: for example, " +
      "run python -m http.server in the folder of this site, and open http://localhost:8000.";
    start.remove();
    return;
  }

  const element = (tag, properties) => Object.assign(document.createElement(tag), properties);
  const addressOf = (copy) => `${lite}notebooks/index.html?path=${copy}`;

  function openDatabase() {
    return new Promise((resolve) => {
      const request = indexedDB.open(DATABASE);
      // There is no database yet. Do not create it, because JupyterLite creates its own.
      request.onupgradeneeded = () => request.transaction.abort();
      request.onsuccess = () => resolve(request.result);
      request.onerror = () => resolve(null);
    });
  }

  function readAllFiles(database) {
    return new Promise((resolve) => {
      const request = database.transaction(STORE).objectStore(STORE).getAll();
      request.onsuccess = () => resolve(request.result);
      request.onerror = () => resolve([]);
    });
  }

  // The copies of this page's notebook in all editions, the newest first.
  async function findCopies() {
    const database = await openDatabase();
    if (!database?.objectStoreNames.contains(STORE)) return [];
    const files = await readAllFiles(database);
    database.close();
    const isCopy = (file) => {
      const [, ...parts] = (file.path ?? "").split("/"); // without the folder of the edition
      return parts.join("/") === name && Boolean(file.content);
    };
    const timeOf = (file) => new Date(file.last_modified).getTime();
    return files.filter(isCopy).sort((a, b) => timeOf(b) - timeOf(a));
  }

  function download(file) {
    const metadata = { ...file.content.metadata, kernelspec: KERNEL };
    const notebook = { ...file.content, metadata };
    const text = JSON.stringify(notebook, null, 1) + "\n";
    const href = URL.createObjectURL(new Blob([text], { type: "application/x-ipynb+json" }));
    element("a", { href, download: name.split("/").pop() }).click();
    setTimeout(() => URL.revokeObjectURL(href), DOWNLOAD_TIME);
  }

  function describe(file) {
    const date = new Date(file.last_modified).toLocaleString("en", {
      dateStyle: "medium",
      timeStyle: "short",
    });
    const isOld = !file.path.startsWith(`${edition}/`);
    const item = element("li", { textContent: `Your work of ${date}` });
    if (isOld) item.append(", in an earlier version of this page");
    const save = element("button", { type: "button", textContent: "Download it" });
    save.addEventListener("click", () => download(file));
    item.append(
      ": ",
      element("a", { href: addressOf(file.path), textContent: "continue" }),
      " or ",
      save,
    );
    return item;
  }

  async function show() {
    const copies = await findCopies();
    place.querySelector("ul")?.remove();
    if (!copies.length) return;
    const hasCurrent = copies.some((file) => file.path === path);
    start.textContent = hasCurrent ? "Continue your work" : "Run the new version of this page";
    // Otherwise a student might hand in the notebook without her work.
    place.querySelector("a[download]").textContent = "Download the notebook without your work";
    const list = element("ul", {});
    list.append(...copies.map(describe));
    place.append(list);
  }

  show();
  // The reader may have saved the notebook in another tab, or on the page before this one.
  document.addEventListener("visibilitychange", () => {
    if (!document.hidden) show();
  });
  addEventListener("pageshow", (event) => {
    if (event.persisted) show();
  });
})();
