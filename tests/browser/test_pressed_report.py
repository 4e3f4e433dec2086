"""A reader presses a pixel in a report, and the page explains its radiance."""

import json
import re

import numpy as np
import pytest

from hdrlab import pipeline, scenes
from hdrlab.capture import camera
from hdrlab.show.pages.report import write_report

pytestmark = pytest.mark.browser

HEIGHT = 240
WIDTH = 360


@pytest.fixture(scope="module")
def assembly():
    chapel = scenes.chapel((HEIGHT, WIDTH))
    times = camera.times_around(chapel, 5, stops=3)
    taken = camera.shoot(chapel, times, camera.Camera(full_well=8_000, read_noise=4), rng=4)
    return pipeline.assemble(taken, align="none")


@pytest.fixture(scope="module")
def address(assembly, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    return write_report(folder, assembly, pipeline.develop(assembly.E)).as_uri()


@pytest.fixture
def report(address, page):
    page.goto(address)
    page.wait_for_selector(".pressable")
    yield page
    assert page.problems == []
    assert [url for url in page.requests if not url.startswith("data:")] == [address]


def shown_pixel(page):
    """Return (y, x) of the pixel that the page shows."""
    x, y = re.search(r"x (\d+), y (\d+)", page.text_content("#place")).groups()
    return int(y), int(x)


def press(page, y, x):
    """Press the picture at a pixel of the map."""
    box = page.locator("#press img").bounding_box()
    place = (
        box["x"] + (x + 0.5) / WIDTH * box["width"],
        box["y"] + (y + 0.5) / HEIGHT * box["height"],
    )
    page.mouse.click(*place)


def assert_shows(page, explanation):
    """Assert that the page shows the sentence and the table of an explanation."""
    assert page.text_content("#sentence") == explanation.sentence
    rows = page.locator("#photos tbody tr").all()
    assert len(rows) == len(explanation.photos)
    for row, photo in zip(rows, explanation.photos, strict=True):
        levels, share, claim, verdict = row.locator("td").all_text_contents()
        assert levels == " ".join(str(level) for level in photo.levels)
        assert verdict == photo.verdict
        if photo.claim == "–":
            assert claim == "–"
            continue
        *words, number = claim.split()
        *expected_words, expected = photo.claim.split()
        assert words == expected_words
        # the page has logarithms of 16 bits, and three digits
        assert float(number) == pytest.approx(float(expected), rel=6e-3)
        if "<" not in share:
            assert float(share.removesuffix(" %")) == pytest.approx(100 * photo.share, abs=0.06)


def test_a_pressed_pixel_shows_what_the_library_says_about_it(report, assembly):
    darkest = np.unravel_index(np.argmin(assembly.E[..., 1]), (HEIGHT, WIDTH))
    brightest = np.unravel_index(np.argmax(assembly.E[..., 1]), (HEIGHT, WIDTH))
    seen = set()
    for y, x in [(20, 30), (120, 180), (200, 300), darkest, brightest]:
        press(report, y, x)
        near = shown_pixel(report)
        step = json.loads(report.text_content("#pixels"))
        reach = step["rows"][1] - step["rows"][0]
        assert abs(near[0] - y) <= reach and abs(near[1] - x) <= reach
        assert_shows(report, assembly.why(*near))
        seen.add(near)
    assert len(seen) == 5


def test_arrow_keys_move_the_pixel_and_shift_moves_it_further(report, assembly):
    report.focus("#press")
    y, x = shown_pixel(report)
    step = json.loads(report.text_content("#pixels"))["columns"]
    apart = step[1] - step[0]
    report.keyboard.press("ArrowRight")
    assert shown_pixel(report) == (y, x + apart)
    report.keyboard.press("ArrowUp")
    assert shown_pixel(report) == (y - apart, x + apart)
    report.keyboard.press("Shift+ArrowLeft")
    assert shown_pixel(report) == (y - apart, x - 7 * apart)
    report.keyboard.press("ArrowDown")
    assert_shows(report, assembly.why(y, x - 7 * apart))


def test_arrow_keys_stop_at_the_edge_of_the_picture(report):
    report.focus("#press")
    for _ in range(40):
        report.keyboard.press("Shift+ArrowLeft")
    y, x = shown_pixel(report)
    report.keyboard.press("ArrowLeft")
    assert shown_pixel(report) == (y, x)
    assert 0 <= x < WIDTH


def test_a_dragged_mouse_shows_the_pixels_on_its_way(report):
    before = shown_pixel(report)
    box = report.locator("#press img").bounding_box()
    report.mouse.move(box["x"] + 20, box["y"] + 20)
    report.mouse.down()
    report.mouse.move(box["x"] + 60, box["y"] + 50)
    assert shown_pixel(report) != before
    report.mouse.up()
    during = shown_pixel(report)
    report.mouse.move(box["x"] + 200, box["y"] + 100)
    assert shown_pixel(report) == during


def test_a_screen_reader_hears_the_sentence_and_axe_finds_nothing_wrong(report, axe):
    assert report.get_attribute("#sentence", "aria-live") == "polite"
    for scheme in ("light", "dark"):
        report.emulate_media(color_scheme=scheme)
        assert axe(report, "html") == []


def test_the_table_of_the_photos_fits_a_telephone(address, page):
    page.set_viewport_size({"width": 390, "height": 844})
    page.goto(address)
    page.wait_for_selector(".pressable")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    table = page.locator("#photos").bounding_box()
    assert table["x"] + table["width"] <= 390
    page.touchscreen.tap(100, page.locator("#press").bounding_box()["y"] + 60)
    assert page.evaluate("document.getElementById('ring').hidden") is False
