"""The story on the site, from light to image in ten screens: its parts and its numbers."""

import re
from pathlib import Path

import nbformat
import numpy as np
import pytest
from test_formulas import numbers_in

from hdrlab.align import mtb
from hdrlab.course.site import pages

pytest.importorskip("anywidget", reason="the figures need anywidget")
ROOT = Path(__file__).parents[2]
STORY = nbformat.read(pages.STORY, as_version=4)
TEXT = "\n".join(cell.source for cell in STORY.cells if cell.cell_type == "markdown")
SCREENS = re.split(r"^## ", TEXT, flags=re.MULTILINE)[1:11]
TOUCHED = {
    *("exposure_window", "bitmap_difference", "gsolve_by_hand", "pixel_mean"),
    *("zone_scale", "bilateral_kernel", "gradient_line", "gain_screen"),
}


@pytest.fixture(scope="module")
def names():
    """The names that the cells of the story define."""
    namespace = {"display": lambda *figures: None}
    for cell in STORY.cells:
        if cell.cell_type == "code":
            exec(compile(cell.source, cell.id, "exec"), namespace)
    return namespace


def gain_stops(n, place):
    """Return how many stops brighter the best screen shows a place than an ordinary one."""
    base = n["colour"].luminance(n["s"])[place]
    best = n["colour"].luminance(n["hdr"])[place]
    return float(np.median(np.log2(best / base)))


SKY = np.s_[28:40, 160:200]  # of the small photos, behind the upper pane
WALL = np.s_[60:110, 280:370]
STAND = np.s_[100:120, 76:86]


def deciding_photo(n, place):
    """Return the photo whose levels at a place are nearest to the middle, where the weight is largest."""
    levels = np.median(n["photos"][(slice(None), *place)], axis=(1, 2))[:, 1]
    return int(np.argmin(np.abs(levels - 127.5)))


def slope_between(n, low, high):
    """Return the pixel values per stop of the response curve."""
    g = n["g"][:, 1] / np.log(2)
    return (high - low) / (g[high] - g[low])


CLAIMS = {
    "1/250 of a second": lambda n: np.isclose(n["times"][n["short"]], 1 / 250),
    "1/4 of a second": lambda n: np.isclose(n["times"][n["long"]], 1 / 4),
    "Twelve photos, each with twice the time": lambda n: (
        len(n["times"]) == 12 and np.allclose(np.diff(np.log2(n["times"])), 1, atol=0.1)
    ),
    "always seven stops wide, and the room has eleven": lambda n: (
        round(n["CAMERA_STOPS"]) == 7 and round(n["ROOM_STOPS"]) == 11
    ),
    "an *offset* of 7 pixels down and 11 to the left": lambda n: (
        list(mtb.search(mtb.gray(n["still"]), mtb.gray(n["shaken"])))[-1].offset == (7, -11)
    ),
    "nearly flat for little light and steep for more": lambda n: (
        slope_between(n, 2, 20) < slope_between(n, 100, 200) / 2
    ),
    "0.7 is one stop": lambda n: round(np.log(2), 1) == 0.7,
    "Short photos decide about the sky, and long ones about the stand": lambda n: (
        deciding_photo(n, SKY) < 4 and deciding_photo(n, STAND) > 7
    ),
    "About eleven stops: the brightest spot sends more than 2000 times as much light": lambda n: (
        all(
            round(np.log2(light.max() / light.min())) == 11 and light.max() / light.min() > 2000
            for light in (n["L"], n["light"])  # of the bars, and of the map that the reader presses
        )
    ),
    "The window. The room hardly changes": lambda n: (
        gain_stops(n, SKY) > 1.5 and abs(gain_stops(n, WALL)) < 0.5
    ),
    "about one and a half stops": lambda n: round(2 / np.log(2)) == 3,
}
FROM_OUTSIDE = {
    "10": "minutes of reading",
    "2.0": "the license of the photos",
    "255": "the largest level of 8 bits",
    "100": "cd/m² of a white page in a lit room, in the table of notebook 01",
    "ten stops": "a screen's, in notebook 00",
    "ten times": "what a decade is",
}


@pytest.mark.notebooks
@pytest.mark.parametrize("sentence", CLAIMS)
def test_what_the_story_states_is_what_its_cells_compute(names, sentence):
    assert sentence in " ".join(TEXT.split())
    assert CLAIMS[sentence](names)


def test_every_number_of_the_story_is_computed_or_has_a_source():
    known = numbers_in(" ".join(CLAIMS)) | set(FROM_OUTSIDE)
    prose = re.sub(r"\[\d\d · [^\]]+\]", " ", TEXT)  # titles of notebooks have numbers, too
    assert numbers_in(prose) <= known


def test_each_of_ten_screens_asks_shows_answers_and_leads_to_a_notebook():
    assert [screen.split(" · ")[0] for screen in SCREENS] == [str(k) for k in range(1, 11)]
    for screen in SCREENS:
        question, answer, end = re.split(r"<details><summary>Answer</summary>|</details>", screen)
        assert "**Guess.**" in question and answer.strip()
        (notebook,) = re.findall(r"Explained in \[[^\]]+\]\(notebooks/(\w+)\.ipynb\)", end)
        assert (ROOT / "notebooks" / f"{notebook}.ipynb").is_file()


def test_a_link_to_a_notebook_has_its_title():
    for title, name in re.findall(r"\[(\d\d · [^\]]+)\]\(notebooks/(\w+)\.ipynb\)", TEXT):
        first = nbformat.read(ROOT / "notebooks" / f"{name}.ipynb", 4).cells[0].source
        assert " ".join(title.split()) == first.splitlines()[0].removeprefix("# ")


def test_the_story_has_the_eight_figures_whose_object_is_dragged():
    called = re.findall(r"widgets\.(\w+)\(", "\n".join(cell.source for cell in STORY.cells))
    assert sorted(set(called) - {"wipe"}) == sorted(TOUCHED)
