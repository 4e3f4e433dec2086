"""A class graded on a cluster has the same results, also when workers are killed.

The cluster is a real one on this machine: a scheduler and workers in separate processes.
"""

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from unittest import mock

import pytest
from distributed import Client, LocalCluster
from support import cluster_jobs

import hdrlab
from hdrlab.course.classroom import jobs
from hdrlab.course.classroom.executors import cluster, processes

pytestmark = pytest.mark.grading

RUN = """
import sys
from pathlib import Path
sys.path[:0] = [{tests!r}, {tests!r} + "/course"]
import test_cluster
from support import cluster_jobs
test_cluster.graded({address!r}, Path({folder!r}), cluster_jobs.grade_slowly)
"""


@contextmanager
def clustered(workers, threads, at_once=0):
    """Start a scheduler and so many workers, at once or a little later."""
    knobs = {"threads_per_worker": threads, "dashboard_address": "127.0.0.1:0", "silence_logs": 50}
    ended = threading.Event()
    with (
        tempfile.TemporaryDirectory() as scratch,  # what a worker that is killed leaves
        mock.patch.dict(os.environ, {"TMPDIR": scratch}),
        LocalCluster(
            n_workers=at_once, processes=True, local_directory=scratch, **knobs
        ) as running,
    ):
        keeper = threading.Thread(target=_keep, args=(running, workers, at_once, ended))
        keeper.start()
        try:
            yield running
        finally:
            ended.set()
            keeper.join()


def _keep(running, workers, requested, ended):
    """Start missing workers again: a nanny does not restart a worker that was killed while it started."""
    met = time.monotonic() - 100 * (requested == 0)
    while not ended.wait(0.5):
        if len(running.scheduler.workers) >= workers:
            met = time.monotonic()
        elif time.monotonic() > met + 10:
            requested = max(requested + 1, workers)
            met = time.monotonic()
            running.scale(requested)


@pytest.fixture(scope="module")
def address():
    """Start a scheduler and two workers, and return the address of the scheduler."""
    with clustered(2, 1, at_once=2) as running:
        yield running.scheduler_address


def graded(address, home, work=cluster_jobs.grade_quickly, **knobs):
    """Grade the class in a folder, and return the job results and the result files."""
    folder = home / "results"
    with jobs.lock_folder(folder):
        done, rest = jobs.split_finished(folder, cluster_jobs.make_jobs(home / "class"))
        with cluster.Cluster(address, work, **knobs) as executor:
            done += jobs.run_jobs(rest, executor, folder)
    return done, contents(folder)


def contents(folder):
    """Return the bytes of all files of a folder, except for its lock."""
    return {
        path.name: path.read_bytes()
        for path in sorted(folder.iterdir())
        if path.name != jobs.LOCK_NAME
    }


def whole(home):
    """Return the results of the same class, graded in this process."""
    with processes.Processes(cluster_jobs.grade_quickly, 2) as executor:
        list(jobs.run_jobs(cluster_jobs.make_jobs(home / "class"), executor, home / "here"))
    return contents(home / "here")


def test_a_cluster_gives_the_same_results_as_the_local_machine(address, tmp_path):
    done, results = graded(address, tmp_path)
    assert results == whole(tmp_path)
    assert len(results) == 5
    assert all(result.is_new for result in done)
    again, same = graded(address, tmp_path)
    assert same == results and not any(result.is_new for result in again)


def test_the_job_of_a_killed_worker_is_done_by_another(address, tmp_path):
    def kill():
        started = cluster_jobs.read_started_jobs(tmp_path / "class")
        while not started:
            time.sleep(0.05)
            started = cluster_jobs.read_started_jobs(tmp_path / "class")
        _, _, worker = started[0]
        os.kill(worker, signal.SIGKILL)

    killer = threading.Thread(target=kill)
    killer.start()
    done, results = graded(address, tmp_path, cluster_jobs.grade_slowly)
    killer.join()
    noted = cluster_jobs.read_started_jobs(tmp_path / "class")
    first = [worker for owner, _, worker in noted if owner == noted[0][0]]
    assert len(noted) == 6 and len(set(first)) == 2
    assert results == whole(tmp_path) and all(result.path for result in done)


def test_a_submission_that_kills_its_worker_is_reported_and_all_others_are_graded(
    address, tmp_path
):
    done, results = graded(address, tmp_path, cluster_jobs.kill_worker)
    owners = [owner for owner, *_ in cluster_jobs.read_started_jobs(tmp_path / "class")]
    (lost,) = [result for result in done if result.path is None]
    assert lost.job.owner == "s3" and "3 times" in lost.problem and "was lost" in lost.problem
    assert owners.count("s3") == 3 and len(owners) == 7
    assert results == {
        name: data for name, data in whole(tmp_path).items() if not name.startswith("s3.")
    }


def test_jobs_that_share_a_worker_with_a_fatal_one_are_still_graded(tmp_path):
    with clustered(1, 4) as running:
        assert not running.scheduler.workers
        done, results = graded(
            running.scheduler_address, tmp_path, cluster_jobs.kill_worker_beside_others
        )
    (lost,) = [result for result in done if result.path is None]
    assert lost.job.owner == "s3" and len(results) == 4
    assert [owner for owner, *_ in cluster_jobs.read_started_jobs(tmp_path / "class")].count(
        "s3"
    ) == 4


def test_no_worker_runs_more_jobs_than_it_has_threads(tmp_path):
    with clustered(
        2, 1, at_once=2
    ) as running:  # its own: where a worker was killed, there may be one too many
        with cluster.Cluster(running.scheduler_address, cluster_jobs.never_finish) as executor:
            started = [executor.start(job) for job in cluster_jobs.make_jobs(tmp_path / "class")]
            assert started == [True, True, False, False, False]
            while len(cluster_jobs.read_started_jobs(tmp_path / "class")) < 2:
                assert not executor.wait_for_attempts()
        until = time.monotonic() + 300
        # they were cancelled with the run
        while any(map(alive, cluster_jobs.read_started_jobs(tmp_path / "class"))):
            assert time.monotonic() < until
            time.sleep(0.1)


def alive(noted):
    with suppress(ProcessLookupError):
        os.kill(noted[1], 0)
        return True
    return False


def test_the_next_run_finishes_a_killed_run_whose_jobs_have_ended(address, tmp_path):
    script = RUN.format(tests=str(Path(__file__).parents[1]), address=address, folder=str(tmp_path))
    run = subprocess.Popen([sys.executable, "-c", script])
    while not (tmp_path / "results").is_dir() or not list((tmp_path / "results").glob("s*.json")):
        assert run.poll() is None
        time.sleep(0.05)
    run.kill()
    run.wait()
    done, results = graded(address, tmp_path)
    assert results == whole(tmp_path) and 1 <= sum(not result.is_new for result in done) < 5
    assert not any(map(alive, cluster_jobs.read_started_jobs(tmp_path / "class")))


def test_a_submission_that_never_ends_is_stopped(address, tmp_path):
    (job,) = cluster_jobs.make_jobs(tmp_path / "class", 1)
    with cluster.Cluster(address, cluster_jobs.never_finish, timeout=0.5) as executor:
        (done,) = jobs.run_jobs([job], executor, tmp_path / "results")
    assert done.path is None and "3 times" in done.problem and "too long" in done.problem


@pytest.mark.parametrize("nowhere", ["tcp://127.0.0.1:1", "nowhere", "http://a:1"])
def test_a_missing_cluster_is_an_error(nowhere, tmp_path, monkeypatch):
    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 1.0)  # the client does not retry for long
    with pytest.raises(ValueError, match="Dask cluster at"):
        graded(nowhere, tmp_path)


def test_a_lost_cluster_is_an_error(tmp_path):
    with (
        clustered(0, 1) as running,
        pytest.raises(ValueError, match="is lost"),
    ):
        threading.Timer(2, running.close).start()
        graded(running.scheduler_address, tmp_path, cluster_jobs.never_finish)


def rename(version):
    hdrlab.__version__ = version


def unable():
    raise RuntimeError("no strict tier here")


def test_a_different_hdrlab_on_the_cluster_is_an_error_with_both_versions(address, tmp_path):
    with Client(address, set_as_default=False) as client:
        client.wait_for_workers(2)
        client.run(rename, "0.0.7")
        try:
            with pytest.raises(ValueError, match=r"0\.0\.7") as error:
                graded(address, tmp_path)
            assert hdrlab.__version__ in str(error.value)
        finally:
            client.run(rename, hdrlab.__version__)
    job = cluster_jobs.make_jobs(tmp_path / "class", 1)[0]
    task = cluster.RemoteJob(
        cluster_jobs.grade_quickly, cluster.version, job, b"", 1.0, "0.0.7 (of another)"
    )
    with pytest.raises(ValueError, match=r"0\.0\.7 \(of another\)"):  # of a worker that joins later
        cluster.run_remote_job(task)


def test_the_error_names_a_worker_without_the_tier(address, tmp_path):
    with pytest.raises(ValueError, match="tcp://.* cannot .*work: no strict tier here"):
        graded(address, tmp_path, check_available=unable)


def die_once(mark):
    with suppress(FileExistsError):
        mark.touch(exist_ok=False)
        os.kill(os.getpid(), signal.SIGKILL)


def test_a_worker_lost_during_the_check_does_not_end_the_run(tmp_path):
    with clustered(2, 1, at_once=2) as running:
        ready = partial(die_once, tmp_path / "died")
        done, results = graded(running.scheduler_address, tmp_path, check_available=ready)
    assert (tmp_path / "died").exists()
    assert results == whole(tmp_path) and not any(result.problem for result in done)
