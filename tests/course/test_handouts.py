"""Handouts: one source makes two notebooks, and the committed notebooks are up to date."""

import ast
import builtins
import json
import os
import re
import subprocess
import sys
from collections import Counter
from itertools import combinations
from pathlib import Path

import pytest

from hdrlab.course import due_dates, materials, notebook, plan
from hdrlab.course.authoring import handouts
from hdrlab.course.plan import Task
from hdrlab.course.source_code import names

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ROOT / "solutions"
PLAN = plan.read()
NAMES = list(PLAN.homeworks)
TASKS = [task for homework in PLAN.homeworks.values() for task in homework.tasks]
pytestmark = pytest.mark.skipif(
    not SOURCES.is_dir(),
    reason="the handouts' prose is in a clone, and this is an installed package",
)


@pytest.fixture(scope="module")
def made():
    """made(name) -> the Handout of a homework."""
    pytest.importorskip("jupytext", reason="jupytext is not installed")
    built = {}

    def make(name):
        if name not in built:
            text = (SOURCES / f"{name}.py").read_text(encoding="utf8")
            built[name] = handouts.handout(text, PLAN.homeworks[name], handouts.lateness(PLAN))
        return built[name]

    return make


def committed(folder, name):
    return json.loads((folder / f"{name}.ipynb").read_text(encoding="utf8"))


def bare(notebook):
    """Return a notebook without the traces of a run."""
    cells = []
    for cell in notebook["cells"]:
        source = cell["source"] if isinstance(cell["source"], str) else "".join(cell["source"])
        kept = {
            "id": cell["id"],
            "cell_type": cell["cell_type"],
            "metadata": cell["metadata"],
            "source": source,
        }
        cells.append(kept)
    return {**notebook, "cells": cells}


@pytest.mark.parametrize("name", NAMES)
def test_the_committed_assignment_is_up_to_date(made, name):
    file = materials.folder("assignments") / f"{name}.ipynb"
    assert handouts.to_text(made(name).assignment) == file.read_text(encoding="utf8"), (
        "hdrlab course build"
    )


@pytest.mark.parametrize("name", NAMES)
def test_the_committed_solution_is_up_to_date(made, name):
    assert bare(made(name).solution) == bare(committed(SOURCES, name)), (
        "hdrlab course build --solutions solutions"
    )


@pytest.mark.parametrize("name", NAMES)
def test_the_committed_solution_was_run_and_passes_every_check(name):
    outputs = [
        output for cell in committed(SOURCES, name)["cells"] for output in cell.get("outputs", ())
    ]
    assert not [
        data for data in outputs if data["output_type"] == "error" or data.get("name") == "stderr"
    ]
    texts = ["".join(data.get("data", {}).get("text/plain", "")) for data in outputs]
    checked = [
        text for text in texts if re.search(r"^\S+: [\d.]+ of [\d.]+ points$", text, re.MULTILINE)
    ]
    assert len(checked) == len(PLAN.homeworks[name].tasks) + 1
    assert not any("✗" in text for text in checked)
    whole = f"{PLAN.homeworks[name].points:g}"
    assert f"{name}: {whole} of {whole} points" in checked[-1]


def bound_names(source):
    """Return the names that a cell binds outside of functions and classes."""
    names = set()
    for statement in ast.parse(source).body:
        if isinstance(statement, ast.FunctionDef | ast.ClassDef):
            names.add(statement.name)
        elif isinstance(statement, ast.Assign):
            targets = [node for target in statement.targets for node in ast.walk(target)]
            names |= {node.id for node in targets if isinstance(node, ast.Name)}
    return names


@pytest.mark.parametrize("name", NAMES)
def test_no_cell_that_shows_a_result_rebinds_a_name_of_a_solution(made, name):
    """Otherwise the checks of the whole notebook would use the rebound name instead of the helper."""
    is_solution = re.compile(
        "|".join(rf"^def {task.id}\(" for task in PLAN.homeworks[name].tasks), re.M
    )
    code = [cell["source"] for cell in made(name).solution["cells"] if cell["cell_type"] == "code"]
    solved = [source for source in code if is_solution.search(source)]
    shown = [source for source in code if not is_solution.search(source)]
    of_solutions = {name for source in solved for name in bound_names(source)}
    of_shown = {name for source in shown for name in bound_names(source)}
    assert sorted(of_solutions & of_shown) == []


def test_each_task_has_one_solution():
    cells = [cell for name in NAMES for cell in committed(SOURCES, name)["cells"]]
    worked = [cell for cell in cells if "task" in cell["metadata"].get("hdrlab", {})]
    assert len(worked) == sum(len(homework.tasks) for homework in PLAN.homeworks.values())


@pytest.mark.parametrize("name", NAMES)
def test_every_figure_of_a_solution_has_an_alt_text(name):
    pages = [
        "".join(output.get("data", {}).get("text/html", ""))
        for cell in committed(SOURCES, name)["cells"]
        for output in cell.get("outputs", ())
    ]
    images = [image for page in pages for image in re.findall(r"<img [^>]*>", page)]
    assert images and all(re.search(r'alt="[^"]{10,}"', image) for image in images)


@pytest.mark.parametrize("name", NAMES)
def test_an_assignment_contains_no_solution(made, name):
    """The cell of a task has the signature, the docstring and the stub, and nothing else of the
    function.
    """
    for cell in made(name).assignment["cells"]:
        task = cell["metadata"].get("hdrlab", {}).get("task")
        if task is not None:
            assert cell["source"].endswith(f'raise NotImplementedError("{task} is yours to write")')
            assert cell["source"].count("\ndef ") == 0 and cell["source"].startswith(f"def {task}(")
        assert cell.get("outputs", []) == []


@pytest.mark.parametrize("name", NAMES)
def test_every_task_has_a_cell_a_check_and_its_points(made, name):
    cells = {cell["id"]: cell for cell in made(name).assignment["cells"]}
    prose = "\n".join(cell["source"] for cell in cells.values() if cell["cell_type"] == "markdown")
    for task in PLAN.homeworks[name].tasks:
        assert f"task-{task.id}" in cells
        assert cells[f"check-{task.id}"]["source"] == f'check("{task.id}")'
        required = ", required" if task.minimum else ""
        assert f"({task.points:g} points{required})" in prose
    assert not re.search(r"\{(points|due|total|late|hand)\}", prose)
    assert f"Due {due_dates.describe(PLAN.homeworks[name].due)}." in prose


def test_a_task_that_the_plan_leaves_out_disappears_with_its_prose_and_figures():
    pytest.importorskip("jupytext", reason="jupytext is not installed")
    hw2 = PLAN.homeworks["hw2"]
    few = hw2._replace(
        tasks=tuple(Task(task.id, task.function, 3) for task in hw2.tasks if task.id == "hat")
    )
    made = handouts.handout((SOURCES / "hw2.py").read_text(encoding="utf8"), few)
    text = "\n".join(cell["source"] for cell in made.assignment["cells"])
    assert "(3 points)" in text
    assert "def hat" in text
    assert "gsolve" not in text
    assert "Robertson" not in text


def test_check_uses_the_points_of_the_assignment(made, monkeypatch):
    pytest.importorskip("jupytext", reason="jupytext is not installed")
    hw2 = PLAN.homeworks["hw2"]
    ours = hw2._replace(tasks=(Task("hat", "core.weights.hat", 20.0),))
    sheet = handouts.handout((SOURCES / "hw2.py").read_text(encoding="utf8"), ours).assignment
    (cell,) = [cell["source"] for cell in sheet["cells"] if "use_plan(" in cell["source"]]
    assert cell.endswith('use_plan("hw2", hat=20)')
    monkeypatch.setattr(notebook, "_planned", {})
    exec(cell[cell.index("use_plan(") :], {"use_plan": notebook.use_plan})
    for name in ("hat", "hw2"):
        homework, tasks = notebook.find_tasks(name)
        assert homework.points == 20 and tasks == ["hat"]
    assert notebook.find_tasks("ev")[0] == PLAN.homeworks["hw1"]
    notebook.use_plan("hw2")
    assert notebook.find_tasks("hw2")[0].points == 100


def test_an_assignment_with_a_choice_limits_the_points_that_count(monkeypatch):
    pytest.importorskip("jupytext", reason="jupytext is not installed")
    hw4 = PLAN.homeworks["hw4"]
    sheet = handouts.handout((SOURCES / "hw4.py").read_text(encoding="utf8"), hw4).assignment
    text = "\n".join(cell["source"] for cell in sheet["cells"])
    assert "UTC. 100 points." in text
    assert "170 points in total, but at most 100 count" in text
    (cell,) = [cell["source"] for cell in sheet["cells"] if "use_plan(" in cell["source"]]
    monkeypatch.setattr(notebook, "_planned", {})
    exec(cell[cell.index("use_plan(") :], {"use_plan": notebook.use_plan})
    assert notebook.find_tasks("hw4")[0] == hw4 and hw4.points == 100


def test_two_or_three_of_the_four_papers_give_all_points_of_homework_4():
    hw4 = PLAN.homeworks["hw4"]
    papers = Counter()
    for task in hw4.tasks:
        papers[task.function.split(".")[-2]] += task.points
    papers["fattal"] += papers.pop("poisson")
    needed = hw4.at_most - papers.pop("reinhard")
    pairs = {
        frozenset(two)
        for two in combinations(papers, 2)
        if sum(papers[paper] for paper in two) >= needed
    }
    assert {frozenset(("durand", "ward")), frozenset(("chiu", "fattal"))} <= pairs
    assert all(sum(papers[paper] for paper in three) >= needed for three in combinations(papers, 3))
    assert max(papers.values()) < needed


SHORT = """
[hw3]
title = "The radiance map and its files"
due = 2026-11-06T23:59:00Z
tasks = [{ id = "to_radiance", function = "io.maps.rgbe.to_radiance", points = 10 }]
"""


def test_an_assignment_marks_the_required_tasks(made):
    tasks = [task for homework in PLAN.homeworks.values() for task in homework.tasks]
    assert [task.id for task in tasks if task.minimum] == ["align", "gsolve", "merge", "display"]
    for name in ("hw1", "hw2", "hw3", "hw4"):
        heads = [cell["source"].partition("\n")[0] for cell in made(name).assignment["cells"]]
        assert sum(head.endswith(" points, required)") for head in heads) == 1, name


def test_the_project_assignment_contains_the_rubric(made):
    text = "".join(made("project").assignment["cells"][0]["source"])
    for item in PLAN.homeworks["project"].by_hand:
        assert f"- **{item.title}** ({item.points:g} points)\n  - {item.points:g}: " in text
        earned = [float(line.partition(":")[0]) for line in item.rubric]
        assert len(earned) > 1
        assert earned == sorted(earned, reverse=True)
        assert earned[0] == item.points


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.id)
def test_an_assignment_with_one_task_runs_without_the_others(task):
    pytest.importorskip("jupytext", reason="jupytext is not installed")
    name = next(homework for homework in NAMES if task in PLAN.homeworks[homework].tasks)
    alone = PLAN.homeworks[name]._replace(tasks=(task,))
    made = handouts.handout((SOURCES / f"{name}.py").read_text(encoding="utf8"), alone)
    known = set(dir(builtins))
    for cell in made.solution["cells"]:
        if cell["cell_type"] == "code":
            for node in ast.parse(cell["source"]).body:
                known |= set(names.bound_names(node))
                assert {use.node.id for use in names.free_names(node)} <= known, cell["source"]


@pytest.mark.notebooks
def test_building_writes_the_assignment_and_the_solution_only(tmp_path):
    """In a separate process, because notebooks run with asyncio, and a browser may use the loop of this
    one.
    """
    pytest.importorskip("jupytext", reason="jupytext is not installed")
    (tmp_path / "plan.toml").write_text(SHORT)
    options = [
        "--plan",
        "plan.toml",
        "--sources",
        SOURCES,
        "--out",
        "assignments",
        "--solutions",
        "worked",
    ]
    command = [sys.executable, "-m", "hdrlab", "course", "build", *options]
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
    ran = subprocess.run(
        command,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert ran.returncode == 0, ran.stderr
    files = {
        file.relative_to(tmp_path).as_posix() for file in tmp_path.rglob("*") if file.is_file()
    }
    assert files == {"plan.toml", "assignments/hw3.ipynb", "worked/hw3.ipynb"}
    worked = json.loads((tmp_path / "worked" / "hw3.ipynb").read_text())
    outputs = [output for cell in worked["cells"] for output in cell.get("outputs", ())]
    assert any("to_radiance: 10 of 10 points" in json.dumps(data) for data in outputs)
    assert not any("execution" in cell["metadata"] for cell in worked["cells"])


def test_a_homework_without_prose_is_an_error(tmp_path):
    with pytest.raises(ValueError, match="prose of hw1"):
        list(handouts.build_steps(PLAN, tmp_path, tmp_path, None))
