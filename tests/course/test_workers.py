"""Jobs on the workers of a fake cluster: which worker gets which job, and who is blamed for a failure."""

from functools import partial

import pytest
from distributed import KilledWorker
from support import fake_cluster
from support.fake_cluster import ADDRESS

from hdrlab.course.classroom.executors import cluster
from hdrlab.course.classroom.jobs import GradingJob, JobAttempt


@pytest.fixture
def clustered(monkeypatch):
    """clustered(a=2, b=1) -> a Cluster of workers with so many threads, and its client."""
    return partial(fake_cluster.make_cluster, monkeypatch)


@pytest.fixture
def job(tmp_path):
    """job(owner) -> a GradingJob with an existing file."""

    def job(owner="ada"):
        (tmp_path / f"{owner}.py").write_bytes(owner.encode())
        return GradingJob(owner, tmp_path / f"{owner}.py", "key")

    return job


# Who gets which


def test_a_job_goes_to_the_worker_with_the_most_free_slots(clustered, job):
    made, client = clustered(a=1, b=3)
    begun = [made.start(job(f"p{k}")) for k in range(5)]
    assert begun == [True] * 4 + [False]
    assert [worker for _, worker in client.sent] == ["b", "b", "a", "b"]
    task = client.sent[0][0]
    assert task == cluster.RemoteJob(len, bool, job("p0"), b"p0", 7.0, cluster.version())


def test_a_job_that_must_run_alone_waits_for_an_idle_worker(clustered, job):
    made, client = clustered(a=2)
    assert made.start(job("first")) and not made.start(job("doubted"), alone=True)
    (future,) = made._running
    future.status = "finished"
    future.answer = b"+1"
    assert made.wait_for_attempts() == [JobAttempt(job("first"), b"1")]
    assert made.start(job("doubted"), alone=True) and not made.start(job("next"))
    client.threads["b"] = 1
    assert made.start(job("next")) and [worker for _, worker in client.sent] == ["a", "a", "b"]
    (future, _) = made._running
    future.status = "finished"
    future.answer = b"+1"
    made.wait_for_attempts()
    assert made.start(job("more")) and client.sent[-1][1] == "a"


def test_without_workers_for_two_minutes_the_run_ends(clustered, job):
    made, client = clustered()
    made._last_worker_time = 1000.0
    made.clock.now = 1120.0
    assert not made.start(job())
    client.threads["a"] = 1
    assert made.start(job())
    client.threads.clear()
    made.clock.now = 1240.0
    assert not made.start(job())
    made.clock.now = 1240.1
    with pytest.raises(ValueError, match=f"cluster at {ADDRESS} has had no worker for 120 s"):
        made.start(job())


def test_a_lost_cluster_is_reported(clustered, job):
    made, client = clustered(a=1)
    client.threads = OSError("the  line\nis cut")
    with pytest.raises(ValueError, match="is lost; finished results are kept: .*line is cut$"):
        made.start(job())


# How they end


def ended(made, status, answer=None, which=0):
    future = list(made._running)[which]
    future.status = status
    future.answer = answer
    return made.wait_for_attempts()


@pytest.mark.parametrize(
    ("status", "answer", "ending"),
    [
        ("finished", b"+result", (b"result", "", True)),
        ("finished", b"+", (b"", "", True)),
        ("finished", b"-it fails", (None, "it fails", True)),
        ("cancelled", None, (None, "it was canceled", False)),
        ("lost", None, (None, "it was canceled", False)),
        ("error", KilledWorker("task", None, 3), (None, "its worker a was lost", True)),
    ],
)
def test_a_job_ends_with_its_result_or_the_reason_for_none(status, answer, ending, clustered, job):
    made, client = clustered(a=2)
    made.start(job(), alone=True)
    assert made.wait_for_attempts() == [] and set(made.clock.slept) == {0.05}
    waited = len(made.clock.slept)
    assert 10 <= waited <= 11
    assert ended(made, status, answer) == [JobAttempt(job(), *ending)]
    assert not made._running and not made._reserved_workers and len(made.clock.slept) == waited
    assert client.cancelled[-1] == []


def test_a_job_runs_until_its_result_has_arrived(clustered, job):
    made, _ = clustered(a=1)
    made.start(job())
    assert ended(made, "finished", TimeoutError()) == [] and len(made._running) == 1
    assert ended(made, "of its own") == []
    assert ended(made, "finished", b"+1") == [JobAttempt(job(), b"1")]


def test_an_error_on_a_worker_ends_the_run(clustered, job):
    made, _ = clustered(a=1)
    made.start(job())
    with pytest.raises(ValueError, match="cluster cannot .*work: no walls"):
        ended(made, "error", RuntimeError("no walls"))


def test_a_lost_worker_is_blamed_on_a_job_that_ran_alone(clustered, job):
    made, client = clustered(a=2, b=1, c=1)
    for owner in ("p", "q", "r", "s"):
        made.start(job(owner))
    places = {task.job.owner: worker for task, worker in client.sent}
    assert sorted(places.values()) == ["a", "a", "b", "c"]
    gone = [future for future, running in made._running.items() if running.worker in "ab"]
    del client.threads["a"], client.threads["b"]
    attempts = made.wait_for_attempts()
    assert {
        attempt.job.owner: (attempt.result, attempt.problem, attempt.counts) for attempt in attempts
    } == {
        owner: (None, f"its worker {worker} was lost", worker == "b")
        for owner, worker in places.items()
        if worker != "c"
    }
    assert client.cancelled == [gone]
    assert [running.worker for running in made._running.values()] == ["c"]


def test_a_job_that_kills_workers_is_given_up_and_the_others_run(clustered, job):
    made, client = clustered(a=2)
    made.start(job("p"))
    made.start(job("q"))
    first = next(iter(made._running))
    assert ended(made, "error", KilledWorker("task", None, 3)) == [
        JobAttempt(job("p"), None, "its worker a was lost", False)
    ]
    assert client.cancelled[0] == [first] and len(made._running) == 1


# Its beginning and its end


@pytest.fixture
def entered(clustered, monkeypatch):
    """entered(options of the client) -> the client of an entered Cluster."""

    def entered(error=None, **knobs):
        made, client = clustered(a=1)
        for name, value in knobs.items():
            setattr(client, name, value)

        def connected(address, *, timeout, set_as_default):
            assert (address, timeout, set_as_default) == (ADDRESS, 5, False)
            if error is not None:
                raise error
            return client

        monkeypatch.setattr(cluster, "Client", connected)
        return made, client

    return entered


def test_a_run_that_ends_cancels_its_running_jobs(entered, job):
    made, client = entered()
    with made:
        made.start(job())
        assert client.closed == 0
    assert client.cancelled == [list(made._running)] and client.closed == 1


@pytest.mark.parametrize(
    ("knobs", "message"),
    [
        ({"scheduler": "0.1"}, "the scheduler of the cluster has hdrlab 0.1, expected"),
        ({"versions": {"w": "0.2"}}, "w of the cluster has hdrlab 0.2, expected"),
        (
            {"able": {"w": RuntimeError("no walls")}},
            "w of the cluster cannot do the work: no walls",
        ),
        ({"versions": {"w": OSError()}, "able": {"v": None, "w": OSError()}}, ""),
    ],
)
def test_a_cluster_of_another_hdrlab_or_without_the_tier_is_refused(knobs, message, entered):
    made, client = entered(**knobs)
    if message:
        with pytest.raises(ValueError, match=message), made:
            pass
        assert client.closed == 1
    else:
        with made:
            pass


def test_a_missing_cluster_is_reported_with_its_address(entered):
    for error, why in (
        (OSError("x"), "there is none$"),
        (ValueError("odd"), "there is none: odd$"),
    ):
        made, _ = entered(error)
        with pytest.raises(ValueError, match=f"Dask cluster at {ADDRESS}, {why}"), made:
            pass
    made, client = entered()
    made._address = "nowhere://x"
    with (
        pytest.raises(ValueError, match="Dask cluster at nowhere://x, there is none: "),
        made,
    ):
        pass
    assert client.closed == 0
