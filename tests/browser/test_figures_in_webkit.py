"""The figures with draggable objects in WebKit, the engine of Safari.

Selenium drives it. It needs WebKitWebDriver (Debian's package webkit2gtk-driver) and a display, such as
that of `xvfb-run`.
"""

import io
import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from laboratory import widget_page
from PIL import Image

from hdrlab.capture.sensor import Sensor
from hdrlab.show import widgets

webdriver = pytest.importorskip("selenium.webdriver", reason="selenium is not installed")
from selenium.webdriver import ActionChains, Keys  # noqa: E402
from selenium.webdriver.support.wait import WebDriverWait  # noqa: E402

pytestmark = [
    pytest.mark.browser,
    pytest.mark.filterwarnings("ignore::DeprecationWarning:selenium"),
]

WAIT_SECONDS = 60  # a limit for errors
FOCUS = """const [part] = arguments;
(part.tabIndex < 0 ? part.querySelector("[tabindex]") : part).focus();"""
PIXELS = np.arange(120)
ROW = np.where(PIXELS < 60, 0, 2) + 0.1 * np.sin(PIXELS / 2)
WEDGE = np.geomspace(1, 2.0**12, 120)[None] * np.ones((90, 1))
PHOTOS = np.stack([np.clip(WEDGE * time, 0, 255).astype(np.uint8) for time in (0.1, 0.2, 0.4)])
GAINS = np.linspace(0, 1, 120)[None, :, None] * np.ones((90, 1, 3))
# Each figure, and the part of it that is dragged.
FIGURES = {
    "exposure": (
        lambda: widgets.exposure_window(WEDGE, Sensor(), alt="A", time=1 / 60, sensitivity=0.01),
        ".hdrlab-scale",
    ),
    "bitmaps": (
        lambda: widgets.bitmap_difference(PHOTOS[1], PHOTOS[2], alt="A"),
        "[role=application]",
    ),
    "gsolve": (
        lambda: widgets.gsolve_by_hand(PHOTOS, [0.1, 0.2, 0.4], alt="A"),
        ".hdrlab-levels",
    ),
    "pixel": (
        lambda: widgets.pixel_mean(PHOTOS, [0.1, 0.2, 0.4], np.log(np.arange(1, 257)), alt="A"),
        "[role=application]",
    ),
    "zones": (lambda: widgets.zone_scale(WEDGE, alt="A"), ".hdrlab-scale"),
    "kernel": (lambda: widgets.bilateral_kernel(ROW, alt="A", at=50), ".hdrlab-levels"),
    "gradients": (lambda: widgets.gradient_line(ROW, alt="A"), ".hdrlab-steps"),
    "gains": (
        lambda: widgets.gain_screen(
            np.uint8(200 * GAINS), GAINS, [0] * 3, [3] * 3, alt="A", screen=2.0
        ),
        ".hdrlab-scale",
    ),
}


@pytest.fixture(scope="module")
def driver():
    program = shutil.which("WebKitWebDriver")
    browsers = sorted(Path("/usr/lib").glob("*/webkit2gtk-4.*/MiniBrowser"))
    if program is None or not browsers:
        pytest.skip("WebKit needs WebKitWebDriver and its MiniBrowser")
    if "DISPLAY" not in os.environ:
        pytest.skip("WebKit needs a display, such as that of xvfb-run")
    options = webdriver.WebKitGTKOptions()
    options.binary_location = str(browsers[-1])
    options.add_argument("--automation")
    service = webdriver.WebKitGTKService(executable_path=program)
    started = webdriver.WebKitGTK(options=options, service=service)
    started.set_window_size(1280, 900)
    yield started
    started.quit()


@pytest.fixture
def figure(driver, tmp_path):
    """Return a function that opens a figure by name, and returns the part that is dragged."""

    def open_(name):
        make, dragged = FIGURES[name]
        (tmp_path / "figure.html").write_text(widget_page(make()), "utf-8")
        driver.get((tmp_path / "figure.html").as_uri())
        wait_until(driver, lambda: read_status(driver) != "")
        return driver.find_element("css selector", dragged)

    return open_


def wait_until(driver, condition):
    WebDriverWait(driver, WAIT_SECONDS).until(lambda _: condition())


def read_status(driver):
    return driver.execute_script(
        "return document.querySelector('[role=status]')?.textContent ?? ''"
    )


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_follows_a_key_and_the_pointer(driver, figure, name):
    dragged = figure(name)
    first = read_status(driver)
    driver.execute_script(FOCUS, dragged)
    ActionChains(driver).send_keys(Keys.ARROW_RIGHT, Keys.ARROW_RIGHT).perform()
    wait_until(driver, lambda: read_status(driver) != first)
    second = read_status(driver)
    pointer = ActionChains(driver).move_to_element(dragged).click_and_hold()
    pointer.move_by_offset(-40, 10).move_by_offset(-40, 10).release().perform()
    wait_until(driver, lambda: read_status(driver) != second)


@pytest.mark.parametrize("name", ["kernel", "gradients"])
def test_a_plot_with_dots_is_mostly_paper(driver, figure, name):
    """WebKit once filled the whole plot if a dot had no length."""
    figure(name)
    page = Image.open(io.BytesIO(driver.get_screenshot_as_png())).convert("L")
    for plot in driver.find_elements("class name", "hdrlab-levels"):
        left = plot.rect["x"]
        top = plot.rect["y"]
        width = plot.rect["width"]
        height = plot.rect["height"]
        shown = np.asarray(page.crop((left, top, left + width, top + height)))
        assert np.mean(shown > 200) > 0.7


def test_the_fields_that_are_matched_have_a_pixel_for_each_pixel_of_the_screen(driver, tmp_path):
    (tmp_path / "figure.html").write_text(
        widget_page(widgets.screen_match(WEDGE, alt="A")), "utf-8"
    )
    driver.get((tmp_path / "figure.html").as_uri())
    wait_until(driver, lambda: read_status(driver) != "")
    sizes = driver.execute_script(
        """return [...document.querySelectorAll(".hdrlab-field")].map((field) => {
            const box = field.getBoundingClientRect();
            const expected = [box.width * devicePixelRatio, box.height * devicePixelRatio];
            return [field.width, field.height, ...expected];
        });"""
    )
    assert len(sizes) == 2
    for width, height, *expected in sizes:
        assert [width, height] == pytest.approx(expected, abs=1)
    for slider in driver.find_elements("css selector", "input[type=range]"):
        driver.execute_script(FOCUS, slider)
        ActionChains(driver).send_keys(Keys.ARROW_LEFT).perform()
    wait_until(driver, lambda: read_status(driver).startswith("Gamma"))
