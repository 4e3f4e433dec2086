"""A killed run of grading is completed by the next one, and nothing is graded twice."""

import os
import random
import signal
import subprocess
import sys
import time
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from support import cluster_jobs

from hdrlab.course.classroom import jobs
from hdrlab.course.classroom.executors import processes
from hdrlab.course.students.roster import Roster, Student
from hdrlab.course.submissions import class_folder

pytestmark = [
    pytest.mark.grading,
    pytest.mark.skipif(os.name != "posix", reason="submissions here are ended by signals of POSIX"),
]

RUN = """
import sys
from pathlib import Path
sys.path.insert(0, {tests!r})
import test_interrupted_runs
test_interrupted_runs.graded(Path({folder!r}))
"""


def graded(home, work=cluster_jobs.grade_quickly, again=False):
    """Grade the class in a folder, and return the job results and the result files."""
    folder = home / "results"
    grading_jobs = cluster_jobs.make_jobs(home / "class")
    if again:
        jobs.delete_results(folder, grading_jobs)
    with jobs.lock_folder(folder):
        done, rest = jobs.split_finished(folder, grading_jobs)
        with processes.Processes(work, 2) as executor:
            done += jobs.run_jobs(rest, executor, folder)
    return done, {path.name: path.read_bytes() for path in sorted(folder.glob("*.json"))}


def test_nothing_is_graded_twice(tmp_path):
    first, results = graded(tmp_path)
    again, same = graded(tmp_path)
    assert all(result.is_new for result in first)
    assert not any(result.is_new for result in again)
    assert results == same
    assert len(cluster_jobs.read_started_jobs(tmp_path / "class")) == len(results) == 5


def test_only_changed_submissions_are_graded_again(tmp_path):
    graded(tmp_path)
    (tmp_path / "class" / "s4.py").write_text(f"{tmp_path / 'class' / 'begun'}\nother")
    again, results = graded(tmp_path)
    assert [result.job.owner for result in again if result.is_new] == ["s4"] and len(results) == 5
    assert sum(result.is_new for result in graded(tmp_path, again=True)[0]) == 5


class AtOnce:
    """An executor that runs a job in this process, and then calls a function."""

    def __init__(self, after):
        self.after = after
        self.ended = []

    def start(self, job, *, alone=False):
        self.ended.append(jobs.JobAttempt(job, b"{}"))
        return True

    def wait_for_attempts(self):
        self.after()
        ended, self.ended = self.ended, []
        return ended


@pytest.mark.quick
def test_an_old_result_that_is_removed_meanwhile_is_no_error(tmp_path):
    old = jobs.result_path(tmp_path, jobs.GradingJob("s0", tmp_path, "old"))
    jobs.write_private_file(old, b"{}")
    new_jobs = [jobs.GradingJob("s0", tmp_path, "new")]
    (done,) = jobs.run_jobs(new_jobs, AtOnce(old.unlink), tmp_path)
    assert list(tmp_path.iterdir()) == [done.path] and done.is_new


def test_a_submission_that_kills_its_process_is_reported_and_others_are_graded(tmp_path):
    (tmp_path / "alone").mkdir()
    _, alone = graded(tmp_path / "alone")
    done, results = graded(tmp_path, cluster_jobs.grade_and_kill_self)
    lost = [result for result in done if result.path is None]
    assert [result.job.owner for result in lost] == ["s3"]
    assert "3 times" in lost[0].problem
    assert "(-9)" in lost[0].problem
    assert results == {name: data for name, data in alone.items() if not name.startswith("s3.")}


def test_an_endless_submission_is_stopped(tmp_path):
    one_job = cluster_jobs.make_jobs(tmp_path / "class", 1)
    with processes.Processes(cluster_jobs.never_finish, 1, timeout=0.5) as executor:
        (done,) = jobs.run_jobs(one_job, executor, tmp_path / "results")
    assert done.path is None and "too long" in done.problem
    assert list((tmp_path / "results").iterdir()) == []


def test_an_error_of_a_job_is_reported_in_one_line(tmp_path):
    done, results = graded(tmp_path, cluster_jobs.raise_error)
    assert {result.problem for result in done} == {
        "it ended 3 times without a result: ValueError: expected this, got that"
    }
    assert not results


def test_two_runs_cannot_write_to_the_same_folder(tmp_path):
    (tmp_path / "feedback").mkdir()
    (tmp_path / "feedback" / ".hdrlab-0123456789ab.html").write_text(
        "half of a page, by a run that was killed"
    )
    with jobs.lock_folder(tmp_path):
        with pytest.raises(ValueError, match="another run"), jobs.lock_folder(tmp_path):
            pass
        assert not list((tmp_path / "feedback").iterdir())
    with jobs.lock_folder(tmp_path):
        pass


def test_an_interrupted_run_stops_its_jobs(tmp_path):
    with (
        pytest.raises(KeyboardInterrupt),
        processes.Processes(cluster_jobs.never_finish, 2) as executor,
    ):
        for job in cluster_jobs.make_jobs(tmp_path / "class", 2):
            assert executor.start(job)
        while len(cluster_jobs.read_started_jobs(tmp_path / "class")) < 2:
            assert not executor.wait_for_attempts()
        raise KeyboardInterrupt
    for _, process, _ in cluster_jobs.read_started_jobs(tmp_path / "class"):
        with pytest.raises(ProcessLookupError):
            os.kill(process, 0)


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="kills a group of processes")
def test_the_next_run_finishes_a_killed_run(tmp_path):
    (tmp_path / "whole").mkdir()
    _, whole = graded(tmp_path / "whole")
    rng = random.Random(5)
    home = tmp_path / "killed"
    home.mkdir()
    script = RUN.format(tests=str(Path(__file__).parents[1]), folder=str(home))
    for kill in range(4):
        run = subprocess.Popen([sys.executable, "-c", script], start_new_session=True)
        time.sleep(rng.uniform(0.3, 2.0))
        if kill % 2:
            run.kill()  # only the run; its child processes may still write results
            run.wait()
            time.sleep(0.3)
        with suppress(ProcessLookupError):  # nothing of it is left
            os.killpg(run.pid, signal.SIGKILL)
        run.wait()
    done, results = graded(home)
    assert results == whole
    assert len(done) == 5 and all(result.path for result in done)


def test_files_are_matched_with_their_owners(tmp_path):
    roster = Roster(
        (
            Student("b1", "A", "team1"),
            Student("b2", "B", "team1"),
            Student("b12", "C", "b12"),
            Student("b3", "D", "b3"),
        )
    )
    for name in ("B2_hw2.ipynb", "b12.py", "b123.py", "stranger.zip", "notes.txt"):
        (tmp_path / name).write_text(name)
    (tmp_path / "b3").mkdir()
    (tmp_path / "b3" / "hw2.ipynb").write_text("x")
    (tmp_path / "team1-late.ipynb").write_text("later")
    (tmp_path / "b3" / "link.py").symlink_to("/etc/passwd")
    noon = datetime(2026, 3, 1, 12, tzinfo=UTC)
    times = {"B2_hw2.ipynb": noon, "team1-late.ipynb": noon + timedelta(hours=1)}
    scan = class_folder.find(tmp_path, roster, times)
    assert {team: submission.path.name for team, submission in scan.submissions.items()} == {
        "team1": "team1-late.ipynb",
        "b12": "b12.py",
        "b3": "hw2.ipynb",
    }
    assert scan.submissions["team1"].students == ("b1", "b2")
    assert len(scan.notes) == 6 and any("B2_hw2" in note for note in scan.notes)
