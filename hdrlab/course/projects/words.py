"""A student's words, in Markdown or in a short notebook, as the sections of a page.

Headings part them. HTML in the words is shown as it is written, links lead to the web alone, and
pictures come out of the project's folder, decoded and encoded again.
"""

import base64
import json
import re
import tomllib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import unquote

from markdown_it import MarkdownIt
from markdown_it.token import Token
from markupsafe import Markup, escape

from hdrlab.core.arrays import to_256
from hdrlab.course.sanitize import sanitize_line
from hdrlab.errors import InputError
from hdrlab.io import photos, web
from hdrlab.show.plots import figures

ASKED: dict[str, str] = tomllib.loads(Path(__file__).with_name("asked.toml").read_text("utf8"))
MOST = 5_000_000  # bytes of words
COLUMNS = 200  # of a table; lines with more are plain text
SIDE = 1400  # pixels of a picture
Pictures = dict[str, bytes]


class Section(NamedTuple):
    """A part of the report: its heading, which of the asked it is, or "", and its words as HTML."""

    heading: str
    asked: str
    html: Markup


class Words(NamedTuple):
    """A title, sections, and what could not be shown, in words."""

    title: str
    sections: tuple[Section, ...]
    notes: tuple[str, ...]

    def missing(self) -> list[str]:
        """Return what is asked for and has no section."""
        return [name for name in ASKED if name not in {one.asked for one in self.sections}]


def read(path: Path) -> Words:
    """Read a file of words.

    Raises
    ------
    ValueError
        For a file that is too large, is not UTF-8, or is no notebook though it is called one.
    """
    if path.stat().st_size > 20 * MOST:
        raise InputError(f"{path}: expected a short report, got {path.stat().st_size} bytes")
    try:
        text = path.read_text(encoding="utf8")
        pictures = Pictures()
        if path.suffix == ".ipynb":
            text, pictures = notebook(text)
    except UnicodeDecodeError:
        raise InputError(f"{path}: expected text in UTF-8") from None
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise InputError(f"{path}: expected a notebook ({error})") from None
    text = text.encode("utf8", "replace").decode("utf8")  # JSON may hold half a character
    if len(text) > MOST:
        raise InputError(f"{path}: expected at most {MOST} characters, got {len(text)}")
    return sections(text, path.parent, pictures)


def notebook(text: str) -> tuple[str, Pictures]:
    """Return the Markdown of a notebook, with the pictures that its cells have shown."""
    parts = []
    pictures = Pictures()
    for number, cell in enumerate(json.loads(text)["cells"], 1):
        if cell["cell_type"] == "markdown":
            parts.append("".join(cell["source"]))
        for shown in cell.get("outputs", ()):
            data = shown.get("data", {})
            for kind in ("image/png", "image/jpeg"):
                if kind in data:
                    name = f"cell-{number}-{len(pictures)}"
                    pictures[name] = base64.b64decode("".join(data[kind]))
                    alt = "".join(data.get("text/plain", f"Image of cell {number}"))
                    said = re.sub(r"[^\w .,:()-]", " ", sanitize_line(alt, 120))
                    parts.append(f"![{said}]({name})")
                    break
    return "\n\n".join(parts), pictures


def sections(text: str, folder: Path, pictures: Pictures | None = None) -> Words:
    """Return Markdown as Words; pictures are looked up by name, and then in the folder."""
    notes: list[str] = []
    parser = MarkdownIt("commonmark", {"html": False, "linkify": False}).enable("strikethrough")
    # else its time grows with their square
    if max(line.count("|") for line in text.split("\n")) <= COLUMNS:
        parser.enable("table")
    parser.add_render_rule("image", _drawing(folder, pictures or {}, notes))
    tokens = parser.parse(text)
    heads = [k for k, one in enumerate(tokens) if one.type == "heading_open" and not one.level]
    levels = [int(tokens[k].tag[1]) for k in heads]
    lone = bool(heads) and levels.count(min(levels)) == 1  # the only one of its level is the title
    title = _text(tokens[heads[0] + 1]) if lone and levels[0] == min(levels) else ""
    top = min((level for level in levels[bool(title) :]), default=9)
    starts = [k for k, level in zip(heads, levels, strict=True) if level == top]
    first = heads[0] + 3 if title else 0
    found = []
    ends = [*starts[1:], len(tokens)]
    if before := tokens[first : starts[0] if starts else len(tokens)]:
        found.append(Section("", "", _html(parser, before, top)))
    for start, end in zip(starts, ends[: len(starts)], strict=True):
        heading = _text(tokens[start + 1])
        asked = (name for name, says in ASKED.items() if re.search(says, heading, re.IGNORECASE))
        found.append(Section(heading, next(asked, ""), _html(parser, tokens[start + 3 : end], top)))
    return Words(title, tuple(found), tuple(notes))


def _html(parser: MarkdownIt, tokens: Sequence[Token], top: int) -> Markup:
    """Return tokens as HTML, which holds no other tags than those of Markdown."""
    return Markup(parser.renderer.render(_lowered(tokens, top), parser.options, {}))


def _text(inline: Token) -> str:
    return sanitize_line("".join(one.content for one in inline.children or ()), 200)


def _lowered(tokens: Sequence[Token], top: int) -> Sequence[Token]:
    """Return tokens whose headings go on from the third level: the page has the first and the second."""
    for one in tokens:
        if one.type in ("heading_open", "heading_close"):
            one.tag = f"h{min(6, 2 + max(1, int(one.tag[1]) - top))}"
    return tokens


def _drawing(folder: Path, pictures: Pictures, notes: list[str]) -> Callable[..., str]:
    """Return what draws a picture of the words."""

    def draw(self: Any, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        source = unquote(str(tokens[at].attrs["src"]))
        alt = sanitize_line(tokens[at].content, 300)
        try:
            image = _decoded(source, folder, pictures)
        except Exception as error:  # on damaged pictures the codecs raise what they like
            notes.append(
                f"the image {sanitize_line(source, 60)!r} is left out: {sanitize_line(str(error), 160)}"
            )
            return str(escape(f"[{alt or sanitize_line(source, 60)}]"))
        if not alt:
            said = "has no description for readers who cannot see it; add one: ![description]"
            notes.append(
                f"the image {sanitize_line(source, 60)!r} {said}({sanitize_line(source, 40)})"
            )
        shown = figures.photograph(image, SIDE, alt)
        return f'<img src="{shown.src}" alt="{escape(alt)}" width="{shown.width}" height="{shown.height}">'

    return draw


def _decoded(source: str, folder: Path, pictures: Pictures) -> figures.Image:
    """Return the pixels of a picture that a cell has shown, or of a file of the folder."""
    if source in pictures:
        return web.decode_picture(pictures[source])
    path = (folder / source).resolve()
    if "://" in source or not path.is_relative_to(folder.resolve()) or not path.is_file():
        raise InputError("expected an image in the project's folder")
    return to_256(photos.read_photo(path))
