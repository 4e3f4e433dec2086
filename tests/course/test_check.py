"""check("hat") in a notebook: a bar while it runs, and the points that the sheet says."""

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


def test_a_bar_grows_while_the_promises_of_a_task_are_checked_and_goes_at_the_end(monkeypatch):
    shown = []
    monkeypatch.setattr(notebook, "_history", lambda: [Cell(RIGHT)])
    for way in ("display", "update"):
        monkeypatch.setattr(DisplayHandle, way, lambda handle, html: shown.append(html.data))
    monkeypatch.setattr(notebook, "_plan", {})
    monkeypatch.setattr(notebook, "_latest", {})
    notebook.use_plan("hw2", hat=20)
    found = notebook.check("hat")
    assert found.points == found.homework.points == 20 and "20 of 20 points" in found._repr_html_()
    first, *growing, last = shown
    assert "hat, checking" in first and last == ""
    assert [re.search(r": (\d) of 4 promises", one)[1] for one in growing] == list("12344")
