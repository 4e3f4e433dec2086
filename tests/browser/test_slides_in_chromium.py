"""A slide deck opened from its folder, with the network blocked."""

import re
import subprocess
import sys
from importlib.util import find_spec

import pytest
from laboratory import PATIENCE, changed_by

NEEDS = ("mdit_py_plugins", "ziamath", "nbclient")
pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(
        any(find_spec(name) is None for name in NEEDS),
        reason='the slides need pip install ".[site]"',
    ),
]
NOTEBOOK = "04_response_gsolve"
SIZE = {"width": 1280, "height": 720}

# What of the shown slide is outside of it, or of a part that should hold it.
OUTSIDE = """() => {
    const slide = document.querySelector("section.present .slide");
    const frame = slide.getBoundingClientRect();
    const isOutside = (part, box) => {
        const { left, top, right, bottom, width, height } = part.getBoundingClientRect();
        if (width === 0 || height === 0) return false;
        const isBefore = left < box.left - 1 || top < box.top - 1;
        return isBefore || right > box.right + 1 || bottom > box.bottom + 1;
    };
    const parts = [...slide.querySelectorAll("*")].filter((part) => !part.closest(".spoken, svg *"));
    const outside = parts.filter((part) => isOutside(part, frame));
    for (const text of slide.querySelectorAll(".text"))
        if (text.scrollHeight > text.clientHeight + 1) outside.push(text);
    for (const sized of slide.querySelectorAll(".sized"))
        if (isOutside(sized, sized.parentElement.getBoundingClientRect())) outside.push(sized);
    return outside.map((part) => part.outerHTML.slice(0, 80));
}"""
OPEN = """() => [...document.querySelectorAll("section.present .live")]
    .every((place) => place.dataset.state === "open")"""
NUMBER = "Reveal.getSlidePastCount() + 1"


@pytest.fixture(scope="module")
def deck(executed_folder, tmp_path_factory):
    """The deck of a notebook of the lecture, and the number of its slides."""
    folder = tmp_path_factory.mktemp("deck")
    cache = folder / ".slides.cache"
    cache.mkdir()
    (executed_folder / "executed").mkdir(parents=True, exist_ok=True)
    (cache / "executed").symlink_to(executed_folder / "executed")
    command = [sys.executable, "-m", "hdrlab", "course", "slides", NOTEBOOK, "-o", "slides"]
    ran = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    [count] = re.findall(r"(\d+) slides;", ran.stdout)
    return folder / "slides" / f"{NOTEBOOK}.html", int(count)


@pytest.fixture
def opened(deck, page):
    """The deck at its first slide, at 1280 x 720, without a network."""
    page.context.set_offline(True)
    page.set_viewport_size(SIZE)
    page.goto(deck[0].as_uri())
    page.wait_for_selector(".reveal.ready")
    yield page
    assert page.problems == []
    allowed = (deck[0].as_uri(), "data:", "blob:")
    assert [url for url in page.requests if not url.startswith(allowed)] == []


def show(page, number):
    """Go to a slide by its number, and wait for its widgets."""
    page.evaluate("number => Reveal.slide(number - 1)", number)
    page.wait_for_function(OPEN, timeout=PATIENCE)


def number_of(page, selector):
    """Return the number of the first slide that has such a part."""
    return page.evaluate(
        """selector => 1 + [...document.querySelectorAll("section")]
            .findIndex((section) => section.querySelector(selector))""",
        selector,
    )


def test_all_slides_are_reached_by_the_keyboard_and_nothing_is_cut_off(opened, deck):
    count = deck[1]
    assert opened.locator("section").count() == count > 30
    for number in range(1, count + 1):
        assert opened.evaluate(NUMBER) == number
        opened.wait_for_function(OPEN, timeout=PATIENCE)
        assert opened.evaluate(OUTSIDE) == [], f"slide {number}"
        opened.keyboard.press("ArrowRight")
    assert opened.evaluate("Reveal.isLastSlide()")


@pytest.mark.parametrize("width", [1280, 1920])
def test_the_figure_of_a_slider_follows_the_mouse_on_a_screen_of_any_size(opened, width):
    number = number_of(opened, "img[alt^='Points of sixty pixels']")
    opened.set_viewport_size({"width": width, "height": width * 9 // 16})
    show(opened, number)
    widget = opened.locator("section.present .live")
    slider = widget.get_by_role("slider")
    box = slider.bounding_box()
    end = (box["x"] + 0.97 * box["width"], box["y"] + box["height"] / 2)
    changed_by(opened, widget, lambda: opened.mouse.click(*end))
    assert slider.input_value() == slider.get_attribute("max")
    assert opened.evaluate(NUMBER) == number


def test_page_down_turns_the_page_from_within_a_widget_and_arrow_keys_do_not(opened):
    show(opened, number_of(opened, ".live"))
    before = opened.evaluate(NUMBER)
    control = opened.locator("section.present .live input, section.present .live button").first
    control.focus()
    opened.keyboard.press("ArrowRight")
    assert opened.evaluate(NUMBER) == before
    opened.keyboard.press("PageDown")
    assert opened.evaluate(NUMBER) == before + 1
    opened.keyboard.press("ArrowLeft")
    assert opened.evaluate(NUMBER) == before
    control.focus()
    opened.keyboard.press("Escape")
    opened.keyboard.press("ArrowRight")
    assert opened.evaluate(NUMBER) == before + 1


def test_the_speaker_view_shows_the_folded_text(opened):
    show(opened, number_of(opened, ".notes strong"))
    with opened.expect_popup() as popup:
        opened.keyboard.press("s")
    speaker = popup.value
    speaker.get_by_text("You can see the path in the three or four shortest exposures").wait_for(
        timeout=PATIENCE
    )
    speaker.close()


def test_a_deck_to_print_has_a_page_for_each_slide_and_cuts_nothing_off(deck, page):
    page.set_viewport_size(SIZE)
    page.goto(f"{deck[0].as_uri()}?print-pdf")
    page.wait_for_function(
        "count => document.querySelectorAll('.pdf-page').length === count", arg=deck[1]
    )
    page.wait_for_function("document.querySelector('.sized').style.transform !== ''")
    heights = page.evaluate(
        "[...document.querySelectorAll('.pdf-page')].map((part) => part.offsetHeight)"
    )
    assert set(heights) <= {719, 720}
    cut_off = page.evaluate(
        """() => [...document.querySelectorAll(".sized")].filter((sized) => {
            const room = sized.parentElement.getBoundingClientRect();
            return sized.getBoundingClientRect().bottom > room.bottom + 1;
        }).length"""
    )
    assert cut_off == 0 and page.problems == []
