"""The one who writes: ballots that arrive together go to the disk together, and then all are acknowledged.

A full synchronisation takes milliseconds, whether one ballot is in it or a hundred. So jobs wait in a line
while the disk is busy, and the next transaction takes all of them. Each is undone alone where it fails.
"""

import asyncio
import queue
import sqlite3
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from hdrlab.course.gallery import store

Result = TypeVar("Result")
TOGETHER = 256  # jobs at most in one transaction


class Job(NamedTuple):
    """What is to be written, and who waits for it."""

    work: Callable[[sqlite3.Connection], Any]
    loop: asyncio.AbstractEventLoop
    waiting: "asyncio.Future[Any]"


class Writer:
    """A thread with the database's only writing connection of this process."""

    def __init__(self, folder: str | Path) -> None:
        self._db = store.connect(folder)
        self._jobs: queue.SimpleQueue[Job | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._work, name="gallery writer", daemon=True)
        self._thread.start()

    async def do(self, work: Callable[[sqlite3.Connection], Result]) -> Result:
        """Return what `work` returns, or raise what it raises, after it is on the disk."""
        loop = asyncio.get_running_loop()
        job = Job(work, loop, loop.create_future())
        self._jobs.put(job)
        return await job.waiting

    def close(self) -> None:
        """Write what waits, and end."""
        self._jobs.put(None)
        self._thread.join()
        self._db.close()

    def _work(self) -> None:
        while (first := self._jobs.get()) is not None:
            jobs = [first]
            while not self._jobs.empty() and len(jobs) < TOGETHER:
                following = self._jobs.get()
                if following is None:
                    self._jobs.put(None)
                    break
                jobs.append(following)
            for job, outcome in zip(jobs, self._together(jobs), strict=True):
                job.loop.call_soon_threadsafe(_tell, job.waiting, outcome)

    def _together(self, jobs: list[Job]) -> list[Any]:
        """Return what each job came to, after one transaction, or the error that undid all of it."""
        try:
            with store.transaction(self._db):
                return [self._alone(job) for job in jobs]
        except sqlite3.Error as error:
            return [error] * len(jobs)

    def _alone(self, job: Job) -> Any:
        self._db.execute("SAVEPOINT job")
        try:
            return job.work(self._db)
        except Exception as error:
            self._db.execute("ROLLBACK TO job")
            return error
        finally:
            self._db.execute("RELEASE job")


def _tell(waiting: "asyncio.Future[Any]", outcome: Any) -> None:
    if waiting.done():  # whoever asked has gone
        return
    if isinstance(outcome, Exception):
        waiting.set_exception(outcome)
    else:
        waiting.set_result(outcome)
