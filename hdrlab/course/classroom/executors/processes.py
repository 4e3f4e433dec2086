"""An executor that runs each job in its own process on this machine."""

import os
import threading
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import Self

from hdrlab.course.classroom.jobs import GradingJob, JobAttempt, Work
from hdrlab.course.sandbox import subprocess_runner
from hdrlab.course.sandbox.subprocess_runner import ProcessFailed

JOB_TIMEOUT_SECONDS = 1800.0
WAIT_SECONDS = 0.5


class Processes:
    """A `jobs.Executor` that runs jobs in processes on this machine.

    Parameters
    ----------
    work : returns the bytes of a result; it can be pickled
    max_processes : how many run at a time; by default, the number of processors
    timeout : seconds for one attempt at a job
    """

    def __init__(
        self,
        work: Work,
        max_processes: int | None = None,
        *,
        timeout: float = JOB_TIMEOUT_SECONDS,
    ) -> None:
        self._work = work
        self._max_processes = max_processes or os.cpu_count() or 1
        self._timeout = timeout
        self._running: dict[Future[bytes], GradingJob] = {}
        self._stop = threading.Event()

    def __enter__(self) -> Self:
        self._threads = ThreadPoolExecutor(self._max_processes, "hdrlab-grade")
        return self

    def __exit__(self, *error: object) -> None:
        # After an error or Ctrl-C, jobs are still running. The next run does them again.
        self._stop.set()
        self._threads.shutdown(cancel_futures=True)

    def start(self, job: GradingJob, *, alone: bool = False) -> bool:
        """Start a job if fewer than `max_processes` are running; return whether it was started.

        `alone` changes nothing: a process that dies takes no other job with it.
        """
        if len(self._running) == self._max_processes:
            return False
        future = self._threads.submit(
            subprocess_runner.run,
            self._work,
            job,
            timeout=self._timeout,
            is_stopped=self._stop.is_set,
        )
        self._running[future] = job
        return True

    def wait_for_attempts(self) -> list[JobAttempt]:
        """Wait up to half a second, and return the attempts that have ended."""
        ended, _ = wait(self._running, WAIT_SECONDS, FIRST_COMPLETED)
        return [_attempt(self._running.pop(future), future) for future in ended]


def _attempt(job: GradingJob, future: Future[bytes]) -> JobAttempt:
    try:
        return JobAttempt(job, future.result())
    except ProcessFailed as error:
        return JobAttempt(job, None, str(error))
