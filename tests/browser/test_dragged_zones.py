"""The figure of Reinhard's operator: dragged handles show what hdrlab computes."""

import re

import numpy as np
import pytest
from laboratory import PATIENCE, open_widget

from hdrlab import scenes
from hdrlab.core import colour
from hdrlab.show import widgets
from hdrlab.tonemap import reinhard

pytestmark = pytest.mark.browser

E = scenes.street((96, 144))
L = colour.luminance(E)
SHOWN = """() => {
    const canvas = document.querySelector("canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return Array.from(data);
}"""


@pytest.fixture
def figure():
    return widgets.zone_scale(E, alt="A street", key=0.18, white=8.0)


@pytest.fixture
def dragged(page, figure):
    open_widget(page, figure)
    yield page
    assert page.problems == []


def value_of(page, name):
    return page.evaluate(f"window.model.get('{name}')")


def drag(page, figure, name, stops):
    """Drag a handle by some stops."""
    box = page.locator(".hdrlab-clip").bounding_box()
    handle = page.locator(f".hdrlab-handle-{name}").bounding_box()
    x = handle["x"] + handle["width"] / 2
    y = box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + stops / np.ptp(figure.zones) * box["width"], y, steps=3)
    page.mouse.up()


def assert_picture_is_the_librarys(page):
    """Compare the picture below the white point, whose marks cover the rest."""
    key = value_of(page, "key")
    white = value_of(page, "white")
    texts = [f"key {float(f'{key:.2g}'):g}", f"white {float(f'{white:.2g}'):g}"]
    page.wait_for_function(
        f"document.querySelector('canvas').ariaLabel.endsWith('{', '.join(texts)}')",
        timeout=PATIENCE,
    )
    shown = np.reshape(page.evaluate(SHOWN), (*L.shape, 4))[..., :3]
    expected = colour.render(E, L, reinhard.tonemap(L, key=key, white=white))
    Lm = reinhard.scale_to_key(L, key=key)
    is_below_white = Lm < 0.99 * white
    off = np.abs(shown[is_below_white] - expected[is_below_white].astype(int))
    assert off.max() <= 1 and (off > 0).mean() < 0.03
    status = page.get_by_role("status").inner_text()
    stated = float(re.search(r"([\d.]+)\xa0%", status)[1])
    assert stated == pytest.approx(100 * np.mean(Lm >= white), abs=0.6)


def test_dragging_key_and_white_shows_the_picture_of_the_library(dragged, figure):
    assert_picture_is_the_librarys(dragged)
    drag(dragged, figure, "key", -2)
    assert value_of(dragged, "key") == pytest.approx(0.18 / 4)
    assert_picture_is_the_librarys(dragged)
    drag(dragged, figure, "white", -2)
    assert value_of(dragged, "white") == pytest.approx(2)
    assert_picture_is_the_librarys(dragged)


def test_the_curve_is_that_of_the_library(dragged, figure):
    path = dragged.locator(".hdrlab-is-Ld").get_attribute("d")
    points = np.array([point.split(",") for point in path.removeprefix("M").split("L")], float)
    low, high = figure.zones
    Lm = 0.18 * 2.0 ** (low + points[:, 0] / 100 * (high - low) - 5)
    expected = colour.encode_srgb(reinhard.display(Lm, Lm, 8.0))
    assert 1 - points[:, 1] / 100 == pytest.approx(expected, abs=2e-3)


def test_arrow_keys_move_the_handle_with_the_focus(dragged):
    for role, name, expected in (("Key", "key", 0.36), ("White point", "white", 16)):
        dragged.get_by_role("slider", name=role).focus()
        dragged.keyboard.press("Shift+ArrowRight")
        assert value_of(dragged, name) == pytest.approx(expected)
    assert dragged.evaluate("window.reached") == []


def test_a_touch_moves_the_nearer_handle(dragged):
    box = dragged.locator(".hdrlab-clip").bounding_box()
    dragged.touchscreen.tap(box["x"] + 0.98 * box["width"], box["y"] + 50)
    assert value_of(dragged, "white") > 8 and value_of(dragged, "key") == 0.18


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
