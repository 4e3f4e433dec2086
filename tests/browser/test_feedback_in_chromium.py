"""The feedback page of a hostile submission runs none of its code in a browser."""

from pathlib import Path

import pytest

from hdrlab.course import plan
from hdrlab.course.grading import grader
from hdrlab.course.plan import GradingOptions
from hdrlab.course.reports import feedback

pytestmark = pytest.mark.browser

PAYLOAD = (
    "<script>window.owned = 1</script><img src=x onerror='window.owned = 1'>"
    "<svg onload='window.owned = 1'><a href='javascript:window.owned = 1'>click</a></pre></details>"
    "<iframe srcdoc='<script>parent.owned = 1</script>'></iframe>"
    "<meta http-equiv=refresh content='0;url=http://example.org'>"
)
HOSTILE = f"""
import numpy as np

def hat(n=256):
    print({PAYLOAD!r})
    raise ValueError({PAYLOAD!r})

def irradiance(Z, t, f, w):
    print({PAYLOAD!r})
    return np.zeros(len(Z))
"""


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """The address of the feedback page for a hostile submission."""
    folder = tmp_path_factory.mktemp("hostile")
    file = Path(folder / "hw2.py")
    file.write_text(HOSTILE)
    hw2 = plan.read().homeworks["hw2"]
    few = hw2._replace(
        tasks=tuple(task for task in hw2.tasks if task.id in ("hat", "irradiance", "update"))
    )
    result = grader.grade(
        file, few, GradingOptions(tier="practice", student=PAYLOAD, secret="salt")
    )
    assert "owned" in result.checks[0].message
    (folder / "feedback.html").write_text(feedback.page(result), encoding="utf8")
    return (folder / "feedback.html").as_uri()


def test_nothing_that_a_student_wrote_runs_or_is_fetched(report, page):
    page.on("dialog", lambda dialog: page.problems.append(dialog.message))
    page.goto(report)
    page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    page.wait_for_timeout(300)
    assert page.evaluate("window.owned") is None
    assert [request for request in page.requests if not request.startswith("data:")] == [report]
    assert (
        page.evaluate("document.querySelectorAll('script, iframe, svg, a, object, embed').length")
        == 0
    )
    assert page.evaluate("document.querySelectorAll('meta[http-equiv=refresh]').length") == 0
    assert "window.owned" in page.inner_text("main")  # it is there to read
    assert page.problems == [] and page.url == report


def test_a_script_that_came_in_all_the_same_would_not_run(report, page):
    """The page's content security policy blocks a script that the test inserts."""
    page.goto(report)
    text = Path(page.url.removeprefix("file://")).read_text(encoding="utf8")
    page.set_content(text.replace("<main>", "<main><script>window.owned = 1</script>"))
    assert page.evaluate("window.owned") is None


@pytest.mark.parametrize("width", [1280, 400])
def test_the_report_fits_the_screen_and_axe_finds_nothing_wrong(report, page, axe, width):
    page.set_viewport_size({"width": width, "height": 900})
    page.goto(report)
    page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.evaluate("document.body.id = 'all'")
    assert axe(page, "#all") == []
