"""The parts that all widgets share: their scripts, their style sheet, and a still picture."""

from pathlib import Path
from typing import Any

import anywidget

from hdrlab.io import web
from hdrlab.show.pictures import Picture, encode
from hdrlab.show.plots.figures import fit

SCRIPT_FOLDER = Path(__file__).parent
STYLE_SHEET = SCRIPT_FOLDER / "widgets.css"
# Every saved notebook contains the still picture as well as the widget.
MAX_STILL_SIDE = 960


def script(*names: str) -> str:
    """Return the shared script and the named ones as one module, which imports nothing.

    Each widget in a saved notebook contains its own copy. So comment lines and indentation are left
    out, and no template literal in a script may depend on them.
    """
    lines = []
    for name in ("canvas.js", *names):
        for line in (SCRIPT_FOLDER / name).read_text("utf-8").splitlines():
            code = line.strip()
            if code and not code.startswith("//"):
                lines.append(code + "\n")
    return "".join(lines)


class Widget(anywidget.AnyWidget):
    """A widget that falls back to a still picture with alt text where no script can show it."""

    _css = STYLE_SHEET

    def still(self) -> Picture:
        """Return the widget's first picture, before the reader moves anything."""
        raise NotImplementedError

    def fallback(self) -> tuple[str, str]:
        """Return the still picture as HTML and as text."""
        still = self.still()
        frames = []
        for frame in still.frames:
            image = web.decode_picture(frame)
            frames.append(encode(fit(image, MAX_STILL_SIDE)))
        return still._replace(frames=tuple(frames))._repr_html_(), repr(still)

    def _repr_mimebundle_(self, **kwargs: Any) -> tuple[dict[str, Any], dict[str, Any]]:
        data, metadata = super()._repr_mimebundle_(**kwargs) or ({}, {})
        html, text = self.fallback()
        return data | {"text/html": html, "text/plain": text}, metadata
