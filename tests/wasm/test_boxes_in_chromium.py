"""A reader writes functions in the boxes of a lesson, and the browser checks them."""

from importlib.util import find_spec
from pathlib import Path

import pytest
import small_site

ROOT = Path(__file__).parents[2]
pytestmark = [
    pytest.mark.wasm,
    pytest.mark.skipif(
        any(find_spec(name) is None for name in small_site.PACKAGES), reason=small_site.REASON
    ),
]
RIGHT_HAT = """def hat(n=256):
    z = np.arange(n)
    return np.minimum(z, n - 1 - z) / ((n - 1) // 2)"""
WRONG_HAT = "def hat(n=256):\n    return np.ones(n)"
ENDLESS_HAT = "def hat(n=256):\n    while True:\n        n += 1"
RIGHT_GSOLVE = ROOT / "benchmarks" / "fairness" / "right" / "gsolve" / "columns.py"


@pytest.fixture
def page(open_page):
    """The page of the notebook in a new browser."""
    return open_page(f"notebooks/{small_site.NOTEBOOK}.html")


def box_of(page, task):
    """Return the box of a task."""
    return page.get_by_role("region", name=f"Try it: write {task}")


def check(box, text):
    """Write a text into a box, press Check, and return the line about the result at the end."""
    box.get_by_role("textbox").fill(text)
    box.get_by_role("button", name="Check").click()
    box.get_by_role("button", name="Stop").wait_for()
    box.get_by_role("button", name="Stop").wait_for(state="hidden")
    return box.get_by_role("status").inner_text()


def test_functions_are_checked_in_the_page_and_kept_over_a_reload(site, page):
    hat = box_of(page, "hat")
    gsolve = box_of(page, "gsolve")
    stub = hat.get_by_role("textbox").input_value()
    assert not [url for url in page.requests if "/lite/" in url], "Python waits for a press"

    assert "1 of 10 points" in check(hat, WRONG_HAT)
    feedback = hat.get_by_role("region", name="Feedback on hat")
    feedback.get_by_text("failed").first.wait_for()
    assert feedback.locator("img").count() > 0
    assert check(hat, RIGHT_HAT) == "hat: 10 of 10 points"
    assert feedback.get_by_text("failed").count() == 0
    assert check(gsolve, RIGHT_GSOLVE.read_text("utf8")) == "gsolve: 30 of 30 points"
    assert len([url for url in page.requests if url.endswith("pyodide.asm.wasm")]) == 1
    assert not [url for url in page.requests if "scipy" in url]

    page.reload()
    field = hat.get_by_role("textbox")
    assert field.input_value() == RIGHT_HAT
    again = hat.get_by_role("button", name="Start again from the stub")
    page.once("dialog", lambda dialog: dialog.dismiss())
    again.click()
    assert field.input_value() == RIGHT_HAT
    page.once("dialog", lambda dialog: dialog.accept())
    again.click()
    assert field.input_value() == stub

    elsewhere = [url for url in page.requests if not url.startswith((site, "data:", "blob:"))]
    assert elsewhere == [] and page.problems == []


def test_an_endless_loop_leaves_the_page_alive_and_stop_ends_it(page):
    hat = box_of(page, "hat")
    gsolve = box_of(page, "gsolve")
    assert check(hat, RIGHT_HAT) == "hat: 10 of 10 points"
    hat.get_by_role("textbox").fill(ENDLESS_HAT)
    hat.get_by_role("textbox").press("Control+Enter")
    stop = hat.get_by_role("button", name="Stop")
    stop.wait_for()
    gsolve.get_by_role("textbox").fill("a text")
    gsolve.get_by_role("textbox").press("Control+Enter")
    assert "another function" in gsolve.get_by_role("status").inner_text()
    stop.click()
    assert hat.get_by_role("status").inner_text() == "Stopped."
    assert hat.get_by_role("textbox").input_value() == ENDLESS_HAT
    assert check(hat, RIGHT_HAT) == "hat: 10 of 10 points", "Python starts again"


def test_the_keyboard_alone_writes_and_checks(page):
    hat = box_of(page, "hat")
    field = hat.get_by_role("textbox")
    field.focus()
    page.keyboard.press("Control+a")
    # after a colon, the next line is indented
    page.keyboard.type("def hat(n=256):\nreturn np.ones(n)")
    assert field.input_value() == "def hat(n=256):\n    return np.ones(n)"
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.textContent") == "Check"
    page.keyboard.press("Enter")
    hat.get_by_role("button", name="Stop").wait_for()
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.textContent") == "Stop"
    page.keyboard.press("Enter")
    assert hat.get_by_role("status").inner_text() == "Stopped."
    assert page.evaluate("document.activeElement.textContent") == "Check"
