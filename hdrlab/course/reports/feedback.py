"""Show a Result to a student: in a notebook, as a page in one file, or in a terminal.

All text from a student or from a student's function is escaped, and the page forbids scripts. Of a
hidden check, only the outcome is shown.
"""

import re
from functools import cache, partial
from pathlib import Path

import jinja2

from hdrlab.course.grading import results
from hdrlab.io import web
from hdrlab.show.pages.templates import templates

# characters that XML 1.0 does not allow
FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def fragment(result: results.Result, *, private: bool = False, fold_mistakes: bool = False) -> str:
    """Return a Result as a part of a page, for a notebook's output.

    Parameters
    ----------
    result : Result
    private : whether the reader is the instructor, who sees the details of hidden checks, too
    fold_mistakes : whether the reader must ask to see the likely mistakes
    """
    macros = environment().get_template("feedback.html").module
    return str(macros.whole(result, private, True, fold_mistakes))  # type: ignore[attr-defined]


def bar(points: float, whole: float, what: str, unit: str = "points") -> str:
    """Return a progress bar as a part of a page."""
    return str(environment().get_template("feedback.html").module.bar(points, whole, what, unit))  # type: ignore[attr-defined]


def page(result: results.Result, *, private: bool = False, receipt: str = "") -> str:
    """Return a Result as a page in one file, which loads nothing and runs no script.

    Parameters
    ----------
    result : Result
    private : whether the reader is the instructor, who sees the details of hidden checks, too
    receipt : the signed line about the Result, which the page shows, or ""
    """
    return (
        environment()
        .get_template("feedback_page.html")
        .render(result=result, private=private, receipt=receipt)
        .lstrip()
    )


def text(result: results.Result, *, hints: int = 0, private: bool = False) -> str:
    """Return a Result as lines for a terminal, with this many hints for each failed check."""
    template = environment().get_template("feedback.plain")
    return template.render(result=result, hints=hints, private=private)


def number(value: float) -> str:
    """Return points with at most two decimals, without trailing zeros.

    Examples
    --------
    >>> number(7.0), number(7.3333)
    ('7', '7.33')
    """
    return f"{float(value):.2f}".rstrip("0").rstrip(".")


def _pictures(drawing: results.Drawing) -> list[tuple[str, str, str]]:
    """Return each picture's address, alt text and caption."""
    frames = [web.data_uri(frame) for frame in drawing.frames]
    return list(zip(frames, drawing.alts, drawing.captions, strict=True))


@cache  # so that the templates are compiled once for all pages of a class
def environment() -> jinja2.Environment:
    """Return the templates of a Result, with the filters that they use."""
    loaded = templates(Path(__file__).parent)
    loaded.filters |= {"pictures": _pictures, "number": number, "points": results.points}
    loaded.filters["xml"] = partial(FORBIDDEN.sub, "")
    return loaded
