"""Predictions on a plain page: by pointer and by keys, skipped, answered before, and for a screen reader."""

import imageio.v3 as iio
import numpy as np
import pytest
from laboratory import open_widget

from hdrlab.core.colour import decode_srgb
from hdrlab.show.widgets import predict

pytestmark = pytest.mark.browser

LEVELS = np.repeat(np.arange(192, dtype=np.uint8)[None], 120, axis=0)
ASKED = {
    "choice": lambda: predict.choice(
        "Which is brighter?", 1, ["the sky", "the wall"], because="It is white."
    ),
    "pictures": lambda: predict.choice(
        "Which is gray?", 0, ["A", "B"], pictures=[LEVELS // 2 + 60, LEVELS // 9]
    ),
    "number": lambda: predict.number("How many stops?", 12, (0, 20), unit="stops"),
    "curve": lambda: predict.curve("Draw it.", [0, 1], [0, 1], names=("level", "light")),
    "place": lambda: predict.place(
        "Where is it brightest?", LEVELS > 185, LEVELS, alt="A ramp to white"
    ),
}


@pytest.fixture
def ask(page):
    def open_(kind, **traits):
        widget = ASKED[kind]()
        for name, value in traits.items():
            setattr(widget, name, value)
        open_widget(page, widget)
        return page

    yield open_
    assert page.problems == []
    assert [url for url in page.requests if not url.startswith(("blob:", "data:"))] == []


def status(page):
    return page.get_by_role("status").last.inner_text()


def show(page):
    page.get_by_role("button", name="Show").click()


def given(page):
    return page.evaluate("window.model.get('given')")


def test_a_choice_is_compared_with_the_truth_and_kept(ask):
    page = ask("choice")
    page.get_by_role("radio", name="the sky").check()
    show(page)
    assert status(page).startswith("You said: the sky. The truth: the wall. It is white.")
    assert given(page) == 0 and page.evaluate("window.model.get('done')")
    assert page.get_by_role("button").count() == 0


def test_a_number_is_given_by_keys_and_told_how_far_it_is(ask):
    page = ask("number")
    page.get_by_role("slider", name="your answer").press("End")
    show(page)
    assert status(page).startswith("You said 20 stops, 8 too high. The truth: 12 stops.")
    assert page.get_by_role("slider", name="the truth", include_hidden=True).input_value() == "12"


def test_a_curve_drawn_near_the_truth_is_near(ask):
    page = ask("curve")
    box = page.locator("canvas").bounding_box()
    low, high = (1 - (y + 0.2) / 1.4 for y in (0, 1))  # the axes leave room
    page.mouse.move(box["x"] + 2, box["y"] + low * box["height"])
    page.mouse.down()
    for share in np.linspace(0, 1, 30):
        x, y = share * (box["width"] - 4) + 2, (low + share * (high - low)) * box["height"]
        page.mouse.move(box["x"] + x, box["y"] + y)
    page.mouse.up()
    show(page)
    assert status(page).startswith("Near: your curve is off by 0.0")


def test_a_curve_is_drawn_by_keys_and_read_aloud(ask):
    page = ask("curve")
    page.locator(".hdrlab-stage").focus()
    for key in ("ArrowUp", "ArrowRight", "ArrowRight", "ArrowDown"):
        page.keyboard.press(key)
    assert page.get_by_role("status").first.inner_text() == "level 0.125: light 0.5"
    show(page)
    assert [round(y, 3) for y in given(page) if y is not None] == [0.535, 0.535, 0.5]
    assert "and the true one" in page.get_by_role("img").get_attribute("aria-label")


def luminances(page, places):
    """Return the relative luminance of some pixels of the canvas, as the screen shows them."""
    picture = iio.imread(page.locator("canvas").screenshot())[..., :3] / 255
    height, width = picture.shape[:2]
    pixels = np.array([picture[int(y * height), int(x * width)] for x, y in places])
    return decode_srgb(pixels) @ [0.2126, 0.7152, 0.0722]


def test_the_field_of_a_curve_is_dark_where_jupyterlab_is_and_both_curves_stand_out(ask):
    page = ask("curve", given=[1.0] * 17, done=True)
    places = [
        (0.3, 0.05),
        (0.5, 0.2 / 1.4),
        (0.7, 1 - 0.9 / 1.4),
    ]  # the field, yours at 1, the truth
    assert luminances(page, places)[0] == 1
    page.evaluate("document.body.dataset.jpThemeLight = 'false'")
    field, *lines = luminances(page, places)
    assert field < 0.01 and all((line + 0.05) / (field + 0.05) > 3 for line in lines)


@pytest.mark.parametrize(("across", "told"), [(0.99, "Yes."), (0.5, "You were 90 pixels away.")])
def test_a_pixel_is_marked_by_the_pointer_and_told_how_far_it_is(ask, across, told):
    page = ask("place")
    box = page.locator("canvas").bounding_box()
    page.mouse.click(box["x"] + across * box["width"], box["y"] + 20)
    show(page)
    assert status(page).startswith(told)


def test_a_pixel_is_marked_by_keys(ask):
    page = ask("place")
    page.locator(".hdrlab-stage").focus()
    for key in ("ArrowRight", "Shift+ArrowRight", "ArrowUp"):
        page.keyboard.press(key)
    show(page)
    assert given(page) == [117, 59]


@pytest.mark.parametrize("kind", ASKED)
def test_skipping_is_one_click_and_shows_the_truth(ask, kind):
    page = ask(kind)
    page.get_by_role("button", name="Skip").click()
    assert status(page).startswith("The truth: ") and "so far" not in status(page)
    assert given(page) is None and page.evaluate("window.model.get('done')")


@pytest.mark.parametrize("kind", ASKED)
def test_without_an_answer_the_truth_stays_hidden(ask, kind):
    page = ask(kind)
    show(page)
    assert status(page) == "First your answer, or skip it."
    assert not page.evaluate("window.model.get('done')")


def test_a_saved_answer_comes_back_with_its_truth(ask):
    page = ask("number", given=3.0, done=True)
    assert status(page).startswith("You said 3 stops, 9 too low. The truth: 12 stops.")


def test_the_page_counts_what_was_near(ask):
    page = ask("choice")
    page.get_by_role("radio", name="the wall").check()
    show(page)
    assert status(page).endswith("On this page so far: 1 of 1 near.")


@pytest.mark.parametrize("width", [1280, 390])
@pytest.mark.parametrize("kind", ASKED)
def test_a_question_fits_the_screen_and_axe_finds_nothing_wrong_before_and_after(
    ask, axe, kind, width
):
    page = ask(kind)
    page.set_viewport_size({"width": width, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert axe(page, "#at") == []
    page.get_by_role("button", name="Skip").click()
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert axe(page, "#at") == []
