// An extension of JupyterLab, written as the prebuilt module that JupyterLab loads: the command
// "Download my notebook". JupyterLite 0.5 has no entry for a download in the menu of a notebook,
// and its own command names the file after the whole path, with the folder of the edition.
const COMMAND = "hdrlab:download";
const DOWNLOAD_TIME = 60_000; // ms, after which the address of a download is released
// The kernel of an installed Jupyter, which has no kernel "Python (Pyodide)"
const KERNEL = { display_name: "Python 3 (ipykernel)", language: "python", name: "python3" };

async function download(context) {
  await context.save();
  const notebook = context.model.toJSON();
  notebook.metadata.kernelspec = KERNEL;
  const text = JSON.stringify(notebook, null, 1) + "\n";
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "application/x-ipynb+json" }));
  link.download = context.path.split("/").pop();
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), DOWNLOAD_TIME);
}

const plugin = {
  id: "hdrlab-download:command",
  autoStart: true,
  activate: ({ commands, shell }) => {
    commands.addCommand(COMMAND, {
      label: "Download my notebook",
      caption:
        "Save this notebook as a file, to hand it in. Until then it is in this browser only.",
      isEnabled: () => Boolean(shell.currentWidget?.context?.model),
      execute: () => download(shell.currentWidget.context),
    });
  },
};

globalThis._JUPYTERLAB = globalThis._JUPYTERLAB ?? {};
globalThis._JUPYTERLAB["hdrlab-download"] = {
  init: () => {},
  get: () => Promise.resolve(() => ({ __esModule: true, default: plugin })),
};
