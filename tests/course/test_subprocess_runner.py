"""A job in a separate process: its environment, the reason why it ended, and the number of
processes.
"""

import ast
import io
import os
import pickle
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from hdrlab.course.classroom.executors import processes
from hdrlab.course.classroom.jobs import GradingJob, JobAttempt
from hdrlab.course.sandbox import subprocess_runner
from hdrlab.course.sandbox.subprocess_runner import ProcessFailed, import_path


@pytest.fixture
def ended(monkeypatch):
    """ended(code, answer, printed, waits) -> the record of a fake process that ends like this after so
    many polls.
    """

    def ended(code=0, answer=b"+", message=b"", waits=0):
        fake = SimpleNamespace(asked=[], done=[], now=50.0)

        class Process:
            returncode = code

            def __init__(self, command, **knobs):
                fake.command = command
                fake.knobs = knobs
                fake.scratch = Path(knobs["env"]["TMPDIR"])
                assert fake.scratch.is_dir()

            def __enter__(self):
                return self

            def __exit__(self, *error):
                fake.done.append("left")

            def communicate(self, arguments, timeout):
                fake.asked.append((arguments, timeout))
                fake.now += timeout
                if len(fake.asked) <= waits:
                    raise subprocess.TimeoutExpired("", timeout)
                return answer, message

            def kill(self):
                fake.done.append("kill")

        monkeypatch.setattr(subprocess_runner.subprocess, "Popen", Process)
        monkeypatch.setattr(subprocess_runner, "time", SimpleNamespace(monotonic=lambda: fake.now))
        return fake

    return ended


def failed(**knobs):
    with pytest.raises(ProcessFailed) as raised:
        subprocess_runner.run(len, "piece", timeout=1.0, **knobs)
    return str(raised.value), raised.value.is_own_fault, raised.value.was_killed


def test_a_process_gets_the_import_path_then_limits_function_and_job(ended, monkeypatch):
    monkeypatch.setenv("OF_THE_GRADER", "1")
    fake = ended(0, b"++answer")
    assert subprocess_runner.run(len, "piece", timeout=1.0) == b"+answer"
    assert fake.command == [
        sys.executable,
        "-P",
        "-m",
        subprocess_runner.__name__,
        str(os.getpid()),
    ]
    environment = fake.knobs["env"]
    assert (environment["PYTHONPATH"], environment["OF_THE_GRADER"]) == (import_path(), "1")
    ((order, tick),) = fake.asked
    stream = io.BytesIO(order)
    assert pickle.load(stream) == [path for path in sys.path if path]
    assert pickle.load(stream) == ({}, len, "piece") and tick == 0.2
    assert fake.done == ["kill", "left"] and not fake.scratch.exists()
    fake = ended()
    assert subprocess_runner.run(len, "piece", timeout=1.0, limits={"CPU": 3}) == b""
    stream = io.BytesIO(fake.asked[0][0])
    pickle.load(stream)
    assert pickle.load(stream)[0] == {"CPU": 3}


@pytest.mark.parametrize(
    ("code", "answer", "message", "why"),
    [
        (0, b"-ValueError: no", b"noise", ("ValueError: no", False, False)),
        (0, b"-MemoryError: ", b"", ("MemoryError:", True, False)),
        (0, b"-MemoryErro", b"", ("MemoryErro", False, False)),
        (1, b"", b"one\ntwo\n", ("two", False, False)),
        (1, b"-", b"one\ntwo ", ("two", False, False)),
        (1, b"", b"n" * 301, ("n" * 300, False, False)),
        (3, b"", b"", ("its process was ended (3)", False, False)),
        (0, b"", b" \n", ("its process was ended (0)", False, False)),
        (-9, b"", b"", ("its process was ended (-9)", False, True)),
        (-15, b"", b"", ("its process was ended (-15)", False, True)),
        (9, b"", b"", ("its process was ended (9)", False, False)),
        (-11, b"", b"", ("its process was ended (-11)", True, False)),
        (-24, b"", b"", ("its process was ended (-24)", True, False)),
        (-1, b"", b"", ("its process was ended (-1)", True, False)),
    ],
)
def test_a_failure_has_the_last_line_of_its_error_and_says_what_caused_it(
    code, answer, message, why, ended
):
    fake = ended(code, answer, message)
    assert failed() == why and fake.done == ["kill", "left"] and not fake.scratch.exists()


def test_a_process_is_waited_for_until_its_time_limit(ended):
    fake = ended(0, b"+x", waits=4)
    assert subprocess_runner.run(len, "piece", timeout=0.81) == b"x"
    assert [timeout is None for timeout, _ in fake.asked] == [False, True, True, True, True]
    fake = ended(0, b"+x", waits=99)
    assert failed() == ("it took too long", False, False)
    assert 5 <= len(fake.asked) <= 6 and fake.done == ["kill", "left"]


def test_a_process_that_is_stopped_is_ended(ended):
    stops = iter((False, False, True))
    fake = ended(0, b"+x", waits=99)
    assert failed(is_stopped=lambda: next(stops)) == ("it was stopped", False, False)
    assert len(fake.asked) == 3 and fake.done == ["kill", "left"]


# In a real process: the work is to evaluate an expression


def test_printed_text_is_not_an_answer_and_limits_apply():
    limited = "[r.getrlimit(n) for r in [__import__('resource')] for n in (r.RLIMIT_CPU, r.RLIMIT_NOFILE)]"
    code = f"{limited}, __import__('tempfile').gettempdir()"
    piece = f"print('noise') or __import__('os').write(1, b'more') and repr(({code})).encode()"
    limits = {"CPU": 50, "NOFILE": 40, "OF_NO_KIND": 1}
    limits_applied, scratch = ast.literal_eval(
        subprocess_runner.run(eval, piece, timeout=60, limits=limits).decode()
    )
    assert limits_applied == [(50, 51), (40, 40)]
    assert Path(scratch).name.startswith("hdrlab-piece-") and not Path(scratch).exists()


@pytest.mark.parametrize(
    ("piece", "why"),
    [
        ("{}['a\\n b']", ("KeyError: 'a\\n b'", False, False)),
        (
            "int('a\\nb')",
            ("ValueError: invalid literal for int() with base 10: 'a\\nb'", False, False),
        ),
        ("exec('raise MemoryError')", ("MemoryError:", True, False)),
        (
            f"__import__('os').kill(__import__('os').getpid(), {signal.SIGTERM:d})",
            (None, False, True),
        ),
    ],
)
def test_an_error_is_reported_in_one_line_and_differs_from_a_kill(piece, why):
    with pytest.raises(ProcessFailed) as raised:
        subprocess_runner.run(eval, piece, timeout=60)
    message = str(raised.value)
    assert (
        message if why[0] else None,
        raised.value.is_own_fault,
        raised.value.was_killed,
    ) == why
    assert "\n" not in message


def test_a_process_whose_parent_has_died_does_nothing(monkeypatch):
    calls = []
    monkeypatch.setattr(
        subprocess_runner.system, "die_with_parent", lambda parent: calls.append(parent)
    )
    monkeypatch.setattr(subprocess_runner.os, "dup", lambda descriptor: pytest.fail("it begins"))
    subprocess_runner.main("17")
    assert calls == [17]


# So many at a time


class Threads:
    """A fake pool, whose futures the test completes."""

    made: list = []

    def __init__(self, count, prefix):
        self.count = count
        self.begun = []
        self.ended = None
        self.made.append(self)

    def submit(self, function, work, piece, **knobs):
        future = processes.Future()
        self.begun.append((function, work, piece, knobs, future))
        return future

    def shutdown(self, **knobs):
        self.ended = knobs


@pytest.fixture
def threads(monkeypatch):
    """The pools that were created."""
    monkeypatch.setattr(processes, "ThreadPoolExecutor", Threads)
    monkeypatch.setattr(Threads, "made", [])
    monkeypatch.setattr(processes, "WAIT_SECONDS", 0.01)
    return Threads.made


@pytest.mark.parametrize(
    ("max_processes", "processors", "count"), [(3, 2, 3), (None, 5, 5), (None, None, 1)]
)
def test_the_number_of_parallel_processes_is_as_requested_or_the_number_of_processors(
    max_processes, processors, count, threads, monkeypatch
):
    monkeypatch.setattr(os, "cpu_count", lambda: processors)
    with processes.Processes(len, max_processes) as executor:
        jobs = [GradingJob(f"p{k}", Path(f"p{k}"), "key") for k in range(count + 1)]
        assert [executor.start(job) for job in jobs] == [True] * count + [False]
        assert executor.wait_for_attempts() == []
        ((function, work, piece, knobs, future), *_) = threads[0].begun
        assert (function, work, piece, threads[0].count) == (
            subprocess_runner.run,
            len,
            jobs[0],
            count,
        )
        assert knobs["timeout"] == 1800 and knobs["is_stopped"]() is False
        future.set_result(b"result")
        assert executor.wait_for_attempts() == [JobAttempt(jobs[0], b"result")]
        assert executor.start(jobs[-1], alone=True) and not executor.start(jobs[0])
        threads[0].begun[-1][-1].set_exception(ProcessFailed("no"))
        assert executor.wait_for_attempts() == [JobAttempt(jobs[-1], None, "no")]
    assert knobs["is_stopped"]() is True and threads[0].ended == {"cancel_futures": True}
