// Runs a notebook of hdrlab when it is opened, so that its figures appear without a click. `hdrlab lab`,
// Binder and the image for a JupyterHub load this extension of JupyterLab, with the digests of the code
// of hdrlab's notebooks.
//
// Opening a notebook must never run somebody else's code. So this script runs a notebook only if the
// digest of its code is one of these. It does not run a notebook with outputs either: they may contain
// the reader's answers.

function knownDigests() {
  const config = document.getElementById("jupyter-config-data");
  return JSON.parse(config.textContent).hdrlabCodeDigests ?? [];
}

// The digest of code cells, as `code_digests` in materials.py computes it.
async function digestOf(codeCells) {
  const sources = codeCells.map((cell) => cell.model.sharedModel.getSource());
  const bytes = new TextEncoder().encode(sources.join("\0"));
  const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
  return Array.from(digest, (byte) => byte.toString(16).padStart(2, "0")).join("");
}

// Run the cells in place. The command "Run All Cells" would scroll to the end of the notebook.
async function runIfUnchanged(panel, context) {
  // Browsers compute digests only on https pages and on this machine's own.
  if (!globalThis.isSecureContext) return;
  await Promise.all([context.ready, panel.revealed]);
  const codeCells = panel.content.widgets.filter((cell) => cell.model.type === "code");
  if (codeCells.some((cell) => cell.model.outputs.length > 0)) return;
  if (!knownDigests().includes(await digestOf(codeCells))) return;
  const { sessionContext } = context;
  await sessionContext.ready;
  if (!sessionContext.session?.kernel) return;
  await Promise.allSettled(codeCells.map((cell) => cell.constructor.execute(cell, sessionContext)));
}

const plugin = {
  id: "hdrlab:run-when-opened",
  autoStart: true,
  activate(app) {
    const createNew = (panel, context) => {
      runIfUnchanged(panel, context);
    };
    app.docRegistry.addWidgetExtension("Notebook", { createNew });
  },
};

// JupyterLab loads an extension as a container of webpack's module federation.
globalThis._JUPYTERLAB ??= {};
globalThis._JUPYTERLAB.hdrlab = {
  init: () => {},
  get: async () => () => ({ __esModule: true, default: plugin }),
};
