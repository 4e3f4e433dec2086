"""What a subject is made of: rows of work, who does it, and what must hold of the figures.

A hold compares one number, computed from the figures of all who did the work, with a limit; beyond
it lies the goal.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import log
from pathlib import Path
from typing import Any, NamedTuple, Protocol

OURS = "hdrlab"
NEAR = 1.25  # x the floor: what ratios of one run hold to

Run = Callable[[], Any]


@dataclass(frozen=True)
class Usage:
    """What a process took; a run that starts processes returns this, and is not timed itself.

    `cpu_seconds` is the processor time of the process and of those that it started.
    """

    seconds: float
    megabytes: float
    cpu_seconds: float = 0.0

    def net(self, idle: "Usage") -> "Usage":
        """Return what is left without what an idle process of the same input and output takes."""
        return Usage(
            self.seconds - idle.seconds,
            self.megabytes - idle.megabytes,
            self.cpu_seconds - idle.cpu_seconds,
        )


class Case(NamedTuple):
    """Work that is ready to run.

    Attributes
    ----------
    runs : who -> a function without arguments that does the work; hdrlab first
    missing : peer -> why it is not there
    error : how far a result is from the truth, given who made it; None where nothing can be said
    reads : bytes of the input, which have to be read at least once; by who where they differ
    least : what must be done at least, where that is more than to go through memory: a file by one
        call
    """

    runs: dict[str, Run]
    missing: dict[str, str]
    error: Callable[[str, Any], float | None] = lambda who, result: None
    reads: int | Mapping[str, int] = 0
    least: Run | None = None


class Figures(NamedTuple):
    """Of one who did it: median seconds in one thread and by default, peak MB beyond the input, error.

    `floor` is the seconds that the machine takes to read the input and write the result, and
    nothing else; of a file, to read or write its bytes by one call.
    """

    seconds: float
    default: float
    megabytes: float | None = None
    error: float | None = None
    floor: float | None = None


Results = dict[str, Figures]


class Hold(NamedTuple):
    """What must be at least, or at most, a limit; `figure` returns None where it cannot be told.

    What is `timed` may end short of its limit where the machine does: no program could be much
    faster.
    """

    what: str
    figure: Callable[[Results], float | None]
    limit: float
    goal: float | None = None
    least: bool = False
    timed: bool = False

    def verdict(self, results: Results) -> str:
        """Return "ok", "MISSED", "not judged", or "AT FLOOR": within a quarter of what the machine takes."""
        value = self.figure(results)
        if value is None:
            return "not judged"
        if value >= self.limit if self.least else value <= self.limit:
            return "ok"
        ours = results[OURS]
        return (
            "AT FLOOR"
            if self.timed and ours.floor and ours.seconds <= NEAR * ours.floor
            else "MISSED"
        )


class Row(NamedTuple):
    """Work: `case` prepares it from the folder of data, for one thread or not; `accuracy` names the error."""

    name: str
    title: str
    case: Callable[[Path, bool], Case]
    holds: tuple[Hold, ...]
    accuracy: str = "error"


class Judged(Protocol):
    """What must hold of figures."""

    @property
    def what(self) -> str: ...

    def verdict(self, results: Any, /) -> str: ...


class Named(Protocol):
    """A row of any subject."""

    @property
    def name(self) -> str: ...

    @property
    def holds(self) -> Sequence[Judged]: ...


Outcome = tuple[Named, Mapping[str, Any] | None]  # None where the work failed


def verdicts(outcomes: Sequence[Outcome]) -> list[tuple[Named, Judged, str]]:
    """Return what became of every hold; where the work failed, all of them are missed."""
    return [
        (row, hold, "MISSED" if results is None else hold.verdict(results))
        for row, results in outcomes
        for hold in row.holds
    ]


def best_peer(results: Results, column: str = "seconds") -> str | None:
    """Return the fastest peer, or None where there is none."""
    peers = [who for who in results if who != OURS]
    return min(peers, key=lambda who: getattr(results[who], column), default=None)


def ratio(results: Results, column: str = "seconds") -> float | None:
    """Return how many times faster hdrlab is than the best peer, in one thread, or by `default`."""
    peer = best_peer(results, column)
    if peer is None or OURS not in results:
        return None
    theirs = float(getattr(results[peer], column))
    ours = float(getattr(results[OURS], column))
    return theirs / ours


def faster(limit: float, goal: float | None = None) -> Hold:
    """Hold at least this ratio to the best peer."""
    return Hold("times as fast as the best peer", ratio, limit, goal, least=True, timed=True)


def faster_by_default(limit: float, goal: float | None = None) -> Hold:
    """Hold at least this ratio where everyone takes all processors that it can, as a user's command does."""
    figure = partial(ratio, column="default")
    return Hold("times as fast as the best peer, by default", figure, limit, goal, least=True)


def smaller(share: float) -> Hold:
    """Hold at most this share of the best peer's memory."""

    def figure(results: Results) -> float | None:
        peer = best_peer(results)
        theirs = results[peer].megabytes if peer else None
        ours = results[OURS].megabytes
        return ours / theirs if ours is not None and theirs else None

    return Hold("of its peak memory", figure, share)


def close(limit: float, what: str, goal: float | None = None) -> Hold:
    """Hold at most this error."""
    return Hold(what, lambda results: results[OURS].error, limit, goal)


def grows(small: str, large: str, pixels: float, limit: float) -> Hold:
    """Hold that time grows at most with this power of the number of pixels."""

    def exponent(results: Results) -> float:
        return log(results[large].seconds / results[small].seconds) / log(pixels)

    return Hold("is the power of the pixels that time grows with", exponent, limit)


def within(who: str, megabytes: float) -> Hold:
    """Hold at most this much memory beyond the input."""
    return Hold(f"MB beyond the frames, {who}", lambda results: results[who].megabytes, megabytes)
