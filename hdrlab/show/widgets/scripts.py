"""The widgets' scripts and their style sheet: they travel in the package and load nothing from elsewhere."""

from pathlib import Path

HERE = Path(__file__).parent
STYLE = HERE / "widgets.css"


def script(*names: str) -> str:
    """Return one module of these files, after what all widgets share: a widget's script imports nothing."""
    return "".join((HERE / name).read_text("utf-8") for name in ("canvas.js", *names))
