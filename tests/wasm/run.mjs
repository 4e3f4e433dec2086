// Run a Python script in Pyodide: node run.mjs TESTBED REPOSITORY SCRIPT PACKAGES [ARGUMENTS...]
import fs from "node:fs";
import { pathToFileURL } from "node:url";

const [testbed, repository, script, packages, ...args] = process.argv.slice(2);
const folder = `${testbed}/pyodide/`;
const { loadPyodide } = await import(pathToFileURL(`${folder}pyodide.mjs`));
const print = (text) => console.log(text);
const python = await loadPyodide({ indexURL: folder, stdout: print, stderr: print });
await python.loadPackage(packages.split(","), { messageCallback: () => {} });
const mounts = { "/pure": `${testbed}/pure`, "/hdrlab": repository };
for (const [place, root] of Object.entries(mounts)) {
  python.FS.mkdirTree(place);
  python.FS.mount(python.FS.filesystems.NODEFS, { root }, place);
}
python.globals.set("ARGUMENTS", python.toPy(args));
try {
  python.runPython(`
import sys
sys.dont_write_bytecode = True
sys.path[:0] = ["/hdrlab", "/pure"]
`);
  await python.runPythonAsync(fs.readFileSync(script, "utf8"), { filename: script });
} catch (error) {
  console.error(String(error));
  process.exitCode = 1;
}
console.error(JSON.stringify({
  cpuSeconds: process.cpuUsage().user / 1e6,
  memoryMegabytes: python._module.HEAP8.length / 1e6,
}));
process.exit(process.exitCode ?? 0);
