"""The tiers of tests: their lists name what there is, and their report hides nothing."""

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import results
import threadpoolctl
from tiers import ALL, FIRST, QUICK, TIERS, may_hold, tier_of, turn

ROOT = Path(__file__).parents[1]
STARTS = [start for starts in TIERS.values() for start in starts]


@pytest.mark.parametrize("start", [*STARTS, *FIRST])
def test_what_a_tier_lists_is_there(start):
    file, _, test = start.partition("::")
    there = [ROOT / file] if file.endswith("/") else list(ROOT.glob(f"{file}*"))
    assert there and all(path.exists() for path in there)
    assert not test or re.search(
        rf"^(def|class) {test.partition('[')[0]}", there[0].read_text(encoding="utf8"), re.MULTILINE
    )


def test_the_longest_start_counts():
    assert tier_of("tests/browser/test_notebooks_in_jupyterlab.py::TestThree::test_a") == "browser"
    assert (
        tier_of("tests/browser/test_notebooks_in_jupyterlab.py::TestOthers0::test_a")
        == "jupyterlab"
    )
    assert len(set(STARTS)) == len(STARTS)


def test_what_is_long_has_its_turn_before_the_others():
    addresses = [
        "tests/core/test_blur.py::test_a",
        *(f"{start}::test_a" for start in reversed(FIRST)),
    ]
    assert sorted(addresses, key=turn) == [*reversed(addresses[1:]), addresses[0]]


def test_a_test_that_is_named_nowhere_is_quick_and_its_file_is_read():
    assert tier_of("tests/core/test_blur.py::test_a") == QUICK and may_hold(
        "tests/core/test_blur.py", QUICK
    )
    assert tier_of("tests/browser/test_new.py::test_a") == "browser"
    assert may_hold("tests/", "browser") and may_hold("tests/browser/test_new.py", "browser")
    assert not may_hold("tests/browser/", QUICK) and may_hold("tests/browser/", ALL)
    assert not may_hold("tests/core/", "browser")


def test_a_file_that_holds_one_dear_test_is_read_for_both_tiers():
    start = next(start for start in TIERS["papers"] if "::" in start)
    file, tier = start.partition("::")[0], tier_of(start)
    assert may_hold(file, tier) and may_hold(file, QUICK) and tier != QUICK


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
    assert results.main(tmp_path) == 1
    said = capsys.readouterr().out
    assert "FAILED tests.a::test_two" in said and said.endswith("1 passed, 1 failed, 1 skipped\n")
    assert said.index("test_two") < said.index("test_one") < said.index("test_three")


def test_a_report_of_no_tests_is_no_success(tmp_path, capsys):
    assert results.main(tmp_path) == 1
    assert capsys.readouterr().out.endswith("0 passed, 0 failed, 0 skipped\n")
