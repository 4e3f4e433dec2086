"""The figure of the bilateral filter draws hdrlab's weights and means."""

import re

import numpy as np
import pytest
from laboratory import PATIENCE, open_widget

from hdrlab.core.filters.bilateral import bilateral
from hdrlab.show import widgets

pytestmark = pytest.mark.browser

PIXELS = np.arange(120)
LINE = np.where(PIXELS < 60, 0, 2) + 0.1 * np.sin(PIXELS / 2)
STATUS = "document.querySelector('[role=status]').textContent"


@pytest.fixture
def figure(page):
    page.widget = widgets.bilateral_kernel(LINE, alt="A step with a ripple", at=54)
    open_widget(page, page.widget)
    yield page
    assert page.problems == []


def heights_of(page, name):
    """Return the heights of a line in the unit of the signal."""
    path = page.locator(f".hdrlab-levels path[class='{name}']").get_attribute("d")
    points = np.array([point.split(",") for point in path.removeprefix("M").split("L")], float)
    low, high = page.widget.span
    assert points[:, 0] == pytest.approx((PIXELS + 0.5) / len(PIXELS), abs=1e-4)
    return high - points[:, 1] * (high - low)


def weights_of(page, row):
    """Return the heights of the bars of a row, 1 for the pixel itself."""
    path = page.locator(".hdrlab-weights path").nth(row).get_attribute("d")
    tops = [float(top) for top in re.findall(r"V([\d.]+)H", path)]
    return (1 - np.array(tops)) / 0.94


def assert_figure_shows_the_library(page):
    at = page.evaluate("window.model.get('at')")
    sigma_s = page.evaluate("window.model.get('sigma_s')")
    sigma_r = page.evaluate("window.model.get('sigma_r')")
    expected = bilateral(LINE[None], sigma_s=sigma_s, sigma_r=sigma_r)
    stated = f"Around pixel {at}, "
    page.wait_for_function(f"{STATUS}.startsWith('{stated}')", timeout=PATIENCE)
    page.wait_for_function("() => new Promise(requestAnimationFrame)")
    numbers = re.search(
        r"up to (\S+) pixels, .* to (\S+)\. .* is (\S+) decades", page.evaluate(STATUS)
    ).groups()
    near, k, mean = [float(number.replace("−", "-")) for number in numbers]
    assert k == pytest.approx(float(expected.k[0, at]), abs=0.06)
    assert mean == pytest.approx(float(expected.mean[0, at]), abs=0.006)
    assert heights_of(page, "hdrlab-strong") == pytest.approx(expected.mean[0], abs=1e-3)
    alone = bilateral(LINE[None], sigma_s=sigma_s, sigma_r=1e4)
    assert near == pytest.approx(float(alone.k[0, at]), abs=0.06)
    assert heights_of(page, "hdrlab-is-g hdrlab-dashed") == pytest.approx(alone.mean[0], abs=1e-3)
    by_place = weights_of(page, 0)
    by_value = weights_of(page, 1)
    both = weights_of(page, 2)
    assert both == pytest.approx(by_place * by_value, abs=1e-3)
    assert both.sum() == pytest.approx(float(expected.k[0, at]), abs=0.02)
    assert (both * LINE).sum() / both.sum() == pytest.approx(mean, abs=0.01)


def drag(page, frame, start, end):
    """Drag from one place in a part of the figure to another, in shares of its width and height."""
    frame.scroll_into_view_if_needed()
    box = frame.bounding_box()
    places = [
        (box["x"] + right * box["width"], box["y"] + down * box["height"])
        for right, down in (start, end)
    ]
    page.mouse.move(*places[0])
    page.mouse.down()
    page.mouse.move(*places[1], steps=3)
    page.mouse.up()


def test_the_dragged_kernel_weighs_and_filters_as_the_library_does(figure):
    assert_figure_shows_the_library(figure)
    plot = figure.get_by_role("slider", name="Pixel in")
    width = figure.get_by_role("slider", name="Width of")
    height = figure.get_by_role("slider", name="Height of")
    drag(figure, plot, (0.4, 0.5), (0.52, 0.5))
    assert figure.evaluate("window.model.get('at')") == 62
    assert_figure_shows_the_library(figure)
    drag(figure, width, (0.6, 0.5), (62.5 / 120 + 0.1, 0.5))
    assert figure.evaluate("window.model.get('sigma_s')") == pytest.approx(12, abs=0.6)
    assert_figure_shows_the_library(figure)
    drag(figure, height, (0.5, 0.3), (0.5, 0.9))
    assert figure.evaluate("window.model.get('sigma_r')") > 1.5
    assert_figure_shows_the_library(figure)


def test_arrow_keys_and_a_touch_move_the_kernel_and_its_widths(figure):
    for role, name, expected in (("Pixel in", "at", 62), ("Width of", "sigma_s", 16)):
        figure.get_by_role("slider", name=role).focus()
        figure.keyboard.press("Shift+ArrowRight")
        assert figure.evaluate(f"window.model.get('{name}')") == pytest.approx(expected)
    figure.get_by_role("slider", name="Height of").focus()
    figure.keyboard.press("Shift+ArrowDown")
    assert figure.evaluate("window.model.get('sigma_r')") == pytest.approx(0.2)
    assert figure.evaluate("window.reached") == []
    assert_figure_shows_the_library(figure)
    box = figure.get_by_role("slider", name="Pixel in").bounding_box()
    figure.touchscreen.tap(box["x"] + 3, box["y"] + 50)
    assert figure.evaluate("window.model.get('at')") == 0
    assert_figure_shows_the_library(figure)


def test_a_pixel_beyond_the_edge_counts_nothing_until_values_are_far_apart_too(figure):
    """A pixel is close in place and in value; the other side of the step has no weight."""
    assert weights_of(figure, 2)[60:].max() < 1e-3
    status = figure.evaluate(STATUS)
    figure.evaluate("window.model.set('sigma_r', 6)")
    figure.wait_for_function(f"said => {STATUS} !== said", arg=status, timeout=PATIENCE)
    figure.wait_for_function("() => new Promise(requestAnimationFrame)")
    assert weights_of(figure, 2)[60:].max() > 0.5


@pytest.mark.parametrize("theme", ["true", "false"])
def test_axe_finds_nothing_by_day_and_by_night(figure, axe, theme):
    paper = "#fff" if theme == "true" else "#111"
    ink = "#212121" if theme == "true" else "#eee"
    figure.evaluate(
        """([theme, paper, ink]) => {
            document.body.dataset.jpThemeLight = theme;
            document.body.style.background = paper;
            document.body.style.setProperty("--jp-ui-font-color1", ink);
            document.body.style.setProperty("--jp-layout-color0", paper);
        }""",
        [theme, paper, ink],
    )
    assert axe(figure, "#at") == []
    figure.set_viewport_size({"width": 390, "height": 800})
    assert figure.evaluate("document.documentElement.scrollWidth") <= 390
