"""Notebooks, opened and run as a reader does it: in JupyterLab, in a browser.

Three hold every kind of widget. The others have a tier of their own, since they take long: their
cells are run in the tier of notebooks, and their widgets are moved on the pages of the site.
"""

import re
from pathlib import Path

import pytest
from laboratory import DIGEST, LOOK, PATIENCE, SHOW_ALL_ANSWERS, changed_by

pytestmark = pytest.mark.browser

FOLDER = Path(__file__).parents[2] / "notebooks"
THREE = ["00_welcome.ipynb", "18_all_operators.ipynb", "24_made_of_patches.ipynb"]
OTHERS = sorted({path.name for path in FOLDER.glob("*.ipynb")} - set(THREE))

# JupyterLab's own, when it runs without its optional servers.
# The last one comes from the extension for JupyterLite, which does not find JupyterLite.
NOISE = ("/lsp/status", "/api/terminals", "terminals", "Shared module @jupyterlite/")


def outputs_of(page):
    return page.evaluate(
        """() => window.jupyterapp.shell.currentWidget.content.widgets
            .filter((cell) => cell.model.type === "code")
            .flatMap((cell) => cell.model.outputs.toJSON())"""
    )


def until_painted(page, widget):
    page.wait_for_function(
        """(el) => {
            const canvas = el.querySelector("canvas");  // a question may have none
            return canvas ? canvas.getAttribute("aria-label") : el.querySelector(".hdrlab-note");
        }""",
        arg=widget.element_handle(),
    )


def move_sliders(page, widget, settle=lambda: None):
    """Move each slider and put it back; outside of spot metering, the position of the spot has no
    effect.
    """
    for slider in widget.get_by_role("slider").all():
        text = slider.get_attribute("aria-valuetext")
        start = slider.input_value()
        slider.focus()
        back = start == slider.get_attribute("max")
        changed_by(
            page,
            widget,
            lambda back=back: [press(page, "Left" if back else "Right") for _ in range(3)],
        )
        settle()
        assert slider.get_attribute("aria-valuetext") != text
        changed_by(page, widget, lambda slider=slider, start=start: slider.fill(start))
        settle()


def press(page, arrow):
    page.keyboard.press(f"Arrow{arrow}")


def move_play(page, widget):
    move_sliders(page, widget)
    button = widget.get_by_role("button", name="Play")
    changed_by(page, widget, button.click)
    widget.get_by_role("slider").press("Home")  # which ends it


def move_tune(page, widget):
    """Each slider was put back, so the picture is again the one that the cell made."""
    before = widget.evaluate(DIGEST)
    move_sliders(page, widget, lambda: until_answered(page, widget))
    for row in widget.get_by_role("radiogroup").all():
        start = row.locator("label:has(:checked)").inner_text()
        for button in row.get_by_role("radio", checked=False).all()[:1]:
            button.check()
            until_answered(page, widget)
        row.get_by_text(start, exact=True).click()
        until_answered(page, widget)
    # Python's own picture comes after a stored one of the same place.
    page.wait_for_function(
        f"([el, before]) => ({DIGEST})(el) === before",
        arg=[widget.element_handle(), before],
        timeout=PATIENCE,
        polling=LOOK,
    )


def name_of(control):
    return control.locator("span").first.inner_text()


def text_of(control):
    """Return the value of a slider or of a row of buttons."""
    if control.get_attribute("role") == "radiogroup":
        return control.locator("label:has(:checked)").inner_text()
    return control.get_by_role("slider").get_attribute("aria-valuetext")


def until_answered(page, widget):
    """Wait until the picture shows the last position."""
    controls = widget.locator(".hdrlab-controls > *").all()
    expected = ", ".join(f"{name_of(control)} {text_of(control)}" for control in controls)
    page.wait_for_function(
        """([el, wanted]) => el.querySelector("canvas").getAttribute("aria-label").endsWith(wanted)
            && el.querySelector("[role=status]").textContent === "" """,
        arg=[widget.element_handle(), expected],
        timeout=PATIENCE,
        polling=LOOK,
    )


def move_wipe(page, widget):
    move_sliders(page, widget)
    box = widget.locator("canvas").bounding_box()
    edge = float(widget.get_by_role("slider", name="edge").input_value()) / 100

    def drag():
        page.mouse.move(box["x"] + edge * box["width"], box["y"] + box["height"] / 2)
        page.mouse.down()
        page.mouse.move(box["x"] + 0.2 * box["width"], box["y"] + box["height"] / 2, steps=3)
        page.mouse.up()

    changed_by(page, widget, drag)


def move_blink(page, widget):
    for choice in reversed(widget.get_by_role("radio").all()):
        changed_by(page, widget, choice.check)
    changed_by(page, widget, lambda: widget.get_by_role("application").press("Space"))
    move_sliders(page, widget)


def move_brush(page, widget):
    move_sliders(page, widget)
    box = widget.locator("canvas").bounding_box()
    changed_by(page, widget, lambda: widget.get_by_role("application").press("ArrowLeft"))
    changed_by(
        page,
        widget,
        lambda: page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 0.3 * box["height"]),
    )


def move_pixel(page, widget):
    canvas = widget.locator("canvas")
    before = canvas.get_attribute("aria-label")
    widget.get_by_role("application").press("ArrowLeft")
    page.wait_for_function(
        "([canvas, before]) => canvas.getAttribute('aria-label') !== before",
        arg=[canvas.element_handle(), before],
        timeout=PATIENCE,
        polling=LOOK,
    )
    changed_by(page, widget, widget.get_by_role("button").first.click)


def move_by_key(page, widget):
    status = widget.get_by_role("status")
    before = status.inner_text()
    widget.get_by_role("application").press("ArrowLeft")
    page.wait_for_function(
        "([status, before]) => status.innerText !== before",
        arg=[status.element_handle(), before],
        timeout=PATIENCE,
        polling=LOOK,
    )


def move_shutter(page, widget):
    changed_by(page, widget, lambda: widget.get_by_role("slider").press("ArrowLeft"))


def move_screen(page, widget):
    """Drag to a brighter screen, because the dimmest is shown at first."""
    changed_by(page, widget, lambda: widget.get_by_role("slider").press("ArrowRight"))


def move_zones(page, widget):
    for handle in widget.get_by_role("slider").all():
        changed_by(page, widget, lambda handle=handle: handle.press("Shift+ArrowLeft"))


def move_handles(page, widget):
    """Move each handle of a figure of a line; a handle states its own value."""
    for handle in widget.get_by_role("slider").all():
        before = handle.get_attribute("aria-valuetext")
        handle.press("Shift+ArrowLeft")
        page.wait_for_function(
            "([handle, before]) => handle.getAttribute('aria-valuetext') !== before",
            arg=[handle.element_handle(), before],
            timeout=PATIENCE,
            polling=LOOK,
        )


def move_predict(page, widget):
    """Ask for the truth; `test_predict_without_a_kernel` tests the answers."""
    widget.get_by_role("button", name="Show", exact=True).click()
    assert widget.get_by_role("status").last.inner_text().startswith("The truth: ")


MOVES = {
    "play": move_play,
    "tune": move_tune,
    "wipe": move_wipe,
    "blink": move_blink,
    "brush": move_brush,
    "pixel": move_pixel,
    "bitmaps": move_by_key,
    "gsolve": move_by_key,
    "exposure": move_shutter,
    "zones": move_zones,
    "gains": move_screen,
    "kernel": move_handles,
    "gradients": move_handles,
}
MOVES |= {"predict": move_predict}
# They ask nothing of Python; tests of their own drag them, and the tier of all notebooks opens theirs.
TESTED_ALONE = {"pixel", "exposure", "bitmaps", "gsolve", "zones", "gains", "kernel", "gradients"}


class Notebooks:
    """What is tested of each notebook. The classes below are what xdist hands to its workers, each whole."""

    def test_a_notebook_runs_and_each_of_its_controls_changes_the_picture(
        self, lab, page, notebook
    ):
        page.add_init_script(SHOW_ALL_ANSWERS)
        try:
            lab.open(page, notebook)
            lab.run_all(page)
            assert [
                output
                for output in outputs_of(page)
                if output["output_type"] == "error" or output.get("name") == "stderr"
            ] == []

            widgets = page.locator(".hdrlab").all()
            assert widgets, "the notebook shows no widget"
            for widget in widgets:
                widget.scroll_into_view_if_needed()
                until_painted(page, widget)
                MOVES[widget.get_attribute("data-kind")](page, widget)

            assert [
                text for text in page.problems if not any(noise in text for noise in NOISE)
            ] == []
            assert [
                url for url in page.requests if not url.startswith((lab.address, "data:", "blob:"))
            ] == []
        finally:
            lab.close()


def test_the_three_hold_every_kind_of_widget_that_is_not_tested_alone():
    texts = [(FOLDER / name).read_text(encoding="utf8") for name in THREE]
    shown = {kind for text in texts for kind in re.findall(r"widgets\.(\w+)\(", text)}
    if any("predict.number(" in text for text in texts):
        shown.add("predict")
    assert shown >= set(MOVES) - TESTED_ALONE


@pytest.mark.parametrize("notebook", THREE)
class TestThree(Notebooks): ...


@pytest.mark.jupyterlab
@pytest.mark.parametrize("notebook", OTHERS[0::2])
class TestOthers0(Notebooks): ...


@pytest.mark.jupyterlab
@pytest.mark.parametrize("notebook", OTHERS[1::2])
class TestOthers1(Notebooks): ...
