"""A task that an instructor writes: the example works, and so do its assignment, checks and grading."""

import json
import subprocess
import sys
import zipfile
from pathlib import Path
from types import SimpleNamespace

import pytest

from hdrlab.course import notebook, plan
from hdrlab.course.authoring import handouts, own_task, stubs
from hdrlab.course.authoring.export import gradescope
from hdrlab.course.checks import misconceptions
from hdrlab.course.checks.plugin import GradingPlugin
from hdrlab.course.grading import grader
from hdrlab.course.plan import GradingOptions
from hdrlab.course.source_code import inline
from hdrlab.errors import InputError

WRONG = "def flat_field(Z, flat):\n    return Z / flat\n"
FILE = "flat_field.py:flat_field"


@pytest.fixture
def folder(tmp_path):
    """A folder with the example, as the command writes it."""
    assert list(own_task.write(tmp_path / "ours", "flat_field", "extra"))
    return tmp_path / "ours"


def extra(folder):
    """Return the homework of the example."""
    return plan.read(folder / "plan.toml").homeworks["extra"]


def test_a_task_may_be_a_function_in_a_file_beside_the_plan(folder):
    (task,) = extra(folder).tasks
    assert task.own == folder / "flat_field.py" and task.name == "flat_field"
    assert plan.function(task)(4.0, [2.0, 2.0]).tolist() == [4.0, 4.0]
    assert plan.read().task("gsolve").own is None


@pytest.mark.parametrize("function", ["../x.py:x", "ours/x.py:x", "x:x", "x.py:"])
def test_a_function_outside_the_plans_folder_is_refused(folder, function):
    text = (folder / "plan.toml").read_text()
    (folder / "plan.toml").write_text(text.replace(FILE, function))
    with pytest.raises(ValueError, match="plan"):
        plan.read(folder / "plan.toml")


def test_a_second_task_joins_the_first_and_a_third_begins_another_homework(folder):
    for name, homework in (("dark", "extra"), ("white", "more")):
        assert folder / f"{name}.py" in list(own_task.write(folder, name, homework))
    read = plan.read(folder / "plan.toml")
    homeworks = read.homeworks
    assert read.late == plan.read().late
    assert [[task.id for task in homework_read.tasks] for homework_read in homeworks.values()] == [
        ["flat_field", "dark"],
        ["white"],
    ]
    assert (folder / "sheets" / "extra.py").read_text().count("# %% task=") == 2


@pytest.mark.parametrize("name", ["flat_field", "extra", "Dark", "dark-frame", "class", "../dark"])
def test_a_task_name_that_is_taken_or_not_an_identifier_is_refused(folder, name):
    with pytest.raises(InputError):
        list(own_task.write(folder, name, "extra"))


def test_the_assignment_of_an_own_task_has_its_stub_text_points_and_checks(
    folder, tmp_path, monkeypatch
):
    pytest.importorskip("jupytext", reason="jupytext is not installed")
    out = tmp_path / "handout"
    made = list(handouts.build_steps(plan.read(folder / "plan.toml"), folder / "sheets", out, None))
    checks = out / "extra-checks"
    assert made == [out / "extra.ipynb", checks / "plan.toml", checks / "test_flat_field.py"]
    cells = ["".join(cell["source"]) for cell in json.loads(made[0].read_text())["cells"]]
    assert any(cell.startswith("def flat_field(Z, flat):") for cell in cells)
    (plan_cell,) = [cell for cell in cells if "use_plan(" in cell]
    assert plan_cell.endswith('use_plan("extra", plan="extra-checks/plan.toml", flat_field=10)')
    monkeypatch.setattr(notebook, "_planned", {})
    monkeypatch.chdir(out)
    exec(plan_cell[plan_cell.index("use_plan(") :], {"use_plan": notebook.use_plan})
    homework, tasks = notebook.find_tasks("flat_field")
    assert tasks == ["flat_field"]
    assert grader.files_of(homework, None) == [checks / "test_flat_field.py"]


@pytest.mark.grading
def test_an_own_task_is_graded_with_its_mistakes_hidden_checks_and_point_limit(folder, tmp_path):
    (tmp_path / "extra.py").write_text(WRONG)
    conditions = GradingOptions("practice", hidden=folder / "hidden")
    report = grader.grade(tmp_path / "extra.py", extra(folder), conditions)
    (task,) = extra(folder).tasks
    says = {check.name: check.sentence for check in misconceptions.of_task(task)}
    assert report.misconceptions == {"flat_field": says["flat_field_mean_forgotten"]}
    assert 5 <= report.score < 10
    assert [check.hidden for check in report.checks] == [False] * 3 + [True]


@pytest.mark.parametrize(("marks", "points"), [((), "1"), ((3,), "3"), ((0.5,), "1/2")])
def test_a_check_is_worth_what_its_marker_says_and_without_one_a_point(marks, points, tmp_path):
    mark = pytest.mark.points(*marks).mark if marks else None
    check = SimpleNamespace(
        name="test_a", path=Path("test_hat.py"), get_closest_marker=lambda name: mark
    )
    out = tmp_path / "lines"
    GradingPlugin({"out": str(out), "hidden": ""}).pytest_collection_finish(
        SimpleNamespace(items=[check])
    )
    assert json.loads(out.read_text())["points"] == points


@pytest.mark.grading
def test_a_task_without_solution_and_mistakes_still_reports_failed_checks(folder, tmp_path):
    (task,) = extra(folder).tasks
    task.own.unlink()
    (tmp_path / "extra.py").write_text(WRONG)
    report = grader.grade(tmp_path / "extra.py", extra(folder), GradingOptions("practice"))
    assert report.misconceptions == {} and report.score < 10
    assert any("the corrected wall: expected" in check.message for check in report.checks)


def test_gradescope_gets_the_task_its_checks_and_its_mistakes(folder, tmp_path):
    read = plan.read(folder / "plan.toml")
    (file,) = gradescope.export(read, tmp_path / "zips", plan_file=folder / "plan.toml")
    zipfile.ZipFile(file).extractall(
        tmp_path / "source", ["plan.toml", "flat_field.py", "test_flat_field.py"]
    )
    held = zipfile.ZipFile(file).namelist()
    assert "mistakes/flat_field_multiplied.py" in held
    assert not any(name.startswith("hidden/") for name in held)
    assert grader.files_of(extra(tmp_path / "source"), None)[0].is_file()


def test_a_solution_may_use_the_library_and_its_stub_does_not_show_it(folder):
    task = extra(folder).tasks[0]
    text = (folder / "flat_field.py").read_text()
    text = text.replace(
        "import numpy as np", "import numpy as np\n\nfrom hdrlab.core.weights import hat"
    )
    task.own.write_text(text.replace("flat.mean() / flat", "hat().max() * flat.mean() / flat"))
    block = inline.inlined({task.id: task.function})[task.id].text
    assert "def hat(" in block and "hdrlab" not in block
    assert "hat" not in stubs.stub(task)


@pytest.mark.grading
def test_the_tests_of_the_task_template_pass(folder):
    ran = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", str(folder)],
        cwd=folder,
        capture_output=True,
        text=True,
    )
    assert ran.returncode == 0 and "15 passed" in ran.stdout, ran.stdout
