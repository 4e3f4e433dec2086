"""The page on which a screen shows mixtures of two lights, played in a browser."""

from hdrlab.calibration.display import Schedule, draw_schedule
from hdrlab.show.pages.display import write_display


def test_the_page_plays_and_counts_its_frames(page, tmp_path):
    shown = draw_schedule(Schedule(patch=4, border=4), shape=(48, 40))
    page.goto(write_display(tmp_path, shown, frames=2).as_uri())
    page.wait_for_function("document.querySelector('canvas').style.left !== ''")
    page.keyboard.press("Enter")
    page.wait_for_function("run !== null && run.count > 20")
    page.keyboard.press("Enter")
    page.wait_for_function("document.querySelector('#said').textContent.includes('Frames missed')")
    assert page.problems == []
