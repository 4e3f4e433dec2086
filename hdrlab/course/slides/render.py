"""Write slides as a page of HTML that loads nothing: text, formulas, figures and live widgets are in it."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from markupsafe import Markup

from hdrlab import __version__
from hdrlab.course.site import formulas, live, pages
from hdrlab.course.slides.markdown import height_of, parser
from hdrlab.course.slides.rule import Slide, SlideKind
from hdrlab.show.pages.templates import render_page

HERE = Path(__file__).parent
LIVE_SCRIPT = Path(live.__file__).parent / "theme" / "static" / "live.js"
MAX_SHORT_LINES = 6.0  # of text, which is then set in larger letters
EQUATION_PIXELS = 40.0  # size of the letters of a displayed equation
MIN_EQUATION_PIXELS = 30.0  # an equation with smaller letters is broken at its wide spaces
MAX_EQUATION_WIDTH_PIXELS = 1150.0
WIDE_SPACE = r"\qquad"
FORMULA_WIDTH = re.compile(r'style="width:([\d.]+)em')


def render_deck(slides: Sequence[Slide], notebook: Any, name: str) -> str:
    """Return the page of a deck.

    Parameters
    ----------
    slides : the slides of the notebook, see `rule.make_slides`
    notebook : the executed notebook
    name : its name, by which the deck names its widgets
    """
    widgets = {id(output): widget for output, widget in live.widgets(notebook, name)}
    scripts: dict[str, str] = {}
    shown = []
    for slide in slides:
        outputs = [] if slide.cell is None else notebook.cells[slide.cell].get("outputs", [])
        for output in outputs:
            if id(output) in widgets:
                scripts |= widgets[id(output)].scripts()
        notes = [*slide.notes, *(_printed_note(notebook, cell) for cell in slide.printed)]
        is_code = slide.kind is SlideKind.CODE
        shown.append(
            {
                "kind": slide.kind.value,
                "heading": inline_html(slide.heading),
                "label": slide.label,
                "is_short": is_short(slide.text),
                "lead": to_html(slide.lead),
                "text": slide.text if is_code else to_html(slide.text),
                "figure": Markup("".join(_figures(outputs, widgets))),
                "printed": _printed(outputs),
                "notes": to_html("\n\n".join(notes), for_notes=True),
            }
        )
    return render_page(
        HERE,
        "deck.html",
        title=slides[0].heading if slides else name,
        version=__version__,
        slides=shown,
        styles=[_asset("reveal/reveal.css"), _asset("deck.css")],
        contained={key: Markup(text) for key, text in scripts.items()},
        scripts=[
            _asset("reveal/reveal.js"),
            _asset("reveal/notes.js"),
            Markup(LIVE_SCRIPT.read_text("utf-8")),
            _asset("deck.js"),
        ],
    )


def is_short(text: str) -> bool:
    """Return whether a slide's text is short enough for larger letters."""
    return not text.startswith("|") and height_of(text) <= MAX_SHORT_LINES


def _asset(name: str) -> Markup:
    """Return a script or a style of this package, which is part of the page."""
    return Markup((HERE / name).read_text("utf-8"))


def _figures(outputs: Sequence[Any], widgets: dict[int, live.ExportedWidget]) -> list[str]:
    """Return the HTML of the widgets and figures of a cell."""
    html = []
    for output in outputs:
        data = output.get("data", {})
        if id(output) in widgets:
            html.append(widgets[id(output)].as_embedded_html())
        elif "text/html" in data:
            html.append("".join(data["text/html"]))
        elif "text/plain" in data:
            html.append(f"<pre>{Markup.escape(''.join(data['text/plain']))}</pre>")
    return html


def _printed(outputs: Sequence[Any]) -> str:
    """Return what a cell printed."""
    texts = ["".join(each["text"]) for each in outputs if each["output_type"] == "stream"]
    return "".join(texts).rstrip()


def _printed_note(notebook: Any, cell: int) -> str:
    printed = _printed(notebook.cells[cell].get("outputs", []))
    return f"```text\n{printed}\n```"


@cache
def _converter(*, for_notes: bool) -> Any:
    """Return a converter of Markdown to HTML that draws formulas.

    In notes, formulas are MathML: the speaker's window has no style of ours.
    """
    converter = parser()
    math_inline = _mathml if for_notes else _inline_formula
    math_block = _mathml if for_notes else _equation
    converter.add_render_rule("math_inline", _math_rule(math_inline))
    converter.add_render_rule("math_block", _math_rule(math_block))
    converter.add_render_rule("link_open", _open_link)
    return converter


def _math_rule(draw: Any) -> Any:
    def render(self: Any, tokens: Any, index: int, options: Any, env: Any) -> str:
        return str(draw(tokens[index].content))

    return render


def _inline_formula(tex: str) -> str:
    return f'<span class="math">{formulas.formula(tex)}</span>'


def _mathml(tex: str) -> str:
    return ET.tostring(formulas.tree(tex, inline=True), "unicode")


def _equation(tex: str) -> str:
    """Return a displayed equation, on several lines if it is too wide for one."""
    lines = [tex]
    if _letter_pixels(tex) < MIN_EQUATION_PIXELS:
        first, *parts = tex.split(WIDE_SPACE)
        lines = [first]
        for part in parts:
            longer = f"{lines[-1]}{WIDE_SPACE}{part}"
            if _letter_pixels(longer) < MIN_EQUATION_PIXELS:
                lines.append(part)
            else:
                lines[-1] = longer
    size = min(_letter_pixels(line) for line in lines)
    rows = "".join(f"<div>{formulas.formula(line, inline=False)}</div>" for line in lines)
    return f'<div class="equation" style="font-size:{size:.1f}px">{rows}</div>'


def _letter_pixels(tex: str) -> float:
    """Return the size of letters with which a line of an equation fits on a slide."""
    width = FORMULA_WIDTH.search(formulas.formula(tex, inline=False))
    if width is None:
        return EQUATION_PIXELS
    return min(EQUATION_PIXELS, MAX_EQUATION_WIDTH_PIXELS / float(width[1]))


def _open_link(self: Any, tokens: Any, index: int, options: Any, env: Any) -> str:
    """Open links in another window, so that the deck stays where it is."""
    tokens[index].attrSet("target", "_blank")
    tokens[index].attrSet("rel", "noopener")
    return str(self.renderToken(tokens, index, options, env))


def to_html(text: str, *, for_notes: bool = False) -> Markup:
    """Return Markdown as HTML; links to other notebooks become plain text.

    Examples
    --------
    >>> print(to_html("See [05, Robertson](05_response_robertson.ipynb)."))
    <p>See 05, Robertson.</p>
    <BLANKLINE>
    """
    unlinked = pages.unlink_missing_notebooks(text, set())
    return Markup(_converter(for_notes=for_notes).render(unlinked))


def inline_html(text: str) -> Markup:
    """Return one line of Markdown, such as a heading, as HTML."""
    return Markup(_converter(for_notes=False).renderInline(text))
