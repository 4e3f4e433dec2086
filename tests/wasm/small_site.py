"""A site of two pages, with Python for the browser: a notebook with boxes, and the reader's own photos."""

import re
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import nbformat

from hdrlab.course.site import boxes, pages
from hdrlab.course.site.lite import build

ROOT = Path(__file__).parents[2]
NOTEBOOK = "04_response_gsolve"
PHOTOS_PAGE = "own_photos"
# what the pages and JupyterLite are built with
PACKAGES = ("jupyterlite_pyodide_kernel", "myst_nb")
LINK_TO_PAGE = re.compile(r"\[([^\]]+)\]\(\w+\.md\)")
REASON = 'the site and JupyterLite need pip install ".[site,lite]"'


class QuietHandler(SimpleHTTPRequestHandler):
    """Serve files without a line about each request."""

    def log_message(self, *_: object) -> None:
        """Print nothing."""


def write(folder: Path, pyodide: Path) -> Path:
    """Write the site into a folder, with Pyodide from another one, and return the folder to serve."""
    from sphinx.application import Sphinx

    from hdrlab.course.site.sphinx import SETTINGS

    source = folder / "source"
    html = folder / "html"
    (source / "notebooks").mkdir(parents=True)
    notebook = nbformat.read(ROOT / "notebooks" / f"{NOTEBOOK}.ipynb", 4)
    for cell in notebook.cells:
        cell.source = pages.unlink_missing_notebooks(cell.source, set())
    boxes.insert(notebook, NOTEBOOK, {"hw2"})
    nbformat.write(notebook, source / "notebooks" / f"{NOTEBOOK}.ipynb")
    own_photos = (pages.PAGES / f"{PHOTOS_PAGE}.md").read_text("utf8")
    own_photos = LINK_TO_PAGE.sub(r"\1", own_photos)  # this site lacks the other pages
    (source / f"{PHOTOS_PAGE}.md").write_text(own_photos, "utf8")
    toctree = f"```{{toctree}}\nnotebooks/{NOTEBOOK}\n{PHOTOS_PAGE}\n```\n"
    (source / "index.md").write_text(f"# First page\n\nA text.\n\n{toctree}", "utf8")
    settings = SETTINGS | {"html_context": {"edition": "0123abcd"}}
    notes = folder / "notes"
    Sphinx(source, None, html, notes, "html", settings, status=None, warning=None).build()
    build.build(html, folder, [], [], build.find_pyodide(str(pyodide)))
    return html


@contextmanager
def serve(html: Path) -> Iterator[str]:
    """Serve a folder on this machine, and give its address."""
    handler = partial(QuietHandler, directory=str(html))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()
