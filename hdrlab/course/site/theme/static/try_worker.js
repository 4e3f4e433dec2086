// Python for the boxes "Try it" (try.js): it loads Pyodide, then what each check needs, and runs the checks.
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

async function start(lite) {
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
}

async function add(names, label) {
  const missing = names.filter((name) => !present.has(name));
  if (!missing.length) return;
  expect(label, missing.reduce((sum, name) => sum + (manifest.bytes[name] ?? NaN), 0) || 0);
  await python.loadPackage(missing, { messageCallback: () => {} });
  missing.forEach((name) => present.add(name));
}

function check(task, text, draw) {
  tell("checking");
  const answer = python.pyimport("hdrlab.course.site.lite.in_browser").check_as_json;
  return JSON.parse(answer(task, text, draw));
}

async function answer({ lite, task, text, packages }) {
  if (!python) await start(lite);
  await add(packages, packages.join(" and "));
  // what the text itself imports
  await python.loadPackagesFromImports(text, { messageCallback: () => {} });
  const hasFigures = present.has(manifest.figures);
  const result = check(task, text, hasFigures);
  const wantsFigures = !result.isRight && !hasFigures && !result.isBroken;
  tell("feedback", { ...result, isLast: !wantsFigures });
  if (!wantsFigures) return;
  // matplotlib is large: the words come first, and stay if the figures cannot be drawn
  try {
    await add([manifest.figures], "what draws the figures");
    tell("feedback", { ...check(task, text, true), isLast: true });
  } catch (error) {
    console.warn(`${error}`);
    tell("feedback", { ...result, isLast: true });
  }
}

// the last line of Python's traceback; "" if Python has not started
function describe(error) {
  const lines = `${error.message ?? error}`.trim().split("\n");
  return python ? lines.findLast((line) => /^\S*Error/.test(line)) ?? lines.at(-1) : "";
}

onmessage = ({ data }) => answer(data).catch((error) => tell("failed", { message: describe(error) }));
