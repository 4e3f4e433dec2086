"""A student edits a cell of a handout in JupyterLab until its check passes."""

import shutil

import pytest

from hdrlab.course import materials

pytestmark = pytest.mark.browser

WRONG = """def hat(n=256):
z = np.arange(n)
return np.abs(z - n // 2) / (n // 2)"""
ENDS_COUNT = """def hat(n=256):
z = np.arange(n)
return np.minimum(z + 1, n - z) / (n // 2)"""
RIGHT = """def hat(n=256):
z = np.arange(n)
return np.minimum(z, n - 1 - z) / ((n - 2) // 2)"""
AT = "[...window.jupyterapp.shell.currentWidget.content.widgets]"
ANSWER = 300_000  # ms until a check has answered: a limit for errors


@pytest.fixture(scope="module")
def handout(lab):
    """The name of a student's copy of a handout."""
    shutil.copy(materials.folder("assignments") / "hw2.ipynb", lab.folder / "mine.ipynb")
    return "mine.ipynb"


def cell(page, name):
    """Return the cell with this id, as a locator."""
    index = page.evaluate(f"(name) => {AT}.findIndex((cell) => cell.model.id === name)", name)
    assert index >= 0, f"no cell {name}"
    return page.locator(".jp-Notebook .jp-Cell").nth(index)


def write(page, name, text):
    """Put text into a cell as a student does, by the keyboard, and run it and the check below it.

    The editor indents what follows a colon by itself, so the lines come without their indents.
    """
    cell(page, name).locator(".cm-content").click()
    page.keyboard.press("Control+a")
    page.keyboard.press("Delete")
    for k, line in enumerate(text.splitlines()):
        if k:
            page.keyboard.press("Enter")
        page.keyboard.insert_text(line)
    page.keyboard.press("Shift+Enter")
    # on a busy machine it takes a moment until this one is selected
    below = name.replace("task-", "check-")
    page.wait_for_function(
        "(name) => window.jupyterapp.shell.currentWidget.content.activeCell.model.id === name",
        arg=below,
    )
    page.keyboard.press("Shift+Enter")


def answered(page, name, word):
    """Return the output of the check once it contains a word."""
    checked = cell(page, f"check-{name}")
    written = cell(page, f"task-{name}")
    output = checked.locator(".hdrlab-check")
    try:
        output.get_by_text(word).first.wait_for(timeout=ANSWER)
    except Exception as error:
        text = f"{written.inner_text()}\n{checked.inner_text()}"
        raise AssertionError(f"expected {word!r}, got {text}") from error
    return output


def test_a_failing_check_passes_after_the_student_edits_the_cell(lab, page, axe, handout):
    try:
        lab.open(page, handout)
        page.evaluate("() => { window.jupyterapp.commands.execute('notebook:run-all-cells'); }")
        blank = answered(page, "hat", "no answer")
        assert "hat is yours to write" in blank.inner_text()
        assert "0 of 10 points" in blank.inner_text()
        lab.until_done(page)

        write(page, "task-hat", WRONG)
        red = answered(page, "hat", "Likely mistake")
        assert "✗ failed" in red.inner_text()
        picture = red.locator("img").first
        assert "they differ by" in picture.get_attribute("alt")
        assert picture.evaluate("(image) => image.complete && image.naturalWidth") > 100
        hint = red.locator("details", has_text="A hint").first
        second = hint.locator("details", has_text="Another hint").first
        assert not second.is_visible()
        hint.locator("summary").first.click()
        assert second.is_visible()
        page.evaluate(
            "() => document.querySelectorAll('.hdrlab-check').forEach((one, k) => { one.id = `c${k}`; })"
        )
        assert axe(page, f"#{red.get_attribute('id')}") == []

        write(page, "task-hat", RIGHT)
        green = answered(page, "hat", "10 of 10 points")
        assert "✗" not in green.inner_text() and green.inner_text().count("✓ passed") >= 3
        assert "hw2 so far: 10 of 100 points" in green.inner_text()
        assert [
            url for url in page.requests if not url.startswith((lab.address, "data:", "blob:"))
        ] == []
    finally:
        lab.close()


def test_a_student_answers_the_questions_of_the_tutor_by_keyboard(lab, page, axe, handout):
    try:
        lab.open(page, handout)
        page.evaluate("() => { window.jupyterapp.commands.execute('notebook:run-all-cells'); }")
        lab.until_done(page)
        assert cell(page, "check-hat").get_by_role("button").count() == 0  # a stub has no questions
        write(page, "task-hat", ENDS_COUNT)
        answered(page, "hat", "Show the likely mistake")
        below = cell(page, "check-hat")
        below.get_by_role("button", name="Ask me three questions about hat").focus()
        page.keyboard.press("Enter")
        forms = below.locator("[data-kind=ask]")
        for number, answer in enumerate(("1", "0,6", "0")):
            forms.nth(number).wait_for(timeout=ANSWER)
            page.keyboard.press("Tab")
            page.keyboard.type(answer)
            page.keyboard.press("Enter")
        last = below.get_by_text("Look at this line")
        last.wait_for(timeout=ANSWER)
        # the page scrolls to the end of the dialogue
        page.wait_for_function(
            "(text) => text.getBoundingClientRect().bottom <= innerHeight",
            arg=last.element_handle(),
        )
        said = below.inner_text()
        assert said.count("Yes. The right value") == 2
        assert "You said: 0.6. The right value: 0.5." in said
        assert "Your hat leads to 0.666667." in said and "Your hat leads to 0.333333." in said
        assert "return np.minimum(z + 1, n - z) / (n // 2)" in said.split("Look at this line")[1]
        page.evaluate(
            "document.querySelectorAll('[data-kind=ask]').forEach((f, k) => f.id = `q${k}`)"
        )
        assert axe(page, "#q1") == []
    finally:
        lab.close()
