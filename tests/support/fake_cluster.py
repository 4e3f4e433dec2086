"""A fake Dask client with workers and a clock that a test controls."""

from types import SimpleNamespace

from hdrlab.course.classroom.executors import cluster
from hdrlab.course.classroom.executors.cluster import Cluster

ADDRESS = "tcp://127.0.0.1:8786"


class FakeFuture:
    """The future of a job; the test sets its `status` and its `answer`, a result or an error."""

    def __init__(self):
        self.status = "pending"
        self.answer = None

    def done(self):
        return self.status != "pending"

    def result(self, timeout):
        assert timeout == 5
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer

    def exception(self):
        return self.answer


class FakeClient:
    """A client of a cluster that records what is submitted to it.

    Attributes
    ----------
    threads : the number of threads of each worker, by its name; an Exception is raised instead
    sent : (job, worker) of each submitted job
    cancelled : the futures of each call of `cancel`
    closed : how often the client was closed
    scheduler, versions, able : what the scheduler and the workers answer about their versions and
        about the sandbox
    """

    def __init__(self, **threads):
        self.threads = threads
        self.sent = []
        self.cancelled = []
        self.closed = 0
        self.scheduler = cluster.version()
        self.versions = {}
        self.able = {}

    def nthreads(self):
        if isinstance(self.threads, Exception):
            raise self.threads
        return dict(self.threads)

    def run_on_scheduler(self, function):
        return self.scheduler

    def run(self, function, on_error):
        assert on_error == "return"
        return self.versions if function is cluster.version else self.able

    def submit(self, function, task, *, key, workers, pure):
        assert function is cluster.run_remote_job
        assert key.startswith("hdrlab-grade-")
        assert pure is False
        self.sent.append((task, *workers))
        return FakeFuture()

    def cancel(self, futures, *, force):
        assert force is True
        self.cancelled.append(list(futures))

    def close(self):
        self.closed += 1


def make_cluster(monkeypatch, **threads):
    """Return a Cluster with a FakeClient, and the client.

    The attribute `clock` of the Cluster has the time `now` and the waits `slept`, in seconds. A wait
    advances the clock and returns immediately.

    Parameters
    ----------
    threads : the number of threads of each worker, by its name
    """
    clock = SimpleNamespace(now=1000.0, slept=[])

    def sleep(seconds):
        clock.slept.append(seconds)
        clock.now += seconds

    fake_time = SimpleNamespace(monotonic=lambda: clock.now, sleep=sleep)
    monkeypatch.setattr(cluster, "time", fake_time)
    client = FakeClient(**threads)
    executor = Cluster(ADDRESS, len, bool, timeout=7.0)
    executor._client = client
    executor.clock = clock
    return executor, client
