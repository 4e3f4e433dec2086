// Load Python in a worker (try_worker.js, photos_worker.js): Pyodide, and then the packages that are needed.
// The page gets messages of the kind "progress", with the bytes that have come so far.
const pythonLoader = (() => {
  let manifest = null; // lite/try.json, made by lite/checks.py
  let python = null;
  const present = new Set(); // packages of Pyodide
  // of what is being loaded: its name, and bytes
  let what = "";
  let loaded = 0;
  let total = 0;

  const tell = (kind, details) => postMessage({ kind, ...details });

  // The bytes of all responses are counted as they come, those of Pyodide, too.
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

  // Start Python with hdrlab, once; `lite` is the address of the site's folder lite.
  async function start(lite) {
    if (python) return python;
    manifest = await (await fetchPlainly(`${lite}try.json`, { cache: "no-cache" })).json();
    expect("Python", manifest.bytes.start);
    const code = read(lite + manifest.code).then((response) => response.arrayBuffer());
    const script = new URL(manifest.pyodide, lite).href;
    importScripts(script);
    const indexURL = script.slice(0, script.lastIndexOf("/") + 1);
    const started = await loadPyodide({ indexURL, packages: manifest.packages, env: { MPLBACKEND: "agg", HOME: "/home/pyodide" } });
    const packages = started.runPython("import sysconfig; sysconfig.get_path('purelib')");
    started.unpackArchive(await code, "zip", { extractDir: packages });
    python = started;
    return python;
  }

  // Load packages of Pyodide that are not there yet.
  async function add(names, label) {
    const missing = names.filter((name) => !present.has(name));
    if (!missing.length) return;
    expect(label, missing.reduce((sum, name) => sum + (manifest.bytes[name] ?? NaN), 0) || 0);
    await python.loadPackage(missing, { messageCallback: () => {} });
    missing.forEach((name) => present.add(name));
  }

  // the last line of Python's traceback; "" if Python has not started
  function describe(error) {
    const lines = `${error.message ?? error}`.trim().split("\n");
    return python ? lines.findLast((line) => /^\S*Error/.test(line)) ?? lines.at(-1) : "";
  }

  return { start, add, describe, tell, has: (name) => present.has(name), manifest: () => manifest };
})();
