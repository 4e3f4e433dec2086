"""What a rerun of published experiments is made of: who runs it, what it finds, and what must hold of that.

A figure is one number, or a few of one kind, such as median, 95 % and worst; a hold has as many
limits. What an experiment finds beyond its holds is printed, too. Long work is shared among
processors: each item draws from a seed of its own, so the figures do not depend on who does which.
"""

import os
import signal
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from tqdm import tqdm

from benchmarks.measure import ROOT, THREADS

PROCESSES = os.cpu_count() or 1
Numbers = tuple[float, ...]
Found = Mapping[str, Numbers]  # what was found -> its figure
Item = TypeVar("Item")
Result = TypeVar("Result")


class Skipped(Exception):
    """Raised by an experiment whose data are not here; its text says which."""


class Hold(NamedTuple):
    """A figure that must lie from `low` to `high`, number by number, and beside it what was published.

    `limits` is the same in words.
    """

    what: str
    low: Numbers
    high: Numbers
    limits: str
    published: str = "-"

    def verdict(self, figures: Found) -> str:
        """Return "ok", "MISSED", or "not judged"."""
        if not figures:
            return "not judged"
        value = np.array(figures[self.what])  # NaN lies nowhere
        return "ok" if np.all((value >= self.low) & (value <= self.high)) else "MISSED"


class Experiment(NamedTuple):
    """A published experiment: `run` reads its data from a folder, and returns what it finds, by name.

    `published` has what was published of figures without a hold. A row that draws at random
    (`has_seed`) gets the seed of the command line: `run(folder, seed=seed)`. A row that repeats a
    part of another row runs only where `--rows` names it (`only_by_name`).
    """

    name: str
    title: str
    run: Callable[..., Mapping[str, ArrayLike]]
    holds: tuple[Hold, ...]
    published: Mapping[str, str] = MappingProxyType({})
    has_seed: bool = False
    only_by_name: bool = False


def at_most(what: str, *limits: float, published: str = "-") -> Hold:
    """Hold numbers of at most these limits."""
    return Hold(what, (-np.inf,) * len(limits), limits, f"<= {listed(limits)}", published)


def at_least(what: str, *limits: float, published: str = "-") -> Hold:
    """Hold numbers of at least these limits."""
    return Hold(what, limits, (np.inf,) * len(limits), f">= {listed(limits)}", published)


def near(what: str, *values: float, by: float, published: str = "-") -> Hold:
    """Hold numbers that differ from these by at most `by`."""
    low = tuple(value - by for value in values)
    high = tuple(value + by for value in values)
    return Hold(what, low, high, f"{listed(values)} +- {by:g}", published)


def listed(values: Numbers) -> str:
    """Return the numbers as text; "-" for a limit that there is not."""
    return ", ".join(f"{value:.4g}" if np.isfinite(value) else "-" for value in values)


def spread(errors: NDArray[np.float64]) -> Numbers:
    """Return median, 95 % and worst of many errors."""
    return (*np.quantile(errors, (0.5, 0.95)).tolist(), float(errors.max()))


def findings(experiment: Experiment, folder: Path, seed: int = 0) -> Found:
    """Return what an experiment finds; Skipped and Ctrl-C pass, any other failure becomes a RuntimeError."""
    try:
        figures = (
            experiment.run(folder, seed=seed) if experiment.has_seed else experiment.run(folder)
        )
        return {
            what: tuple(np.atleast_1d(value).astype(float).tolist())
            for what, value in figures.items()
        }
    except Skipped:
        raise
    except Exception as error:
        raise RuntimeError(f"{experiment.name}: {type(error).__name__}, {error}") from error


def real(folder: Path, name: str) -> Path:
    """Return a set of measured data: in the folder, or beside the project in ../shared/data."""
    for place in (folder / name, ROOT.parent / "shared" / "data" / name):
        if place.is_dir():
            return place
    raise Skipped(f"no {name} in --data or ../shared/data")


def measured_curves(folder: Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return exposure and brightness of the 201 measured responses of DoRF, (201, n) each."""
    with np.load(real(folder, "crf_curves") / "dorf_201.npz") as file:
        return file["irradiance"].astype(np.float64), file["brightness"].astype(np.float64)


def along(work: Callable[[Item], Result], items: Iterable[Item], what: str) -> list[Result]:
    """Return work(item) of every item, in order, with a bar on a terminal."""
    items = list(items)
    bar: dict[str, Any] = {"desc": what, "total": len(items), "leave": False, "disable": None}
    if PROCESSES == 1:
        return list(tqdm(map(work, items), **bar))
    workers = min(PROCESSES, len(items))
    with one_thread(), ProcessPoolExecutor(workers, get_context("spawn"), _end_at_once) as pool:
        try:
            return list(tqdm(pool.map(work, items), **bar))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


@contextmanager
def one_thread() -> Iterator[None]:
    """Hold the BLAS of processes that start meanwhile to one thread."""
    before = {name: os.environ.get(name) for name in THREADS}
    os.environ.update(dict.fromkeys(THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name)
            if value is not None:
                os.environ[name] = value


def _end_at_once() -> None:
    """Let Ctrl-C end a process without a word; the parent has one."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
