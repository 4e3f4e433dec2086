"""The figure of the gain map: a dragged headroom shows what hdrlab computes."""

import re

import numpy as np
import pytest
from laboratory import PATIENCE, open_widget

from hdrlab import pipeline, scenes
from hdrlab.core import colour, gainmap
from hdrlab.show import widgets

pytestmark = pytest.mark.browser

HEADROOM = 8.0
E = scenes.chapel((80, 120))
BASE = pipeline.develop(E, "reinhard")
S = colour.decode_srgb(BASE / np.float64(255))
H = gainmap.expose(E, S, HEADROOM)
LOW, HIGH = gainmap.find_range(gainmap.log_gain(S, H))
G = np.rint(255 * gainmap.gain_map(S, H, LOW, HIGH)) / 255
SHOWN = """() => {
    const canvas = document.querySelector("canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return Array.from(data);
}"""


@pytest.fixture
def figure():
    return widgets.gain_screen(BASE, G, LOW, HIGH, alt="A chapel", headroom=HEADROOM, screen=2)


@pytest.fixture
def dragged(page, figure):
    open_widget(page, figure)
    yield page
    assert page.problems == []


def assert_screen_shows_the_librarys_light(page, times):
    page.wait_for_function(
        f"document.querySelector('canvas').ariaLabel.includes('shows {times} times')",
        timeout=PATIENCE,
    )
    assert page.evaluate("window.model.get('screen')") == pytest.approx(times)
    W = gainmap.weight(times, HEADROOM)
    light = gainmap.apply_gain(S, G, LOW, HIGH, W=W)
    expected = colour.to_8bit(np.clip(light / HEADROOM, 0, 1))
    shown = np.reshape(page.evaluate(SHOWN), (*E.shape[:2], 4))[..., :3]
    assert np.abs(shown - expected.astype(int)).max() <= 1
    status = page.get_by_role("status").inner_text()
    assert float(re.search(r"([\d.]+)\xa0%", status)[1]) == pytest.approx(100 * W, abs=0.5)


def test_dragging_the_peak_shows_the_light_of_the_library(dragged, figure):
    assert_screen_shows_the_librarys_light(dragged, 2)
    box = dragged.locator(".hdrlab-clip").bounding_box()
    low, high = figure.span
    dragged.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 20)
    dragged.mouse.down()
    for times in (4, 8, 1):
        x = box["x"] + (np.log2(times) - low) / (high - low) * box["width"]
        dragged.mouse.move(x, box["y"] + 20)
        assert_screen_shows_the_librarys_light(dragged, times)
    dragged.mouse.up()


def test_arrow_keys_and_a_touch_move_the_peak(dragged):
    dragged.get_by_role("slider").focus()
    dragged.keyboard.press("Shift+ArrowRight")
    assert_screen_shows_the_librarys_light(dragged, 4)
    assert dragged.evaluate("window.reached") == []
    box = dragged.locator(".hdrlab-clip").bounding_box()
    dragged.touchscreen.tap(box["x"] + 2, box["y"] + 20)
    assert_screen_shows_the_librarys_light(dragged, 1)


@pytest.mark.parametrize("theme", ["true", "false"])
def test_axe_finds_nothing_by_day_and_by_night(dragged, axe, theme):
    paper = "#fff" if theme == "true" else "#111"
    ink = "#212121" if theme == "true" else "#eee"
    dragged.evaluate(
        """([theme, paper, ink]) => {
            document.body.dataset.jpThemeLight = theme;
            document.body.style.background = paper;
            document.body.style.setProperty("--jp-ui-font-color1", ink);
            document.body.style.setProperty("--jp-layout-color0", paper);
        }""",
        [theme, paper, ink],
    )
    assert axe(dragged, "#at") == []
    dragged.set_viewport_size({"width": 390, "height": 800})
    assert dragged.evaluate("document.documentElement.scrollWidth") <= 390
