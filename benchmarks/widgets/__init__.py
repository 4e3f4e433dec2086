"""How quickly widgets answer in a real browser: every notebook in JupyterLab, and the Detail Brush.

latency  from the event of a key on a slider to the frame of the display that shows the new picture
first    from the start of a run to the first picture on the page, its kernel being ready

Headless, so the screen itself takes up to a frame more. Every slider of every `play` and `tune` is
moved there and back, and the 95th percentile of the slowest must hold. A picture of `tune` that was
made beforehand counts: it is shown until Python's comes. With HDRLAB_STORED=1 there are none, and
each is Python's.
"""

from pathlib import Path

from benchmarks.experiments import Experiment, at_least, at_most
from benchmarks.measure import ROOT
from benchmarks.widgets import brushing, notebooks

FIRST = 5.0
PLAY = 25.0
TUNE = 100.0
FRAMES = 50.0


def row(path: Path) -> Experiment:
    """Return the row of a notebook; it must hold what the widgets in it must."""
    text = path.read_text(encoding="utf8")
    holds = [at_most(notebooks.FIRST, FIRST)]
    if "widgets.play(" in text:
        holds.append(at_most(notebooks.WORST["play"], PLAY))
    if "widgets.tune(" in text:
        holds.append(at_most(notebooks.WORST["tune"], TUNE))
    return Experiment(
        path.stem, "in JupyterLab", lambda folder: notebooks.opened(folder, path.name), tuple(holds)
    )


ROWS: tuple[Experiment, ...] = (
    *map(row, sorted((ROOT / "notebooks").glob("*.ipynb"))),
    Experiment(
        "brush",
        "the Detail Brush at 1024 x 768 with a window of 512",
        brushing.brushed,
        (at_least(brushing.FIGURE, *[FRAMES] * len(brushing.MAGNIFICATIONS)),),
    ),
)
