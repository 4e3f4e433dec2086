"""`hdrlab check`, `grade`, `doctor` and `course` on the command line."""

import json
from pathlib import Path

import pytest

from hdrlab import cli

pytestmark = pytest.mark.grading

PLAN = """
[hw2]
title = "The response curve"
due = 2026-10-23T23:59:00Z
tasks = [{ id = "hat", function = "core.weights.hat", points = 8 }]
"""
WRONG = "import numpy as np\ndef hat(n=256):\n    return np.abs(np.arange(n) - n // 2) / (n // 2)\n"


@pytest.fixture
def typed(tmp_path, monkeypatch, capsys):
    """typed(arguments) -> (exit code, stdout, stderr) in a folder with a plan and a wrong function."""
    (tmp_path / "plan.toml").write_text(PLAN)
    (tmp_path / "hw2.py").write_text(WRONG)
    monkeypatch.chdir(tmp_path)

    def typed(*arguments):
        with pytest.raises(SystemExit) as ended:
            cli.run(arguments)
        out, err = capsys.readouterr()
        return ended.value.code or 0, out, err

    return typed


def test_check_prints_the_outcome_of_each_promise(typed):
    code, out, _ = typed("check", "hw2.py", "--plan", "plan.toml", "--task", "hat")
    assert code == 0 and "✗" in out and "Likely mistake: " in out and "of 8 points" in out
    assert "Hint 1" not in out


def test_check_gives_as_many_hints_as_are_asked_for(typed):
    _, out, _ = typed("check", "hw2.py", "--plan", "plan.toml", "--hints", "2")
    assert "Hint 1: " in out and "Hint 2: " in out and "Hint 3: " not in out


def test_check_writes_a_page_with_pictures(typed, tmp_path):
    _, out, _ = typed("check", "hw2.py", "--plan", "plan.toml", "--report", "found.html")
    page = (tmp_path / "found.html").read_text()
    assert "found.html" in out and 'src="data:image/webp' in page and "For practice" in page


def test_grade_writes_every_form_into_one_folder(typed, tmp_path):
    code, out, err = typed(
        "grade", "hw2.py", "--plan", "plan.toml", "--tier", "practice", "--out", "results"
    )
    names = {file.name for file in (tmp_path / "results").iterdir()}
    assert code == 0
    assert names == {
        "result.json",
        "gradescope.json",
        "junit.xml",
        "result.csv",
        "feedback.html",
    }
    read = json.loads((tmp_path / "results" / "result.json").read_text())
    assert read["tier"] == "practice" and 0 <= read["score"] < read["max_score"] == 8
    assert "not for credit" in err and "feedback.html" in out


def test_grade_draws_each_students_inputs_from_a_secret_file(typed, tmp_path):
    (tmp_path / "secret").write_text("salt\n")
    common = ("grade", "hw2.py", "--plan", "plan.toml", "--tier", "practice", "--out", "results")
    seeds = []
    for student in ("ada", "bob"):
        typed(*common, "--student", student, "--secret-file", "secret")
        seeds.append(json.loads((tmp_path / "results" / "result.json").read_text())["seed"])
    assert seeds[0] != seeds[1]
    code, _, err = typed(*common, "--student", "ada")
    assert code == 2 and "--secret-file" in err


@pytest.mark.parametrize("secret", [(), ("--student", "ada", "--secret-file", "secret")])
def test_a_practice_score_is_announced_once(typed, secret):
    words = ("grade", "hw2.py", "--plan", "plan.toml", "--tier", "practice", "--out", "results")
    _, _, err = typed(*words, *secret)
    assert err.count("practice") == err.count("not for credit") == 1


def test_a_secret_is_made_on_first_use_and_kept(typed, tmp_path):
    common = ("grade", "hw2.py", "--plan", "plan.toml", "--tier", "practice", "--out", "results")
    seeds = []
    for is_first in (True, False):
        code, _, err = typed(*common, "--student", "ada", "--secret-file", "new.txt")
        assert code == 0 and ("new.txt: created a secret" in err) is is_first
        seeds.append(json.loads((tmp_path / "results" / "result.json").read_text())["seed"])
    secret = tmp_path / "new.txt"
    assert seeds[0] == seeds[1] != "" and len(secret.read_text().strip()) > 30
    assert secret.stat().st_mode & 0o077 == 0
    secret.write_text("\n")
    code, _, err = typed(*common, "--student", "ada", "--secret-file", "new.txt")
    assert code == 2
    assert "new.txt" in err and "empty" in err


@pytest.mark.quick
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("check", "missing.ipynb", "--homework", "hw2"), "missing.ipynb"),
        (("check", "hw2.py", "--task", "nothing"), "--task, one of hat"),
        (("check", "hw2.py", "--homework", "hw9"), "--homework, one of hw2"),
        (("check", "plan.toml"), "--homework"),
        (("grade", "hw2.py", "--tier", "perfect"), "perfect"),
        (("course", "export"), "--nbgrader DIR or --gradescope DIR"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(typed, arguments, message):
    code, _, err = typed(*arguments, *(() if arguments[0] == "course" else ("--plan", "plan.toml")))
    assert code == 2 and message in err and "Traceback" not in err


@pytest.mark.quick
def test_doctor_names_every_tier(typed):
    code, out, _ = typed("doctor")
    assert code == 0 and all(tier in out for tier in ("strict", "container", "practice"))


@pytest.mark.quick
def test_the_course_is_built_and_exported(typed, tmp_path):
    pytest.importorskip("jupytext", reason="jupytext is not installed")
    sources = Path(__file__).resolve().parents[2] / "solutions"
    if not sources.is_dir():
        pytest.skip("the handouts' prose is in a clone, and this is an installed package")
    code, out, _ = typed(
        "course", "build", "--plan", "plan.toml", "--sources", str(sources), "--out", "handouts"
    )
    assert code == 0
    assert "hw2.ipynb" in out
    assert "def hat" in (tmp_path / "handouts" / "hw2.ipynb").read_text()
    code, out, _ = typed(
        "course", "export", "--plan", "plan.toml", "--nbgrader", "nb", "--gradescope", "gs"
    )
    assert code == 0 and (tmp_path / "nb" / "nbgrader_config.py").exists()
    assert (tmp_path / "gs" / "hw2_autograder.zip").exists()


@pytest.mark.quick
def test_grade_refuses_options_that_it_would_ignore(typed, tmp_path):
    (tmp_path / "class").mkdir()
    (tmp_path / "secret").write_text("salt\n")
    code, _, err = typed("grade", "hw2.py", "--plan", "plan.toml", "--only", "ada", "--jobs", "2")
    assert code == 2 and "--only, --jobs" in err and "hw2.py" in err
    code, _, err = typed("grade", "class", "--student", "ada", "--secret-file", "secret")
    assert code == 2 and "--student" in err and "class" in err
