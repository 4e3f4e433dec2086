"""Prediction questions on a page without a kernel: mouse, keyboard, saved answers, screen readers."""

import imageio.v3 as iio
import numpy as np
import pytest
from laboratory import open_widget

from hdrlab.core.colour import decode_srgb
from hdrlab.show.widgets import predict

pytestmark = pytest.mark.browser

LEVELS = np.repeat(np.arange(192, dtype=np.uint8)[None], 120, axis=0)
QUESTIONS = {
    "choice": lambda: predict.choice(
        "Which is brighter?", 1, ["the sky", "the wall"], because="It is white."
    ),
    "pictures": lambda: predict.choice(
        "Which is gray?", 0, ["A", "B"], pictures=[LEVELS // 2 + 60, LEVELS // 9]
    ),
    "number": lambda: predict.number("How many stops?", 12, (0, 20), unit="stops"),
    "entry": lambda: predict.entry("What does it give?", 0.667, because="It is 2 / 3."),
    "curve": lambda: predict.curve("Draw it.", [0, 1], [0, 1], names=("level", "light")),
    "place": lambda: predict.place(
        "Where is it brightest?", LEVELS > 185, LEVELS, alt="A ramp to white"
    ),
}


@pytest.fixture
def ask(page):
    def open_(kind, **traits):
        widget = QUESTIONS[kind]()
        for name, value in traits.items():
            setattr(widget, name, value)
        open_widget(page, widget)
        return page

    yield open_
    assert page.problems == []
    assert [url for url in page.requests if not url.startswith(("blob:", "data:"))] == []


def status(page):
    return page.get_by_role("status").last.inner_text()


def check(page):
    page.get_by_role("button", name="Check my answer").click()


def show(page):
    page.get_by_role("button", name="Show", exact=True).click()


def answer_of(page):
    return page.evaluate("window.model.get('given')")


@pytest.mark.parametrize(
    ("typed", "number", "said"),
    [
        ("0,67", 0.67, "Yes."),
        (" 0.667 ", 0.667, "Yes."),
        ("2/3", 2 / 3, "Yes."),
        ("\u22120.667", -0.667, "You said: -0.667."),
        ("1", 1, "You said: 1."),
    ],
)
def test_a_typed_number_is_compared_with_the_truth(ask, typed, number, said):
    page = ask("entry", code="hat(6)[2]", covers=False)
    page.get_by_role("textbox", name="your answer").fill(typed)
    page.keyboard.press("Enter")
    assert status(page) == f"{said} The right value: 0.667. It is 2 / 3."
    assert answer_of(page) == number


@pytest.mark.parametrize("typed", ["", "/2", "1/", "1/0", "1/2/3", "half"])
def test_what_is_no_number_is_asked_for_again(ask, typed):
    page = ask("entry", code="hat(6)[2]", covers=False)
    page.get_by_role("textbox", name="your answer").fill(typed)
    page.keyboard.press("Enter")
    assert status(page).startswith("Type a number first")
    assert answer_of(page) is None


def test_text_that_is_no_number_is_not_taken_as_an_answer(ask):
    page = ask("entry")
    page.get_by_role("textbox", name="your answer").fill("two")
    page.keyboard.press("Enter")
    assert "Type a number" in status(page) and answer_of(page) is None


def test_a_choice_is_compared_with_the_truth_and_kept(ask):
    page = ask("choice")
    page.get_by_role("radio", name="the sky").check()
    check(page)
    assert status(page).startswith("You said: the sky. The truth: the wall. It is white.")
    assert answer_of(page) == 0 and page.evaluate("window.model.get('done')")
    assert page.get_by_role("button").count() == 0


def test_a_number_is_typed_and_its_distance_from_the_answer_is_shown(ask):
    page = ask("number")
    page.get_by_role("slider", name="your answer").press("End")
    check(page)
    assert status(page).startswith("You said: 20 stops, 8 too high. The truth: 12 stops.")
    assert page.get_by_role("slider", name="the truth", include_hidden=True).input_value() == "12"


def test_a_curve_drawn_with_the_pointer_near_the_truth_is_near(ask):
    page = ask("curve")
    box = page.locator("canvas").bounding_box()
    field = (0.08, 0.97, 0.14, 0.82)  # where 0 and 1 stand in the canvas; the axes leave room
    left, right, high, low = field
    for position in np.linspace(0, 1, 30):
        x = box["x"] + (left + position * (right - left)) * box["width"]
        y = box["y"] + (low + position * (high - low)) * box["height"]
        page.mouse.move(x, y)
        page.mouse.down()
    page.mouse.up()
    check(page)
    assert "3 of 3" in status(page) and "1 of 1 near" in status(page)


def test_the_shape_of_a_curve_is_scored_apart_from_its_position(ask):
    line = [k / 16 for k in range(17)]
    shifted = ask("curve", given=[y - 0.3 for y in line], done=True)
    assert "3 of 3" in status(shifted) and "0.3 too low" in status(shifted)
    flat = ask("curve", given=[0.5] * 17, done=True)
    assert "0 of 3" in status(flat) and "nearly flat" in status(flat)


def test_a_curve_is_drawn_by_keys_and_read_aloud(ask):
    page = ask("curve")
    page.locator(".hdrlab-stage").focus()
    for key in ("ArrowUp", "ArrowRight", "ArrowRight", "ArrowDown"):
        page.keyboard.press(key)
    assert page.get_by_role("status").first.inner_text() == "level 0.125: light 0.5"
    check(page)
    assert [round(y, 3) for y in answer_of(page) if y is not None] == [0.535, 0.535, 0.5]
    assert "and the true one" in page.get_by_role("img").get_attribute("aria-label")


def luminances(page, places):
    """Return the relative luminance of some pixels of the canvas, as the screen shows them."""
    picture = iio.imread(page.locator("canvas").screenshot())[..., :3] / 255
    height, width = picture.shape[:2]
    pixels = np.array([picture[int(y * height), int(x * width)] for x, y in places])
    return decode_srgb(pixels) @ [0.2126, 0.7152, 0.0722]


def test_the_field_of_a_curve_is_dark_where_jupyterlab_is_and_both_curves_stand_out(ask):
    page = ask("curve", given=[1.0] * 17, done=True)
    # the field, your curve at 1, the truth at 0.7
    places = [(0.31, 0.08), (0.525, 0.16), (0.075 + 0.9 * 0.7, 0.031 + 0.896 * (1 - 0.9 / 1.4))]
    assert luminances(page, places)[0] == 1
    page.evaluate("document.body.dataset.jpThemeLight = 'false'")
    field, *lines = luminances(page, places)
    assert field < 0.01 and all((line + 0.05) / (field + 0.05) > 3 for line in lines)


@pytest.mark.parametrize(
    ("across", "messages"), [(0.99, "Yes."), (0.5, "You were 90 pixels away.")]
)
def test_a_pixel_is_marked_with_the_pointer_and_its_distance_from_the_answer_is_shown(
    ask, across, messages
):
    page = ask("place")
    box = page.locator("canvas").bounding_box()
    page.mouse.click(box["x"] + across * box["width"], box["y"] + 20)
    check(page)
    assert status(page).startswith(messages)


def test_a_pixel_is_marked_by_keys(ask):
    page = ask("place")
    page.locator(".hdrlab-stage").focus()
    for key in ("ArrowRight", "Shift+ArrowRight", "ArrowUp"):
        page.keyboard.press(key)
    check(page)
    assert answer_of(page) == [117, 59]


@pytest.mark.parametrize("kind", QUESTIONS)
def test_showing_is_one_click_and_needs_no_answer(ask, kind):
    page = ask(kind)
    show(page)
    assert status(page).startswith("The truth: ") and "so far" not in status(page)
    assert answer_of(page) is None and page.evaluate("window.model.get('done')")


@pytest.mark.parametrize("kind", QUESTIONS)
def test_without_an_answer_the_truth_stays_hidden(ask, kind):
    page = ask(kind)
    check(page)
    assert status(page) and "truth" not in status(page)
    assert not page.evaluate("window.model.get('done')")


def test_a_saved_answer_comes_back_with_its_truth(ask):
    page = ask("number", given=3.0, done=True)
    assert status(page).startswith("You said: 3 stops, 9 too low. The truth: 12 stops.")


def test_the_page_counts_what_was_near(ask):
    page = ask("choice")
    page.get_by_role("radio", name="the wall").check()
    check(page)
    assert status(page).endswith("On this page so far: 1 of 1 near.")


@pytest.mark.parametrize("width", [1280, 390])
@pytest.mark.parametrize("kind", QUESTIONS)
def test_a_question_fits_the_screen_and_axe_finds_nothing_wrong_before_and_after(
    ask, axe, kind, width
):
    page = ask(kind)
    page.set_viewport_size({"width": width, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert axe(page, "#at") == []
    show(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert axe(page, "#at") == []
