"""Every notebook, opened and run as a reader does it: in JupyterLab, in a browser."""

from pathlib import Path

import pytest

NOTEBOOKS = sorted(path.name for path in (Path(__file__).parents[2] / "notebooks").glob("*.ipynb"))

# JupyterLab's own, when it runs without its optional servers.
NOISE = ("/lsp/status", "/api/terminals", "terminals")


def picture(widget):
    """Return the pixels of a widget's canvas, as text."""
    return widget.locator("canvas").evaluate("canvas => canvas.toDataURL()")


def until_painted(page, widget):
    page.wait_for_function(
        "el => el.querySelector('canvas').getAttribute('aria-label')", arg=widget.element_handle()
    )


def outputs_of(page):
    return page.evaluate(
        """() => window.jupyterapp.shell.currentWidget.content.widgets
            .filter((cell) => cell.model.type === "code")
            .flatMap((cell) => cell.model.outputs.toJSON())"""
    )


@pytest.mark.parametrize("notebook", NOTEBOOKS)
def test_a_notebook_runs_and_each_of_its_sliders_changes_the_picture(lab, page, notebook):
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
        until_painted(page, widget)
        for slider in widget.get_by_role("slider").all():
            before, said = picture(widget), slider.get_attribute("aria-valuetext")
            slider.focus()
            at_the_end = slider.input_value() == slider.get_attribute("max")
            for _ in range(3):
                page.keyboard.press("ArrowLeft" if at_the_end else "ArrowRight")
            page.wait_for_function(
                "([el, before]) => el.querySelector('canvas').toDataURL() !== before",
                arg=[widget.element_handle(), before],
                timeout=10_000,
            )
            says = slider.get_attribute("aria-valuetext")
            assert says != said
            page.wait_for_function(  # the last of the presses is what stays
                "([el, ending]) => el.querySelector('canvas').getAttribute('aria-label').includes(ending)",
                arg=[widget.element_handle(), says.split(" of ")[0]],
                timeout=10_000,
            )

    assert [text for text in page.problems if not any(noise in text for noise in NOISE)] == []
    assert [url for url in page.requests if not url.startswith((lab.address, "data:", "blob:"))] == []
