"""What a student reads of a Result: in a notebook, on a page that travels alone, or at a terminal.

Everything that a student wrote, or that their function said, is text here: it is escaped where it
is put in, and the page forbids scripts besides. Of a hidden check the outcome alone is shown.
"""

import re
from functools import cache, partial
from pathlib import Path

import jinja2

from hdrlab.course.grading import results
from hdrlab.io import web
from hdrlab.show.pages.templates import templates

# what XML 1.0 cannot hold
FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def fragment(result: results.Result, *, private: bool = False) -> str:
    """Return a Result as a piece of a page, for a notebook's output.

    Parameters
    ----------
    result : Result
    private : whether the reader is the instructor, who sees what hidden checks say, too
    """
    return str(environment().get_template("feedback.html").module.whole(result, private, True))  # type: ignore[attr-defined]


def bar(points: float, whole: float, what: str, unit: str = "points") -> str:
    """Return how far something has come, as a piece of a page."""
    return str(environment().get_template("feedback.html").module.bar(points, whole, what, unit))  # type: ignore[attr-defined]


def page(result: results.Result, *, private: bool = False) -> str:
    """Return a Result as a page, complete in itself: it fetches nothing and runs nothing."""
    return (
        environment()
        .get_template("feedback_page.html")
        .render(result=result, private=private)
        .lstrip()
    )


def text(result: results.Result, *, hints: int = 0, private: bool = False) -> str:
    """Return a Result as lines for a terminal, with the first so many hints of what does not hold."""
    template = environment().get_template("feedback.plain")
    return template.render(result=result, hints=hints, private=private)


def number(value: float) -> str:
    """Return points as a reader wants them: 7, or 7.5.

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


@cache  # a class has many pages, and the templates are translated once
def environment() -> jinja2.Environment:
    """Return the templates of a Result, with the filters that they use."""
    found = templates(Path(__file__).parent)
    found.filters |= {"pictures": _pictures, "number": number, "points": results.points}
    found.filters["xml"] = partial(FORBIDDEN.sub, "")
    return found
