r"""Convert the Markdown of a question to HTML, with formulas as TeX between \( and \)."""

from html import escape
from typing import Any

from hdrlab.course.slides.markdown import parser


def to_html(markdown: str) -> str:
    """Return Markdown as HTML, with formulas as TeX."""
    converter = parser()
    converter.add_render_rule("math_inline", _inline_tex)
    converter.add_render_rule("math_block", _displayed_tex)
    return str(converter.render(markdown))


def _inline_tex(self: object, tokens: list[Any], index: int, options: object, env: object) -> str:
    return rf"\({escape(tokens[index].content)}\)"


def _displayed_tex(
    self: object, tokens: list[Any], index: int, options: object, env: object
) -> str:
    return rf"<p>\[{escape(tokens[index].content)}\]</p>"
