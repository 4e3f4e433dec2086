"""Every notebook, opened and run as a reader does it: in JupyterLab, in a browser."""

from pathlib import Path

import pytest
from laboratory import DIGEST, PATIENCE, changed_by

NOTEBOOKS = sorted(path.name for path in (Path(__file__).parents[2] / "notebooks").glob("*.ipynb"))

# JupyterLab's own, when it runs without its optional servers.
NOISE = ("/lsp/status", "/api/terminals", "terminals")


def outputs_of(page):
    return page.evaluate(
        """() => window.jupyterapp.shell.currentWidget.content.widgets
            .filter((cell) => cell.model.type === "code")
            .flatMap((cell) => cell.model.outputs.toJSON())"""
    )


def until_painted(page, widget):
    page.wait_for_function(
        "el => el.querySelector('canvas')?.getAttribute('aria-label')", arg=widget.element_handle()
    )


def move_sliders(page, widget, settle=lambda: None):
    """Move each slider by itself and put it back: in another mode of metering the spot's place is idle."""
    for slider in widget.get_by_role("slider").all():
        said, start = slider.get_attribute("aria-valuetext"), slider.input_value()
        slider.focus()
        back = start == slider.get_attribute("max")
        changed_by(
            page, widget, lambda back=back: [press(page, "Left" if back else "Right") for _ in range(3)]
        )
        settle()
        assert slider.get_attribute("aria-valuetext") != said
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
    """Each slider was put back, so the picture is the one that the cell made: no later cell has a say."""
    before = widget.evaluate(DIGEST)
    move_sliders(page, widget, lambda: until_answered(page, widget))
    assert widget.evaluate(DIGEST) == before


def until_answered(page, widget):
    """Wait until the last position is what stays, and is Python's own answer, not a stored one."""
    names = [label.inner_text() for label in widget.locator(".hdrlab-slider span:first-child").all()]
    texts = [slider.get_attribute("aria-valuetext") for slider in widget.get_by_role("slider").all()]
    wanted = ", ".join(f"{name} = {text}" for name, text in zip(names, texts, strict=True))
    page.wait_for_function(
        """([el, wanted]) => el.querySelector("canvas").getAttribute("aria-label").endsWith(wanted)
            && el.querySelector("[role=status]").textContent === "" """,
        arg=[widget.element_handle(), wanted],
        timeout=PATIENCE,
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


MOVES = {"play": move_play, "tune": move_tune, "wipe": move_wipe, "blink": move_blink, "brush": move_brush}


class Notebooks:
    """What is tested of each notebook. The classes below are what xdist hands to its workers, each whole."""

    def test_a_notebook_runs_and_each_of_its_controls_changes_the_picture(self, lab, page, notebook):
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

            assert [text for text in page.problems if not any(noise in text for noise in NOISE)] == []
            assert [url for url in page.requests if not url.startswith((lab.address, "data:", "blob:"))] == []
        finally:
            lab.close()


@pytest.mark.parametrize("notebook", NOTEBOOKS[0::4])
class TestNotebooks0(Notebooks): ...


@pytest.mark.parametrize("notebook", NOTEBOOKS[1::4])
class TestNotebooks1(Notebooks): ...


@pytest.mark.parametrize("notebook", NOTEBOOKS[2::4])
class TestNotebooks2(Notebooks): ...


@pytest.mark.parametrize("notebook", NOTEBOOKS[3::4])
class TestNotebooks3(Notebooks): ...
