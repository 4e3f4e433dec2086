"""In a tier for credit, an attack earns nothing, changes no other result, and leaves nothing behind.

The attacks are those of tests/attacks. test_attacks_naive shows that they work where nothing stops them.
"""

import re
from contextlib import ExitStack

import numpy as np
import pytest
from support import attack_fixtures

from hdrlab.course import plan
from hdrlab.course.checks.compare import AnswerMismatch, same
from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.sandbox import tiers
from hdrlab.course.sandbox.inside import system

pytestmark = pytest.mark.grading

ENDS = {  # the outcome of the first check
    "a01_everything_equals_it": "not an array: it contains an object of the class Agreeable",
    "a01_agreeable_array": "expected .*, got 7",
    "a02_nan": "expected finite numbers, got 16 NaN",
    "a02_infinity": "expected finite numbers, got 16 NaN or infinite",
    "a03_patched_tools": "got 0",
    "a04_patched_grader": "answer",
    "a05_frames": "expected",
    "a06_reading": "LookupError: nothing was there to be read",
    "a07_results": "PermissionError: no file of results could be written",
    "a08_pickle": "an object of the class Pickled",
    "a08_pickled_bytes": "expected one array of numbers, got bytes",
    "a09_exit": "ended its process, and gave no answer",
    "a09_sys_exit": "raised SystemExit",
    "a09_kill_parent": r"no signal was sent: \[-1, -1, -1, -1, -1, -1, -1\]",
    "a10_forged_lines": "got None",
    "a11_planted_modules": "PermissionError: nothing could be planted",
    "a12_endless_call": "took longer than",
    "a12_endless_import": "took longer than",
    "a12_endless_generator": "took longer than",
    "a12_endless_end": "took longer than",
    "a13_memory": "Cannot allocate memory",
    "a14_processes": "PermissionError: no process could be started",
    "a14_threads": "can't start new thread",
    "a15_daemon": "PermissionError",
    "a16_floods": "PermissionError: no place could be flooded",
    "a17_network": "PermissionError",
    "a18_links_and_devices": "PermissionError: nothing could be made",
    "a19_huge": "an array of 8000000000000 bytes",
    "a19_ragged": "expected one array of numbers, got list",
    "a19_objects": "an array of dtype object",
    "a19_structured": "an array of dtype void",
    "a19_strides": "got 0",
    "a20_scripts": "<script>",
    "a21_hard_coded": "got 0",
    "a22_library": "LookupError: there was nothing to call",
    "a23_state": "got 0",
    "a24_changed_inputs": "got 0",
    "a25_monitor": r"nothing could be watched: \[-1, -1, -1\]",
    "a26_out_of_turn": "sent an invalid answer: it belongs to another call",
    "a26_oversized": "sent an invalid answer",
    "a26_truncated": "sent an invalid answer",
    "a26_silence": "took longer than",
}
SLOW = ("a12", "a26_silence")  # they are waited for
AT_THE_FENCE = (  # attacks that meet something else in the container tier: no walls, but a fence
    *("a06_reading", "a07_results", "a09_kill_parent", "a11_planted_modules", "a16_floods"),
    *("a18_links_and_devices", "a22_library", "a23_state", "a25_monitor"),
)
CASES = [("strict", name) for name in attack_fixtures.ATTACK_NAMES] + [
    ("container", name) for name in AT_THE_FENCE
]


@pytest.fixture(scope="module")
def honest():
    """Correct submissions by tier, whose processes wait next to those of the attacks."""
    with ExitStack() as stack:
        waiting = {}

        def another(tier):
            """Start a sandbox of a tier; skip the test if this machine cannot run the tier."""
            if tier not in waiting:
                try:
                    subject = Subject({"double": attack_fixtures.HONEST_CODE}, tiers.choose(tier))
                    stack.enter_context(subject).double(1.0)
                except tiers.Unavailable as reason:
                    pytest.skip(str(reason))
                waiting[tier] = subject
            return waiting[tier]

        yield another


@pytest.fixture(scope="module")
def port():
    """The port of a server that knows the answer.

    Meanwhile, orphaned processes become children of this one.
    """
    with attack_fixtures.serve_answer() as number, attack_fixtures.adopt_orphans():
        yield number


def points(subject, student="a"):
    """Return how many of two checks pass, on the student's own inputs, and the errors of the others."""
    held = 0
    outcomes = []
    for check in ("first", "second"):
        subject.fresh()
        x = np.random.default_rng(plan.seed("a secret", student, check)).random((4, 4))
        try:
            answer = subject.double(x)
            same(answer, 2 * x, 1e-9)
            held += 1
        except (NoAnswer, AnswerMismatch) as error:
            outcomes.append(str(error))
    return held, outcomes


def test_every_listed_attack_has_a_test():
    assert {int(name[1:3]) for name in attack_fixtures.ATTACK_NAMES} == set(range(1, 27))
    assert set(attack_fixtures.ATTACK_NAMES) == set(ENDS)


@pytest.mark.parametrize(("tier", "name"), CASES)
def test_an_attack_earns_no_points_and_leaves_no_files_or_processes(
    tier, name, honest, tmp_path, port
):
    place = attack_fixtures.fill_folder(tmp_path)
    other = honest(tier)
    files = attack_fixtures.list_file_sizes(place)
    processes = system.list_children()
    timeout = 0.5 if name.startswith(SLOW) else 20.0
    source = {"double": attack_fixtures.prepare_attack(name, place, port)}
    with Subject(source, tiers.choose(tier), timeout) as subject:
        held, outcomes = points(subject)
        assert points(other, "another") == (2, []), "another's submission was harmed"
    assert held == 0
    assert re.search(ENDS[name], outcomes[0]), outcomes
    assert system.list_children() == processes, "a process is left"
    assert attack_fixtures.list_file_sizes(place) == files, "a file is left"
    assert not re.search(
        r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202e]", "".join(outcomes) + subject.printed
    )
    assert len(subject.printed) <= 1 << 16
