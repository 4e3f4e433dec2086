"""Runs of grading that are killed at random moments: the results do not change.

The tests kill the command that instructors use, the processes that it has started, and the workers of
a cluster. The class is small and is graded in the practice tier.
"""

import os
import random
import signal
import subprocess
import sys
import threading
import time
import zipfile
from contextlib import suppress
from datetime import UTC, datetime
from itertools import zip_longest
from pathlib import Path

import pytest
import test_cluster
from support import linux_processes
from support.one_task_homework import CORRECT_CODE, PLAN

from hdrlab.course.classroom import jobs, run as classroom
from hdrlab.course.grading import doctor, grader, results
from hdrlab.course.plan import GradingOptions, Homework, Task

pytestmark = pytest.mark.grading

HIDDEN = """
import pytest

@pytest.mark.points(2)
def test_the_hat_weights_mid_gray_most(subject):
    assert subject.hat(256).argmax() in (127, 128)
"""
FLAT = "import numpy as np\n\ndef hat(n=256):\n    return np.ones(n)\n"
LETHAL = "import os\n\ndef hat(n=256):\n    os._exit(0)\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Make a class of four: a right submission, a wrong one, one that ends its process, and an archive."""
    home = tmp_path_factory.mktemp("class")
    (home / "in").mkdir()
    (home / "checks").mkdir()
    for name, source in {"b1": CORRECT_CODE, "b2": FLAT, "b3": LETHAL}.items():
        (home / "in" / f"{name}.py").write_text(source)
    with zipfile.ZipFile(home / "in" / "b4.zip", "w") as archive:
        archive.writestr("hw2.py", CORRECT_CODE)
    (home / "checks" / "test_hat.py").write_text(HIDDEN)
    (home / "roster.csv").write_text("student,name\nb1,Ada\nb2,Bo\nb3,Cy\nb4,Di\nb5,Ed\n")
    (home / "plan.toml").write_text(PLAN)
    return home


def begin(home, out, *more):
    words = [
        "grade",
        "in",
        "--homework",
        "hw2",
        "--tier",
        "practice",
        "--plan",
        "plan.toml",
        "-o",
        str(out),
    ]
    words += ["--roster", "roster.csv", "--hidden", "checks", *more]
    scratch = home / "scratch"
    scratch.mkdir(exist_ok=True)
    environment = os.environ | {"TMPDIR": str(scratch)}
    command = [sys.executable, "-m", "hdrlab", *words]
    return subprocess.Popen(
        command, cwd=home, env=environment, stderr=subprocess.PIPE, start_new_session=True
    )


def contents(folder):
    """Return the bytes of all files of a folder, except for its lock."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and path.name != jobs.LOCK_NAME
    }


def different(some, other):
    """Return the files that differ, each with the first line that differs in both folders."""
    differences = {}
    for name in sorted({*some, *other}):
        if some.get(name) != other.get(name):
            both = [files.get(name, b"(no file)").splitlines() for files in (some, other)]
            differences[name] = next(
                filter(lambda pair: len({*pair}) > 1, zip_longest(*both)), "the last byte"
            )
    return differences


def finished(home, out):
    """Run to the end, and return the files."""
    run = begin(home, out)
    output = run.communicate(timeout=1800)[1].decode()
    assert run.returncode == 0 and "warning" not in output, output
    return contents(out)


def family(pid):
    """Return a process and all its descendants."""
    parents = {
        process: int(stat.rpartition(b")")[2].split()[1])
        for process, stat in linux_processes.read_proc_files("stat").items()
    }
    family = [pid]
    for process in family:
        family += [child for child, parent in parents.items() if parent == process]
    return family[1:]


def besieged(run, rng, most, others=list):
    """Kill the run, or one of its child processes or of the others, until it ends; return the number of
    kills.
    """
    kills = 0
    while kills < most:
        with suppress(subprocess.TimeoutExpired):
            run.wait(rng.uniform(0.2, 4.0))
            break
        started = [*family(run.pid), *others()]
        with suppress(ProcessLookupError):
            os.kill(
                rng.choice(started) if started and rng.random() < 0.6 else run.pid, signal.SIGKILL
            )
        kills += 1
    return kills


def graded(home, out, rng, most, *more, others=list):
    """Run and kill again and again until all are graded; return the files and the number of kills."""
    kills = 0
    missing = "warning"
    while "warning" in missing:  # of one that was killed three times: the next run grades it
        run = begin(home, out, *more)
        now = besieged(run, rng, most - kills, others)
        missing = run.communicate(timeout=1800)[1].decode()
        stopped = (
            now >= doctor.MAX_ATTEMPTS
            and "sandbox did not start: it was ended by signal 9" in missing
        )
        assert run.returncode in (0, -signal.SIGKILL) or stopped, missing
        kills += now
        missing = "warning" if run.returncode else missing
    return contents(out), kills


@pytest.fixture(scope="module")
def whole(folder):
    """Return the files of a run that was not killed."""
    return finished(folder, folder / "whole")


PROC = pytest.mark.skipif(
    not Path("/proc/self/stat").exists(), reason="finds a run's processes in /proc"
)


@PROC
def test_after_a_kill_at_any_of_twenty_moments_the_results_are_the_same_bytes(folder, whole):
    assert sum(name.startswith(("results/", "feedback/")) for name in whole) == 4 * 6
    assert {"gradebook.csv", "canvas.csv", "moodle.csv", "what_if.csv", "class.html"} <= set(whole)
    rng = random.Random(9)
    kills = 0
    rounds = 0
    while kills < 20:
        rounds += 1
        results, more = graded(folder, folder / f"round{rounds}", rng, 20 - kills)
        assert different(results, whole) == {}
        kills += more
    until = time.monotonic() + 300
    while linux_processes.processes_using(folder / "scratch") and time.monotonic() < until:
        time.sleep(0.05)
    assert not linux_processes.processes_using(folder / "scratch")


@PROC
def test_a_cluster_whose_workers_are_killed_gives_the_same_bytes(folder, whole):
    with test_cluster.clustered(2, 1, at_once=2) as running:
        words = "--cluster", running.scheduler_address
        undisturbed, _ = graded(folder, folder / "cluster", random.Random(1), 0, *words)
        assert different(undisturbed, whole) == {}
        results, kills = graded(
            folder, folder / "killed", random.Random(4), 6, *words, others=workers
        )
    assert different(results, whole) == {} and kills


def workers():
    """Return the processes of a cluster that this process has started, and their child processes."""
    command_lines = linux_processes.read_proc_files("cmdline")
    spawned = [
        child for child in family(os.getpid()) if b"spawn_main" in command_lines.get(child, b"")
    ]
    return [process for child in spawned for process in (child, *family(child))]


@pytest.fixture
def killing():
    """killing(*words) starts a thread that kills the first new child process whose command has these
    words.
    """
    threads = []

    def begin(*words, below=False):
        threads.append(threading.Thread(target=_kill, args=(words, below)))
        threads[-1].start()

    yield begin
    for thread in threads:
        thread.join()


def _kill(words, below):
    until = time.monotonic() + 300
    while time.monotonic() < until:
        command_lines = linux_processes.read_proc_files("cmdline")
        for process in family(os.getpid()):
            victims = family(process) if below else [process]
            if victims and all(word in command_lines.get(process, b"") for word in words):
                with suppress(ProcessLookupError):
                    return os.kill(victims[0], signal.SIGKILL)
        time.sleep(0.01)


SLOW = CORRECT_CODE.replace("    return", "    import time\n    time.sleep(0.3)\n    return")
HAT = Homework(
    "hw2", "T", datetime(2026, 10, 23, tzinfo=UTC), (Task("hat", "core.weights.hat", 10),)
)


@PROC
def test_checks_that_are_ended_from_outside_are_no_result(tmp_path, killing):
    (tmp_path / "b1.py").write_text(SLOW)
    killing(b"pytest", b"--job")
    with pytest.raises(ValueError, match="ended from outside, by signal 9"):
        grader.grade(tmp_path / "b1.py", HAT, GradingOptions(tier="practice"))


@PROC
def test_a_function_whose_process_something_kills_is_graded_again(tmp_path, killing):
    (tmp_path / "b1.py").write_text(SLOW)
    job = jobs.GradingJob("b1", tmp_path / "b1.py", "key")
    class_grader = classroom.Grader(HAT, GradingOptions(tier="practice"))
    killing(b"supervisor.py", below=True)
    once = grader.grade(job.path, HAT, class_grader.conditions)
    assert "no answer" in {check.outcome for check in once.checks}
    killing(b"supervisor.py", below=True)
    result = results.from_json(class_grader.grade(job))
    assert {check.outcome for check in result.checks} == {"holds"}
