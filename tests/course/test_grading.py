"""Grading a submission in the practice tier: points, messages, and what must not change them.

Other files test the strict tier and its isolation.
"""

import shutil
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support import linux_processes

from hdrlab.course import materials, plan
from hdrlab.course.authoring import solutions
from hdrlab.course.grading import grader, results
from hdrlab.course.plan import GradingOptions
from hdrlab.course.reports import feedback, gradebook
from hdrlab.course.sandbox import tiers
from hdrlab.course.sandbox.session import Unavailable
from hdrlab.course.source_code import inline
from hdrlab.course.submissions import reader

pytestmark = pytest.mark.grading

HOMEWORKS = plan.read().homeworks
PRACTICE = GradingOptions(tier="practice")

RIGHT = """import numpy as np

def hat(n=256):
    z = np.arange(n)
    return np.minimum(z, n - 1 - z) / ((n - 1) // 2)
"""


def of(homework, *tasks):
    """Return a homework with only some of its tasks, so that grading is fast."""
    whole = HOMEWORKS[homework]
    return whole._replace(tasks=tuple(task for task in whole.tasks if task.id in tasks))


HAT = of("hw2", "hat")


@pytest.fixture
def graded(tmp_path):
    """graded(text, homework, conditions) -> the Result of a file that holds it."""

    def graded(text, homework=HAT, conditions=PRACTICE):
        file = tmp_path / "hw2.py"
        file.write_text(text)
        return grader.grade(file, homework, conditions)

    return graded


def test_the_library_earns_all_points_and_a_blank_none(tmp_path, graded):
    blocks = inline.inlined(
        {task.id: task.function for task in of("hw2", "hat", "irradiance").tasks}
    )
    whole = graded(
        "\n\n".join(block.text for block in blocks.values()), of("hw2", "hat", "irradiance")
    )
    assert whole.score == whole.max_score == 20 and not whole.problems and not whole.misconceptions
    blank = shutil.copy(materials.folder("assignments") / "hw2.ipynb", tmp_path)
    result = grader.grade(blank, of("hw2", "hat", "irradiance"), PRACTICE)
    assert result.score == 0 and {check.outcome for check in result.checks} == {"no answer"}
    assert "hat is yours to write" in result.checks[0].message


def test_the_points_of_a_task_are_divided_among_its_checks(graded):
    homework = of("hw2", "hat")
    double = homework._replace(tasks=(homework.tasks[0]._replace(points=7.5),))
    result = graded(RIGHT, double)
    assert result.score == result.max_score == 7.5
    assert sum(check.max_points for check in result.checks) == 7.5


def test_a_wrong_function_loses_points_and_its_mistake_is_recognized(graded):
    wrong = RIGHT.replace("np.minimum(z, n - 1 - z)", "np.abs(z - (n - 1) / 2)")
    result = graded(wrong)
    assert 0 <= result.score < 10
    assert list(result.misconceptions) == ["hat"]
    broken = [check for check in result.checks if check.outcome == "fails"]
    assert broken and all(len(check.hints) == 3 and check.message for check in broken)


def test_a_mismatch_of_curves_is_drawn_with_an_alt_text(graded):
    wrong = solutions.texts(of("hw2", "gsolve"), ["gsolve_smoothness_not_weighted"])["gsolve"]
    result = graded(wrong, of("hw2", "gsolve"))
    drawn = [check.drawing for check in result.checks if check.drawing.frames]
    assert drawn and all("they differ by" in alt for drawing in drawn for alt in drawing.alts)
    assert drawn[0].frames[0][8:12] == b"WEBP"
    assert any(
        "Yours: shape (256,), dtype float64, values " in check.message for check in result.checks
    )
    assert not any(
        check.drawing.frames
        for check in graded(wrong, of("hw2", "gsolve"), replace(PRACTICE, draw=False)).checks
    )


def test_a_mismatch_of_images_is_drawn_as_expected_yours_and_difference(graded):
    wrong = "import numpy as np\ndef shrink(Y):\n"
    wrong += "    return Y[: len(Y) // 2 * 2 : 2, : Y.shape[1] // 2 * 2 : 2]\n"
    result = graded(wrong, of("hw1", "shrink"))
    drawing = next(check.drawing for check in result.checks if check.drawing.frames)
    assert len(drawing.frames) == 3 and drawing.captions[:2] == ("expected", "yours")
    assert "worst pixel is row" in drawing.alts[2]


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("raise RuntimeError('no light')", "raised RuntimeError: no light"),
        ("while True: pass", "took longer than"),
        ("import os; os._exit(0)", "gave no answer"),
        ("return object()", "not an array"),
        ("return None", "got None"),
        ("return np.full(n, np.nan)", "finite"),
        ("return np.ones(3)", "expected shape"),
    ],
)
def test_a_function_without_a_valid_answer_fails_with_a_plain_message(graded, body, message):
    text = f"import numpy as np\ndef hat(n=256):\n    {body}\n"
    result = graded(text, conditions=replace(PRACTICE, timeout=1.0))
    assert result.score == 0, result.checks[0].message
    assert any(message in check.message for check in result.checks), result.checks[0].message


def test_a_timeout_skips_the_rest_of_its_task_only(graded):
    endless = RIGHT + "def irradiance(*given):\n    while True: pass\n"
    result = graded(endless, of("hw2", "hat", "irradiance"), replace(PRACTICE, timeout=1.0))
    first, *others = result.of("irradiance")
    assert "took longer than" in first.message and results.points(result.of("hat")) == (10, 10)
    assert all(
        (other.kind, other.message, other.follows) == ("late", "", first.promise)
        for other in others
    )


@pytest.mark.parametrize("line", ["import cv2", "import hdrlab", "hat.weight = undefined"])
def test_an_error_that_breaks_every_check_is_reported_once(graded, line):
    result = graded(RIGHT.replace("    z = ", f"    {line}\n    z = "))
    first, *others = result.checks
    assert result.score == 0
    assert first.message
    assert {page.follows for page in others} == {first.promise}


def test_a_crash_fails_one_check_only(graded):
    dies_at_large = RIGHT.replace("    z = ", "    if n > 4000: import os; os._exit(0)\n    z = ")
    result = graded(dies_at_large)
    assert [check.outcome for check in result.checks].count("no answer") == 1
    assert 5 < result.score < 10


def test_ignoring_lambda_costs_half_the_points_and_is_reported_once(graded):
    wrong = solutions.texts(of("hw2", "gsolve"), ["gsolve_lambda_read_as_1"])["gsolve"]
    result = graded(wrong, of("hw2", "gsolve"), replace(PRACTICE, draw=False))
    assert 15 <= result.score < 20
    assert [page.follows for page in result.checks if page.outcome != "holds"].count("") == 1


def test_a_missing_task_costs_only_its_own_points(graded):
    result = graded(RIGHT, of("hw2", "hat", "irradiance"))
    assert result.score == 10
    assert any("irradiance was not found" in problem for problem in result.problems)


@pytest.mark.parametrize("answer", ["[[1, 2], [3], 4]", "[[1], [[2]]]", "{'a': [1, [2]]}"])
def test_a_ragged_answer_does_not_affect_the_mistakes_of_other_tasks(graded, answer):
    wrong = RIGHT.replace("np.minimum(z, n - 1 - z)", "np.abs(z - (n - 1) / 2)")
    ragged = f"def irradiance(*given, **named):\n    return {answer}\n"
    result = graded(wrong + ragged, of("hw2", "hat", "irradiance"))
    assert list(result.misconceptions) == ["hat"]
    assert results.points(result.of("irradiance"))[0] == 0


def test_a_missing_task_is_reported_once(graded):
    result = graded(RIGHT, of("hw2", "hat", "irradiance"))
    pages = feedback.text(result), feedback.page(result)
    assert [text.count("was not found") for text in pages] == [1, 1]
    assert not any(page.message for page in result.of("irradiance"))


def test_hidden_checks_count_and_students_see_only_their_outcome(graded, tmp_path):
    hidden = tmp_path / "hidden"
    hidden.mkdir()
    (hidden / "test_hat.py").write_text(
        "import pytest\nfrom hdrlab.course.checks.compare import Different\n\n@pytest.mark.points(5)\n"
        'def test_it_is_blue(subject):\n    """A secret hint."""\n'
        '    if len(subject.hat(12)) != 12:\n        raise Different("the secret")\n'
    )
    at_least_20 = RIGHT.replace("np.arange(n)", "np.arange(max(n, 20))")
    result = graded(at_least_20, conditions=replace(PRACTICE, hidden=hidden))
    (own,) = (check for check in result.checks if check.hidden)
    assert own.outcome == "fails"
    assert own.max_points > 0
    assert result.max_score == 10
    assert result.score < 10
    for shown in (
        feedback.page(result),
        feedback.text(result),
        gradebook.gradescope(result).decode(),
    ):
        assert "secret" not in shown and "It is blue" in shown
    assert "the secret" in feedback.text(result, private=True)


def test_of_a_hidden_check_that_breaks_students_see_no_detail_and_lose_no_points(graded, tmp_path):
    hidden = tmp_path / "hidden"
    hidden.mkdir()
    (hidden / "test_hat.py").write_text(
        "import pytest\n\n@pytest.mark.points(5)\n"
        'def test_it_is_blue(subject):\n    raise TypeError("the secret")\n'
    )
    result = graded(RIGHT, conditions=replace(PRACTICE, hidden=hidden))
    assert result.score == result.max_score
    for shown in (
        feedback.page(result),
        feedback.text(result),
        gradebook.gradescope(result).decode(),
    ):
        assert "secret" not in shown
    assert "the secret" in feedback.text(result, private=True)


def test_grading_is_repeatable_and_each_student_has_their_own_inputs(graded):
    wrong = RIGHT + "\ndef irradiance(Z, t, f, w):\n    return (w[Z] * f[Z]) @ t\n"
    conditions = replace(PRACTICE, student="ada", secret="salt")
    first = graded(wrong, of("hw2", "hat", "irradiance"), conditions)
    again = graded(wrong, of("hw2", "hat", "irradiance"), conditions)
    assert results.to_json(first) == results.to_json(again)
    other = graded(wrong, of("hw2", "hat", "irradiance"), replace(conditions, student="bob"))
    assert [check.message for check in other.checks] != [check.message for check in first.checks]
    assert other.seed != first.seed and other.score == first.score


def test_results_are_yielded_check_by_check(tmp_path):
    file = tmp_path / "hw2.py"
    file.write_text(RIGHT)
    steps = list(grader.grade_steps(file, of("hw2", "hat"), PRACTICE))
    assert [step.score for step in steps] == sorted(step.score for step in steps)
    assert len({step.max_score for step in steps}) == 1 and steps[-1].score == 10


@pytest.mark.skipif(
    not Path("/proc/self/environ").exists(), reason="processes are looked for in /proc"
)
def test_stopping_the_grading_leaves_no_files_or_processes(tmp_path, monkeypatch):
    """No file and no process remains, although a function runs forever at that moment."""
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(scratch))
    file = tmp_path / "hw2.py"
    file.write_text(RIGHT + "def irradiance(*given):\n    while True: pass\n")
    steps = grader.grade_steps(file, of("hw2", "hat", "irradiance"), replace(PRACTICE, timeout=60))
    next(steps)  # hat comes first, and its other checks take a moment: then there is an endless one
    time.sleep(2)
    assert linux_processes.processes_using(scratch) and list(scratch.iterdir())
    steps.close()
    end = time.monotonic() + 300
    while linux_processes.processes_using(scratch) and time.monotonic() < end:
        time.sleep(0.05)
    assert linux_processes.processes_using(scratch) == [] and list(scratch.iterdir()) == []


def test_an_unavailable_tier_is_an_error_without_a_fallback(graded, monkeypatch):
    def refuse(tier):
        raise Unavailable(f"{tier} cannot be had")

    monkeypatch.setattr("hdrlab.course.sandbox.tiers.choose", refuse)
    with pytest.raises(Unavailable, match="strict cannot be had"):
        graded(RIGHT, conditions=GradingOptions())


def test_pytest_settings_of_the_surroundings_do_not_change_a_score(graded, tmp_path, monkeypatch):
    """Neither a conftest nor options of pytest in this folder or in the environment change a score."""
    (tmp_path / "conftest.py").write_text("raise SystemExit")
    (tmp_path / "pytest.ini").write_text("[pytest]\naddopts = --nothing-of-this\n")
    monkeypatch.setenv("PYTEST_ADDOPTS", "--collect-only")
    monkeypatch.chdir(tmp_path)
    assert graded(RIGHT).score == 10


def test_missing_checks_and_a_missing_hidden_folder_are_errors(graded, tmp_path):
    homework = of("hw2", "hat")
    unknown = homework._replace(tasks=(homework.tasks[0]._replace(id="nothing"),))
    with pytest.raises(ValueError, match="checks for hw2"):
        graded(RIGHT, unknown)
    with pytest.raises(ValueError, match="folder with hidden checks"):
        graded(RIGHT, conditions=replace(PRACTICE, hidden=tmp_path / "missing"))


def test_the_grader_knows_the_code_that_the_assignment_gives():
    arguments = reader.given_cells("hw2")
    assert any("class Solution" in cell.text for cell in arguments)
    assert all(cell.given for cell in arguments)


def test_students_can_use_the_code_that_the_assignment_gives(graded):
    text = inline.inlined({"gsolve": "response.debevec.gsolve"})["gsolve"].text
    start = text.index("class Solution")
    without = text[:start] + text[text.index("\n\ndef ", start) :]
    assert np.isclose(graded(without, of("hw2", "gsolve")).score, 30)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.quick if name == "project" else ())
        for name in HOMEWORKS
    ],
)
def test_in_a_sandbox_the_library_earns_all_points_and_a_blank_none(name, tmp_path):
    try:
        tiers.choose("strict")
    except Unavailable as reason:
        pytest.skip(f"this machine has no strict tier: {reason}")
    homework = HOMEWORKS[name]
    file = tmp_path / f"{name}.py"
    blocks = inline.inlined({task.id: task.function for task in homework.tasks})
    file.write_text("\n\n".join(block.text for block in blocks.values()))
    strict = GradingOptions(student="ada", secret="salt")
    right = grader.grade(file, homework, strict)
    assert right.score == right.max_score == homework.points, [
        check for check in right.checks if check.message
    ]
    assert right.for_credit and right.tier == "strict"
    blank = grader.grade(materials.folder("assignments") / f"{name}.ipynb", homework, strict)
    assert blank.score == 0 and blank.max_score == homework.points and not blank.problems
