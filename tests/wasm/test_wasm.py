"""Notebooks and checks in WebAssembly, as a browser runs them: Pyodide under Node, see testbed.py.

The test bed has no scikit-image, so that cells which need it fail; the public workflow runs the
site with all packages. What is not reached in the time is listed as skipped.
"""

import hashlib
import json
import re
import subprocess
from pathlib import Path

import pytest
import testbed
from checks import outcomes

from hdrlab.course import plan
from hdrlab.course.checks import misconceptions

pytestmark = pytest.mark.wasm

ROOT = Path(__file__).parents[2]
HERE = Path(__file__).parent
FAIRNESS = ROOT / "benchmarks" / "fairness"
# all of this tier takes at most 8 minutes
NOTEBOOKS_SECONDS = 120
CHECKS_SECONDS = 100
# one notebook may begin just before the time is over
GRACE_SECONDS = 150
FIRST_NOTEBOOKS = ("04_response_gsolve", "00_welcome", "01_sensor", "13_files")
NOTEBOOK_PACKAGES = ",".join(testbed.PYODIDE_PACKAGES)
CHECK_PACKAGES = "numpy,scipy,pillow,pygments,packaging"
# what a cell may lack: scikit-image in the test bed; processes and cameras in every browser
MISSING_THERE = re.compile(r"skimage|scikit-image|process|camera|gphoto", re.IGNORECASE)
FAILED_BEFORE = re.compile(r"^NameError")


@pytest.fixture(scope="module")
def bed():
    """The folder of the test bed."""
    folder = testbed.find()
    if folder is None:
        pytest.skip(
            "no test bed: run python tests/wasm/testbed.py FOLDER, "
            f"and set {testbed.VARIABLE}=FOLDER; Node is needed, too"
        )
    return folder


def run_in_pyodide(bed, script, packages, seconds, *arguments):
    """Run a script in Pyodide, and return its results: those until the time is over."""
    command = ["node", HERE / "run.mjs", bed, ROOT, HERE / script, packages, str(seconds)]
    process = subprocess.Popen(
        [*command, *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    try:
        output, _ = process.communicate(timeout=seconds + GRACE_SECONDS)
        assert process.returncode == 0, output[-3000:]
    except subprocess.TimeoutExpired:
        process.kill()
        output, _ = process.communicate()
    lines = [line for line in output.splitlines() if line.startswith("RESULT ")]
    return [json.loads(line.removeprefix("RESULT ")) for line in lines]


def test_the_packages_of_the_test_bed_are_the_official_ones(bed):
    lock = json.loads((bed / "pyodide" / "pyodide-lock.json").read_text("utf8"))
    assert lock["info"]["version"] == testbed.PYODIDE
    for package in lock["packages"].values():
        data = (bed / "pyodide" / package["file_name"]).read_bytes()
        assert hashlib.sha256(data).hexdigest() == package["sha256"], package["file_name"]


def test_the_cells_of_the_notebooks_run(bed, record_property):
    names = sorted(path.stem for path in (ROOT / "notebooks").glob("*.ipynb"))
    first = [name for name in names if name.startswith(FIRST_NOTEBOOKS)]
    rest = [name for name in names if name not in first]
    paths = [f"notebooks/{name}.ipynb" for name in [*first, *rest]]
    results = run_in_pyodide(bed, "cells.py", NOTEBOOK_PACKAGES, NOTEBOOKS_SECONDS, *paths)
    assert results
    unexpected = []
    for result in results:
        record_property(result["notebook"], f"{result['cells']} cells")
        has_gap = False
        for failure in result["failures"]:
            is_gap = MISSING_THERE.search(failure["error"]) is not None
            follows = has_gap and FAILED_BEFORE.search(failure["error"])
            has_gap = has_gap or is_gap
            if not is_gap and not follows:
                unexpected.append((result["notebook"], failure))
    assert not unexpected


def test_right_answers_and_mistakes_get_the_same_outcomes_as_here(bed, tmp_path):
    tasks = [task for homework in plan.read().homeworks.values() for task in homework.tasks]
    mistakes = {mistake.task: mistake.name for mistake in misconceptions.known()}
    answers = []
    for task in tasks:
        right = sorted((FAIRNESS / "right" / task.id).glob("*.py"))
        if right:
            answers.append((task.id, right[0].read_text("utf8")))
        if task.id in mistakes:
            text = misconceptions.solutions([task], [mistakes[task.id]])[task.id]
            answers.append((task.id, text))
    # the first ones are those that run where not all are reached
    path = bed / "pure" / "answers.json"
    path.write_text(json.dumps(answers), encoding="utf8")
    results = run_in_pyodide(bed, "checks.py", CHECK_PACKAGES, CHECKS_SECONDS, "/pure/answers.json")
    assert results
    for result in results:
        id, text = answers[result["number"]]
        here = [[words_of(cell) for cell in row] for row in outcomes(id, text)]
        there = [[words_of(cell) for cell in row] for row in result["rows"]]
        assert there == here, id


def words_of(text):
    """Return a text without its numbers, whose last digits may differ between machines.

    pytest adds a line to the message of a plain assertion here, where it rewrites the checks.
    """
    names, _, _ = text.partition("\nassert ")
    return re.sub(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?", "#", names)
