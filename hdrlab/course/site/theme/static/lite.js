// Where a reader's own copy of this page's notebook is: JupyterLite keeps it in the browser's database.
// Each edition of the notebooks has a folder of its own, so an older copy never hides a newer notebook.
(() => {
  const DATABASE = "hdrlab notebooks"; // as in lite/build.py
  const STORE = "files";
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
      "A page that was opened from a folder cannot run. Open it from a web server: for example, run " +
      "python -m http.server in the folder of this site, and open http://localhost:8000.";
    start.remove();
    return;
  }

  const element = (tag, properties) => Object.assign(document.createElement(tag), properties);
  const addressOf = (copy) => `${lite}notebooks/index.html?path=${copy}`;

  function openDatabase() {
    return new Promise((resolve) => {
      const request = indexedDB.open(DATABASE);
      // there is none yet, and JupyterLite makes its own
      request.onupgradeneeded = () => request.transaction.abort();
      request.onsuccess = () => resolve(request.result);
      request.onerror = () => resolve(null);
    });
  }

  // The copies of this page's notebook, of all editions; the newest comes first.
  async function findCopies() {
    const database = await openDatabase();
    if (!database?.objectStoreNames.contains(STORE)) return [];
    const request = database.transaction(STORE).objectStore(STORE).getAll();
    await new Promise((resolve) => (request.onsuccess = request.onerror = resolve));
    database.close();
    const copies = request.result.filter((file) => file.path?.endsWith(`/${name}`) && file.content);
    const isOfThisPage = (file) => file.path.split("/").slice(1).join("/") === name;
    const time = (file) => new Date(file.last_modified).getTime();
    return copies.filter(isOfThisPage).sort((one, other) => time(other) - time(one));
  }

  function download(file) {
    const notebook = { ...file.content, metadata: { ...file.content.metadata, kernelspec: KERNEL } };
    const text = JSON.stringify(notebook, null, 1) + "\n";
    const href = URL.createObjectURL(new Blob([text], { type: "application/x-ipynb+json" }));
    element("a", { href, download: name.split("/").pop() }).click();
    setTimeout(() => URL.revokeObjectURL(href), 60_000);
  }

  function describe(file) {
    const date = new Date(file.last_modified).toLocaleString("en", { dateStyle: "medium", timeStyle: "short" });
    const isOld = !file.path.startsWith(`${edition}/`);
    const item = element("li", { textContent: `Your work of ${date}` });
    if (isOld) item.append(", in an earlier version of this page");
    const save = element("button", { type: "button", textContent: "Download it" });
    save.addEventListener("click", () => download(file));
    item.append(": ", element("a", { href: addressOf(file.path), textContent: "continue" }), " or ", save);
    return item;
  }

  async function show() {
    const copies = await findCopies();
    place.querySelector("ul")?.remove();
    if (!copies.length) return;
    const hasCurrent = copies.some((file) => file.path === path);
    start.textContent = hasCurrent ? "Continue your work" : "Run the new version of this page";
    // or a student might hand in the notebook without her work
    place.querySelector("a[download]").textContent = "Download the notebook without your work";
    const list = element("ul", {});
    list.append(...copies.map(describe));
    place.append(list);
  }

  show();
  // the notebook may have been saved in another tab, or on the page before
  document.addEventListener("visibilitychange", () => document.hidden || show());
  addEventListener("pageshow", (event) => event.persisted && show());
})();
