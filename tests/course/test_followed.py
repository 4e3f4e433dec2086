"""The grader follows the process of the checks: how it starts it, and how it explains its end."""

import json
import os
import subprocess
import sys
from types import SimpleNamespace

import pytest

from hdrlab.course.checks import SPECIFICATION, pytest_process
from hdrlab.course.sandbox.subprocess_runner import import_path


@pytest.fixture
def followed(monkeypatch, tmp_path):
    """followed(looks, code) -> a process that writes one text per poll, and ends with a code."""

    def followed(looks, code=0, message="", patience=10.0):
        fake = SimpleNamespace(done=[], slept=[], now=100.0, looks=list(looks))
        (tmp_path / "lines").touch()

        class Process:
            def __init__(self, words, **knobs):
                fake.words = words
                fake.knobs = knobs
                fake.there = os.path.isdir(knobs["cwd"])
                knobs["stdout"].write(message.encode())

            def poll(self):
                if fake.looks:
                    text = fake.looks.pop(0)
                    with (tmp_path / "lines").open("a") as lines:
                        lines.write(text)
                    return None
                return code

            def kill(self):
                fake.done.append("kill")

            def wait(self):
                fake.done.append("wait")

        def sleep(seconds):
            fake.slept.append(seconds)
            fake.now += seconds

        monkeypatch.setattr(
            pytest_process, "time", SimpleNamespace(monotonic=lambda: fake.now, sleep=sleep)
        )
        monkeypatch.setattr(pytest_process.subprocess, "Popen", Process)
        fake.lines = pytest_process.run_pytest(
            tmp_path, tmp_path / "job.json", [tmp_path / "test_a.py"], timeout=patience
        )
        return fake

    return followed


def test_only_complete_lines_are_yielded(followed, tmp_path):
    fake = followed(['{"a": 1}\n{"b"', ": 2}", '\n{"c": 3}\n'])
    assert next(fake.lines) == {"a": 1} and not fake.slept
    assert next(fake.lines) == {"b": 2} and fake.slept == [0.02] * 2
    assert list(fake.lines) == [{"c": 3}] and fake.done == ["kill", "wait"]


def test_pytest_starts_in_an_empty_folder_with_a_clean_environment(followed, tmp_path, monkeypatch):
    monkeypatch.setenv("PYTEST_ADDOPTS", "-x")
    monkeypatch.setenv("OF_MINE", "1")
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "7")
    fake = followed([])
    assert list(fake.lines) == []
    empty = tmp_path / "empty"
    environment = fake.knobs["env"]
    assert fake.there and fake.knobs["cwd"] == empty and fake.knobs["stdin"] == subprocess.DEVNULL
    assert fake.knobs["stdout"] is fake.knobs["stderr"]
    assert fake.words[:4] == [sys.executable, "-P", "-m", "pytest"]
    assert fake.words[-1] == str(tmp_path / "test_a.py")
    for word in (
        f"--rootdir={empty}",
        f"--job={tmp_path / 'job.json'}",
        f"pythonpath={SPECIFICATION}",
    ):
        assert word in fake.words
    assert "PYTEST_ADDOPTS" not in environment and environment["OF_MINE"] == "1"
    assert environment["TMPDIR"] == str(tmp_path) and environment["PYTHONPATH"] == import_path()
    for name in (
        "PYTEST_DISABLE_PLUGIN_AUTOLOAD",
        "PYTHONDONTWRITEBYTECODE",
        "OPENBLAS_NUM_THREADS",
    ):
        assert environment[name] == "1"


@pytest.mark.parametrize(
    ("code", "message", "error"),
    [
        (0, "", None),
        (1, "one failed", None),
        (-9, "", "the checks were ended from outside, by signal 9"),
        (-1, "", "the checks were ended from outside, by signal 1"),
        (2, "a\nb\nc\nd\ne\n\n", "the checks could not be run: b / c / d / e"),
        (5, "", "the checks could not be run: "),
    ],
)
def test_the_exit_code_decides_whether_the_run_was_an_error(code, message, error, followed):
    fake = followed([json.dumps({"a": 1}) + "\n"], code, message)
    assert next(fake.lines) == {"a": 1}
    if error is None:
        assert list(fake.lines) == []
    else:
        with pytest.raises(ValueError, match=f"^{error}$"):
            next(fake.lines)


def test_after_the_timeout_the_process_is_killed_and_its_results_count(followed):
    fake = followed(['{"a": 1}\n'] + [""] * 999, 7, patience=0.99)
    assert list(fake.lines) == [{"a": 1}]
    assert 49 <= len(fake.slept) <= 51
    assert fake.done == ["kill", "wait"]


def test_closing_the_iterator_kills_the_process(followed):
    fake = followed(['{"a": 1}\n'] + [""] * 9, 7)
    next(fake.lines)
    fake.lines.close()
    assert fake.done == ["kill", "wait"]
