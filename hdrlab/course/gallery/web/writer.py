"""The one who writes: ballots that arrive together go to the disk together, and then all are acknowledged.

A full synchronisation takes milliseconds, whether one ballot is in it or a hundred. So jobs wait in
a line while the disk is busy, and the next transaction takes all of them. Each is undone alone
where it fails.
"""

import asyncio
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from hdrlab.course.gallery import store

Result = TypeVar("Result")
Work = Callable[[sqlite3.Connection], Any]
TOGETHER = 256  # jobs at most in one transaction


class Writer:
    """The database's only writing connection of this process."""

    def __init__(self, folder: str | Path) -> None:
        self._db = store.connect(folder)
        self._busy = False
        self._jobs: list[tuple[Work, asyncio.Future[Any]]] = []

    async def do(self, work: Callable[[sqlite3.Connection], Result]) -> Result:
        """Return what `work` returns, or raise what it raises, after it is on the disk."""
        waiting = asyncio.get_running_loop().create_future()
        self._jobs.append((work, waiting))
        if not self._busy:
            self._busy = True
            self._task = asyncio.create_task(self._write())  # of its own: whoever asked may go
        return await waiting

    async def close(self) -> None:
        """End, when all that waited is written, though whoever asked for it has gone."""
        if self._busy:
            await self._task
        self._db.close()

    async def _write(self) -> None:
        while self._jobs:
            jobs = self._jobs[:TOGETHER]
            self._jobs = self._jobs[TOGETHER:]
            outcomes = await asyncio.to_thread(self._together, [work for work, _ in jobs])
            self._busy = bool(self._jobs)  # before anybody is told, and asks for more
            for (_, waiting), outcome in zip(jobs, outcomes, strict=True):
                if waiting.done():  # whoever asked has gone
                    continue
                if isinstance(outcome, Exception):
                    waiting.set_exception(outcome)
                else:
                    waiting.set_result(outcome)

    def _together(self, works: list[Work]) -> list[Any]:
        """Return what each job came to, after one transaction, or the error that undid all of it."""
        try:
            with store.transaction(self._db):
                return [self._alone(work) for work in works]
        except sqlite3.Error as error:
            return [error] * len(works)

    def _alone(self, work: Work) -> Any:
        self._db.execute("SAVEPOINT job")
        try:
            return work(self._db)
        except Exception as error:
            self._db.execute("ROLLBACK TO job")
            return error
        finally:
            self._db.execute("RELEASE job")
