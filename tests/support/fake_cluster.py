"""A cluster that does what it is told: its client, its workers and a made clock, for who gets which."""

from types import SimpleNamespace

from hdrlab.course.classroom.executors import cluster
from hdrlab.course.classroom.executors.cluster import Cluster

ADDRESS = "tcp://127.0.0.1:8786"


class Future:
    """The future of a piece, whose end is set from outside."""

    def __init__(self):
        self.status, self.answer = "pending", None

    def done(self):
        return self.status != "pending"

    def result(self, timeout):
        assert timeout == 5
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer

    def exception(self):
        return self.answer


class Client:
    """A client of a cluster: its workers and their threads, and what was asked of it."""

    def __init__(self, **threads):
        self.threads, self.sent, self.cancelled, self.closed = threads, [], [], 0
        self.scheduler, self.versions, self.able = cluster.version(), {}, {}

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
        assert (
            function is cluster.run_remote_job and key.startswith("hdrlab-grade-") and pure is False
        )
        self.sent.append((task, *workers))
        return Future()

    def cancel(self, futures, *, force):
        assert force is True
        self.cancelled.append(list(futures))

    def close(self):
        self.closed += 1


def clustered(monkeypatch, **threads):
    """Return a Cluster of these workers and their threads, its client, and a made clock as `clock`."""
    clock = SimpleNamespace(now=1000.0, slept=[])

    def sleep(seconds):
        clock.slept.append(seconds)
        clock.now += seconds

    monkeypatch.setattr(cluster, "time", SimpleNamespace(monotonic=lambda: clock.now, sleep=sleep))
    client = Client(**threads)
    made = Cluster(ADDRESS, len, bool, timeout=7.0)
    made._client, made.clock = client, clock
    return made, client
