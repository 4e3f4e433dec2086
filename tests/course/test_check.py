"""`check("hat")` in a notebook: a progress bar, then the points of the task."""

import re

import pytest
from IPython.display import DisplayHandle

from hdrlab.course import notebook
from hdrlab.course.source_code.closure import Cell

pytestmark = pytest.mark.grading

RIGHT = """import numpy as np

def hat(n=256):
    z = np.arange(n)
    return np.minimum(z, n - 1 - z) / ((n - 1) // 2)
"""


def test_check_shows_a_progress_bar_that_disappears_at_the_end(monkeypatch):
    shown = []
    monkeypatch.setattr(notebook, "_cells_of_kernel", lambda: [Cell(RIGHT)])
    for way in ("display", "update"):
        monkeypatch.setattr(DisplayHandle, way, lambda handle, html: shown.append(html.data))
    monkeypatch.setattr(notebook, "_planned", {})
    monkeypatch.setattr(notebook, "_latest", {})
    notebook.use_plan("hw2", hat=20)
    report = notebook.check("hat")
    assert report.points == report.homework.points == 20
    assert "20 of 20 points" in report._repr_html_()
    first, *growing, last = shown
    assert "hat, checking" in first and last == ""
    assert [re.search(r": (\d) of 4 checks", html)[1] for html in growing] == list("12344")
