"""The figure of Fattal's operator in one dimension shows hdrlab's gradients and its new line."""

import re

import numpy as np
import pytest
from laboratory import PATIENCE, open_widget

from hdrlab.show import widgets
from hdrlab.tonemap import fattal

pytestmark = pytest.mark.browser

PIXELS = np.arange(120)
LINE = 5 / (1 + np.exp(-(PIXELS - 60) / 6)) + 0.15 * np.sin(PIXELS / 2)
STEPS = np.diff(LINE)
MEAN = np.abs(STEPS).mean()
STATUS = "document.querySelector('[role=status]').textContent"
NEXT_FRAME = "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"


@pytest.fixture
def figure(page):
    page.widget = widgets.gradient_line(LINE, alt="A ramp with a ripple")
    open_widget(page, page.widget)
    yield page
    assert page.problems == []


def points_of(path):
    return np.array([point.split(",") for point in path.removeprefix("M").split("L")], float)


def assert_figure_shows_the_library(page):
    page.evaluate(NEXT_FRAME)
    alpha = page.evaluate("window.model.get('alpha')")
    beta = page.evaluate("window.model.get('beta')")
    at = page.evaluate("window.model.get('at')")
    phi = fattal.attenuation(np.abs(STEPS), MEAN, alpha=alpha, beta=beta, noise=0.01)
    expected = LINE[0] + np.append(0, np.cumsum(phi * STEPS))

    low, high = page.widget.span
    path = page.locator(".hdrlab-gradients path.hdrlab-thick").first.get_attribute("d")
    assert high - points_of(path)[:, 1] * (high - low) == pytest.approx(expected, abs=1e-3)

    tops = [
        np.array(re.findall(r"V(-?[\d.]+)H", bars.get_attribute("d")), float)
        for bars in page.locator(".hdrlab-steps path.hdrlab-area").all()
    ]
    foot = float(page.locator(".hdrlab-steps path.hdrlab-thin").get_attribute("d")[3:-2])
    before = foot - tops[0]
    after = foot - tops[1]
    unit = before[np.argmax(before)] / STEPS.max()
    assert before == pytest.approx(unit * STEPS, abs=2e-4)
    assert after == pytest.approx(unit * phi * STEPS, abs=2e-4)

    spans = re.search(r"spans (\S+) nats before and (\S+) after", page.evaluate(STATUS)).groups()
    assert [float(span) for span in spans] == pytest.approx(
        [np.ptp(LINE), np.ptp(expected)], abs=0.006
    )
    kept = float(re.search(r"becomes (\S+) times", page.evaluate(STATUS))[1])
    assert kept == pytest.approx(phi[at], abs=0.006)


def drag(page, handle, right, down):
    """Drag a handle by some pixels of the screen."""
    handle.scroll_into_view_if_needed()
    box = handle.bounding_box()
    x = box["x"] + box["width"] / 2
    y = box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + right, y + down, steps=3)
    page.mouse.up()


def test_the_dragged_curve_attenuates_and_adds_up_as_the_library_does(figure):
    assert_figure_shows_the_library(figure)
    drag(figure, figure.get_by_role("slider", name="Beta"), 0, 60)
    assert 0.1 <= figure.evaluate("window.model.get('beta')") < 0.5
    assert_figure_shows_the_library(figure)
    drag(figure, figure.get_by_role("slider", name="Alpha"), -100, 60)
    assert figure.evaluate("window.model.get('alpha')") < 0.3
    assert_figure_shows_the_library(figure)


def test_the_handles_lie_on_the_curve_and_follow_the_pointer(figure):
    box = figure.locator(".hdrlab-attenuation").bounding_box()
    beta = figure.get_by_role("slider", name="Beta")
    drag(figure, beta, -20, 40)
    figure.evaluate(NEXT_FRAME)
    knob = beta.bounding_box()
    path = figure.locator(".hdrlab-attenuation path.hdrlab-thick").get_attribute("d")
    end = points_of(path)[-1]
    assert knob["y"] + knob["height"] / 2 == pytest.approx(box["y"] + end[1] * box["height"], abs=2)


def test_a_power_of_one_changes_nothing(figure):
    beta = figure.get_by_role("slider", name="Beta")
    beta.focus()
    for _ in range(3):
        figure.keyboard.press("Shift+ArrowRight")
    assert figure.evaluate("window.model.get('beta')") == 1
    assert_figure_shows_the_library(figure)
    spans = re.search(r"spans (\S+) nats before and (\S+) after", figure.evaluate(STATUS))
    assert spans[1] == spans[2]


def test_arrow_keys_and_a_touch_move_the_handles_and_the_step(figure):
    for role, name, key, expected in (
        ("Alpha", "alpha", "Shift+ArrowDown", 0.5),
        ("Beta", "beta", "ArrowDown", 0.78),
        ("Step", "at", "Shift+ArrowLeft", int(np.argmax(np.abs(STEPS))) - 8),
    ):
        figure.get_by_role("slider", name=re.compile(f"^{role}")).focus()
        figure.keyboard.press(key)
        assert figure.evaluate(f"window.model.get('{name}')") == pytest.approx(expected)
    assert figure.evaluate("window.reached") == []
    box = figure.locator(".hdrlab-steps").bounding_box()
    figure.touchscreen.tap(box["x"] + 3, box["y"] + 80)
    assert figure.evaluate("window.model.get('at')") == 0
    figure.wait_for_function(f"{STATUS}.includes('Step 0,')", timeout=PATIENCE)
    assert_figure_shows_the_library(figure)


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
