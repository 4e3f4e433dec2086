"""What all widgets share: scripts and a style sheet that load nothing from elsewhere, and a still picture."""

from pathlib import Path
from typing import Any

import anywidget

from hdrlab.io import web
from hdrlab.show.pictures import Picture, encode
from hdrlab.show.plots.figures import fit

HERE = Path(__file__).parent
STYLE = HERE / "widgets.css"
SIDE = 960  # pixels of a still picture: it travels beside the widget in every saved notebook


def script(*names: str) -> str:
    """Return one module of these files, after what all widgets share: a widget's script imports nothing."""
    return "".join((HERE / name).read_text("utf-8") for name in ("canvas.js", *names))


class Widget(anywidget.AnyWidget):
    """A widget that is a still picture with alt text wherever a saved notebook is read without its model."""

    _css = STYLE

    def still(self) -> Picture:
        """Return what the widget shows before anything is moved."""
        raise NotImplementedError

    def fallback(self) -> tuple[str, str]:
        """Return the still picture as HTML and as text."""
        still = self.still()
        frames = tuple(encode(fit(web.decode_picture(frame), SIDE)) for frame in still.frames)
        return still._replace(frames=frames)._repr_html_(), repr(still)

    def _repr_mimebundle_(self, **kwargs: Any) -> tuple[dict[str, Any], dict[str, Any]]:
        data, metadata = super()._repr_mimebundle_(**kwargs) or ({}, {})
        html, text = self.fallback()
        return data | {"text/html": html, "text/plain": text}, metadata
