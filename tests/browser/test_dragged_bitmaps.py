"""The figure of two bitmaps counts the same differing bits as alignment by bitmaps."""

import re

import numpy as np
import pytest
from laboratory import PATIENCE, open_widget

from hdrlab import scenes
from hdrlab.align import mtb
from hdrlab.capture import camera
from hdrlab.show import widgets

pytestmark = pytest.mark.browser

STREET = scenes.street((96, 144))
TIMES = camera.times_around(STREET, 3, stops=2)[:2]
SENSOR = camera.Camera(response="srgb", full_well=20_000, read_noise=8)
MOVING, FIXED = camera.shoot(STREET, TIMES, SENSOR, offsets=[(3, -5), (0, 0)], rng=4).images
HEIGHT, WIDTH = MOVING.shape[:2]  # what both photos show
LEVELS = {state.level: state for state in mtb.search(mtb.gray(FIXED), mtb.gray(MOVING))}


@pytest.fixture
def dragged(page):
    open_widget(page, widgets.bitmap_difference(FIXED, MOVING, alt="A street at night"))
    yield page
    assert page.problems == []


def counts_shown(page, offset):
    """Return how many bits differ and how many are compared, once the figure shows the offset."""
    ending = f"moved by ({offset[0]}, {offset[1]})".replace("-", "−")
    page.wait_for_function(
        "(ending) => document.querySelector('canvas').ariaLabel.endsWith(ending)",
        arg=ending,
        timeout=PATIENCE,
    )
    text = page.evaluate("document.querySelector('[role=status]').textContent")
    return [int(number) for number in re.search(r": (\d+) of (\d+) ", text).groups()]


def drag(page, offset):
    """Press the middle of the bitmap, and drag it by an offset."""
    box = page.locator("canvas").first.bounding_box()
    x = box["x"] + box["width"] / 2
    y = box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + offset[1] * box["width"] / WIDTH, y + offset[0] * box["height"] / HEIGHT)
    page.mouse.up()


def test_drags_count_the_bits_that_the_library_counts(dragged):
    state = LEVELS[0]
    at = np.zeros(2, int)
    for step in [(-3, 5), (10, -7), (-7, 2), (-20, 20)]:
        drag(dragged, step)
        at += step
        count, total = counts_shown(dragged, at)
        expected = mtb.error(state.fixed, state.moving, tuple(at))
        assert count / total == pytest.approx(expected, rel=1e-9)


def test_without_exclusion_all_pixels_of_the_overlap_are_compared(dragged):
    dragged.get_by_role("checkbox").uncheck()
    drag(dragged, (4, 6))
    count, total = counts_shown(dragged, (4, 6))
    fixed = LEVELS[0].fixed[0]
    moving = LEVELS[0].moving[0]
    assert total == (HEIGHT - 4) * (WIDTH - 6)
    assert count == np.sum(fixed[4:, 6:] ^ moving[:-4, :-6])


def test_arrow_keys_move_by_pixels_of_the_level_and_a_finer_level_doubles_the_offset(dragged):
    dragged.get_by_role("button", name="1/4").press("Enter")
    dragged.get_by_role("application").focus()
    dragged.keyboard.press("ArrowRight")
    dragged.keyboard.press("ArrowUp")
    for level, offset in [(2, (-1, 1)), (1, (-2, 2))]:
        count, total = counts_shown(dragged, offset)
        state = LEVELS[level]
        expected = mtb.error(state.fixed, state.moving, offset)
        assert count / total == pytest.approx(expected, rel=1e-9)
        dragged.get_by_role("button", name="1/2").press("Enter")
    assert dragged.get_by_role("status").get_attribute("aria-live") == "polite"
    assert not set(dragged.evaluate("window.reached")) & {"ArrowRight", "ArrowUp"}


def test_axe_finds_nothing_in_either_theme(dragged, axe):
    for is_light, paper, ink, link in [
        (True, "#fff", "#212121", ""),
        (False, "#111", "#eee", "#74bdf2"),
    ]:
        dragged.evaluate(
            """([isLight, paper, ink, link]) => {
                document.body.dataset.jpThemeLight = isLight;
                document.body.style.background = paper;
                document.body.style.setProperty("--jp-ui-font-color1", ink);
                document.body.style.setProperty("--jp-content-link-color", link);
            }""",
            [is_light, paper, ink, link],
        )
        assert axe(dragged, "#at") == []


def test_all_of_it_fits_a_telephone(dragged):
    dragged.set_viewport_size({"width": 390, "height": 800})
    assert dragged.evaluate("document.documentElement.scrollWidth") <= 390
