"""All that Sphinx reads is put in one folder, and Sphinx makes the site of it.

out           the site and nothing else; it takes the place of the one before when all of it is made
.out.cache    beside it, what the next build need not make again: executed notebooks, sources, Sphinx's notes
"""

import base64
import hashlib
import io
import json
import re
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import nbformat
import numpy as np
from markupsafe import Markup

from hdrlab.course.site import live, reference
from hdrlab.course.site.execute import Done, library_key
from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.show.pages.templates import render_page

PAGES = Path(__file__).parent / "pages"
FRONT = PAGES / "front.ipynb"  # the picture of the first page
# keeps GitHub's pages from leaving out what begins with _; its text tells a site of ours
MARK = ".nojekyll"
MADE = b"Made by hdrlab site, which replaces what is in this folder.\n"
WIDGETS = "_widgets"  # where the pages find them
# folders whose files are all ours
OWN = ("notebooks", "assignments", "reference", "_images", "_modules", WIDGETS)
# what a notebook says of running it, where nothing runs
OF_RUNNING = re.compile(
    r"(?s)Run the cells from the top\. |Choose \*Run\*.*?read on\. |, and you can break.nothing:.*?it back"
)
COLOUR_CODES = re.compile(r"\x1b\[[0-9;]*m")
LANGUAGE = {"name": "python", "pygments_lexer": "ipython3"}


class Site(NamedTuple):
    """What was made: the first page, how many pages and widgets there are, and what Sphinx complained of."""

    front: Path
    pages: int
    widgets: int
    complaints: list[str]


def cache_of(out: Path) -> Path:
    """Return the folder beside a site in which is kept what its next build need not make again."""
    return out.resolve().with_name(f".{out.resolve().name}.cache")


def claim(out: Path) -> Path:
    """Mark a folder as a site's, which must be empty or a site of before, and return that of its cache.

    Raises
    ------
    ValueError
        Where `out` holds something else: a build removes pages that are no more.
    """
    mark = out / MARK
    if out.exists() and not out.is_dir():
        raise InputError(f"expected a folder to write the site to, {out} is a file")
    if out.exists() and any(out.iterdir()) and not (mark.exists() and mark.read_bytes() == MADE):
        raise InputError(
            f"expected an empty folder or a site of before, {out} holds something else"
        )
    live.write_changed(mark, MADE)
    cache = cache_of(out)
    live.write_changed(cache / ".gitignore", b"*\n")
    return cache


def build(
    out: Path,
    done: Sequence[Done],
    handouts: Sequence[Path],
    more: Mapping[str, str],
    *,
    address: str = "",
) -> Site:
    """Make the site of executed notebooks, FRONT among them, of handouts, and of more pages by name.

    A handout is shown as it is, since its tasks are still to be done. Where nothing has changed
    since the site was made, it is left as it is. `address` is where it will stand.
    """
    record = cache_of(out) / "made.json"
    sheets = {file.stem: file.read_text("utf-8") for file in handouts}
    ran = sorted(one.executed.name for one in done)
    made_of = [library_key(course=True), ran, sheets, dict(more), address]
    key = hashlib.sha256(json.dumps(made_of).encode()).hexdigest()
    if record.exists() and (out / "index.html").exists():
        before = json.loads(record.read_text("utf-8"))
        if before["key"] == key:
            return Site(out / "index.html", *before["site"])
    record.unlink(missing_ok=True)  # an interrupted build leaves no record
    site = _build(out, done, sheets, more, address)
    live.write_changed(record, json.dumps({"key": key, "site": site[1:]}).encode())
    return site


def _build(
    out: Path, done: Sequence[Done], sheets: dict[str, str], more: Mapping[str, str], address: str
) -> Site:
    source = cache_of(out) / "source"
    html = cache_of(out) / "html"
    front = next(one for one in done if one.source == FRONT)
    notebooks = {
        one.source.stem: nbformat.read(one.executed, 4) for one in done if one.source != FRONT
    }
    titles = {name: _title(notebook) or name for name, notebook in notebooks.items()}
    modules = reference.modules()
    known = {*notebooks, *sheets}
    uses = {
        name: reference.imported(_code(notebook), modules) for name, notebook in notebooks.items()
    }
    texts = dict(reference.pages(titles, uses))
    handouts = {name: nbformat.reads(text, as_version=4) for name, text in sheets.items()}
    headings = {name: _title(notebook) for name, notebook in handouts.items()}
    widgets = 0
    shutil.rmtree(html / WIDGETS, ignore_errors=True)  # of notebooks that may be gone
    for folder, group in {"notebooks": notebooks, "assignments": handouts}.items():
        for name, notebook in group.items():
            texts[f"{folder}/{name}.ipynb"], count = _prepared(
                notebook, name, known, html / WIDGETS
            )
            widgets += count
    hero = next(one for _, one in live.widgets(nbformat.read(front.executed, 4), "front"))
    live.write(hero, html / WIDGETS)
    live.write_changed(html / "_static" / "preview.jpg", _preview(hero))
    first = {"hero": Markup(hero.as_html(WIDGETS)), "titles": titles, "handouts": headings}
    texts["index.md"] = render_page(PAGES, "index.md", **first)
    guides = [page for page in PAGES.glob("*.md") if page.name != "index.md"]
    texts |= {page.name: _linked(page.read_text("utf-8"), known) for page in guides} | dict(more)
    files = {name: text.encode() for name, text in texts.items()}
    files |= {f"cases/{one.name}": one.read_bytes() for one in PAGES.glob("cases/*.webp")}
    for name, content in files.items():
        live.write_changed(source / name, content)
    _keep(source, set(files))
    complaints = _sphinx(source, html, address)
    for part in ("notebooks", "assignments", "reference"):
        _keep(html, {name.rpartition(".")[0] + ".html" for name in texts}, part)
    _publish(html, out)
    return Site(out / "index.html", len(texts), widgets + 1, complaints)


def _code(notebook: Any) -> list[str]:
    return [cell.source for cell in notebook.cells if cell.cell_type == "code"]


def _title(notebook: Any) -> str:
    """Return a notebook's title, its first heading."""
    text = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")
    return next((line[2:].strip() for line in text.splitlines() if line.startswith("# ")), "")


def _prepared(notebook: Any, name: str, known: set[str], folder: Path) -> tuple[str, int]:
    """Return a notebook without its widgets, which go to `folder`, and how many there are."""
    found = list(live.widgets(notebook, name))
    for output, one in found:
        live.write(one, folder)
        output["data"] = {"text/html": one.as_html(f"../{WIDGETS}")}
    live.set_apart(notebook, name, folder, f"../{WIDGETS}")
    notebook.metadata.pop("widgets", None)
    notebook.metadata.setdefault("language_info", LANGUAGE)
    if not _title(notebook):
        notebook.cells.insert(0, nbformat.v4.new_markdown_cell(f"# {name}"))
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            cell.source = OF_RUNNING.sub("", _linked(cell.source, known))
        if cell.metadata.get("jupyter", {}).get("source_hidden"):  # as JupyterLab has it
            # as Sphinx has it
            cell.metadata["tags"] = [
                *cell.metadata.get("tags", ()),
                "hide-input",
            ]
    return nbformat.writes(notebook), len(found)


def _linked(text: str, known: set[str]) -> str:
    """Return Markdown in which a link to a notebook that the site lacks is plain text."""

    def link(found: re.Match[str]) -> str:
        return found[0] if found[2] in known else found[1]

    return re.sub(r"\[([^\]]+)\]\((?:\.\./)?(?:notebooks/|assignments/)?(\w+)\.ipynb\)", link, text)


def _preview(hero: live.Live) -> bytes:
    """Return what a link to the site shows elsewhere: the first page's two pictures, half of each."""
    one, other = [
        web.decode_picture(base64.b64decode(each["base64"])) for each in hero.state["pictures"]
    ]
    middle = one.shape[1] // 2
    return web.encode_jpeg(np.hstack([one[:, :middle], other[:, middle:]]))


def _sphinx(source: Path, html: Path, address: str) -> list[str]:
    """Run Sphinx, and return its complaints."""
    from sphinx.application import Sphinx

    from hdrlab.course.site.sphinx import SETTINGS

    complaints = io.StringIO()
    notes = html.parent / "doctrees"
    settings = SETTINGS | {"html_baseurl": address and address.rstrip("/") + "/"}
    Sphinx(source, None, html, notes, "html", settings, status=None, warning=complaints).build()
    return [
        line for line in COLOUR_CODES.sub("", complaints.getvalue()).splitlines() if line.strip()
    ]


def _keep(folder: Path, names: set[str], part: str = "") -> None:
    """Remove all files of a part of a folder but those that are named."""
    for file in [one for one in (folder / part).rglob("*") if one.is_file()]:
        if file.relative_to(folder).as_posix() not in names:
            file.unlink()


def _publish(html: Path, out: Path) -> None:
    """Bring what was made to its place, and remove from our folders there what was not."""
    files = [file for file in html.rglob("*") if file.is_file() and file.name[0] != "."]
    made = {file.relative_to(html).as_posix() for file in files}
    for name in sorted(made):
        live.write_changed(out / name, (html / name).read_bytes())
    for part in OWN:
        _keep(out, made, part)
