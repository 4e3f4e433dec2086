// Load Python in a worker (try_worker.js, photos_worker.js): Pyodide, and packages as needed.
// The worker sends the page messages of the kind "progress", with the bytes that are loaded.
const pythonLoader = (() => {
  let manifest = null; // lite/try.json, which lite/checks.py writes
  let python = null;
  const loadedPackages = new Set(); // the packages of Pyodide that are loaded
  let what = ""; // the name of what is being loaded, and its bytes so far and in all
  let loaded = 0;
  let total = 0;

  const tell = (kind, details) => postMessage({ kind, ...details });

  // Count the bytes of all responses, also of those that Pyodide fetches.
  const fetchPlainly = self.fetch;
  self.fetch = async (...request) => {
    const response = await fetchPlainly(...request);
    if (!response.ok || !response.body) return response;
    const counter = new TransformStream({
      transform(chunk, output) {
        loaded += chunk.length;
        tell("progress", { what, loaded, total });
        output.enqueue(chunk);
      },
    });
    return new Response(response.body.pipeThrough(counter), response);
  };

  // Report that something else is being loaded now.
  function expect(label, bytes) {
    what = label;
    loaded = 0;
    total = bytes;
    tell("progress", { what, loaded, total });
  }

  async function read(url) {
    const response = await fetch(url);
    if (!response.ok) throw new Error(`${url}: ${response.status}`);
    return response;
  }

  // Start Python with hdrlab if it is not running yet. `lite` is the address of the folder lite.
  async function start(lite) {
    if (python) return python;
    manifest = await (await fetchPlainly(`${lite}try.json`, { cache: "no-cache" })).json();
    expect("Python", manifest.bytes.start);
    const code = read(lite + manifest.code).then((response) => response.arrayBuffer());
    const script = new URL(manifest.pyodide, lite).href;
    importScripts(script);
    const indexURL = script.slice(0, script.lastIndexOf("/") + 1);
    const started = await loadPyodide({
      indexURL,
      packages: manifest.packages,
      env: { MPLBACKEND: "agg", HOME: "/home/pyodide" },
    });
    const packages = started.runPython("import sysconfig; sysconfig.get_path('purelib')");
    started.unpackArchive(await code, "zip", { extractDir: packages });
    python = started;
    return python;
  }

  // Load the packages of Pyodide that are missing.
  async function add(names, label) {
    const missing = names.filter((name) => !loadedPackages.has(name));
    if (!missing.length) return;
    // The total is 0 if the size of a package is unknown.
    const bytes = missing.reduce((sum, name) => sum + (manifest.bytes[name] ?? NaN), 0) || 0;
    expect(label, bytes);
    await python.loadPackage(missing, { messageCallback: () => {} });
    missing.forEach((name) => loadedPackages.add(name));
  }

  // Return the line of Python's traceback that names the error, or "" if Python has not started.
  function describe(error) {
    if (!python) return "";
    const lines = `${error.message ?? error}`.trim().split("\n");
    return lines.findLast((line) => /^\S*Error/.test(line)) ?? lines.at(-1);
  }

  return {
    start,
    add,
    describe,
    tell,
    has: (name) => loadedPackages.has(name),
    manifest: () => manifest,
  };
})();
