"""Generated submissions work without hdrlab and answer like hdrlab, or like the wrong function."""

import ast
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import scoring

from hdrlab.course import plan
from hdrlab.course.authoring import solutions
from hdrlab.course.checks import inprocess, misconceptions
from hdrlab.course.submissions import reader

pytestmark = pytest.mark.grading

HERE = Path(__file__).parents[1]
HOMEWORKS = plan.read().homeworks
OF_TASK = {task.id: name for name, homework in HOMEWORKS.items() for task in homework.tasks}
KNOWN = misconceptions.known()
HW2 = [mistake for mistake in KNOWN if OF_TASK[mistake.task] == "hw2"]


def function(name, task, cells, folder):
    """Return a task's function as the grader finds it in a notebook."""
    homework = HOMEWORKS[OF_TASK[task]]
    file = folder / f"{name}.ipynb"
    file.write_text(solutions.notebook(homework, cells), encoding="utf8")
    scope = {"__name__": "a student's module"}
    exec(reader.tasks_of(file, [task]).sources[task], scope)
    return scope[task]


@pytest.mark.parametrize("mistake", KNOWN, ids=[mistake.name for mistake in KNOWN])
def test_a_known_mistake_runs_without_hdrlab(mistake, tmp_path):
    cells = solutions.texts(HOMEWORKS[OF_TASK[mistake.task]], [mistake.name])
    for text in cells.values():
        for node in ast.walk(ast.parse(text)):
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                names = [str(node.module)]
            assert not any(name.startswith("hdrlab") for name in names)
    assert callable(function(mistake.name, mistake.task, cells, tmp_path))


@cache
def small(task):
    """Return the two smallest inputs of a task's checks, as (arguments, named arguments)."""
    library = inprocess.library()
    scoring.score(task, library)
    sizes = [sum(np.size(array) for array in arguments) for arguments, _, _ in library.calls]
    return [library.calls[k][:2] for k in np.argsort(sizes, kind="stable")[:2]]


@pytest.mark.parametrize("mistake", HW2, ids=[mistake.name for mistake in HW2])
def test_an_inlined_mistake_gives_the_same_answers_as_its_function(mistake, tmp_path):
    wrong = function(
        mistake.name, mistake.task, solutions.texts(HOMEWORKS["hw2"], [mistake.name]), tmp_path
    )
    for arguments, named in small(mistake.task):
        inlined_answer = misconceptions.call_quietly(wrong, arguments, named)
        filed = misconceptions.call_quietly(mistake.function, arguments, named)
        assert filed is not None and misconceptions.difference(inlined_answer, filed) == 0


@pytest.mark.parametrize("homework", HOMEWORKS.values(), ids=HOMEWORKS)
def test_without_a_mistake_the_submission_is_the_solution(homework, tmp_path):
    cells = solutions.texts(homework)
    for name, text in (
        ("a.ipynb", solutions.notebook(homework, cells)),
        ("a.py", solutions.script(cells)),
    ):
        (tmp_path / name).write_text(text, encoding="utf8")
        submission = reader.tasks_of(tmp_path / name, [task.id for task in homework.tasks])
        assert set(submission.sources) == {task.id for task in homework.tasks}
        assert not any("is yours to write" in source for source in submission.sources.values())
    handout = (HERE.parent / "assignments" / f"{homework.name}.ipynb").read_text(encoding="utf8")
    assert solutions.notebook(homework) == handout
