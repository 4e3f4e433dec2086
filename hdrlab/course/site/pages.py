"""Build the site: collect everything that Sphinx reads in one folder, and run Sphinx.

out           the site and nothing else; it replaces the previous one once it is complete
.out.cache    next to it, what the next build reuses: executed notebooks, sources, Sphinx's doctrees
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

from hdrlab.course.authoring.execute import ExecutedNotebook, library_key
from hdrlab.course.site import boxes, covers, live, reference
from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.show.pages.templates import render_page

PAGES = Path(__file__).parent / "pages"
STORY = PAGES / "story.ipynb"  # its last figure is on the first page, too
# The guide with the figure that measures the reader's screen, which a notebook has, too
SCREEN_GUIDE = "screen.md"
SCREEN_NOTEBOOK = "25_a_picture_that_lights_up"
SCREEN_PLACE = '<div class="screen-match"></div>'
# how a notebook names a guide: where a notebook is run there are no guides, so it has no link
NAMED_GUIDE = re.compile(r"(?<=guide )\*([^*]+)\*")
# makes GitHub Pages serve files whose names begin with _; its text identifies a site of hdrlab
MARKER_FILE = ".nojekyll"
MARKER_TEXT = b"Made by hdrlab site, which replaces what is in this folder.\n"
WIDGETS = "_widgets"  # folder of the exported widgets
# the build removes outdated files from these folders
OWN_FOLDERS = ("notebooks", "assignments", "reference", "_images", "_modules", WIDGETS)
# sentences of a notebook that make no sense on a page, where nothing can be run
SENTENCES_ON_RUNNING = re.compile(
    r"(?s)Run the cells from the top\. |`hdrlab lab` runs .*?read on\. "
    r"|\s+You cannot break anything:.*?Enter\)\."
)
COLOUR_CODES = re.compile(r"\x1b\[[0-9;]*m")
# what stands below the title of each notebook
LESSON = re.compile(r"(?s)\*(?P<minutes>\d+) minutes\..*?Afterwards you can\s(?P<goal>.*?)\*\n")
LANGUAGE = {"name": "python", "pygments_lexer": "ipython3"}


class Lesson(NamedTuple):
    """How long a notebook takes, and what readers can do afterwards; 0 and "" if it does not say so."""

    minutes: int = 0
    goal: str = ""


class Site(NamedTuple):
    """The result of a build: the first page, the numbers of pages and widgets, and Sphinx's warnings."""

    front: Path
    pages: int
    widgets: int
    complaints: list[str]


def cache_of(out: Path) -> Path:
    """Return the cache folder of a site, next to it."""
    return out.resolve().with_name(f".{out.resolve().name}.cache")


def claim(out: Path) -> Path:
    """Mark a folder as a site of hdrlab, and return its cache folder.

    Raises
    ------
    ValueError
        If `out` is neither empty nor a previous site: a build removes outdated pages.
    """
    mark = out / MARKER_FILE
    if out.exists() and not out.is_dir():
        raise InputError(f"expected a folder to write the site to, {out} is a file")
    if (
        out.exists()
        and any(out.iterdir())
        and not (mark.exists() and mark.read_bytes() == MARKER_TEXT)
    ):
        raise InputError(
            f"{out} is neither empty nor an hdrlab site; choose another folder with --out"
        )
    live.write_changed(mark, MARKER_TEXT)
    return make_cache(out)


def make_cache(out: Path) -> Path:
    """Make the cache folder of an output folder, which git ignores, and return it."""
    cache = cache_of(out)
    live.write_changed(cache / ".gitignore", b"*\n")
    return cache


def build(
    out: Path,
    done: Sequence[ExecutedNotebook],
    handouts: Sequence[Path],
    more: Mapping[str, str],
    *,
    address: str = "",
    edition: str = "",
) -> Site:
    """Build the site from executed notebooks (STORY among them), handouts, and more pages by name.

    Handouts are shown without being run: their tasks are still to be done. If nothing has changed
    since the last build, the site is left as it is. `address` is the URL where it will be published.
    With an `edition` (see `lite.build`), each notebook's page has a button that opens it in
    JupyterLite, and some have boxes in which a reader checks a function.
    """
    record = cache_of(out) / "made.json"
    sheets = {file.stem: file.read_text("utf-8") for file in handouts}
    ran = sorted(notebook.executed.name for notebook in done)
    made_of = [library_key(course=True), ran, sheets, dict(more), address, edition]
    key = hashlib.sha256(json.dumps(made_of).encode()).hexdigest()
    if record.exists() and (out / "index.html").exists():
        before = json.loads(record.read_text("utf-8"))
        if before["key"] == key:
            return Site(out / "index.html", *before["site"])
    else:
        # a build that was killed has left half of a file, or a page that Sphinx takes for finished
        for folder in ("source", "html", "doctrees"):
            shutil.rmtree(cache_of(out) / folder, ignore_errors=True)
    record.unlink(missing_ok=True)  # so that an interrupted build leaves no record
    site = _build(out, done, sheets, more, address, edition)
    live.write_changed(record, json.dumps({"key": key, "site": site[1:]}).encode())
    return site


def _build(
    out: Path,
    done: Sequence[ExecutedNotebook],
    sheets: dict[str, str],
    more: Mapping[str, str],
    address: str,
    edition: str,
) -> Site:
    source = cache_of(out) / "source"
    html = cache_of(out) / "html"
    notebooks = {notebook.source.stem: nbformat.read(notebook.executed, 4) for notebook in done}
    story = notebooks.pop(STORY.stem)
    titles = {name: title_of(notebook) or name for name, notebook in notebooks.items()}
    modules = reference.list_modules()
    known = {*notebooks, *sheets}
    uses = {
        name: reference.find_imports(_code(notebook), modules)
        for name, notebook in notebooks.items()
    }
    texts = dict(reference.pages(titles, uses))
    handouts = {name: nbformat.reads(text, as_version=4) for name, text in sheets.items()}
    headings = {name: title_of(notebook) for name, notebook in handouts.items()}
    guides = [page for page in PAGES.rglob("*.md") if page.name != "index.md"]
    guide_of_title = {page.read_text("utf-8").splitlines()[0][2:]: page.name for page in guides}
    screen_figure = _find_screen_figure(notebooks)
    widgets = 0
    shutil.rmtree(html / WIDGETS, ignore_errors=True)  # some notebooks may be gone
    for folder, group in {"notebooks": notebooks, "assignments": handouts}.items():
        for name, notebook in group.items():
            if edition and folder == "notebooks":
                boxes.insert(notebook, name, set(sheets))
            _link_guides(notebook, guide_of_title)
            texts[f"{folder}/{name}.ipynb"], count = _prepare_notebook(
                notebook, name, known, html / WIDGETS, f"../{WIDGETS}"
            )
            widgets += count
    *_, (_, hero) = live.widgets(story, STORY.stem)
    texts[STORY.name], count = _prepare_notebook(story, STORY.stem, known, html / WIDGETS, WIDGETS)
    live.write_changed(html / "_static" / "preview.jpg", _preview(hero))
    first = {
        "hero": Markup(hero.as_html(WIDGETS)),
        "titles": titles,
        "story": describe_lesson(story),
        "lessons": {name: describe_lesson(notebook) for name, notebook in notebooks.items()},
        "handouts": headings,
        "edition": edition,
    }
    texts["index.md"] = render_page(PAGES, "index.md", **first)
    for page in guides:
        name = page.relative_to(PAGES).as_posix()
        texts[name] = unlink_missing_notebooks(page.read_text("utf-8"), known)
    texts[SCREEN_GUIDE] = texts[SCREEN_GUIDE].replace(SCREEN_PLACE, screen_figure)
    texts |= more
    files = {name: text.encode() for name, text in texts.items()}
    for image in [*PAGES.glob("cases/*.webp"), *PAGES.glob("teachers_sheets/*.svg")]:
        files[image.relative_to(PAGES).as_posix()] = image.read_bytes()
    for name, content in files.items():
        live.write_changed(source / name, content)
    _remove_other_files(source, set(files))
    complaints = _sphinx(source, html, address, edition)
    for part in ("notebooks", "assignments", "reference"):
        _remove_other_files(html, {name.rpartition(".")[0] + ".html" for name in texts}, part)
    _publish(html, out)
    return Site(out / "index.html", len(texts), widgets + count, complaints)


def _find_screen_figure(notebooks: Mapping[str, Any]) -> str:
    """Return the HTML of the figure of SCREEN_NOTEBOOK that measures the screen, "" if there is none."""
    if SCREEN_NOTEBOOK not in notebooks:
        return ""
    for _, widget in live.widgets(notebooks[SCREEN_NOTEBOOK], SCREEN_NOTEBOOK):
        if {"gray", "dark"} <= widget.state.keys():
            return widget.as_html(WIDGETS)
    return ""


def _link_guides(notebook: Any, guide_of_title: Mapping[str, str]) -> None:
    """Make links of the titles of guides that a notebook names as "the guide *Title*"."""

    def link(named: re.Match[str]) -> str:
        guide = guide_of_title.get(" ".join(named[1].split()))
        return f"[{named[1]}](../{guide})" if guide else named[0]

    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            cell.source = NAMED_GUIDE.sub(link, cell.source)


def _code(notebook: Any) -> list[str]:
    return [cell.source for cell in notebook.cells if cell.cell_type == "code"]


def title_of(notebook: Any) -> str:
    """Return a notebook's title, its first heading."""
    text = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")
    return next((line[2:].strip() for line in text.splitlines() if line.startswith("# ")), "")


def describe_lesson(notebook: Any) -> Lesson:
    """Return the minutes of a notebook and what readers learn, from the text below its title."""
    text = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")
    stated = LESSON.search(text)
    if stated is None:
        return Lesson()
    return Lesson(int(stated["minutes"]), " ".join(stated["goal"].split()))


def _prepare_notebook(
    notebook: Any, name: str, known: set[str], folder: Path, address: str
) -> tuple[str, int]:
    """Export a notebook's widgets to `folder`; return its text for Sphinx and the number of widgets.

    `address` is the address of the folder, as seen from the notebook's page.
    """
    exported = list(live.widgets(notebook, name))
    for output, widget in exported:
        live.write_widget(widget, folder)
        output["data"] = {"text/html": widget.as_html(address)}
    questions = [output for output, widget in exported if widget.question]
    covers.mark_covered(notebook.cells, _cells_of(questions, notebook))
    live.extract_images(notebook, name, folder, address)
    notebook.metadata.pop("widgets", None)
    notebook.metadata.setdefault("language_info", LANGUAGE)
    if not title_of(notebook):
        notebook.cells.insert(0, nbformat.v4.new_markdown_cell(f"# {name}"))
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            cell.source = SENTENCES_ON_RUNNING.sub("", unlink_missing_notebooks(cell.source, known))
        # JupyterLab folds a cell by its metadata, myst-nb by a tag
        if cell.metadata.get("jupyter", {}).get("source_hidden"):
            tags = cell.metadata.get("tags", ())
            cell.metadata["tags"] = [*tags, "hide-input"]
    return nbformat.writes(notebook), len(exported)


def _cells_of(outputs: Sequence[Any], notebook: Any) -> list[int]:
    """Return the indices of the cells that have some of these outputs."""
    wanted = {id(output) for output in outputs}
    return [
        index
        for index, cell in enumerate(notebook.cells)
        if any(id(output) in wanted for output in cell.get("outputs", ()))
    ]


def unlink_missing_notebooks(text: str, known: set[str]) -> str:
    """Return Markdown in which links to notebooks that the site lacks are plain text."""

    def link(found: re.Match[str]) -> str:
        return found[0] if found[2] in known else found[1]

    return re.sub(r"\[([^\]]+)\]\((?:\.\./)?(?:notebooks/|assignments/)?(\w+)\.ipynb\)", link, text)


def _preview(hero: live.ExportedWidget) -> bytes:
    """Return the preview image for links to the site: half of each of the first page's two images."""
    left, right = [
        web.decode_picture(base64.b64decode(image["base64"])) for image in hero.state["pictures"]
    ]
    middle = left.shape[1] // 2
    return web.encode_jpeg(np.hstack([left[:, :middle], right[:, middle:]]))


def _sphinx(source: Path, html: Path, address: str, edition: str) -> list[str]:
    """Run Sphinx and return its warnings."""
    from sphinx.application import Sphinx

    from hdrlab.course.site.sphinx import SETTINGS

    complaints = io.StringIO()
    notes = html.parent / "doctrees"
    base_url = address and address.rstrip("/") + "/"
    settings = SETTINGS | {"html_baseurl": base_url, "html_context": {"edition": edition}}
    Sphinx(source, None, html, notes, "html", settings, status=None, warning=complaints).build()
    return [
        line for line in COLOUR_CODES.sub("", complaints.getvalue()).splitlines() if line.strip()
    ]


def _remove_other_files(folder: Path, names: set[str], part: str = "") -> None:
    """Remove the files of a subfolder that are not in `names`."""
    for file in list((folder / part).rglob("*")):
        if file.is_file() and file.relative_to(folder).as_posix() not in names:
            file.unlink()


def _publish(html: Path, out: Path) -> None:
    """Copy the built site to `out`, and remove outdated files from its own folders."""
    files = [file for file in html.rglob("*") if file.is_file() and file.name[0] != "."]
    made = {file.relative_to(html).as_posix() for file in files}
    for name in sorted(made):
        live.write_changed(out / name, (html / name).read_bytes())
    for part in OWN_FOLDERS:
        _remove_other_files(out, made, part)
