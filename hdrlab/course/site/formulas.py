"""Formulas as a page shows them: drawn as SVG when the site is built, so that it needs no script and no font.

Beside the drawing stands MathML that is not seen, which a screen reader speaks and a reader can
copy.
"""

import warnings
import xml.etree.ElementTree as ET
from functools import cache
from typing import Any

from hdrlab.errors import InputError

SIZE = 20.0  # of a letter, in the drawing's own unit
# the letters of formulas are small for their height: this makes them as large as the text's
EM = 1.15 / SIZE
PLAIN = {  # commands that the parser leaves as they are, after \big for one
    **{r"\{": "{", r"\}": "}", r"\lbrace": "{", r"\rbrace": "}", r"\lbrack": "[", r"\rbrack": "]"},
    **{
        r"\lceil": "⌈",
        r"\rceil": "⌉",
        r"\lfloor": "⌊",
        r"\rfloor": "⌋",
        r"\langle": "⟨",
        r"\rangle": "⟩",
    },
    **{r"\lvert": "|", r"\rvert": "|", r"\lVert": "‖", r"\rVert": "‖", r"\arg": "arg"},
}


@cache
def formula(tex: str, *, inline: bool = True) -> str:
    """Return a formula in the notation of TeX as HTML.

    Raises
    ------
    ValueError
        For a command that is not known.

    Examples
    --------
    >>> html = formula("g(Z) = ln E + ln t")
    >>> html.count("<svg"), html.count("<math")
    (1, 1)
    """
    # it looks for its font in a way that Python 3.11 and 3.12 warn of
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        import ziamath

    math = tree(tex, inline=inline)
    drawn = ziamath.Math(ET.tostring(math, encoding="unicode"), size=SIZE).svgxml()
    view = drawn.get("viewBox", "")
    _, top, width, height = map(float, view.split())
    box = f"width:{EM * width:.3f}em;height:{EM * height:.3f}em;vertical-align:{-EM * (top + height):.3f}em"
    svg = ET.Element("svg", {"viewBox": view, "style": box, "aria-hidden": "true"})
    svg.extend(drawn)
    for part in svg.iter():
        part.tag = part.tag.rpartition("}")[2]
    # as all are
    text = ET.tostring(svg, "unicode").replace(' fill="black"', "").replace("STIXTwoMath", "")
    return f'{text}<span class="spoken">{ET.tostring(math, "unicode")}</span>'


def tree(tex: str, *, inline: bool) -> ET.Element:
    """Return a formula as MathML, its signs set close to what they belong to: (-1, 2), not ( - 1, 2)."""
    from latex2mathml.converter import convert

    math = ET.fromstring(convert(" ".join(tex.split()), display="inline" if inline else "block"))
    for part in math.iter():
        part.tag = part.tag.rpartition("}")[2]
        if (part.text or "").startswith("\\"):
            if part.text not in PLAIN:
                raise InputError(
                    f"expected a formula that can be drawn, got {part.text} in {tex!r}"
                )
            part.text = PLAIN[part.text]
    for row in math.iter("mrow"):
        before: Any = None
        for part in row:
            opens = before is None or (
                before.tag == "mo" and before.text not in (")", "]", "}", "|", "!")
            )
            if part.tag == "mo" and part.text in ("\u2212", "+", "±") and opens:
                part.set("form", "prefix")
            if part.tag == "mo" and part.text in ("|", "‖", "∥") and part.get("fence") is None:
                # only those of left and right are as tall as what they enclose
                part.set("stretchy", "false")
            before = part
    return math
