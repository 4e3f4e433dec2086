"""The figure that measures a screen: simulated screens are recovered from what the page really shows."""

import io
import re

import imageio.v3 as iio
import numpy as np
import pytest
from laboratory import PATIENCE, open_widget

from hdrlab import scenes
from hdrlab.calibration import matching
from hdrlab.core import colour
from hdrlab.show import widgets
from hdrlab.tonemap import ward

pytestmark = pytest.mark.browser

E = scenes.chapel((80, 120))
L = colour.luminance(E)
SHOWN = """(k) => {
    const canvas = document.querySelectorAll("canvas.hdrlab-photo")[k];
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return Array.from(data);
}"""
TWO_FRAMES = """() => new Promise((resolve) =>
    requestAnimationFrame(() => requestAnimationFrame(resolve)))"""


@pytest.fixture
def opened(browser):
    """Return a function that opens the figure on a screen with so many pixels for a CSS pixel."""
    contexts = []

    def open_(device_scale_factor=1.0):
        context = browser.new_context(
            viewport={"width": 1280, "height": 720}, device_scale_factor=device_scale_factor
        )
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(PATIENCE)
        page.problems = []
        page.on("pageerror", lambda error: page.problems.append(str(error)))
        open_widget(page, widgets.screen_match(E, alt="A chapel"))
        page.evaluate(TWO_FRAMES)
        return page

    yield open_
    for context in contexts:
        assert all(page.problems == [] for page in context.pages)
        context.close()


def set_slider(page, name, position):
    page.get_by_role("slider", name=name).fill(str(position))
    page.evaluate(TWO_FRAMES)


def field_light(page, number, screen):
    """Return the light of the patch of a field, and of its surround, on a simulated screen."""
    field = page.locator(".hdrlab-field").nth(number).screenshot()
    codes = iio.imread(io.BytesIO(field))[..., 0]
    height, width = codes.shape
    half = int(0.15 * height)
    patch = codes[height // 2 - half : height // 2 + half, width // 2 - half : width // 2 + half]
    edge = codes[8 : 8 + 2 * half, 8 : width // 4]
    return [matching.screen_light(part / 255, screen).mean() for part in (patch, edge)]


def find_match(page, name, is_bright_enough):
    """Move a slider to its first position at which the patch is bright enough, by bisection."""
    low = -1
    high = int(page.get_by_role("slider", name=name).get_attribute("max"))
    while high - low > 1:
        middle = (low + high) // 2
        set_slider(page, name, middle)
        low, high = (low, middle) if is_bright_enough() else (middle, high)
    set_slider(page, name, high)


@pytest.mark.parametrize("device_scale_factor", [1, 1.5])
@pytest.mark.parametrize(("gamma", "black"), [(1.8, 0.03), (2.2, 0.01), (2.8, 0.0005)])
def test_a_simulated_screen_is_recovered_from_screenshots(
    opened, gamma, black, device_scale_factor
):
    page = opened(device_scale_factor)
    screen = matching.Screen(gamma, black)

    def is_as_bright_as_the_rows():
        patch, rows = field_light(page, 0, screen)
        return patch >= rows

    def is_visible():
        patch, surround = field_light(page, 1, screen)
        return patch - surround >= matching.THRESHOLD * surround

    find_match(page, "gray", is_as_bright_as_the_rows)
    assert "Make both matches" in page.get_by_role("status").inner_text()
    find_match(page, "dark", is_visible)
    found = re.search(
        r"Gamma ([\d.]+) .*?([\d.]+) stops \(([\d.]+) to ([\d.]+)\)",
        page.get_by_role("status").inner_text(),
    )
    assert float(found[1]) == pytest.approx(gamma, rel=0.1)
    assert float(found[2]) == pytest.approx(screen.stops, rel=0.1)
    assert float(found[3]) <= screen.stops <= float(found[4])


def test_numbers_and_picture_are_those_of_the_library(opened):
    page = opened()
    page.get_by_role("slider", name="gray").focus()
    for _ in range(5):
        page.keyboard.press("ArrowRight")
    page.get_by_role("slider", name="dark").focus()
    page.keyboard.press("ArrowLeft")
    page.evaluate(TWO_FRAMES)
    gray = page.evaluate("window.model.get('gray')")
    dark = page.evaluate("window.model.get('dark')")
    assert gray * 255 == pytest.approx(155) and dark * 255 < 24
    assert page.evaluate("window.reached") == []
    screen = matching.measure(gray, dark)
    fewest, most = matching.stops_range(gray, dark)
    status = page.get_by_role("status").inner_text().replace("\xa0", " ")
    assert status.startswith(f"Gamma {screen.gamma:.2f} ±")
    assert f"{screen.stops:.1f} stops ({fewest:.1f} to {most:.1f})" in status
    white = matching.setting_of_contrast(screen)
    assert page.get_by_text(f"For this screen: ward with white {white:.0f}").count() == 1
    Ld = ward.tonemap(L, white=white)
    expected = matching.encode(colour.recolour(E, L, Ld), screen.gamma)
    shown = np.reshape(page.evaluate(SHOWN, 1), (*E.shape[:2], 4))[..., :3]
    off = np.abs(shown - expected.astype(int))
    assert np.quantile(off, 0.99) <= 1 and off.max() <= 4  # steps of the table of light near black
    usual = colour.to_8bit(colour.recolour(E, L, ward.tonemap(L)))
    before = np.reshape(page.evaluate(SHOWN, 0), (*E.shape[:2], 4))[..., :3]
    assert np.abs(before - usual.astype(int)).max() <= 1


def test_no_result_is_shown_before_both_sliders_were_moved(opened):
    page = opened()
    assert page.evaluate(SHOWN, 0) == page.evaluate(SHOWN, 1)
    assert page.get_by_text("make both matches first").count() == 1
    assert "Gamma" not in page.get_by_role("status").inner_text()


def test_the_fields_fill_the_screen_and_come_back(opened):
    page = opened()
    small = page.locator(".hdrlab-field").first.bounding_box()["height"]
    page.get_by_role("button", name="Fill the screen").click()
    back = page.get_by_role("button", name="Back to the page")
    back.wait_for()
    assert page.locator(".hdrlab-field").first.bounding_box()["height"] > 1.5 * small
    assert not page.locator("canvas.hdrlab-photo").first.is_visible()
    back.click()
    page.get_by_role("button", name="Fill the screen").wait_for()
    assert page.locator("canvas.hdrlab-photo").first.is_visible()


def test_a_square_that_never_disappears_gives_a_bound(opened):
    page = opened()
    set_slider(page, "gray", 58)
    set_slider(page, "dark", 0)
    status = page.get_by_role("status").inner_text().replace("\xa0", " ")
    assert "Black at most 0.024 % of white" in status and "at least 12.0 stops." in status


@pytest.mark.parametrize("theme", ["true", "false"])
def test_axe_finds_nothing_by_day_and_by_night(opened, axe, theme):
    page = opened()
    paper = "#fff" if theme == "true" else "#111"
    ink = "#212121" if theme == "true" else "#eee"
    page.evaluate(
        """([theme, paper, ink]) => {
            document.body.dataset.jpThemeLight = theme;
            document.body.style.background = paper;
            document.body.style.setProperty("--jp-ui-font-color1", ink);
            document.body.style.setProperty("--jp-layout-color0", paper);
        }""",
        [theme, paper, ink],
    )
    assert axe(page, "#at") == []
    page.set_viewport_size({"width": 390, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
