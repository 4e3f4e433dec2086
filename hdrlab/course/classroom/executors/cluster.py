"""An executor on many machines: a Dask cluster, whose workers have hdrlab, and no disk in common with ours.

A submission's bytes go out with the work, and its result's bytes come back; nothing is kept over
there. A piece is given to one worker, and no worker has more of them than threads, so that it is
known who was at work where when a worker is lost. A piece that was alone on its worker is blamed
for the loss; those that were several are not, and each is tried again alone.
"""

import contextlib
import secrets
import time
from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any, NamedTuple, Self

import dask
import distributed
from distributed import Client, Future, KilledWorker
from distributed.comm import resolve_address

import hdrlab
from hdrlab.course import grading, scratch
from hdrlab.course.checks.running import LIBRARY
from hdrlab.course.classroom.executors import alone as process
from hdrlab.course.classroom.executors.processes import LOOK, PATIENCE
from hdrlab.course.classroom.journal import Ending, Piece, Work
from hdrlab.errors import InputError

CONNECT = 5.0  # seconds to find the cluster in, and to fetch a result in
LONELY = 120.0  # seconds without any worker, after which the run ends
TICK = 0.05  # seconds between two looks at what has ended
# a submission may be of many photographs
WARNING = {"distributed.admin.large-graph-warning-threshold": "4 GiB"}


class Task(NamedTuple):
    """What travels to a worker: the work, the piece and its bytes, and which hdrlab they are of."""

    work: Work
    ready: Callable[[], object]
    piece: Piece
    data: bytes
    patience: float
    version: str


def version() -> str:
    """Return which hdrlab this is: its version, and a digest of its source, its tables included."""
    return f"{hdrlab.__version__} ({_sources()})"


@cache
def _sources() -> str:
    files = sorted(one for one in LIBRARY.rglob("*.*") if one.suffix in (".py", ".toml"))
    return grading.specification(files)[:8]


def do(task: Task) -> bytes:
    """Do a piece, on a worker: a sign, + or -, and the result's bytes, or why there are none."""
    if version() != task.version:
        raise InputError(f"its hdrlab is {version()}, expected {task.version}")
    task.ready()
    with scratch.locked_folder() as folder:
        path = folder / task.piece.path.name
        path.write_bytes(task.data)
        piece = task.piece._replace(path=path)
        try:
            return b"+" + process.run(task.work, piece, patience=task.patience, stopped=_watch())
        except process.Failed as error:
            return b"-" + str(error).encode()


def _watch() -> Callable[[], bool]:
    """Return what tells whether a task is no longer wanted: the run has ended, or was killed."""
    worker = distributed.get_worker()
    mine = worker.get_current_task()

    def stopped() -> bool:
        state = worker.state.tasks.get(mine)
        return state is None or state.state == "cancelled"

    return stopped


class Cluster:
    """A `journal.Executor` of the workers of a Dask cluster; those who join later are of it, too.

    Parameters
    ----------
    address : of the scheduler, such as tcp://10.0.0.1:8786
    work : returns the bytes of a result; it can be pickled
    ready : raises an error on a machine that cannot do the work
    patience : seconds for one try

    Raises
    ------
    ValueError
        Where there is no cluster, where it has another hdrlab, or cannot do the work, or is lost
        later on.
    """

    def __init__(
        self,
        address: str,
        work: Work,
        ready: Callable[[], object] = version,
        patience: float = PATIENCE,
    ) -> None:
        self._address, self._work, self._ready, self._patience = address, work, ready, patience
        self._running: dict[Future[Any], tuple[Piece, str]] = {}  # with its worker's address
        self._taken: set[str] = set()  # workers that one piece has to itself
        self._met = time.monotonic()  # when there was a worker, last

    def __enter__(self) -> Self:
        try:
            resolve_address(
                self._address
            )  # first: a Client that cannot read it is left behind, half made
            self._client = Client(self._address, timeout=CONNECT, set_as_default=False)
        except (OSError, ValueError) as error:
            why = f": {error}" if isinstance(error, ValueError) else ""
            raise InputError(
                f"expected a Dask cluster at {self._address}, there is none{why}"
            ) from None
        with contextlib.ExitStack() as held:
            held.callback(self._client.close)
            self._check()
            held.pop_all()
        return self

    def __exit__(self, *error: object) -> None:
        with contextlib.suppress(OSError, RuntimeError):  # it may be gone
            self._client.cancel(list(self._running), force=True)
        self._client.close()

    def start(self, piece: Piece, *, alone: bool = False) -> bool:
        """Begin a piece on the worker with most room, if there is any."""
        threads, busy = self._present(), self._busy()
        room = {one: threads[one] - busy[one] for one in threads if one not in self._taken}
        fitting = [one for one in room if room[one] > 0 and not (alone and busy[one])]
        if not fitting:
            return False
        worker = max(fitting, key=room.__getitem__)
        if alone:
            self._taken.add(worker)
        self._running[self._sent(piece, worker)] = piece, worker
        return True

    def endings(self) -> list[Ending]:
        """Wait a little, and return what has ended, and those whose worker is lost."""
        until = time.monotonic() + LOOK
        while not any(one.done() for one in self._running) and time.monotonic() < until:
            time.sleep(TICK)
        ended = [one for future in list(self._running) if (one := self._ending(future))]
        return ended + self._lost(set(self._busy()) - set(self._present()))

    def _check(self) -> None:
        """Raise a ValueError for another hdrlab over there, or for a worker that cannot do the work.

        One that is lost while it is asked answers by an error of the network, and is not asked for
        more.
        """
        mine = version()
        with self._talking():
            said = {"the scheduler": self._client.run_on_scheduler(version)}
            said |= self._client.run(version, on_error="return")
            able = self._client.run(self._ready, on_error="return")
        for who, theirs in said.items():
            if theirs != mine and not isinstance(theirs, OSError):
                raise InputError(
                    f"{who} of the cluster has hdrlab {theirs}, expected {mine} as it is here"
                )
        for who, why in able.items():
            if isinstance(why, BaseException) and not isinstance(why, OSError):
                raise InputError(f"{who} of the cluster cannot do it: {why}")

    @contextlib.contextmanager
    def _talking(self) -> Iterator[None]:
        """Say in plain words what an error of the network means."""
        try:
            yield
        except (OSError, RuntimeError) as error:
            why = " ".join(str(error).split())[: process.LAST]
            says = f"the cluster at {self._address} is lost; what is graded stays graded: {why}"
            raise InputError(says) from None

    def _busy(self) -> "Counter[str]":
        """Return how many pieces each worker has."""
        return Counter(worker for _, worker in self._running.values())

    def _present(self) -> dict[str, int]:
        """Return the workers that there are, and how many pieces each may have."""
        with self._talking():
            known: dict[str, int] = self._client.nthreads()
        now = time.monotonic()
        self._met = now if known else self._met
        if now - self._met > LONELY:
            raise InputError(f"the cluster at {self._address} has had no worker for {LONELY:.0f} s")
        return known

    def _sent(self, piece: Piece, worker: str) -> "Future[Any]":
        task = Task(
            self._work, self._ready, piece, piece.path.read_bytes(), self._patience, version()
        )
        key = f"hdrlab-grade-{secrets.token_hex(8)}"
        with self._talking(), dask.config.set(WARNING):
            return self._client.submit(do, task, key=key, workers=[worker], pure=False)

    def _ending(self, future: "Future[Any]") -> Ending | None:
        """Return how a piece has ended, if it has; that its worker is lost shows elsewhere, as a rule."""
        piece, worker = self._running[future]
        if future.status == "finished":
            return self._answer(future, piece)
        if future.status == "error":
            with self._talking():
                why = future.exception()
            if not isinstance(why, KilledWorker):
                raise InputError(f"{worker} of the cluster cannot do it: {why}")
            return self._lost({worker}, only=future)[0]  # again and again, at the same address
        if future.status in ("cancelled", "lost"):  # somebody has cleared the cluster
            self._forget(future)
            return Ending(piece, None, "it was cancelled", blamed=False)
        return None

    def _answer(self, future: "Future[Any]", piece: Piece) -> Ending | None:
        """Return what a worker answered, unless that was lost with it."""
        with self._talking():
            try:
                answer = future.result(timeout=CONNECT)
            except TimeoutError:
                return None
        self._forget(future)
        whole = answer[:1] == b"+"
        return Ending(piece, answer[1:]) if whole else Ending(piece, None, answer[1:].decode())

    def _forget(self, future: "Future[Any]") -> None:
        _, worker = self._running.pop(future)
        self._taken.discard(worker)

    def _lost(self, gone: set[str], only: "Future[Any] | None" = None) -> list[Ending]:
        """Return the endings of pieces whose worker is gone: one that was alone there is to blame."""
        company, each = self._busy(), self._running.items()
        lost = [(one, *which) for one, which in each if which[1] in gone and only in (None, one)]
        with self._talking():
            self._client.cancel([one for one, *_ in lost], force=True)
        for one, *_ in lost:
            self._forget(one)
        why = "its worker {} was lost".format
        return [
            Ending(piece, None, why(worker), blamed=company[worker] == 1)
            for _, piece, worker in lost
        ]
