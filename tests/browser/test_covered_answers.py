"""A question covers its answer until the reader answers, in JupyterLab and in Notebook 7.

The same on the site is tested in `test_site_in_a_browser`.
"""

from importlib.util import find_spec

import nbformat
import pytest

PATIENCE = 60_000  # ms
pytestmark = pytest.mark.browser

IMPORTS = """import numpy as np
from hdrlab.show import pictures
from hdrlab.show.widgets import predict
square = np.full((40, 60), 200, np.uint8)"""
SKY = 'predict.choice("Which is brighter?", 1, ["the sky", "the wall"])'
STOPS = 'predict.number("How many stops?", 12, (0, 20), unit="stops")'
FIGURE = 'pictures.picture(square, alt="A wall")'
ANSWER = "<details open><summary>What you should have seen</summary>\n\nThe wall.\n\n</details>"
THOUGHT = "**Think.** Why is it brighter?"


def write_notebook(path):
    """Write a notebook with two questions, each with a figure and an answer, and text between."""
    cells = [
        nbformat.v4.new_markdown_cell("# Brightness"),
        nbformat.v4.new_code_cell(IMPORTS),
        nbformat.v4.new_markdown_cell("**Predict.** Which of them is brighter?"),
        nbformat.v4.new_code_cell(SKY),
        nbformat.v4.new_code_cell("print('answer one')"),
        nbformat.v4.new_markdown_cell("Text between the figures."),
        nbformat.v4.new_code_cell(FIGURE),
        nbformat.v4.new_markdown_cell(ANSWER),
        nbformat.v4.new_code_cell("print('after the answer')"),
        nbformat.v4.new_code_cell(STOPS),
        nbformat.v4.new_code_cell("print('answer two')"),
        nbformat.v4.new_markdown_cell(THOUGHT),
        nbformat.v4.new_code_cell("print('after the thought')"),
    ]
    metadata = {"kernelspec": {"name": "python3", "display_name": "Python 3"}}
    nbformat.write(nbformat.v4.new_notebook(cells=cells, metadata=metadata), path)


ALWAYS = ["Text between the figures.", "after the answer", "Think. Why is it brighter?"]
ALWAYS += ["after the thought"]
FIRST = ["answer one", "The wall."]
SECOND = ["answer two"]


def visible(page, text):
    """Return the visible elements with a text; JupyterLab also keeps its hidden source."""
    return page.get_by_text(text, exact=True).filter(visible=True)


def assert_shown(page, texts, *, covered=()):
    """Wait until exactly these texts are shown."""
    for text in texts:
        visible(page, text).first.wait_for(timeout=PATIENCE)
    page.wait_for_timeout(500)  # covers are counted again a moment after a change
    assert [text for text in covered if visible(page, text).count()] == []


def question(page, name):
    return page.locator(".hdrlab").filter(has_text=name)


def answer_by_keys(page):
    """Answer the first question without a pointer."""
    page.get_by_role("radio", name="the sky").focus()
    page.keyboard.press("Space")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")


def assert_questions_cover(page):
    """Answer the questions one after the other, and look at what is shown."""
    question(page, "How many stops?").wait_for(timeout=PATIENCE)
    figure = page.get_by_role("img", name="A wall")
    assert_shown(page, ALWAYS, covered=[*FIRST, *SECOND])
    assert figure.count() == 0
    answer_by_keys(page)
    assert_shown(page, [*ALWAYS, *FIRST], covered=SECOND)
    figure.wait_for()
    question(page, "How many stops?").get_by_role("button", name="Show").click()
    assert_shown(page, [*ALWAYS, *FIRST, *SECOND])


@pytest.fixture
def in_lab(lab, page):
    write_notebook(lab.folder / "covered.ipynb")
    lab.open(page, "covered.ipynb")
    lab.run_all(page)
    yield page
    lab.close()


def test_in_jupyterlab_a_question_covers_its_answer_after_run_all(in_lab):
    assert_questions_cover(in_lab)


def test_in_jupyterlab_one_switch_uncovers_everything_and_is_remembered(in_lab, lab):
    page = in_lab
    switch = question(page, "Which is brighter?").get_by_label("Show all answers")
    assert_shown(page, ALWAYS, covered=[*FIRST, *SECOND])
    switch.check()
    assert_shown(page, [*ALWAYS, *FIRST, *SECOND])
    lab.open(page, "covered.ipynb")
    lab.run_all(page)
    assert_shown(page, [*ALWAYS, *FIRST, *SECOND])
    question(page, "How many stops?").get_by_label("Show all answers").uncheck()
    assert_shown(page, ALWAYS, covered=[*FIRST, *SECOND])


def test_in_jupyterlab_paper_shows_everything(in_lab):
    assert_shown(in_lab, ALWAYS, covered=[*FIRST, *SECOND])
    in_lab.emulate_media(media="print")
    hidden = ".jp-Cell-outputWrapper, .jp-MarkdownCell details"
    assert in_lab.locator(hidden).evaluate_all(
        "(all) => all.every((el) => getComputedStyle(el).display !== 'none')"
    )


@pytest.mark.skipif(find_spec("notebook") is None, reason="Notebook 7 is not installed")
def test_in_notebook_7_a_question_covers_its_answer_when_all_cells_have_run(lab, page):
    write_notebook(lab.folder / "covered.ipynb")
    page.goto(f"{lab.address}/notebooks/covered.ipynb?token={lab.token}")
    page.locator(".jp-Notebook-ExecutionIndicator[data-status=idle]").wait_for(timeout=PATIENCE)
    page.wait_for_timeout(4000)  # until the session is ready, else it asks for a kernel
    page.locator(".jp-Cell").first.click()
    try:
        for _ in range(page.locator(".jp-Cell").count()):
            page.keyboard.press("Shift+Enter")
            page.wait_for_timeout(300)
        assert_questions_cover(page)
    finally:
        lab.close()
