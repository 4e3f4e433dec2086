"""The figure of the exposure: a dragged shutter shows what hdrlab's simulated camera records."""

import re

import numpy as np
import pytest
from laboratory import PATIENCE, open_widget

from hdrlab import scenes
from hdrlab.capture import camera, ranges
from hdrlab.capture.sensor import Sensor
from hdrlab.core import colour
from hdrlab.show import widgets

pytestmark = pytest.mark.browser

SENSOR = Sensor(full_well=20_000, read_noise=5, gain=5, bits=12, black=64)
SENSITIVITY = 1 / 1000
E = scenes.workshop((96, 144))
L = colour.luminance(E)
SLIDER = "document.querySelector('[role=slider]')"


@pytest.fixture
def figure():
    return widgets.exposure_window(E, SENSOR, alt="A workshop", time=1 / 4, sensitivity=SENSITIVITY)


@pytest.fixture
def dragged(page, figure):
    open_widget(page, figure)
    yield page
    assert page.problems == []


def percentages(page, shutter):
    """Return the percentages of pixels lost in noise and of clipped ones, once the shutter shows."""
    page.wait_for_function(
        f"{SLIDER}.getAttribute('aria-valuetext').startsWith('{shutter}:')", timeout=PATIENCE
    )
    text = page.evaluate(f"{SLIDER}.getAttribute('aria-valuetext')")
    return [float(number) for number in re.findall(r"([\d.]+)\xa0%", text)]


def drag_to(page, figure, index):
    """Drag the window from where it is to a setting of the dial."""
    box = page.locator(".hdrlab-histogram").bounding_box()
    stops = np.log2(figure.times[page.evaluate("window.model.get('at')")] / figure.times[index])
    window = page.locator(".hdrlab-window").bounding_box()
    x = window["x"] + window["width"] / 2
    y = box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + stops / np.ptp(figure.span) * box["width"], y, steps=3)
    page.mouse.up()


def test_dragging_the_shutter_states_the_percentages_of_the_library(dragged, figure):
    for shutter in ("1/60 s", "4 s", "1/1000 s", "30 s"):
        index = figure.shutters.index(shutter)
        drag_to(dragged, figure, index)
        held = ranges.expose_levels(L, figure.times[index], SENSOR, sensitivity=SENSITIVITY)
        expected = [100 * held.noise.mean(), 100 * held.full.mean()]
        assert percentages(dragged, shutter) == pytest.approx(expected, abs=0.6)


def test_the_clipped_percentage_is_that_of_a_simulated_photo(dragged, figure):
    index = figure.shutters.index("1 s")
    drag_to(dragged, figure, index)
    gray = camera.Camera(response="linear", bits=16, sensor=SENSOR, sensitivity=SENSITIVITY)
    photo = camera.shoot(L, [figure.times[index]], gray).images[0]
    almost_full = 0.999 * (2**16 - 1)  # its noise is smaller
    clipped = 100 * (photo > almost_full).mean()
    assert percentages(dragged, "1 s")[1] == pytest.approx(clipped, abs=1)


def test_the_photo_is_that_of_the_simulated_camera_up_to_its_noise(dragged, figure):
    shown = np.reshape(
        dragged.evaluate("""() => {
            const canvas = document.querySelector("canvas");
            const image = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            return Array.from(image.data);
        }"""),
        (*L.shape, 4),
    )[..., :3]
    time = figure.times[figure.at]
    held = ranges.expose_levels(L, time, SENSOR, sensitivity=SENSITIVITY)
    is_unmarked = ~(held.full | held.noise)
    same = camera.Camera(response="srgb", sensor=SENSOR, sensitivity=SENSITIVITY)
    taken = camera.shoot(E, [time], same).images[0]
    difference = shown[is_unmarked].astype(float) - taken[is_unmarked]
    assert np.abs(difference.mean()) < 0.2
    other = camera.shoot(E, [time], same, rng=1).images[0].astype(float)
    noise = np.std(other[is_unmarked] - taken[is_unmarked])
    assert np.std(difference) == pytest.approx(noise, rel=0.15)


def test_arrow_keys_turn_the_dial_by_a_third_of_a_stop_and_with_shift_by_a_stop(dragged):
    dragged.get_by_role("slider").focus()
    dragged.keyboard.press("ArrowRight")
    percentages(dragged, "1/5 s")
    dragged.keyboard.press("Shift+ArrowLeft")
    percentages(dragged, "0.4 s")
    assert dragged.evaluate("window.reached") == []


def test_a_touch_beside_the_window_brings_it_to_the_finger(dragged):
    box = dragged.locator(".hdrlab-histogram").bounding_box()
    dragged.touchscreen.tap(box["x"] + 0.98 * box["width"], box["y"] + 50)
    dragged.wait_for_function(
        "document.querySelector('.hdrlab-window').offsetLeft > "
        "document.querySelector('.hdrlab-histogram').offsetWidth / 2",
        timeout=PATIENCE,
    )


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


def test_all_of_it_fits_a_telephone(dragged):
    dragged.set_viewport_size({"width": 390, "height": 800})
    assert dragged.evaluate("document.documentElement.scrollWidth") <= 390
