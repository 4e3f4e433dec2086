"""A notebook saved with its widgets opens in `hdrlab lab` without being run again."""

import json

import nbformat
import pytest
from laboratory import PATIENCE, Absent, jupyterlab

from hdrlab.course import materials

pytestmark = pytest.mark.browser

CELL = """import numpy as np
from hdrlab.show import widgets

def square(level=100, side=40):
    return np.full((side, 60), level, np.uint8)

widgets.tune(square, lambda picture: picture, alt="A square", level=(0, 200, 20), side=[40, 60])"""
SAVE = "() => window.jupyterapp.commands.execute('docmanager:save')"
STATE = "application/vnd.jupyter.widget-state+json"


@pytest.fixture
def reader(tmp_path, monkeypatch):
    """A JupyterLab as `hdrlab lab` starts it."""
    monkeypatch.setenv("JUPYTER_CONFIG_PATH", str(materials.JUPYTER))
    try:
        with jupyterlab(tmp_path) as started:
            yield started
    except Absent as reason:
        pytest.skip(str(reason))


def widget_of(page):
    widget = page.locator(".jp-OutputArea-output .hdrlab")
    widget.wait_for(timeout=PATIENCE)
    return widget


def test_a_saved_notebook_that_is_opened_again_answers_at_every_position_before_it_is_run(
    reader, page
):
    file = reader.folder / "saved.ipynb"
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3"}}
    nbformat.write(
        nbformat.v4.new_notebook(metadata=kernel, cells=[nbformat.v4.new_code_cell(CELL)]), file
    )
    reader.open(page, file.name)
    reader.run_all(page)
    widget_of(page)
    page.evaluate(SAVE)
    saved = json.loads(file.read_text("utf-8"))
    assert saved["metadata"]["widgets"][STATE]["state"]
    outputs = [output["data"] for output in saved["cells"][0]["outputs"] if "data" in output]
    assert len(outputs) == 1
    output = outputs[0]
    assert "".join(output["text/plain"]).startswith("A square")
    assert "<img alt=" in "".join(output["text/html"])

    reader.close()
    reader.open(page, file.name)  # with a new kernel
    widget = widget_of(page)
    for name, key, words in (
        ("level", "End", "level 200, side 40"),
        ("side", "End", "level 200, side 60"),
    ):
        widget.get_by_role("slider", name=name).press(key)
        expected = f"A square, {words}"
        page.wait_for_function(
            "([el, words]) => el.querySelector('canvas').getAttribute('aria-label') === words",
            arg=[widget.element_handle(), expected],
            timeout=PATIENCE,
        )
    assert widget.get_by_role("status").inner_text() == "Computed beforehand."
    size = widget.evaluate(
        "el => [el.querySelector('canvas').width, el.querySelector('canvas').height]"
    )
    assert size == [60, 60]
    # be told the news, as JupyterLab asks
    assert page.get_by_text("Would you like to").count() == 0
