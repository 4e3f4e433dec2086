"""The figure of gsolve shows hdrlab's sum of squares and curve for all values of ln E that a reader sets."""

import re

import numpy as np
import pytest
from laboratory import PATIENCE, open_widget

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.core import weights
from hdrlab.response import debevec
from hdrlab.show import widgets

pytestmark = pytest.mark.browser

ROOM = scenes.room((64, 96))
TIMES = 2.0 ** np.arange(-10, 3, 2)
SENSOR = camera.Camera(sensitivity=1 / 16, full_well=20_000, read_noise=5)
IMAGES = camera.shoot(ROOM, TIMES, SENSOR, rng=4).images
W = weights.hat()
STATUS = "document.querySelector('[role=status]').textContent"


@pytest.fixture
def figure(page):
    page.emulate_media(reduced_motion="reduce")
    page.widget = widgets.gsolve_by_hand(IMAGES, TIMES, alt="A room with a window")
    open_widget(page, page.widget)
    yield page
    assert page.problems == []


def solve_for_curve(widget, lE, smoothness):
    """Return the least sum of squares over all curves g for these lE, by the library's matrix."""
    A, b = debevec.system(np.array(widget.levels), np.array(widget.ln_times), smoothness, W)
    rest = b - A[:, 256:] @ lE
    g = np.linalg.lstsq(A[:, :256], rest, rcond=None)[0]
    return np.sum((A[:, :256] @ g - rest) ** 2)


def state_shown(page, changed_from=None):
    """Return the sum of squares and the lE that the figure shows, once both have changed."""
    if changed_from is not None:
        page.wait_for_function(
            f"(before) => {STATUS} !== before", arg=changed_from, timeout=PATIENCE
        )
    text = page.evaluate(STATUS)
    total = float(re.search(r"Sum (\S+),", text)[1])
    return total, np.array(page.evaluate("window.model.get('ln_E')")), text


def test_dragged_pixels_have_the_sum_of_squares_of_the_library(figure):
    total, lE, text = state_shown(figure)
    assert total == pytest.approx(solve_for_curve(figure.widget, lE, 30), rel=6e-3)
    point = figure.locator(".hdrlab-levels b").nth(4).bounding_box()
    figure.mouse.move(point["x"] + 4, point["y"] + 4)
    figure.mouse.down()
    figure.mouse.move(point["x"] + 64, point["y"] + 4)
    figure.mouse.up()
    total, lE, _ = state_shown(figure, text)
    assert np.count_nonzero(lE) == 1 and lE.max() > 0.5
    assert total == pytest.approx(solve_for_curve(figure.widget, lE, 30), rel=6e-3)


def test_the_sum_is_least_where_ln_E_is_that_of_gsolve(figure):
    widget = figure.widget
    figure.get_by_role("slider").focus()
    for key, smoothness in [("Home", 0.1), ("End", 1000)]:
        figure.keyboard.press(key)
        figure.get_by_role("button", name="Let gsolve do it").press("Enter")
        expected = debevec.gsolve(widget.levels, widget.ln_times, smoothness, W).lE
        figure.wait_for_function(
            "(lE) => window.model.get('ln_E').every((ln, i) => Math.abs(ln - lE[i]) < 1e-9)",
            arg=expected.tolist(),
            timeout=PATIENCE,
        )
        figure.wait_for_function(
            f"() => /Sum (.+), the least possible is \\1[.]/.test({STATUS})", timeout=PATIENCE
        )
        least, _, text = state_shown(figure)
        assert least == pytest.approx(solve_for_curve(widget, expected, smoothness), rel=6e-3)
        figure.get_by_role("slider").focus()
    figure.get_by_role("application").focus()
    for key in ("ArrowRight", "ArrowLeft", "ArrowLeft"):
        figure.keyboard.press(key)
        total, lE, text = state_shown(figure, text)
        if not np.allclose(lE, expected):
            assert total > least
    assert not {"ArrowRight", "ArrowLeft"} & set(figure.evaluate("window.reached"))


def test_a_point_is_linked_with_its_pixel_of_the_photo_and_its_row_of_the_matrix(figure):
    point = figure.locator(".hdrlab-levels b").nth(7 + 3).bounding_box()
    figure.mouse.move(point["x"] + 4, point["y"] + 4)
    figure.wait_for_function(
        "document.querySelector('.hdrlab-equation').textContent.startsWith('Row 11: pixel 2 ')",
        timeout=PATIENCE,
    )
    pressed = figure.get_by_role("button", pressed=True)
    assert pressed.inner_text() == "2"
    level = figure.widget.levels[1][3]
    assert (
        f"level {level}, weight {W[level]:.2f}" in figure.locator(".hdrlab-equation").inner_text()
    )


def test_axe_finds_nothing_in_either_theme_and_all_of_it_fits_a_telephone(figure, axe):
    for is_light, paper, ink, link in (
        (True, "#fff", "#212121", ""),
        (False, "#111", "#eee", "#74bdf2"),
    ):
        figure.evaluate(
            """([isLight, paper, ink, link]) => {
                document.body.dataset.jpThemeLight = isLight;
                document.body.style.background = paper;
                document.body.style.setProperty("--jp-ui-font-color1", ink);
                document.body.style.setProperty("--jp-content-link-color", link);
            }""",
            [is_light, paper, ink, link],
        )
        assert axe(figure, "#at") == []
    figure.set_viewport_size({"width": 390, "height": 800})
    assert figure.evaluate("document.documentElement.scrollWidth") <= 390
