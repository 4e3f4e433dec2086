"""A job on a worker of a cluster: what is sent, what comes back, and when it ends."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from hdrlab.course.classroom.executors import cluster
from hdrlab.course.classroom.executors.cluster import RemoteJob
from hdrlab.course.classroom.jobs import GradingJob
from hdrlab.course.grading import grader
from hdrlab.course.sandbox import subprocess_runner
from hdrlab.course.sandbox.subprocess_runner import LIBRARY


def test_a_version_is_a_digest_of_the_source_and_its_tables(monkeypatch, tmp_path):
    files = sorted(path for path in LIBRARY.rglob("*.*") if path.suffix in (".py", ".toml"))
    assert cluster.version().endswith(f"({grader.specification(files)[:8]})")
    assert any(path.suffix == ".toml" for path in files)


@pytest.mark.parametrize("fails", [False, True])
def test_a_worker_grades_a_job_from_its_bytes_and_marks_success_or_failure(fails, monkeypatch):
    seen = []

    def run(work, job, *, timeout, is_stopped):
        seen.append((work, job.owner, job.path.name, job.path.read_bytes(), timeout, is_stopped))
        if fails:
            raise subprocess_runner.ProcessFailed("it fails")
        return b"result"

    monkeypatch.setattr(cluster.subprocess_runner, "run", run)
    monkeypatch.setattr(cluster, "_watch_cancellation", lambda: "watched")
    ready = []
    task = RemoteJob(
        len,
        lambda: ready.append(1),
        GradingJob("ada", Path("/far/hw.py"), "k"),
        b"x",
        3.0,
        cluster.version(),
    )
    assert cluster.run_remote_job(task) == (b"-it fails" if fails else b"+result")
    assert seen == [(len, "ada", "hw.py", b"x", 3.0, "watched")] and ready == [1]
    with pytest.raises(ValueError, match="its hdrlab is .*, .*other"):
        cluster.run_remote_job(replace(task, version="other"))
    assert len(seen) == 1


def test_a_remote_job_stops_when_it_is_forgotten_or_cancelled(monkeypatch):
    tasks = {
        "mine": SimpleNamespace(state="executing"),
        "other": SimpleNamespace(state="cancelled"),
    }
    worker = SimpleNamespace(get_current_task=lambda: "mine", state=SimpleNamespace(tasks=tasks))
    monkeypatch.setattr(cluster.distributed, "get_worker", lambda: worker)
    stopped = cluster._watch_cancellation()
    assert stopped() is False
    tasks["mine"].state = "cancelled"
    assert stopped() is True
    del tasks["mine"]
    assert stopped() is True
