"""Read a student's report, in Markdown or in a short notebook, and split it into sections.

The headings start the sections. HTML in the text is shown as it is written, and links lead to the
web only. Images are read from the project's folder, decoded, and encoded again.
"""

import base64
import json
import re
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from markdown_it import MarkdownIt
from markdown_it.token import Token
from markupsafe import Markup, escape

from hdrlab.core.arrays import to_256
from hdrlab.course.sanitize import sanitize_line
from hdrlab.errors import InputError
from hdrlab.io import photos, web
from hdrlab.show.plots import figures

# topic that the assignment asks for -> pattern of a heading about it
TOPIC_PATTERNS: dict[str, str] = tomllib.loads(
    Path(__file__).with_name("asked.toml").read_text("utf8")
)
MAX_CHARACTERS = 5_000_000
# a notebook holds images, too
MAX_FILE_BYTES = 20 * MAX_CHARACTERS
# text whose lines have more is shown without tables: the parser's time grows with their square
MAX_TABLE_COLUMNS = 200
IMAGE_SIDE_PIXELS = 1400
IMAGE_TYPES = ("image/png", "image/jpeg")
# lower than every heading
NO_HEADING_LEVEL = 9
# an inline token and a closing one follow the token that opens a heading
TOKENS_PER_HEADING = 3

# encoded images, by the name under which the text refers to them
NotebookImages = dict[str, bytes]


@dataclass(frozen=True)
class Section:
    """A section of a report.

    Attributes
    ----------
    heading : its heading, or "" for the text before the first one
    topic : the topic of the assignment that the heading names, or ""
    html : its text
    """

    heading: str
    topic: str
    html: Markup


@dataclass(frozen=True)
class ReportText:
    """The text of a report.

    Attributes
    ----------
    title : its title, or ""
    sections : its sections, in order
    notes : what could not be shown, as sentences
    """

    title: str
    sections: tuple[Section, ...]
    notes: tuple[str, ...]

    def missing(self) -> list[str]:
        """Return the topics of the assignment that have no section."""
        present = {section.topic for section in self.sections}
        return [topic for topic in TOPIC_PATTERNS if topic not in present]


def read(path: Path) -> ReportText:
    """Read a report from a Markdown file or a notebook.

    Raises
    ------
    InputError
        For a file that is too large, is not UTF-8, or is named .ipynb and is no notebook.
    """
    size = path.stat().st_size
    if size > MAX_FILE_BYTES:
        raise InputError(f"{path}: expected a short report, got {size} bytes")
    images: NotebookImages = {}
    try:
        text = path.read_text(encoding="utf8")
        if path.suffix == ".ipynb":
            text, images = notebook(text)
    except UnicodeDecodeError:
        raise InputError(f"{path}: expected text in UTF-8; save it in this encoding") from None
    # what JSON of another form than a notebook's raises
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise InputError(f"{path}: expected a notebook ({error})") from None
    text = text.encode("utf8", "replace").decode("utf8")  # JSON may hold half a character
    if len(text) > MAX_CHARACTERS:
        raise InputError(f"{path}: expected at most {MAX_CHARACTERS} characters, got {len(text)}")
    return sections(text, path.parent, images)


def notebook(text: str) -> tuple[str, NotebookImages]:
    """Return the Markdown of a notebook, and the images in the outputs of its cells."""
    parts = []
    images: NotebookImages = {}
    for number, cell in enumerate(json.loads(text)["cells"], 1):
        if cell["cell_type"] == "markdown":
            parts.append("".join(cell["source"]))
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            encoded = _output_image(data)
            if encoded is None:
                continue
            name = f"cell-{number}-{len(images)}"
            images[name] = encoded
            alt = "".join(data.get("text/plain", f"Image of cell {number}"))
            # no character with a meaning in Markdown
            description = re.sub(r"[^\w .,:()-]", " ", sanitize_line(alt, 120))
            parts.append(f"![{description}]({name})")
    return "\n\n".join(parts), images


def _output_image(data: Mapping[str, Any]) -> bytes | None:
    """Return the encoded image in the data of a cell's output, or None if there is none."""
    for image_type in IMAGE_TYPES:
        if image_type in data:
            return base64.b64decode("".join(data[image_type]))
    return None


def sections(text: str, folder: Path, images: NotebookImages | None = None) -> ReportText:
    """Split Markdown into sections.

    Parameters
    ----------
    text : the Markdown
    folder : the project's folder, from which images are read
    images : images that are looked up by name, before the folder
    """
    notes: list[str] = []
    parser = _make_parser(text)
    parser.add_render_rule("image", _make_image_rule(folder, images or {}, notes))
    tokens = parser.parse(text)
    headings = [
        index
        for index, token in enumerate(tokens)
        if token.type == "heading_open" and token.level == 0
    ]
    levels = [int(tokens[index].tag[1]) for index in headings]
    title = ""
    # the first heading is the title if no other one is of its level or above
    if levels and all(level > levels[0] for level in levels[1:]):
        title = _heading_text(tokens, headings[0])
    if title:
        content_start = headings[0] + TOKENS_PER_HEADING
        top_level = min(levels[1:], default=NO_HEADING_LEVEL)
    else:
        content_start = 0
        top_level = min(levels, default=NO_HEADING_LEVEL)
    starts = [index for index, level in zip(headings, levels, strict=True) if level == top_level]
    boundaries = [*starts, len(tokens)]

    result = []
    introduction = tokens[content_start : boundaries[0]]
    if introduction:
        result.append(Section("", "", _render(parser, introduction, top_level)))
    for start, end in pairwise(boundaries):
        heading = _heading_text(tokens, start)
        html = _render(parser, tokens[start + TOKENS_PER_HEADING : end], top_level)
        result.append(Section(heading, _topic(heading), html))
    return ReportText(title, tuple(result), tuple(notes))


def _make_parser(text: str) -> MarkdownIt:
    """Return a Markdown parser that keeps HTML as text; with tables, if they are narrow enough."""
    parser = MarkdownIt("commonmark", {"html": False, "linkify": False}).enable("strikethrough")
    columns = max(line.count("|") for line in text.split("\n"))
    if columns <= MAX_TABLE_COLUMNS:
        parser.enable("table")
    return parser


def _topic(heading: str) -> str:
    """Return the first topic of the assignment that a heading names, or ""."""
    for topic, pattern in TOPIC_PATTERNS.items():
        if re.search(pattern, heading, re.IGNORECASE):
            return topic
    return ""


def _heading_text(tokens: Sequence[Token], index: int) -> str:
    """Return the text of the heading that the token at this index opens."""
    children = tokens[index + 1].children or ()
    return sanitize_line("".join(child.content for child in children), 200)


def _render(parser: MarkdownIt, tokens: Sequence[Token], top_level: int) -> Markup:
    """Return tokens as HTML, with no other tags than those of Markdown.

    The tokens' headings begin at the third level: the page has the first and the second.
    """
    for token in tokens:
        if token.type in ("heading_open", "heading_close"):
            depth = max(1, int(token.tag[1]) - top_level)
            token.tag = f"h{min(6, 2 + depth)}"
    return Markup(parser.renderer.render(tokens, parser.options, {}))


def _make_image_rule(folder: Path, images: NotebookImages, notes: list[str]) -> Callable[..., str]:
    """Return the parser's rule that renders an image; it notes images that it leaves out."""

    def render_image(self: Any, tokens: Sequence[Token], index: int, options: Any, env: Any) -> str:
        source = unquote(str(tokens[index].attrs["src"]))
        alt = sanitize_line(tokens[index].content, 300)
        short_source = sanitize_line(source, 60)
        try:
            pixels = _decode_image(source, folder, images)
        except Exception as error:  # the codecs raise many types for damaged images
            reason = sanitize_line(str(error), 160)
            notes.append(f"the image {short_source!r} is left out: {reason}")
            return str(escape(f"[{alt or short_source}]"))
        if not alt:
            notes.append(
                f"the image {short_source!r} has no description for readers who cannot see it; "
                f"add one: ![description]({sanitize_line(source, 40)})"
            )
        image = figures.photograph(pixels, IMAGE_SIDE_PIXELS, alt)
        size = f'width="{image.width}" height="{image.height}"'
        return f'<img src="{image.src}" alt="{escape(alt)}" {size}>'

    return render_image


def _decode_image(source: str, folder: Path, images: NotebookImages) -> figures.Image:
    """Return the pixels of an image from a cell's output, or from a file in the folder."""
    if source in images:
        return web.decode_picture(images[source])
    path = (folder / source).resolve()
    is_inside = path.is_relative_to(folder.resolve()) and path.is_file()
    if "://" in source or not is_inside:
        raise InputError("expected an image in the project's folder")
    return to_256(photos.read_photo(path))
