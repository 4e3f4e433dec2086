"""The tiers of tests: their lists name existing files, and the report of results is complete."""

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import threadpoolctl
from tiers import LONG_FILES, TIERS, may_hold

from tools import junit_summary

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize("file", LONG_FILES)
def test_each_file_of_the_list_of_long_tests_exists(file):
    assert (ROOT / file).is_file()


FILE_MARK = "pytestmark = pytest.mark.browser"
TESTS = """
import pytest

{mark}

def test_of_the_file():
    pass

@pytest.mark.papers
def test_on_paper():
    pass

@pytest.mark.grading
class TestGrading:
    def test_of_the_class(self):
        pass

    @pytest.mark.quick
    def test_nearest(self):
        pass
"""
# the tests above in a file without a mark, test_plain.py, and in one marked as browser, test_marked.py
SELECTED = {
    "quick": {"plain: test_of_the_file", "plain: test_nearest", "marked: test_nearest"},
    "grading": {"plain: test_of_the_class", "marked: test_of_the_class"},
}


@pytest.mark.grading
@pytest.mark.parametrize("tier", SELECTED)
def test_the_nearest_marker_names_the_tier(tier, tmp_path):
    assert collected(tmp_path, tier) == SELECTED[tier]


def test_a_file_without_tests_of_a_tier_is_not_imported(tmp_path):
    path = tmp_path / "test_marked.py"
    path.write_text(TESTS.format(mark=FILE_MARK), "utf8")
    assert {tier for tier in TIERS if may_hold(path, tier)} == {
        "quick",
        "papers",
        "grading",
        "browser",
    }


def collected(folder, tier):
    """Return the tests of a tier that pytest selects in both files."""
    for name in ("conftest.py", "tiers.py"):
        (folder / name).write_text((ROOT / "tests" / name).read_text("utf8"), "utf8")
    (folder / "test_plain.py").write_text(TESTS.format(mark=""), "utf8")
    (folder / "test_marked.py").write_text(TESTS.format(mark=FILE_MARK), "utf8")
    command = [sys.executable, "-m", "pytest", "--collect-only", "-q", f"--tier={tier}"]
    output = subprocess.run(command, cwd=folder, capture_output=True, text=True).stdout
    names = re.findall(r"test_(\w+)\.py::(?:\w+::)?(test_\w+)$", output, re.MULTILINE)
    return {f"{file}: {test}" for file, test in names}


def test_ctrl_c_reaches_what_a_test_starts():
    """Also where the tests themselves run in the background of a script, which ignores it."""
    code = "import signal; print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert ran.stdout == "True\n" and signal.getsignal(signal.SIGINT) is not signal.SIG_IGN


def test_linear_algebra_keeps_to_one_core_here_and_in_what_a_test_starts():
    """Two workers with two threads each take many times as long: a thread that waits computes."""
    code = "import numpy.linalg, scipy.linalg, threadpoolctl\n"
    code += "print({library['num_threads'] for library in threadpoolctl.threadpool_info()})"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert ran.stdout == "{1}\n"
    here = {library["num_threads"] for library in threadpoolctl.threadpool_info()}
    assert here == {1}


REPORT = """<testsuites><testsuite>
<testcase classname="tests.a" name="test_one" time="1.5" />
<testcase classname="tests.a" name="test_two" time="2.5"><failure message="no">no</failure></testcase>
<testcase classname="tests.a" name="test_three" time="0.5"><skipped message="no data" /></testcase>
</testsuite></testsuites>"""


def test_the_report_names_what_failed_and_the_slowest_first(tmp_path, capsys):
    (tmp_path / "quick.xml").write_text(REPORT)
    assert junit_summary.print_summary(tmp_path) == 1
    output = capsys.readouterr().out
    assert "FAILED tests.a::test_two" in output and output.endswith(
        "1 passed, 1 failed, 1 skipped\n"
    )
    assert output.index("test_two") < output.index("test_one") < output.index("test_three")


def test_a_report_of_no_tests_is_no_success(tmp_path, capsys):
    assert junit_summary.print_summary(tmp_path) == 1
    assert capsys.readouterr().out.endswith("0 passed, 0 failed, 0 skipped\n")
