"""Checks and grading without the modules, signals and functions that Windows lacks."""

import ast
import json
import subprocess
import sys
from pathlib import Path

import pytest
from support import simulated_windows
from support.one_task_homework import CORRECT_CODE, PLAN

import hdrlab

pytestmark = pytest.mark.grading

HOME = Path(hdrlab.__file__).parent
SYSTEM = Path("course/sandbox/inside/system.py")
TEMPORARY = Path("io/temporary.py")
POSIX = {"fcntl", "resource", "pwd", "grp", "termios", "pty", "posix", "syslog"}
IN_A_NOTEBOOK = f"""
from IPython.core.interactiveshell import InteractiveShell
shell = InteractiveShell.instance()
shell.run_cell({CORRECT_CODE!r}, store_history=True)
shell.run_cell("from hdrlab.course.notebook import check\\nfound = check('hat')", store_history=True)
print(shell.user_ns["found"])
"""
lacking = pytest.mark.skipif(
    sys.platform != "linux", reason="takes away from Linux what others do not have"
)


@pytest.fixture
def on_windows(tmp_path):
    """on_windows(*words) -> (exit code, stdout, stderr) of Python with these arguments, as if on
    Windows.
    """
    python = tmp_path / "python"
    python.mkdir()
    launcher, environment = simulated_windows.build_interpreter(python)
    (tmp_path / "plan.toml").write_text(PLAN, encoding="utf8")
    (tmp_path / "hw2.py").write_text(CORRECT_CODE, encoding="utf8")

    def run(*words, **more):
        ran = subprocess.run(
            [launcher, *words],
            cwd=tmp_path,
            env=environment | more,
            capture_output=True,
            encoding=more.get("PYTHONIOENCODING", "utf8"),
        )
        return ran.returncode, ran.stdout, ran.stderr

    return run


@lacking
def test_posix_modules_are_hidden_in_these_tests(on_windows):
    code = """if 1:
        import importlib.util, os, signal, subprocess, sys
        from hdrlab.course.sandbox.inside import system
        gone = [hasattr(signal, "SIGKILL"), hasattr(os, "fork"), system.LINUX, system.resource]
        words = [sys.executable, "-c", "import os; print(os.getppid())"]
        print(gone, os.getpid() == int(subprocess.check_output(words)))
    """
    assert on_windows("-c", code)[1] == "[False, False, False, None] False\n"


@lacking
def test_two_runs_cannot_write_to_one_folder(on_windows):
    code = """if 1:
        from pathlib import Path
        from hdrlab.course.classroom.jobs import lock_folder
        with lock_folder(Path("results")), lock_folder(Path("results")):
            pass
    """
    exit_code, _, errors = on_windows("-c", code)
    assert exit_code == 1
    assert "InputError: results" in errors


@lacking
def test_a_student_checks_a_function_in_a_notebook(on_windows):
    code, out, err = on_windows("-c", IN_A_NOTEBOOK)
    assert code == 0 and "✗" not in out and "of 10 points" in out, (out, err)


@lacking
def test_a_student_checks_a_file_at_the_terminal(on_windows):
    code, out, err = on_windows("-m", "hdrlab", "check", "hw2.py", "--plan", "plan.toml")
    assert code == 0 and "✗" not in out and "10 of 10 points" in out, (out, err)


@lacking
def test_an_unencodable_character_is_replaced_in_a_pipe(on_windows, tmp_path):
    wrong = CORRECT_CODE.replace("n - 1 -", "n -")
    (tmp_path / "hw2.py").write_text(wrong, encoding="utf8")
    words = ("-X", "utf8=0", "-m", "hdrlab", "check", "hw2.py", "--plan", "plan.toml")
    code, out, err = on_windows(*words, PYTHONIOENCODING="cp1252")
    assert code == 0 and "of 10 points" in out, (out, err)


@lacking
def test_an_instructor_grades_a_class_for_practice(on_windows, tmp_path):
    (tmp_path / "in" / "ada").mkdir(parents=True)
    (tmp_path / "in" / "ada" / "hw2.py").write_text(CORRECT_CODE, encoding="utf8")
    (tmp_path / "roster.csv").write_text("student,name\nada,Ada\n", encoding="utf8")
    words = (
        "in",
        "--homework",
        "hw2",
        "--roster",
        "roster.csv",
        "--plan",
        "plan.toml",
        "--tier",
        "practice",
    )
    code, out, err = on_windows("-m", "hdrlab", "grade", *words, "--out", "results")
    assert code == 0, (out, err)
    kept = [json.loads(file.read_bytes()) for file in (tmp_path / "results").rglob("*.*.json")]
    assert [record["score"] for record in kept] == [10.0], (out, err)


@lacking
def test_grading_for_credit_is_refused_with_a_line_that_names_the_practice_tier(on_windows):
    code, _, err = on_windows("-m", "hdrlab", "grade", "hw2.py", "--plan", "plan.toml")
    assert code == 2 and len(err.splitlines()) == 1 and "--tier practice" in err


def imported(path):
    """Return the names of the modules that a file imports anywhere."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module or ""
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith(
            ("import_module", "_import_if_available")
        ):
            yield from (
                argument.value for argument in node.args if isinstance(argument, ast.Constant)
            )


def test_only_two_modules_import_posix_modules():
    files = [
        path
        for path in HOME.rglob("*.py")
        if any(name in path.read_text(encoding="utf8") for name in POSIX)
    ]
    assert {path.relative_to(HOME) for path in files if POSIX & set(imported(path))} == {
        SYSTEM,
        TEMPORARY,
    }


def test_no_other_module_names_the_signal_that_windows_lacks():
    files = [path for path in HOME.rglob("*.py") if path.relative_to(HOME) != SYSTEM]
    assert not [path for path in files if "signal.SIGKILL" in path.read_text(encoding="utf8")]
