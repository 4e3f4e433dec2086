"""Grading jobs: the order in which they run, how often, and which result files stay."""

import os
import stat
import subprocess
import sys
from collections import deque
from pathlib import Path

import pytest

from hdrlab.course.classroom import jobs
from hdrlab.course.classroom.jobs import GradingJob, JobAttempt, JobResult
from hdrlab.errors import InputError


def make_jobs(*owners, key="k"):
    return [GradingJob(owner, Path(f"{owner}.py"), key) for owner in owners]


class ScriptedExecutor:
    """An executor whose attempts end as a script says.

    The script gives the outcomes of each owner's attempts: bytes are a result, a text is a failure,
    and a text with a question mark is a failure that does not count against the job.
    """

    def __init__(self, max_running=1, **script):
        self.max_running = max_running
        self.started = []
        self.running = deque()
        self.script = {owner: list(outcomes) for owner, outcomes in script.items()}

    def start(self, job, *, alone=False):
        assert job not in self.running
        if len(self.running) >= self.max_running or (alone and self.running):
            return False
        self.running.append(job)
        self.started.append(f"{job.owner}!" if alone else job.owner)
        return True

    def wait_for_attempts(self):
        assert self.running, "waits although nothing runs"
        job = self.running.popleft()
        outcomes = self.script.get(job.owner) or [b"right"]
        outcome = outcomes.pop(0) if len(outcomes) > 1 else outcomes[0]
        if isinstance(outcome, bytes):
            return [JobAttempt(job, outcome)]
        counts = not outcome.endswith("?")
        return [JobAttempt(job, None, outcome.rstrip("?"), counts=counts)]


def test_each_result_is_written_for_its_owner_alone_as_soon_as_it_is_there(tmp_path):
    folder = tmp_path / "new" / "results"
    first, second = make_jobs("a", "b")
    steps = jobs.run_jobs([first, second], ScriptedExecutor(2, a=[b"one"], b=[b"two"]), folder)
    assert next(steps) == JobResult(first, folder / "a.k.json")
    assert [path.name for path in folder.iterdir()] == ["a.k.json"]
    assert next(steps) == JobResult(second, folder / "b.k.json")
    assert next(steps, None) is None
    assert (folder / "a.k.json").read_bytes() == b"one"
    assert (folder / "b.k.json").read_bytes() == b"two"
    assert stat.S_IMODE((folder / "a.k.json").stat().st_mode) == 0o600
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700


@pytest.mark.parametrize(
    ("max_running", "script", "started", "finished"),
    [
        (1, {}, "a b c", "a b c"),
        (9, {}, "a b c", "a b c"),
        (2, {"a": ["no", b"yes"]}, "a b c a", "b c a"),
        (1, {"a": ["no", "no", b"yes"]}, "a b c a a", "b c a"),
        (1, {"a": ["no"]}, "a b c a a", "b c -a"),
        (3, {"a": ["lost?", b"yes"]}, "a b c a!", "b c a"),
        (1, {"a": ["lost?", b"yes"]}, "a a! b c", "a b c"),
        (1, {"a": ["lost?"] * 5 + [b"yes"]}, "a a! a! a! a! a! b c", "a b c"),
        (1, {"a": ["lost?", "no", "lost?", "no", "no"]}, "a a! b c a! a! a!", "b c -a"),
        (3, {"b": ["lost?", b"yes"], "c": ["lost?", b"yes"]}, "a b c c! b!", "a c b"),
    ],
)
def test_a_failed_job_is_tried_three_times_and_one_that_lost_its_worker_next_and_alone(
    max_running, script, started, finished, tmp_path
):
    executor = ScriptedExecutor(max_running, **script)
    results = list(jobs.run_jobs(make_jobs("a", "b", "c"), executor, tmp_path))
    assert " ".join(executor.started) == started
    owners = [result.job.owner if result.path else f"-{result.job.owner}" for result in results]
    assert " ".join(owners) == finished
    for result in results:
        assert bool(result.problem) == (result.path is None)


def test_a_long_problem_is_shortened(tmp_path):
    (result,) = jobs.run_jobs(make_jobs("a"), ScriptedExecutor(a=["n" * 5000]), tmp_path)
    assert "nnn" in result.problem
    assert len(result.problem) <= jobs.MAX_PROBLEM_LENGTH


def test_a_new_result_replaces_the_outdated_ones_of_its_owner_and_of_nobody_else(tmp_path):
    outdated = tmp_path / "a.1.json"
    of_others = [tmp_path / "b.1.json", tmp_path / "a.b.1.json", tmp_path / "a.txt"]
    for path in (outdated, *of_others):
        path.write_bytes(b"old")
    (failed,) = jobs.run_jobs(make_jobs("a"), ScriptedExecutor(a=["no"]), tmp_path)
    assert failed.path is None
    assert outdated.exists()
    list(jobs.run_jobs(make_jobs("a"), ScriptedExecutor(), tmp_path))
    assert not outdated.exists()
    assert (tmp_path / "a.k.json").exists()
    assert all(path.exists() for path in of_others)


def test_an_outdated_result_may_disappear_while_jobs_run(tmp_path):
    outdated = tmp_path / "a.1.json"
    outdated.write_bytes(b"old")
    steps = jobs.run_jobs(make_jobs("a"), ScriptedExecutor(), tmp_path)
    outdated.unlink()
    assert next(steps).path == tmp_path / "a.k.json"


def test_a_name_with_a_dot_has_its_own_results(tmp_path):
    dotted = tmp_path / "a.b.1.json"
    dotted.write_bytes(b"old")
    assert jobs.find_outdated_results(tmp_path, make_jobs("a")) == {}
    assert jobs.find_outdated_results(tmp_path, make_jobs("a.b", key="2")) == {"a.b": [dotted]}


def test_jobs_with_a_result_are_finished_until_it_is_deleted(tmp_path):
    both = make_jobs("a", "b")
    first, second = both
    jobs.write_private_file(jobs.result_path(tmp_path, second), b"x")
    finished, unfinished = jobs.split_finished(tmp_path, both)
    assert finished == [JobResult(second, tmp_path / "b.k.json", is_new=False)]
    assert unfinished == [first]
    jobs.delete_results(tmp_path, both)
    assert jobs.split_finished(tmp_path, both) == ([], both)


def test_two_jobs_of_one_owner_are_refused(tmp_path):
    with pytest.raises(ValueError, match="owner"):
        jobs.split_finished(tmp_path, [*make_jobs("a"), *make_jobs("a", key="other")])


def test_a_key_depends_on_where_its_parts_begin():
    keys = [jobs.make_key(*parts) for parts in ((), ("",), ("", ""), ("a", "bc"), ("ab", "c"))]
    assert len(set(keys)) == len(keys)


def test_a_file_is_on_the_disk_before_it_has_its_name_and_then_its_folder_is(tmp_path, monkeypatch):
    synced = []
    real_fsync = os.fsync

    def fsync(handle):
        status = os.fstat(handle)
        size = "folder" if stat.S_ISDIR(status.st_mode) else status.st_size
        synced.append((size, (tmp_path / "a").exists()))
        real_fsync(handle)

    monkeypatch.setattr(os, "fsync", fsync)
    jobs.write_private_file(tmp_path / "a", b"data")
    of_files = [entry for entry in synced if entry[0] != "folder"]
    assert of_files[0] == (4, False)
    assert synced[-1] == ("folder", True)
    assert (tmp_path / "a").read_bytes() == b"data"
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == 0o600


def test_a_file_is_written_where_a_folder_cannot_be_flushed(tmp_path, monkeypatch):
    monkeypatch.delattr(os, "O_DIRECTORY")
    jobs.write_private_file(tmp_path / "a", b"more")
    assert (tmp_path / "a").read_bytes() == b"more"


def test_a_private_folder_is_its_owners_also_where_it_was_everybodys(tmp_path):
    (tmp_path / "open").mkdir(mode=0o755)
    for folder in (tmp_path / "open", tmp_path / "a" / "b"):
        assert jobs.make_private(folder) == folder
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700


def test_a_folder_is_locked_by_one_run_and_cleared_of_half_written_files(tmp_path):
    folder = tmp_path / "a" / "results"
    with jobs.lock_folder(folder):
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
        with pytest.raises(ValueError, match="results"), jobs.lock_folder(folder):
            pass
        (folder / "in").mkdir()
        for name in (".hdrlab-0123456789ab", "in/.hdrlab-0123456789ab.json", "kept.json"):
            (folder / name).touch()
    with jobs.lock_folder(folder):
        assert not list(folder.rglob(".hdrlab-*"))
        assert (folder / "kept.json").exists()


HOLDER = """
import sys, time
from pathlib import Path
from hdrlab.course.classroom import jobs
with jobs.lock_folder(Path(sys.argv[1])):
    print("locked", flush=True)
    time.sleep(600)
"""


def test_a_process_keeps_others_out_of_its_folder_until_it_is_killed(tmp_path):
    command = [sys.executable, "-c", HOLDER, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as holder:
        assert holder.stdout.readline() == b"locked\n"
        with pytest.raises(InputError, match=tmp_path.name), jobs.lock_folder(tmp_path):
            pass
        other = subprocess.run(command, capture_output=True)
        assert other.returncode != 0
        assert b"InputError" in other.stderr
        holder.kill()
    with jobs.lock_folder(tmp_path):
        pass
