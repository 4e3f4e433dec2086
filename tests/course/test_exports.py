"""The course in other systems: nbgrader runs it, and Gradescope gets an autograder."""

import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from hdrlab.course import plan
from hdrlab.course.authoring.export import autograder, gradescope, nbgrader
from hdrlab.course.plan import Plan

SHORT = ("hat", "irradiance")  # tasks whose checks take a moment
HERE = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def short():
    """A plan with one homework of two tasks."""
    hw2 = plan.read().homeworks["hw2"]
    return Plan({"hw2": hw2._replace(tasks=tuple(task for task in hw2.tasks if task.id in SHORT))})


@pytest.fixture(scope="module")
def course(short, tmp_path_factory):
    """The plan's course for nbgrader."""
    folder = tmp_path_factory.mktemp("course")
    assert list(nbgrader.export(short, folder))
    return folder


@pytest.fixture(scope="module")
def tool(tmp_path_factory):
    """tool(arguments) runs nbgrader from its own environment, with a kernel of this one."""
    home = os.environ.get("HDRLAB_NBGRADER", "")
    command = Path(home) / "bin" / "nbgrader"
    if not home or not command.is_file():
        pytest.skip("HDRLAB_NBGRADER does not name an environment with nbgrader 0.9.6")
    scratch = tmp_path_factory.mktemp("jupyter")
    kernel = scratch / "share" / "kernels" / "python3"
    kernel.mkdir(parents=True)
    argv = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
    (kernel / "kernel.json").write_text(
        json.dumps({"argv": argv, "display_name": "P", "language": "python"})
    )
    own = {
        "JUPYTER_PATH": str(scratch / "share"),
        "JUPYTER_CONFIG_DIR": str(scratch / "config"),
        "JUPYTER_DATA_DIR": str(scratch / "data"),
        "JUPYTER_RUNTIME_DIR": str(scratch / "runtime"),
        "IPYTHONDIR": str(scratch / "ipython"),
        "HOME": str(scratch),
        "PATH": os.pathsep.join(
            [str(command.parent), os.environ["PATH"]]
        ),  # it calls alembic by its name
        "PYTHONPATH": os.pathsep.join(filter(None, [str(HERE), os.environ.get("PYTHONPATH")])),
    }

    def run(folder, *arguments):
        ran = subprocess.run(
            [command, *arguments],
            cwd=folder,
            env={**os.environ, **own},
            capture_output=True,
            text=True,
            timeout=600,
        )
        assert ran.returncode == 0, ran.stdout + ran.stderr
        return ran.stdout + ran.stderr

    return run


def cells(file):
    return {cell["id"]: cell for cell in json.loads(file.read_text())["cells"]}


def test_a_source_notebook_has_points_locks_and_solutions(course):
    notebook = cells(course / "source" / "hw2" / "hw2.ipynb")
    marks = {
        name: cell["metadata"]["nbgrader"]
        for name, cell in notebook.items()
        if "nbgrader" in cell["metadata"]
    }
    assert set(marks) == {f"{kind}-{task}" for kind in ("task", "check") for task in SHORT}
    assert marks["check-hat"]["points"] == 10
    assert marks["check-hat"]["locked"]
    assert marks["check-hat"]["grade"]
    assert marks["task-hat"]["solution"] and not marks["task-hat"]["locked"]
    text = "".join(notebook["task-irradiance"]["source"])
    scope = {}
    exec("import numpy as np\n" + text, scope)
    assert callable(scope["irradiance"]) and text.count("### BEGIN SOLUTION") == 1


def test_tasks_that_the_plan_leaves_out_are_not_in_the_export(course):
    text = (course / "source" / "hw2" / "hw2.ipynb").read_text()
    assert "def gsolve" not in text and 'check(\\"gsolve\\")' not in text


@pytest.mark.parametrize("name", plan.read().homeworks)
def test_every_solution_of_the_course_runs_inside_its_own_function(name):
    """Functions are nested, so a missing helper would not be noticed: each text is compiled and run."""
    for task in plan.read().homeworks[name].tasks:
        scope = {}
        exec("import numpy as np\n" + nbgrader.solved(task), scope)
        assert callable(scope[task.id])


@pytest.mark.grading
def test_nbgrader_makes_the_students_version_grades_it_and_gives_feedback(course, tool):
    """One student submits a right and a wrong function, another the unchanged assignment."""
    assert "0.9.6" in tool(course, "--version")
    tool(course, "generate_assignment", "hw2", "--create", "--force")
    released = course / "release" / "hw2" / "hw2.ipynb"
    text = released.read_text()
    assert "YOUR CODE HERE" in text and "BEGIN SOLUTION" not in text and "def irradiance" in text
    for student in ("ada", "blank"):
        target = course / "submitted" / student / "hw2"
        target.mkdir(parents=True)
        shutil.copy(released, target / "hw2.ipynb")
    handed_in = course / "submitted" / "ada" / "hw2" / "hw2.ipynb"
    written = json.loads(text)
    for cell in written["cells"]:
        if cell["id"] == "task-hat":
            cell["source"] = (
                "def hat(n=256):\n    z = np.arange(n)\n    return np.minimum(z, n - 1 - z) / ((n - 1) // 2)"
            )
        if cell["id"] == "task-irradiance":  # the times are forgotten
            cell["source"] = (
                "def irradiance(Z, t, f, w):\n    return (w[Z] * f[Z]).sum(1) / w[Z].sum(1)"
            )
    handed_in.write_text(json.dumps(written))
    tool(course, "autograde", "hw2", "--create")
    tool(course, "generate_feedback", "hw2")
    scores = scores_of(course / "gradebook.db")
    assert scores[("ada", "check-hat")] == 10 and 0 <= scores[("ada", "check-irradiance")] < 10
    assert scores[("blank", "check-hat")] == scores[("blank", "check-irradiance")] == 0
    feedback = (course / "feedback" / "ada" / "hw2" / "hw2.html").read_text()
    assert "✗" in feedback and "✓" in feedback


def scores_of(database):
    """Return nbgrader's automatic scores by (student, cell)."""
    import sqlite3

    with sqlite3.connect(database) as db:
        rows = db.execute(
            """SELECT submitted_assignment.student_id, base_cell.name, grade.auto_score FROM grade
            JOIN base_cell ON grade.cell_id = base_cell.id
            JOIN submitted_notebook ON grade.notebook_id = submitted_notebook.id
            JOIN submitted_assignment ON submitted_notebook.assignment_id = submitted_assignment.id"""
        ).fetchall()
    db.close()
    return {(student, name): score for student, name, score in rows}


@pytest.fixture(scope="module")
def zipped(tmp_path_factory):
    """The autograder of a plan with two tasks, unpacked as on Gradescope into source/ below the root."""
    folder = tmp_path_factory.mktemp("gradescope")
    hidden = folder / "own"
    hidden.mkdir()
    (hidden / "test_hat.py").write_text(HIDDEN)
    own = folder / "plan.toml"
    own.write_text(PLAN)
    (archive,) = gradescope.export(
        plan.read(own), folder, hidden=hidden, plan_file=own, secret="salt"
    )
    with zipfile.ZipFile(archive) as opened:
        opened.extractall(folder / "source")
        modes = {entry.filename: entry.external_attr >> 16 for entry in opened.infolist()}
    return folder, modes


PLAN = """
[hw2]
title = "The response curve"
due = 2026-10-23T23:59:00Z
tasks = [
  { id = "hat", function = "core.weights.hat", points = 10 },
  { id = "irradiance", function = "response.robertson.irradiance", points = 10 },
]
"""
HIDDEN = """
import pytest

@pytest.mark.points(1)
def test_any_number_of_levels_works(subject):
    assert len(subject.hat(12)) == 12
"""
# to all public checks, which ask for at least 20 levels
RIGHT = """import numpy as np

def hat(n=256):
    z = np.arange(max(n, 20))
    return np.minimum(z, n - 1 - z) / ((n - 1) // 2)
"""


@pytest.mark.grading
def test_an_autograder_contains_hdrlab_its_checks_and_runnable_scripts(zipped):
    folder, modes = zipped
    names = set(modes)
    assert modes["run_autograder"] & 0o111 and modes["setup.sh"] & 0o111
    for name in (
        "hdrlab/course/checks/specification/test_hat.py",
        "hdrlab/course/assignments/hw2.ipynb",
        "hidden/test_hat.py",
    ):
        assert name in names
    assert not any(name.startswith("solutions/") or "__pycache__" in name for name in names)
    requirements = (folder / "source" / "requirements.txt").read_text()
    assert "numpy" in requirements and "extra" not in requirements
    assert "run_autograder" not in (folder / "source" / "setup.sh").read_text()
    for script in ("setup.sh", "run_autograder"):
        subprocess.run(["bash", "-n", folder / "source" / script], check=True)


def run(root, tier="practice"):
    """Run the autograder in a root folder as Gradescope does: only the zip contains hdrlab."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    environment["PYTHONPATH"] = str(root / "source")
    command = [sys.executable, "-m", "hdrlab.course.authoring.export.autograder", root, tier]
    ran = subprocess.run(
        command, cwd=root, env=environment, capture_output=True, text=True, timeout=300
    )
    assert ran.returncode == 0, ran.stderr
    return json.loads((root / "results" / "results.json").read_text())


def handed_in(folder, tmp_path, name, text):
    root = tmp_path / "autograder"
    (root / "submission").mkdir(parents=True)
    (root / "source").symlink_to(folder / "source")
    (root / "submission" / name).write_text(text)
    (root / "submission_metadata.json").write_text(
        json.dumps({"users": [{"email": "ada@example.org"}]})
    )
    return root


@pytest.mark.grading
def test_an_autograder_needs_only_the_files_of_its_zip(zipped, tmp_path):
    report = run(handed_in(zipped[0], tmp_path, "hw2.py", RIGHT))
    of = {
        task: [check for check in report["tests"] if check["name"].startswith(f"{task}:")]
        for task in SHORT
    }
    hidden = [check for check in report["tests"] if check["visibility"] == "after_published"]
    assert len(hidden) == 1 and hidden[0]["output"] == "" and hidden[0]["score"] == 0
    public = [check for check in of["hat"] if check not in hidden]
    assert hidden[0]["name"] in [check["name"] for check in public]  # both have the same name
    assert {check["status"] for check in public} == {"passed"}, public
    assert report["score"] == pytest.approx(10 - hidden[0]["max_score"], abs=0.001)
    assert of["irradiance"] and all(check["score"] == 0 for check in of["irradiance"])
    assert {check["name"].partition(":")[0] for check in report["tests"]} == set(SHORT)
    assert "irradiance was not found" in report["output"] and "not for credit" in report["output"]


@pytest.mark.grading
def test_an_autograder_that_cannot_grade_reports_why_and_gives_no_points(zipped, tmp_path):
    report = run(handed_in(zipped[0], tmp_path, "hw2.txt", RIGHT))
    assert report["score"] == 0 and "expected a notebook" in report["output"]


def test_a_symbolic_link_is_not_accepted_as_a_submission(tmp_path):
    (tmp_path / "hw2.ipynb").symlink_to("/etc/hostname")
    with pytest.raises(ValueError, match="notebook"):
        autograder.handed_in(tmp_path)


def test_two_notebooks_in_a_submission_are_an_error(tmp_path):
    for name in ("a.ipynb", "b.ipynb"):
        (tmp_path / name).write_text("{}")
    with pytest.raises(ValueError, match=".ipynb file"):
        autograder.handed_in(tmp_path)


def test_file_names_in_capitals_are_accepted_and_control_characters_are_not_printed(tmp_path):
    (tmp_path / "submission").mkdir()
    (tmp_path / "submission" / "HW2.IPYNB").write_text("{}")
    assert autograder.handed_in(tmp_path / "submission").name == "HW2.IPYNB"
    (tmp_path / "submission" / "\x1b[2J\u202e.ipynb").write_text("{}")
    (tmp_path / "source").mkdir()
    (tmp_path / "source" / "settings.json").write_text('{"homework": "hw2", "secret": ""}')
    shutil.copy(plan.PLAN, tmp_path / "source" / "plan.toml")
    autograder.main(tmp_path)
    output = json.loads((tmp_path / "results" / "results.json").read_text())["output"]
    assert output.isprintable() and "expected one .ipynb file" in output


def test_the_same_course_gives_the_same_zip(short, tmp_path):
    first = next(iter(gradescope.export(short, tmp_path / "a")))
    second = next(iter(gradescope.export(short, tmp_path / "b")))
    assert first.read_bytes() == second.read_bytes()
