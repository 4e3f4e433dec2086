"""`hdrlab lab` opens a notebook for reading, runs it without a click, and runs no other code."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from laboratory import PATIENCE, Absent, Lab, jupyterlab

from hdrlab.course import materials

pytestmark = pytest.mark.browser

WELCOME = "notebooks/00_welcome.ipynb"
TIME_FOR_A_FIRST_CELL = 3000  # ms after the kernel is ready
# "[ ]:" beside a code cell that has not run, "[*]:" while it waits or runs, and then a number; nothing
# beside a folded cell
PROMPTS = """() => [...document.querySelectorAll(".jp-CodeCell .jp-InputPrompt")]
    .map((prompt) => prompt.textContent.trim())"""
# The largest fraction of the window's height that a figure takes, of those that are shown
TALLEST = """() => Math.max(...[...document.querySelectorAll(".jp-OutputArea-output :is(img, canvas)")]
    .map((figure) => figure.getBoundingClientRect().height / innerHeight))"""


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    """A JupyterLab that `hdrlab lab` has started on a new folder."""
    try:
        with jupyterlab(tmp_path_factory.mktemp("course"), by_hdrlab=True) as started:
            yield started
            started.close()
    except Absent as reason:
        pytest.skip(str(reason))


def write_changed(lab: Lab, name: str, change: Any) -> None:
    """Write a copy of the first notebook whose first code cell was changed."""
    notebook = json.loads((lab.folder / WELCOME).read_text("utf-8"))
    change(next(cell for cell in notebook["cells"] if cell["cell_type"] == "code"))
    (lab.folder / name).write_text(json.dumps(notebook), "utf-8")


def test_the_first_notebook_is_open_for_reading_and_runs_without_a_click(course, page):
    page.set_viewport_size({"width": 1280, "height": 720})
    page.goto(f"{course.address}/?token={course.token}")
    contents = page.locator(".jp-TableOfContents-content")
    contents.get_by_text("Tone mapping", exact=True).wait_for(timeout=PATIENCE)
    assert not page.locator(".jp-FileBrowser").is_visible()
    course.until_done(page)
    assert page.evaluate("document.querySelector('.jp-WindowedPanel-outer').scrollTop") == 0

    slider = page.locator(".hdrlab").get_by_role("slider", name="exposure changed by")
    slider.scroll_into_view_if_needed()
    slider.press("End")
    picture = page.get_by_role("img", name="A photo of the workshop, exposure changed by +6 stops")
    picture.wait_for(timeout=PATIENCE)

    code = (course.folder / WELCOME).read_text("utf-8")
    covers = page.locator(".hdrlab-cover").filter(visible=True)
    answers = page.locator(".hdrlab-covered .jp-Cell-outputWrapper")
    assert covers.count() == code.count('"predict.')
    assert answers.count() >= covers.count()
    assert answers.filter(visible=True).count() == 0
    assert 0.3 < page.evaluate(TALLEST) <= 0.551


def change_code(cell: dict[str, Any]) -> None:
    cell["source"] = [*cell["source"], "\nprint('somebody else')"]


def keep_an_output(cell: dict[str, Any]) -> None:
    cell["outputs"] = [{"output_type": "stream", "name": "stdout", "text": ["my result"]}]


@pytest.mark.parametrize("change", [change_code, keep_an_output])
def test_a_notebook_with_other_code_or_with_outputs_does_not_run(course, page, change):
    name = f"{change.__name__}.ipynb"
    write_changed(course, name, change)
    course.open(page, name)
    page.wait_for_timeout(TIME_FOR_A_FIRST_CELL)
    assert set(page.evaluate(PROMPTS)) == {"", "[ ]:"}


def test_another_name_does_not_keep_an_unchanged_notebook_from_running(course, page):
    write_changed(course, "another.ipynb", lambda cell: None)
    course.open(page, "another.ipynb")
    page.wait_for_function(f"() => ({PROMPTS})().includes('[2]:')", timeout=PATIENCE)


def test_lab_stores_its_layout_in_the_course_and_nowhere_else(course):
    home = course.folder.parent
    assert list((course.folder / ".jupyter/workspaces").glob("default-*.jupyterlab-workspace"))
    assert not (home / "workspaces").exists() and not (home / "settings").exists()


def test_the_extension_has_the_version_of_hdrlab():
    import hdrlab

    package = Path(materials.LAB_EXTENSIONS) / "hdrlab/package.json"
    assert json.loads(package.read_text("utf-8"))["version"] == hdrlab.__version__
