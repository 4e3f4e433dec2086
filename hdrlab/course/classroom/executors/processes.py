"""An executor on this machine: so many processes at a time, one for each piece."""

import os
import threading
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import Self

from hdrlab.course.classroom.executors import alone as process
from hdrlab.course.classroom.journal import Ending, Piece, Work

PATIENCE = 1800.0  # seconds for one try of a piece
LOOK = 0.5  # seconds to wait for an ending


class Processes:
    """A `journal.Executor` of processes on this machine.

    Parameters
    ----------
    work : returns the bytes of a result; it can be pickled
    jobs : processes at a time; as many as there are processors, unless told
    patience : seconds for one try
    """

    def __init__(self, work: Work, jobs: int | None = None, patience: float = PATIENCE) -> None:
        self._work, self._patience = work, patience
        self._jobs = jobs or os.cpu_count() or 1
        self._running: dict[Future[bytes], Piece] = {}
        self._stopped = threading.Event()

    def __enter__(self) -> Self:
        self._threads = ThreadPoolExecutor(self._jobs, "hdrlab-grade")
        return self

    def __exit__(self, *error: object) -> None:
        self._stopped.set()  # an error, or Ctrl-C: what runs will be done again by the next run
        self._threads.shutdown(cancel_futures=True)

    def start(self, piece: Piece, *, alone: bool = False) -> bool:
        """Begin a piece if there is room; each has a process to itself anyway."""
        if len(self._running) == self._jobs:
            return False
        patience, stopped = self._patience, self._stopped.is_set
        future = self._threads.submit(
            process.run, self._work, piece, patience=patience, stopped=stopped
        )
        self._running[future] = piece
        return True

    def endings(self) -> list[Ending]:
        """Wait a little, and return what has ended."""
        ended, _ = wait(self._running, LOOK, FIRST_COMPLETED)
        return [_ending(self._running.pop(future), future) for future in ended]


def _ending(piece: Piece, future: Future[bytes]) -> Ending:
    try:
        return Ending(piece, future.result())
    except process.Failed as error:
        return Ending(piece, None, str(error))
