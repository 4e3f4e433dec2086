"""The boxes "Try it" of the site: where they are, what they contain, load and answer.

`tests/wasm/test_boxes_in_chromium.py` opens them in a browser.
"""

import io
import json
import re
import subprocess
import sys
import zipfile
from html.parser import HTMLParser
from pathlib import Path

import nbformat
import pytest

from hdrlab.course import notebook as kernel, plan
from hdrlab.course.sandbox import in_process
from hdrlab.course.site import boxes
from hdrlab.course.site.lite import checks, in_browser

ROOT = Path(__file__).parents[2]
STUBS = {
    cell.metadata["hdrlab"]["task"]: cell.source
    for sheet in (ROOT / "assignments").glob("hw*.ipynb")
    for cell in nbformat.read(sheet, 4).cells
    if "task" in cell.metadata.get("hdrlab", {})
}
RIGHT_HAT = """def hat(n=256):
    z = np.arange(n)
    return np.minimum(z, n - 1 - z) / ((n - 1) // 2)"""
WRONG_HAT = "def hat(n=256):\n    return np.ones(n)"
# checks a function in a Python that has only the packages of a box
WITHOUT = """import sys
allowed = set(sys.argv[2].split())
class Refuse:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in {"scipy", "matplotlib", "skimage", "IPython"} - allowed:
            raise ModuleNotFoundError(name)
sys.meta_path.insert(0, Refuse())
from hdrlab.course import notebook, plan
from hdrlab.course.site.lite.in_browser import check_as_json
notebook.PRACTICE = plan.GradingOptions(tier="in-process")
print(check_as_json(sys.argv[1], sys.stdin.read(), "matplotlib" in allowed))
"""


class FormParser(HTMLParser):
    """The text field, the buttons and the links of a box."""

    def __init__(self, html):
        super().__init__()
        self.field = ""
        self.elements = []
        self._inside = None
        self.feed(html)

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        self._inside = tag

    def handle_endtag(self, tag):
        self._inside = None

    def handle_data(self, data):
        if self._inside == "textarea":
            self.field += data


@pytest.fixture
def in_this_process(monkeypatch):
    """Check as a browser does, in this process."""
    options = plan.GradingOptions(tier=in_process.TIER)
    monkeypatch.setattr(kernel, "PRACTICE", options)


def answer(task, text, packages):
    """Return the answer of a browser with these packages to a text."""
    command = [sys.executable, "-W", "ignore", "-c", WITHOUT, task, " ".join(packages)]
    ran = subprocess.run(command, input=text, cwd=ROOT, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    return json.loads(ran.stdout)


@pytest.mark.parametrize("box", boxes.read(), ids=lambda box: box.task)
def test_a_box_stands_below_its_cell_with_the_stub_of_the_sheet(box):
    notebook = nbformat.read(ROOT / "notebooks" / f"{box.notebook}.ipynb", 4)
    boxes.insert(notebook, box.notebook, {"hw1", "hw2", "hw3", "hw4"})
    [place] = [
        k for k, cell in enumerate(notebook.cells) if f'data-task="{box.task}"' in cell.source
    ]
    assert notebook.cells[place - 1].id == box.below
    nbformat.validate(notebook)
    # HTML ignores the line break after <textarea>
    form = FormParser(notebook.cells[place].source)
    assert form.field == "\n" + STUBS[box.task]
    links = [attributes["href"] for tag, attributes in form.elements if tag == "a"]
    assert len(links) == 1 and re.fullmatch(r"\.\./assignments/hw\d\.html", links[0])


def test_a_box_is_hidden_without_scripts_and_says_that_it_never_counts():
    box = boxes.read()[0]
    html = boxes.as_html(box, ())
    [section] = [attributes for tag, attributes in FormParser(html).elements if tag == "section"]
    assert "hidden" in section
    assert "never counts for credit" in html
    assert "<a " not in html, "a site without the sheets has no link to them"


def test_other_notebooks_have_no_boxes():
    notebook = nbformat.read(ROOT / "notebooks" / "00_welcome.ipynb", 4)
    number = len(notebook.cells)
    boxes.insert(notebook, "00_welcome", {"hw1"})
    assert len(notebook.cells) == number


@pytest.mark.grading
@pytest.mark.usefixtures("in_this_process")
def test_a_right_function_gets_all_points_and_a_wrong_one_feedback_with_a_figure():
    right = json.loads(in_browser.check_as_json("hat", RIGHT_HAT, draw=True))
    assert right["isRight"] and right["summary"] == "hat: 10 of 10 points"
    wrong = json.loads(in_browser.check_as_json("hat", WRONG_HAT, draw=True))
    assert not wrong["isRight"] and "<img" in wrong["html"]
    words = json.loads(in_browser.check_as_json("hat", WRONG_HAT, draw=False))
    assert "<img" not in words["html"] and words["summary"] == wrong["summary"]


@pytest.mark.grading
@pytest.mark.usefixtures("in_this_process")
def test_text_that_is_no_python_or_lacks_the_function_gets_a_message():
    broken = json.loads(in_browser.check_as_json("hat", "def hat(n=256)\n    return n", draw=False))
    assert "Your text is no Python, line 1" in broken["html"] and broken["isBroken"]
    other = json.loads(in_browser.check_as_json("hat", "def cap(n=256):\n    return n", draw=False))
    assert "Your text defines no function hat" in other["html"]


@pytest.mark.grading
@pytest.mark.parametrize("box", boxes.read(), ids=lambda box: box.task)
def test_the_checks_of_a_box_need_only_the_packages_that_it_loads(box):
    solutions = sorted((ROOT / "benchmarks" / "fairness" / "right" / box.task).glob("*.py"))
    texts = [path.read_text("utf8") for path in solutions]
    text = next(text for text in texts if "scipy" not in text)
    assert answer(box.task, text, box.packages)["isRight"]
    # the stub raises, and another function is compared with known mistakes and drawn
    assert not answer(box.task, STUBS[box.task], box.packages)["isRight"]
    head = STUBS[box.task].partition("(")[0]
    wrong = f"{head}(first, *more, **options):\n    return 0 * np.asarray(first, float) + 1"
    drawn = answer(box.task, wrong, (*box.packages, "matplotlib"))
    assert not drawn["isRight"] and "no module" not in drawn["html"].lower()


def test_a_browser_loads_the_checks_without_photos_and_compiled_modules():
    with zipfile.ZipFile(io.BytesIO(checks.pack())) as archive:
        names = archive.namelist()
    assert {"hdrlab/course/notebook.py", "pytest/__init__.py", "jinja2/__init__.py"} <= set(names)
    assert "hdrlab/course/checks/specification/test_hat.py" in names
    assert not [name for name in names if name.endswith((".exr", ".jpeg", ".so", ".pyc"))]


@pytest.mark.parametrize("sizes", [{}, {"start": 1000, "scipy": 50}])
def test_the_manifest_names_the_checks_and_their_bytes_as_far_as_they_are_known(tmp_path, sizes):
    checks.write(tmp_path, "./pyodide/pyodide.js", sizes)
    manifest = json.loads((tmp_path / "try.json").read_text())
    code = tmp_path / manifest["code"]
    assert zipfile.is_zipfile(code)
    if sizes:
        assert manifest["bytes"] == {"start": 1000 + code.stat().st_size, "scipy": 50}
    else:
        assert manifest["bytes"] == {}
