"""A real browser, a JupyterLab that shares no folder with the user's own, and a page without a kernel.

The tests open notebooks and widgets with it, and so do the benchmarks.
"""

import base64
import json
import os
import secrets
import shutil
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import anywidget

ROOT = Path(__file__).parents[2]

SETTINGS = {
    "apputils-extension/notification": '{"fetchNews": "false", "checkForUpdates": false}',
    # All cells stay in the page, also those that are scrolled out of sight.
    "notebook-extension/tracker": '{"windowingMode": "none"}',
}

# Chromium as root, without a display, and without a request of its own.
QUIET = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)

# What the switch "Show all answers" remembers: questions then cover nothing.
SHOW_ALL_ANSWERS = "localStorage.setItem('hdrlab-answers', 'shown')"

# The pixels of a widget's picture, as one number.
DIGEST = """(el) => {
    const canvas = el.querySelector("canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let hash = canvas.width;
    for (const pixel of new Uint32Array(data.buffer)) hash = Math.imul(hash ^ pixel, 16777619);
    return hash;
}"""

# ms between two looks at what a kernel does: at each frame they would keep a processor from it
LOOK = 100
PATIENCE = 300_000  # ms until a moved control shows: a limit for errors; speed is for benchmarks

# What a widget's script sees of its model. Bytes arrive as in a notebook: as a view into a larger
# buffer.
PAGE = """<!DOCTYPE html><html lang="en"><title>A widget</title><style>{css}</style>
<div id="at"></div><script type="module">
const unpack = (value) => {{
  if (Array.isArray(value)) return value.map(unpack);
  if (value?.base64 === undefined) return value;
  const bytes = Uint8Array.from(atob(value.base64), (letter) => letter.charCodeAt(0));
  const larger = new Uint8Array(bytes.length + 11);
  larger.set(bytes, 7);
  return new DataView(larger.buffer, 7, bytes.length);
}};
const state = Object.fromEntries(Object.entries({state}).map(([name, value]) => [name, unpack(value)]));
const listeners = {{}};
window.model = {{
  saved: 0,
  get: (name) => state[name],
  set: (name, value) => {{ state[name] = value; (listeners["change:" + name] ?? []).forEach((f) => f()); }},
  save_changes: () => {{ window.model.saved += 1; }},
  on: (name, f) => (listeners[name] ??= []).push(f),
  off: () => {{}},
}};
window.reached = [];
document.addEventListener("keydown", (event) => window.reached.push(event.key));
const script = URL.createObjectURL(new Blob([{script}], {{ type: "text/javascript" }}));
const widget = (await import(script)).default;
widget.render({{ model: window.model, el: document.getElementById("at") }});
</script></html>"""


class Absent(Exception):
    """A program or package that is needed to open a browser is not installed."""


class Lab(NamedTuple):
    """A running JupyterLab."""

    address: str
    token: str
    folder: Path

    def open(self, page: Any, notebook: str) -> None:
        """Open a notebook and wait for its kernel; the toolbar says idle before the session is ready."""
        page.goto(f"{self.address}/lab/tree/{notebook}?reset&token={self.token}")
        page.wait_for_function(
            """() => {
                const session = window.jupyterapp?.shell?.currentWidget?.sessionContext;
                return session?.isReady && session.session?.kernel?.status === "idle";
            }""",
            timeout=PATIENCE,
            polling=LOOK,
        )

    def run_all(self, page: Any, *, timeout: float = 600) -> None:
        """Run every cell from the top and wait until the last one is done."""
        page.evaluate("() => { window.jupyterapp.commands.execute('notebook:run-all-cells'); }")
        self.until_done(page, timeout=timeout)

    def until_done(self, page: Any, *, timeout: float = 600) -> None:
        """Wait until the last cell is done."""
        page.wait_for_function(
            """() => window.jupyterapp.shell.currentWidget.content.widgets
                .filter((cell) => cell.model.type === "code" && cell.model.sharedModel.source.trim())
                .every((cell) => cell.model.executionCount && cell.model.executionState !== "running")""",
            timeout=1000 * timeout,
            polling=LOOK,
        )

    def close(self) -> None:
        """End all kernels; twenty of them, one per notebook, would fill the memory."""
        for kernel in json.loads(self._ask("GET", "/api/kernels")):
            self._ask("DELETE", f"/api/kernels/{kernel['id']}")

    def _ask(self, method: str, path: str) -> bytes:
        headers = {"Authorization": f"token {self.token}"}
        request = urllib.request.Request(self.address + path, method=method, headers=headers)
        with urllib.request.urlopen(request, timeout=300) as answer:
            return bytes(answer.read())


@contextmanager
def chromium(*names: str) -> Iterator[Any]:
    """Start the first Chromium of these names that the system has, or raise Absent."""
    executable = next(filter(None, map(shutil.which, names)), None)
    if find_spec("playwright") is None:
        raise Absent("playwright is not installed")
    if executable is None:
        raise Absent("chromium is not installed")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=executable, args=list(QUIET))
        yield browser
        browser.close()


@contextmanager
def jupyterlab(home: Path, *, by_hdrlab: bool = False) -> Iterator[Lab]:
    """Start a JupyterLab on a copy of the notebooks, with all its folders in `home`, or raise Absent.

    With `by_hdrlab`, the command `hdrlab lab` copies the notebooks and starts it, and it has
    JupyterLab's own settings.
    """
    if find_spec("jupyterlab") is None:
        raise Absent("jupyterlab is not installed")
    if by_hdrlab:
        folder = home / "course"
        folder.mkdir()
        settings = {}
    else:
        folder = Path(shutil.copytree(ROOT / "notebooks", home / "notebooks"))
        settings = SETTINGS
    for name, text in settings.items():
        file = home / "settings" / "@jupyterlab" / f"{name}.jupyterlab-settings"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    token = secrets.token_hex(16)
    server = subprocess.Popen(
        _command(port, token, folder, by_hdrlab=by_hdrlab),
        env=_environment(home),
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.STDOUT,
    )
    try:
        _wait_for(server, f"http://127.0.0.1:{port}/api/status?token={token}")
        yield Lab(f"http://127.0.0.1:{port}", token, folder)
    finally:
        server.terminate()
        try:
            server.wait(10)
        except subprocess.TimeoutExpired:
            server.kill()
            server.wait()


def widget_page(widget: anywidget.AnyWidget) -> str:
    """Return a plain page with a widget, as HTML: no kernel, and no server."""

    def packed(value: Any) -> Any:
        if isinstance(value, bytes):
            return {"base64": base64.b64encode(value).decode()}
        return [packed(item) for item in value] if isinstance(value, list) else value

    own = set(widget.trait_names(sync=True)) - set(anywidget.AnyWidget.class_trait_names())
    state = {name: packed(getattr(widget, name)) for name in own if not name.startswith("_")}
    texts = {
        "state": json.dumps(state),
        "script": json.dumps(str(widget._esm)),
        "css": str(widget._css),
    }
    return PAGE.format(**texts)


def open_widget(page: Any, widget: anywidget.AnyWidget) -> None:
    """Open a plain page with a widget, and wait until its picture is there."""
    page.set_content(widget_page(widget))
    shown = """() => {
        const canvas = document.querySelector("canvas");  // a question may have none
        return canvas ? canvas.getAttribute("aria-label") : document.querySelector(".hdrlab-note");
    }"""
    page.wait_for_function(shown)


def changed_by(page: Any, widget: Any, move: Callable[[], object]) -> None:
    """Move a control, and wait until the picture has changed."""
    before = widget.evaluate(DIGEST)
    move()
    page.wait_for_function(
        f"([el, before]) => ({DIGEST})(el) !== before",
        arg=[widget.element_handle(), before],
        timeout=PATIENCE,
    )


def _command(port: int, token: str, folder: Path, *, by_hdrlab: bool) -> list[str]:
    options = [
        "--no-browser",
        "--allow-root",
        f"--ServerApp.port={port}",
        "--ServerApp.port_retries=0",
        f"--IdentityProvider.token={token}",
        "--LabApp.expose_app_in_browser=True",
    ]
    if by_hdrlab:
        return [sys.executable, "-m", "hdrlab", "lab", "-o", str(folder), "--", *options]
    return [sys.executable, "-m", "jupyterlab", f"--ServerApp.root_dir={folder}", *options]


def _environment(home: Path) -> dict[str, str]:
    own = {
        "JUPYTER_CONFIG_DIR": "config",
        "JUPYTER_DATA_DIR": "data",
        "JUPYTER_RUNTIME_DIR": "runtime",
        "JUPYTERLAB_WORKSPACES_DIR": "workspaces",
        "JUPYTERLAB_SETTINGS_DIR": "settings",
        "IPYTHONDIR": "ipython",
    }
    folders = {name: str(home / folder) for name, folder in own.items()}
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
    return {**os.environ, **folders, "PYTHONPATH": path}


def _wait_for(server: subprocess.Popen[bytes], address: str, *, patience: float = 300) -> None:
    end = time.monotonic() + patience
    while time.monotonic() < end:
        if server.poll() is not None:
            raise RuntimeError(f"JupyterLab ended with code {server.returncode} before it answered")
        try:
            urllib.request.urlopen(address, timeout=2).close()
            return
        except (urllib.error.URLError, OSError):
            time.sleep(0.1)
    raise RuntimeError(f"JupyterLab did not answer within {patience} s")
