"""The pack of model solutions: written on request, ten to thirty lines each, with full points."""

import pytest
import scoring

from hdrlab.course import plan
from hdrlab.course.authoring import solutions
from hdrlab.course.checks import inprocess

PLAN = plan.read()


@pytest.fixture(scope="module")
def pack(tmp_path_factory):
    """The folder of the pack."""
    folder = tmp_path_factory.mktemp("pack")
    assert list(solutions.write(PLAN, folder))
    return folder


def test_the_pack_has_a_notebook_and_a_file_for_each_homework_and_a_table_of_the_tasks(pack):
    names = {f"{name}.{kind}" for name in PLAN.homeworks for kind in ("py", "ipynb")}
    assert {file.name for file in pack.iterdir()} == names | {"README.md"}
    table = (pack / "README.md").read_text()
    assert all(
        f"| `{task.id}` | {task.points:g} |" in table
        for homework in PLAN.homeworks.values()
        for task in homework.tasks
    )


@pytest.mark.parametrize("name", PLAN.homeworks)
def test_the_solutions_run_without_the_library(pack, name):
    text = (pack / f"{name}.py").read_text()
    scope = {"__name__": "pack"}
    exec(compile(text, name, "exec"), scope)
    assert "hdrlab" not in text and {task.id for task in PLAN.homeworks[name].tasks} <= scope.keys()


@pytest.mark.parametrize("task", ["hat", "bound", "compress", "pq"])
def test_every_solution_passes_every_check(pack, task):
    (name,) = [
        name
        for name, homework in PLAN.homeworks.items()
        if task in [own.id for own in homework.tasks]
    ]
    scope = {"__name__": "pack"}
    exec((pack / f"{name}.py").read_text(), scope)
    assert scoring.score(task, inprocess.Subject({task: scope[task]}))[0] == 1
