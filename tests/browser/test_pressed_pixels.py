"""The figure of the weighted mean: a pressed pixel shows what hdrlab computes."""

import re

import numpy as np
import pytest
from laboratory import PATIENCE, open_widget

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.core import weights
from hdrlab.radiance.merge import merge
from hdrlab.show import widgets

pytestmark = pytest.mark.browser

HEIGHT = 64
WIDTH = 96
GREEN = 1
CHAPEL = scenes.chapel((HEIGHT, WIDTH))
TIMES = camera.times_around(CHAPEL, 5, stops=3)
IMAGES = camera.shoot(CHAPEL, TIMES, camera.Camera(full_well=8_000, read_noise=6), rng=4).images
G = np.log(np.maximum(np.arange(256), 0.5) / 128)
E = merge(IMAGES, TIMES, G)
STATUS = "document.querySelector('[role=status]').textContent"


@pytest.fixture
def pressed(page):
    widget = widgets.pixel_mean(IMAGES, TIMES, G, alt="A chapel", at=(0.5, 0.5))
    open_widget(page, widget)
    yield page
    assert page.problems == []


def mean_shown(page, y, x):
    """Return the E that the figure shows, once it shows the pixel."""
    page.wait_for_function(
        f"document.querySelector('canvas').ariaLabel.endsWith('pixel x {x}, y {y}')",
        timeout=PATIENCE,
    )
    return float(re.search(r"E = (\S+)\.$", page.evaluate(STATUS))[1])


def centre(page, y, x):
    box = page.locator("canvas").bounding_box()
    return (
        box["x"] + (x + 0.5) / WIDTH * box["width"],
        box["y"] + (y + 0.5) / HEIGHT * box["height"],
    )


def test_dragging_over_the_photo_shows_the_mean_of_the_library(pressed):
    pressed.mouse.move(*centre(pressed, 2, 2))
    pressed.mouse.down()
    darkest = np.unravel_index(np.argmin(E[..., GREEN]), E.shape[:2])
    brightest = np.unravel_index(np.argmax(E[..., GREEN]), E.shape[:2])
    for y, x in [(5, 7), (20, 40), (60, 90), (33, 12), darkest, brightest]:
        pressed.mouse.move(*centre(pressed, y, x))
        assert mean_shown(pressed, y, x) == pytest.approx(E[y, x, GREEN], rel=6e-3)
    pressed.mouse.up()
    pressed.mouse.move(*centre(pressed, 2, 2))
    assert mean_shown(pressed, y, x) == pytest.approx(E[y, x, GREEN], rel=6e-3)


def test_arrow_keys_move_the_pixel_and_reach_no_other_key_handler(pressed):
    pressed.get_by_role("application").focus()
    pressed.keyboard.press("ArrowRight")
    pressed.keyboard.press("Shift+ArrowUp")
    y = HEIGHT // 2 - 8
    x = WIDTH // 2 + 1
    assert mean_shown(pressed, y, x) == pytest.approx(E[y, x, GREEN], rel=6e-3)
    assert pressed.get_by_role("status").get_attribute("aria-live") == "polite"
    assert pressed.evaluate("window.reached") == []


def test_a_touch_moves_the_pixel(pressed):
    pressed.touchscreen.tap(*centre(pressed, 10, 70))
    assert mean_shown(pressed, 10, 70) == pytest.approx(E[10, 70, GREEN], rel=6e-3)


def test_each_row_states_the_level_the_weight_and_the_claim_of_its_photo(pressed):
    y = HEIGHT // 2
    x = WIDTH // 2
    rows = pressed.locator(".hdrlab-bar-row:has(button)").all()
    assert len(rows) == len(TIMES)
    hat = weights.hat() / weights.hat().max()
    for photo, row in enumerate(rows):
        level = IMAGES[photo, y, x, GREEN]
        texts = row.locator("span").all_inner_texts()
        assert texts[0] == str(level)
        is_measured = 0 < IMAGES[photo, y, x].max() < 250
        if is_measured:
            assert float(texts[1]) == pytest.approx(hat[level], abs=0.006)
            assert float(texts[2]) == pytest.approx(np.exp(G[level]) / TIMES[photo], rel=6e-3)
        else:
            assert float(texts[1]) == 0


def test_a_press_on_a_time_shows_its_photo(pressed):
    pressed.get_by_role("button").nth(0).press("Enter")
    shown = pressed.evaluate("""() => {
        const { width, height } = document.querySelector("canvas");
        const context = document.querySelector("canvas").getContext("2d");
        return Array.from(context.getImageData(0, 0, width, height).data);
    }""")
    assert np.array_equal(np.reshape(shown, (HEIGHT, WIDTH, 4))[..., :3], IMAGES[0])


@pytest.mark.parametrize("theme", ["true", "false"])
def test_axe_finds_nothing_by_day_and_by_night(pressed, axe, theme):
    paper = "#fff" if theme == "true" else "#111"
    ink = "#212121" if theme == "true" else "#eee"
    pressed.evaluate(
        """([theme, paper, ink]) => {
            document.body.dataset.jpThemeLight = theme;
            document.body.style.background = paper;
            document.body.style.setProperty("--jp-ui-font-color1", ink);
            document.body.style.setProperty("--jp-layout-color0", paper);
        }""",
        [theme, paper, ink],
    )
    assert axe(pressed, "#at") == []


def test_all_of_it_fits_a_telephone(pressed):
    pressed.set_viewport_size({"width": 390, "height": 800})
    assert pressed.evaluate("document.documentElement.scrollWidth") <= 390
    for button in pressed.get_by_role("button").all():
        assert button.bounding_box()["height"] >= 24
