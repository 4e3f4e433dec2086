"""The attacks of tests/attacks work: against a naive grader, they earn points or do damage.

The naive grader runs a submission in its own process. A successful attack earns points, leaves a file
or a process behind, or never ends. The attacks in NOT_NAIVE harm something else, or would harm these
tests.
"""

import json
import os
import re
import subprocess
import sys

import pytest
from support import attack_fixtures

from hdrlab.course.sandbox.inside import system

pytestmark = pytest.mark.grading

ENDLESS = [name for name in attack_fixtures.ATTACK_NAMES if name.startswith("a12")]
NOT_NAIVE = {
    "a09_kill_parent": "it would end these tests",
    "a14_threads": "it gains by exhausting the machine, which is not tried",
    "a19_huge": "it would harm a grader that copies it, and has the memory",
    "a19_ragged": "no comparison takes it",
    "a19_strides": "any comparison takes it",
    "a19_structured": "no comparison takes it",
    "a20_scripts": "it harms who reads the report",
    "a26_silence": "there is no channel",
}


@pytest.fixture(scope="module")
def port():
    """The port of a server that knows the answer.

    Meanwhile, orphaned processes become children of this one.
    """
    with attack_fixtures.serve_answer() as number, attack_fixtures.adopt_orphans():
        yield number


def graded(place, patience):
    """Return the output of the naive grader, its exit code, and whether it finished."""
    process = subprocess.Popen(
        [
            sys.executable,
            "-B",
            str(attack_fixtures.ATTACKS_FOLDER / "naive_grader.py"),
            "submission.py",
        ],
        cwd=place,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        encoding="utf8",
        errors="replace",
    )
    try:
        return process.communicate(timeout=patience)[0], process.returncode, True
    except subprocess.TimeoutExpired:
        process.kill()
        return process.communicate()[0], process.returncode, False


def score(place, output, code):
    """Return the points that an instructor would read in the output of the naive grader."""
    points = len(re.findall("^PASS$", output, re.MULTILINE))
    points += 2 * (code == 0 and "FAIL" not in output)
    if (place / "results.json").exists():
        points += json.loads((place / "results.json").read_text())["score"]
    return points


def end(processes):
    """End processes that were left behind."""
    for pid in processes:
        os.kill(pid, 9)
        os.waitpid(pid, 0)


def test_the_naive_grader_grades_honest_submissions_correctly(tmp_path):
    for answer, points in (("2 * x", 4), ("3 * x", 0), ("None", 0)):
        (tmp_path / "submission.py").write_text(f"def double(x): return {answer}")
        output, code, ended = graded(tmp_path, 60)
        assert ended and score(tmp_path, output, code) == points


@pytest.mark.parametrize(
    "name", [name for name in attack_fixtures.ATTACK_NAMES if name not in NOT_NAIVE]
)
def test_the_attack_succeeds_against_a_naive_grader(name, tmp_path, port):
    place = attack_fixtures.fill_folder(tmp_path)
    (place / "submission.py").write_text(attack_fixtures.prepare_attack(name, place, port))
    files = attack_fixtures.list_file_sizes(place)
    processes = system.list_children()
    output, code, ended = graded(place, 2 if name in ENDLESS else 60)
    left = [pid for pid in system.list_children() if pid not in processes]
    end(left)
    assert ended == (name not in ENDLESS)
    if ended:
        assert score(place, output, code) or left or attack_fixtures.list_file_sizes(place) != files
