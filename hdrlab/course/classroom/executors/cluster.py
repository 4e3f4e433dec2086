"""An executor that runs jobs on a Dask cluster, whose workers have hdrlab installed.

Workers need no shared disk: the bytes of a submission are sent with its job, and the bytes of the
result come back. Nothing is kept on the worker. This module chooses the worker of each job, and
gives no worker more jobs than it has threads, so that it knows which jobs ran where when a worker
is lost. If a lost worker had a single job, the loss counts against that job. If it had several, it
counts against none, and each is tried again alone on a worker.
"""

import contextlib
import secrets
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Self

import dask
import distributed
from distributed import Client, Future, KilledWorker
from distributed.comm import resolve_address

import hdrlab
from hdrlab.course import scratch
from hdrlab.course.classroom.executors.processes import JOB_TIMEOUT_SECONDS, WAIT_SECONDS
from hdrlab.course.classroom.jobs import GradingJob, JobAttempt, Work
from hdrlab.course.grading import grader
from hdrlab.course.sandbox import subprocess_runner
from hdrlab.course.sandbox.subprocess_runner import LIBRARY, ProcessFailed
from hdrlab.errors import InputError

CONNECT_SECONDS = 5.0  # to find the cluster, and to fetch a result
NO_WORKER_SECONDS = 120.0  # after so long without any worker, the run ends
POLL_SECONDS = 0.05
SOURCE_SUFFIXES = (".py", ".toml")
# A submission may hold many photos, which Dask would warn about.
DASK_SETTINGS = {"distributed.admin.large-graph-warning-threshold": "4 GiB"}
SUCCEEDED = b"+"
FAILED = b"-"


@dataclass(frozen=True)
class RemoteJob:
    """Everything that a worker needs to run a job.

    Attributes
    ----------
    work : returns the result of a job
    check_available : raises an error on a machine that cannot do the work
    job : GradingJob
    data : the bytes of the submission
    timeout : seconds
    version : the version of hdrlab that the worker must have
    """

    work: Work
    check_available: Callable[[], object]
    job: GradingJob
    data: bytes
    timeout: float
    version: str


@dataclass(frozen=True)
class RunningJob:
    """A job that was sent to a worker, and the worker's address."""

    job: GradingJob
    worker: str


def version() -> str:
    """Return the version of hdrlab, with a digest of its source files and TOML tables."""
    return f"{hdrlab.__version__} ({_source_digest()})"


@cache
def _source_digest() -> str:
    paths = sorted(path for path in LIBRARY.rglob("*.*") if path.suffix in SOURCE_SUFFIXES)
    return grader.specification(paths)[:8]


def run_remote_job(remote_job: RemoteJob) -> bytes:
    """Run a job on a worker; return `+` and the result, or `-` and the reason for the failure."""
    if version() != remote_job.version:
        raise InputError(f"its hdrlab is {version()}, expected {remote_job.version}")
    remote_job.check_available()
    with scratch.locked_folder() as folder:
        path = folder / remote_job.job.path.name
        path.write_bytes(remote_job.data)
        try:
            result = subprocess_runner.run(
                remote_job.work,
                replace(remote_job.job, path=path),
                timeout=remote_job.timeout,
                is_stopped=_watch_cancellation(),
            )
        except ProcessFailed as error:
            return FAILED + str(error).encode()
    return SUCCEEDED + result


def _watch_cancellation() -> Callable[[], bool]:
    """Return a function that says whether this worker's current task has been canceled.

    This is the case when the run has ended or was killed.
    """
    worker = distributed.get_worker()
    task_key = worker.get_current_task()

    def is_cancelled() -> bool:
        state = worker.state.tasks.get(task_key)
        return state is None or state.state == "cancelled"

    return is_cancelled


class Cluster:
    """A `jobs.Executor` that uses the workers of a Dask cluster, including those that join later.

    Parameters
    ----------
    address : of the scheduler, such as tcp://10.0.0.1:8786
    work : returns the bytes of a result; it can be pickled
    check_available : raises an error on a machine that cannot do the work
    timeout : seconds for one attempt at a job

    Raises
    ------
    InputError
        If there is no cluster at the address, if it has another version of hdrlab or cannot do the
        work, or if the connection is lost later.
    """

    def __init__(
        self,
        address: str,
        work: Work,
        check_available: Callable[[], object] = version,
        *,
        timeout: float = JOB_TIMEOUT_SECONDS,
    ) -> None:
        self._address = address
        self._work = work
        self._check_available = check_available
        self._timeout = timeout
        self._running: dict[Future[Any], RunningJob] = {}
        self._reserved_workers: set[str] = set()  # each for one job that runs alone
        self._last_worker_time = time.monotonic()  # when the cluster last had a worker

    def __enter__(self) -> Self:
        self._client = self._connect()
        with contextlib.ExitStack() as stack:
            stack.callback(self._client.close)
            self._check_workers()
            stack.pop_all()
        return self

    def __exit__(self, *error: object) -> None:
        with contextlib.suppress(OSError, RuntimeError):  # the cluster may be gone
            self._client.cancel(list(self._running), force=True)
        self._client.close()

    def start(self, job: GradingJob, *, alone: bool = False) -> bool:
        """Start a job on the worker with the most free threads, if there is one."""
        threads = self._count_threads()
        busy = self._count_jobs()
        free_threads = {}
        for worker, count in threads.items():
            is_suitable = worker not in self._reserved_workers and not (alone and busy[worker])
            if is_suitable and count > busy[worker]:
                free_threads[worker] = count - busy[worker]
        if not free_threads:
            return False
        worker = max(free_threads, key=free_threads.__getitem__)
        if alone:
            self._reserved_workers.add(worker)
        self._running[self._submit(job, worker)] = RunningJob(job, worker)
        return True

    def wait_for_attempts(self) -> list[JobAttempt]:
        """Wait up to half a second, and return attempts that have ended or lost their worker."""
        deadline = time.monotonic() + WAIT_SECONDS
        while time.monotonic() < deadline:
            if any(future.done() for future in self._running):
                break
            time.sleep(POLL_SECONDS)
        ended = []
        for future in list(self._running):
            attempt = self._attempt_of(future)
            if attempt is not None:
                ended.append(attempt)
        lost_workers = set(self._count_jobs()) - set(self._count_threads())
        lost = [
            future for future, running in self._running.items() if running.worker in lost_workers
        ]
        return ended + self._give_up(lost)

    def _connect(self) -> Client:
        """Return a client of the cluster.

        The address is parsed first: a Client that cannot parse it is not closed.
        """
        try:
            resolve_address(self._address)
            return Client(self._address, timeout=CONNECT_SECONDS, set_as_default=False)
        except OSError:
            raise InputError(f"expected a Dask cluster at {self._address}, there is none") from None
        except ValueError as error:
            raise InputError(
                f"expected a Dask cluster at {self._address}, there is none: {error}"
            ) from None

    def _check_workers(self) -> None:
        """Raise InputError if a worker has another version of hdrlab or cannot do the work.

        A worker that is lost in the meantime answers with an OSError. It is not an obstacle.
        """
        own_version = version()
        with self._network_errors():
            versions = {"the scheduler": self._client.run_on_scheduler(version)}
            versions |= self._client.run(version, on_error="return")
            answers = self._client.run(self._check_available, on_error="return")
        for place, other_version in versions.items():
            if other_version != own_version and not isinstance(other_version, OSError):
                raise InputError(
                    f"{place} of the cluster has hdrlab {other_version}, "
                    f"expected {own_version} as on this machine"
                )
        for worker, answer in answers.items():
            if isinstance(answer, BaseException) and not isinstance(answer, OSError):
                raise InputError(f"{worker} of the cluster cannot do the work: {answer}")

    @contextlib.contextmanager
    def _network_errors(self) -> Iterator[None]:
        """Raise InputError when the connection to the cluster is lost."""
        try:
            yield
        except (OSError, RuntimeError) as error:
            reason = " ".join(str(error).split())[: subprocess_runner.MAX_MESSAGE_LENGTH]
            raise InputError(
                f"the cluster at {self._address} is lost; finished results are kept: {reason}"
            ) from None

    def _count_jobs(self) -> "Counter[str]":
        """Return how many jobs each worker has."""
        return Counter(running.worker for running in self._running.values())

    def _count_threads(self) -> dict[str, int]:
        """Return the current workers, and how many threads each has."""
        with self._network_errors():
            threads: dict[str, int] = self._client.nthreads()
        now = time.monotonic()
        if threads:
            self._last_worker_time = now
        if now - self._last_worker_time > NO_WORKER_SECONDS:
            raise InputError(
                f"the cluster at {self._address} has had no worker for {NO_WORKER_SECONDS:.0f} s"
            )
        return threads

    def _submit(self, job: GradingJob, worker: str) -> "Future[Any]":
        remote_job = RemoteJob(
            work=self._work,
            check_available=self._check_available,
            job=job,
            data=job.path.read_bytes(),
            timeout=self._timeout,
            version=version(),
        )
        task_key = f"hdrlab-grade-{secrets.token_hex(8)}"
        with self._network_errors(), dask.config.set(DASK_SETTINGS):
            return self._client.submit(
                run_remote_job, remote_job, key=task_key, workers=[worker], pure=False
            )

    def _attempt_of(self, future: "Future[Any]") -> JobAttempt | None:
        """Return how an attempt has ended, or None while it is running."""
        running = self._running[future]
        if future.status == "finished":
            return self._fetch_answer(future, running.job)
        if future.status == "error":
            with self._network_errors():
                error = future.exception()
            if not isinstance(error, KilledWorker):
                raise InputError(f"{running.worker} of the cluster cannot do the work: {error}")
            # The worker was lost and restarted at the same address, several times.
            (attempt,) = self._give_up([future])
            return attempt
        if future.status in ("cancelled", "lost"):  # somebody has cleared the cluster
            self._remove(future)
            return JobAttempt(running.job, None, "it was canceled", counts=False)
        return None

    def _fetch_answer(self, future: "Future[Any]", job: GradingJob) -> JobAttempt | None:
        """Return what a worker has answered, or None if the answer was lost with its worker."""
        with self._network_errors():
            try:
                answer = future.result(timeout=CONNECT_SECONDS)
            except TimeoutError:
                return None
        self._remove(future)
        if answer.startswith(SUCCEEDED):
            return JobAttempt(job, answer[1:])
        return JobAttempt(job, None, answer[1:].decode())

    def _remove(self, future: "Future[Any]") -> None:
        running = self._running.pop(future)
        self._reserved_workers.discard(running.worker)

    def _give_up(self, futures: "list[Future[Any]]") -> list[JobAttempt]:
        """Return failed attempts for jobs whose worker is lost.

        The failure counts against a job that was alone on its worker.
        """
        jobs_per_worker = self._count_jobs()
        with self._network_errors():
            self._client.cancel(futures, force=True)
        attempts = []
        for future in futures:
            running = self._running[future]
            self._remove(future)
            attempts.append(
                JobAttempt(
                    running.job,
                    None,
                    f"its worker {running.worker} was lost",
                    counts=jobs_per_worker[running.worker] == 1,
                )
            )
        return attempts
