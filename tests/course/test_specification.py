"""The specification: hdrlab passes it for all random inputs; stubs and empty answers fail."""

import inspect

import numpy as np
import pytest
import scoring

from hdrlab.course import plan
from hdrlab.course.checks import SPECIFICATION, compare, inprocess, laws

PLAN = plan.read()
TASKS = [task for homework in PLAN.homeworks.values() for task in homework.tasks]
IDS = [task.id for task in TASKS]
HERE = SPECIFICATION


def unanswered():
    """A stub, as in the assignment."""
    raise NotImplementedError


@pytest.mark.parametrize("task", IDS)
@pytest.mark.parametrize("student", ["ada", "grace", "Emmy Noether"])
def test_the_library_passes_every_check_for_any_student(task, student):
    share, outcomes = scoring.score(
        task, inprocess.library(), plan.seed("the course's secret", student, task)
    )
    assert share == 1, {name: str(error) for name, error in outcomes.items() if error}


@pytest.mark.grading
@pytest.mark.parametrize("task", IDS)
def test_a_blank_stub_passes_no_check(task):
    for blank in (
        lambda *arguments, **named: None,
        lambda *arguments, **named: unanswered(),
        lambda *arguments, **named: np.nan,
        lambda *arguments, **named: [],
        lambda *arguments, **named: "",
    ):
        assert scoring.score(task, inprocess.Subject({task: blank}))[0] == 0


@pytest.mark.parametrize("task", IDS)
def test_an_answer_of_nan_earns_no_points(task):
    def spoiled(answer):
        if isinstance(answer, tuple | list):
            return type(answer)(spoiled(item) for item in answer)
        if isinstance(answer, bytes):
            return b""
        return np.full(np.shape(answer), np.nan)

    right = plan.function(PLAN.task(task))
    wrong = inprocess.Subject({task: lambda *a, **k: spoiled(inprocess.plain(right(*a, **k)))})
    assert scoring.score(task, wrong)[0] == 0


@pytest.mark.parametrize("task", IDS)
def test_every_check_has_points_three_hints_and_a_sentence(task):
    checks = scoring.checks(task)
    assert len(checks) >= 2
    names = {name for name, *_ in checks}
    for name, check, points, hints, needs in checks:
        assert needs is None or (needs != name and needs in names), name
        assert points > 0 and len(hints) == 3 and all(len(hint) > 10 for hint in hints), name
        assert len(name.removeprefix("test_").split("_")) >= 4, f"{name} is no sentence"
        assert set(inspect.signature(check).parameters) <= {"subject", "rng"}, name
    assert len({hints[-1] for *_, hints, _ in checks}) == len(checks), "a hint stands twice"


def test_there_is_a_file_of_checks_for_every_task_and_a_task_for_every_file():
    assert sorted(path.stem for path in HERE.glob("test_*.py")) == sorted(
        f"test_{id}" for id in IDS
    )


@pytest.mark.parametrize("task", TASKS, ids=IDS)
def test_every_task_is_a_documented_function_of_the_library(task):
    assert (plan.function(task).__doc__ or "").strip() and task.name == task.id


@pytest.mark.parametrize("homework", PLAN.homeworks.values(), ids=PLAN.homeworks)
def test_the_functions_of_a_homework_have_names_of_their_own(homework):
    names = [task.name for task in homework.tasks]
    assert len(set(names)) == len(names)


@pytest.mark.grading
@pytest.mark.parametrize("task", IDS)
def test_two_students_draw_different_inputs_and_one_draws_the_same_again(task):
    def inputs_of(student):
        subject = inprocess.library()
        scoring.score(task, subject, plan.seed("secret", student, task))
        return repr([(arguments, named) for arguments, named, _ in subject.calls])

    assert inputs_of("ada") == inputs_of("ada")
    if any("rng" in inspect.signature(check).parameters for _, check, *_ in scoring.checks(task)):
        assert inputs_of("ada") != inputs_of("grace")


# The plan


def written(tmp_path, text):
    path = tmp_path / "plan.toml"
    path.write_text(text, encoding="utf8")
    return path


SHEET = """
[hw9]
title = "Curves"
due = 2026-10-01T12:00:00Z
tasks = [{ id = "gsolve", function = "response.debevec.gsolve", points = 7.5 }]
"""


def test_a_plan_of_an_instructor_sets_points_tasks_and_dates(tmp_path):
    plan_read = plan.read(written(tmp_path, SHEET))
    (homework,) = plan_read.homeworks.values()
    assert (homework.title, homework.points, homework.due.day) == ("Curves", 7.5, 1)
    assert homework.tasks == (plan.Task("gsolve", "response.debevec.gsolve", 7.5),)
    assert plan_read.late == plan.Late(0, 0) and plan.read().late.free_days == 10


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (('title = "Curves"', ""), r"title.*\[hw9\]"),
        (("2026-10-01T12:00:00Z", '"soon"'), "due.*soon"),
        (("T12:00:00Z", ""), "due"),
        (("tasks = [{", "at_most = 8\ntasks = [{"), "7.5.* 8"),
        (("tasks = [{", "at_most = 0\ntasks = [{"), "7.5.* 0"),
        (("tasks = [{", "at_most = nan\ntasks = [{"), "7.5.* nan"),
        (("tasks = [{", "at_most = []\ntasks = [{"), "hw9"),
        (("7.5", "-1"), "points"),
        (("7.5", '"many"'), "hw9"),
        (("[hw9]", "[hw9"), "TOML"),
        (
            ("points = 7.5 }", "points = 7.5 }, { id = 'gsolve', function = 'a.b', points = 1 }"),
            "once",
        ),
        ((SHEET, ""), "tasks"),
        (("[hw9]", "[late]\nfree_days = -1\n[hw9]"), r"free_days.*\[late\]"),
        (("[hw9]", "[late]\nweeks = 1\n[hw9]"), "free_days and points_a_day"),
    ],
)
def test_an_invalid_plan_is_refused_with_the_reason(tmp_path, change, message):
    with pytest.raises(ValueError, match=message):
        plan.read(written(tmp_path, SHEET.replace(*change)))


def test_an_unknown_task_is_refused_with_the_known_ones():
    with pytest.raises(KeyError, match="'gslove'"):
        PLAN.task("gslove")


def test_a_seed_depends_on_the_secret_the_student_and_the_task():
    seed = plan.seed("secret", "ada", "gsolve")
    others = [
        plan.seed("Secret", "ada", "gsolve"),
        plan.seed("secret", "adag", "solve"),
        plan.seed("secret", "ada", "merge"),
    ]
    assert seed == plan.seed("secret", "ada", "gsolve") and len({seed, *others}) == 4


@pytest.mark.parametrize("size", [256, 4096])
def test_the_error_of_a_curve_is_that_of_levels_10_to_250_in_any_unit(size):
    truth = np.log1p(np.arange(size))
    assert laws.curve_error(truth + 3, truth) < 1e-12
    for level, counts in ((9, False), (10, True), (250, True), (251, False)):
        g = truth.copy()
        g[level * (size - 1) // 255] += 1
        assert (laws.curve_error(g, truth) > 1e-6) == counts


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        *(
            (None, "expected numbers, got None"),
            ("text", "one array of numbers"),
            ({}, "one array of numbers"),
        ),
        *(
            ([[1], [2, 3]], "one array of numbers"),
            (np.array([1j]), "real numbers, got dtype complex128"),
        ),
    ],
)
def test_a_non_numeric_answer_is_described_in_the_message(answer, message):
    with pytest.raises(compare.AnswerMismatch, match=message):
        compare.numbers(answer)
