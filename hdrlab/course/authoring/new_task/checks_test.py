"""Test the checks: run them as the grader does, for several students, each with their own inputs."""

from pathlib import Path

import pytest

from hdrlab.course import grading, plan
from hdrlab.course.authoring import stubs
from hdrlab.course.checks import misconceptions
from hdrlab.course.plan import GradingOptions
from hdrlab.course.source_code import inline

FOLDER = Path(__file__).parent
STUDENTS = [f"student {number}" for number in range(5)]
TASKS = [
    pytest.param(homework._replace(tasks=(task,)), task, id=task.id)
    for homework in plan.read(FOLDER / "plan.toml").homeworks.values()
    for task in homework.tasks
    if task.own
]
MISTAKES = [
    pytest.param(*parameters.values, mistake, id=mistake.name)
    for parameters in TASKS
    for mistake in misconceptions.of_task(parameters.values[1])
]


def grade(homework, text, folder, student="student 0"):
    """Return the Result of a submission with this text."""
    path = folder / f"{homework.name}.py"
    path.write_text(text, encoding="utf8")
    hidden = FOLDER / "hidden"
    options = GradingOptions("practice", student, "a secret", hidden if hidden.is_dir() else None)
    return grading.grade(path, homework, options)


@pytest.mark.parametrize(("homework", "task"), TASKS)
@pytest.mark.parametrize("student", STUDENTS)
def test_the_solution_gets_all_points(homework, task, student, tmp_path):
    text = inline.inlined({task.id: task.function})[task.id].text
    result = grade(homework, text, tmp_path, student)
    failures = {check.promise: check.message for check in result.checks if check.outcome != "holds"}
    assert failures == {}
    assert result.score == task.points


@pytest.mark.parametrize(("homework", "task", "mistake"), MISTAKES)
@pytest.mark.parametrize("student", STUDENTS[:2])
def test_a_known_mistake_costs_some_points_and_is_named(homework, task, mistake, student, tmp_path):
    path = next((FOLDER / "mistakes").rglob(f"{mistake.name}.py"))
    result = grade(homework, path.read_text(encoding="utf8"), tmp_path, student)
    assert 0 < result.score < task.points
    assert result.misconceptions == {task.id: mistake.sentence}


@pytest.mark.parametrize(("homework", "task"), TASKS)
def test_the_stub_gets_no_points(homework, task, tmp_path):
    assert grade(homework, stubs.stub(task), tmp_path).score == 0


@pytest.mark.parametrize(("homework", "task"), TASKS)
def test_every_check_has_three_hints_and_every_task_two_mistakes(homework, task, tmp_path):
    result = grade(homework, stubs.stub(task), tmp_path)
    wrong = {check.promise: len(check.hints) for check in result.checks if len(check.hints) != 3}
    assert wrong == {}
    assert len(misconceptions.of_task(task)) >= 2
