"""Write to the gallery's database, with one transaction for all jobs that arrive meanwhile.

A full synchronization takes milliseconds, for one ballot or for a hundred. So jobs wait in a queue
while the disk is busy, and the next transaction takes all of them. A job that fails is rolled back
alone.
"""

import asyncio
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from hdrlab.course.gallery import store

Result = TypeVar("Result")
Work = Callable[[sqlite3.Connection], Any]
MAX_JOBS_PER_TRANSACTION = 256


class Writer:
    """The only connection of this process that writes to the database."""

    def __init__(self, folder: str | Path) -> None:
        self._db = store.connect(folder)
        self._busy = False
        self._jobs: list[tuple[Work, asyncio.Future[Any]]] = []

    async def do(self, work: Callable[[sqlite3.Connection], Result]) -> Result:
        """Run `work` in a transaction, and return or raise its result once it is on the disk."""
        waiting = asyncio.get_running_loop().create_future()
        self._jobs.append((work, waiting))
        if not self._busy:
            self._busy = True
            # a task of its own: the request that started it may be canceled
            self._task = asyncio.create_task(self._write_jobs())
        return await waiting

    async def close(self) -> None:
        """Close the connection after the last waiting job, even if its request was canceled."""
        if self._busy:
            await self._task
        self._db.close()

    async def _write_jobs(self) -> None:
        """Run the waiting jobs until there are none."""
        while self._jobs:
            jobs = self._jobs[:MAX_JOBS_PER_TRANSACTION]
            self._jobs = self._jobs[MAX_JOBS_PER_TRANSACTION:]
            outcomes = await asyncio.to_thread(self._run_jobs, [work for work, _ in jobs])
            # before the results are set, for whoever waits for one may start another job
            self._busy = bool(self._jobs)
            for (_, waiting), outcome in zip(jobs, outcomes, strict=True):
                if waiting.done():  # the request was canceled
                    continue
                if isinstance(outcome, Exception):
                    waiting.set_exception(outcome)
                else:
                    waiting.set_result(outcome)

    def _run_jobs(self, works: list[Work]) -> list[Any]:
        """Run jobs in one transaction; return each result, or the error that undid all of them."""
        try:
            with store.transaction(self._db):
                return [self._run_job(work) for work in works]
        except sqlite3.Error as error:
            return [error] * len(works)

    def _run_job(self, work: Work) -> Any:
        """Run one job; return its result, or the error that it raised after undoing it."""
        self._db.execute("SAVEPOINT job")
        try:
            return work(self._db)
        except Exception as error:
            self._db.execute("ROLLBACK TO job")
            return error
        finally:
            self._db.execute("RELEASE job")
