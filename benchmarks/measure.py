"""Time and memory of a row's runs, each row in processes of its own.

time     wall clock, interleaved: in each round everyone once, so that a busy machine is busy for all of them
memory   the peak of resident memory above what the process held before, in a fresh process, on the second run

Resident memory counts what C++ allocates as well as what Python does. The first run brings in
libraries and tables.
"""

import ctypes
import gc
import importlib
import json
import keyword
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from benchmarks.rows import Case, Figures, Results, Row, Run, Usage

ROOT = Path(__file__).parents[1]
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
UNCOMPILED = "PYTHONDONTWRITEBYTECODE"
# After so many seconds, the smallest number of rounds is enough.
MIN_ROUNDS = 5
MAX_ROUNDS = 41
MIN_SECONDS = 3.0
# Runs of several seconds vary by little: so many rounds suffice if they took so many seconds.
LONG_ROUNDS = 2
LONG_SECONDS = 10.0


def rows_of(subject: str) -> Sequence[Any]:
    """Return the rows of a subject; where its name is a word of Python, its module is called class_."""
    mark = "_" if keyword.iskeyword(subject) else ""
    rows: Sequence[Any] = importlib.import_module(f"benchmarks.{subject}{mark}").ROWS
    return rows


def measured(subject: str, row: Row, folder: Path) -> tuple[Results, dict[str, str]]:
    """Return the Figures of everyone who did the work of a row, and why others did not."""
    one_thread = child(subject, row, folder, "one")
    default = child(subject, row, folder, "default")
    results = {}
    for who, seconds in one_thread["seconds"].items():
        memory = one_thread["megabytes"][who]
        if memory is None:
            memory = child(subject, row, folder, "memory", who)["megabytes"]
        times = median(seconds), median(default["seconds"][who])
        results[who] = Figures(*times, memory, one_thread["errors"][who], one_thread["floors"][who])
    return results, one_thread["missing"]


def child(subject: str, row: Row, folder: Path, *what: str) -> dict[str, Any]:
    """Return what a process of its own finds out; BLAS reads its number of threads when it is loaded.

    Commands find modules compiled, as an installed package's are.
    """
    env = {name: value for name, value in os.environ.items() if name not in {*THREADS, UNCOMPILED}}
    env["PYTHONPYCACHEPREFIX"] = str(folder / "compiled")
    if what[0] != "default":
        env |= dict.fromkeys(THREADS, "1")
    command = [sys.executable, "-m", "benchmarks.measure", subject, row.name, str(folder), *what]
    done = subprocess.run(command, cwd=ROOT, env=env, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{row.name}, {' '.join(what)}: {done.stderr.strip()[-2000:]}")
    return dict(json.loads(done.stdout.splitlines()[-1]))


def main(subject: str, name: str, folder: str, what: str, who: str = "") -> None:
    """Find it out, in the child, and print it as JSON."""
    # the same processor for all, peers' processes too
    if what != "default" and hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    rows = rows_of(subject)
    row = next(row for row in rows if row.name == name)
    case = row.case(Path(folder), what != "default")
    print(json.dumps({"megabytes": peak(case.runs[who])} if what == "memory" else timed(case)))


def timed(case: Case) -> dict[str, Any]:
    """Return the seconds of every round, the errors and the floors of everyone, after a round to warm up.

    The memory of a command is known from that round, too; None where nothing else than a process of
    its own can tell it.
    """
    errors = {}
    floors = {}
    rate = bandwidth()
    least = list[float]()
    megabytes = {}
    for who, run in case.runs.items():
        result = run()
        errors[who] = case.error(who, result)
        megabytes[who] = result.megabytes if isinstance(result, Usage) else None
        reads = case.reads if isinstance(case.reads, int) else case.reads[who]
        floors[who] = (reads + size(result)) / rate if reads else None
    seconds: dict[str, list[float]] = {who: [] for who in case.runs}
    start = time.perf_counter()
    for done in range(MAX_ROUNDS):
        elapsed = time.perf_counter() - start
        if done >= MIN_ROUNDS and elapsed > MIN_SECONDS:
            break
        if done >= LONG_ROUNDS and elapsed > LONG_SECONDS:
            break
        for who, run in case.runs.items():
            seconds[who].append(clocked(run))
        # by turns, for what the others leave in memory and on the disk slows it down
        if case.least:
            least.append(clocked(case.least))
    floors = dict.fromkeys(floors, median(least)) if least else floors
    return {
        "seconds": seconds,
        "errors": errors,
        "missing": case.missing,
        "floors": floors,
        "megabytes": megabytes,
    }


def bandwidth() -> float:
    """Return the bytes a second that go through memory when an array is copied, read and written."""
    source = np.ones(2**24)  # 128 MiB, more than any cache holds
    target = np.empty_like(source)
    times = [clocked(lambda: np.copyto(target, source)) for _ in range(5)]
    return 2 * source.nbytes / min(times)


def size(result: Any) -> int:
    """Return the bytes of a result: of its arrays, and of files that it leaves none."""
    if isinstance(result, np.ndarray):
        return result.nbytes
    return sum(map(size, result)) if isinstance(result, (tuple, list)) else 0


def clocked(run: Run) -> float:
    """Return the seconds of one run."""
    start = time.perf_counter()
    result = run()
    elapsed = time.perf_counter() - start
    return result.seconds if isinstance(result, Usage) else elapsed


def peak(run: Run) -> float | None:
    """Return the MB by which a run raises the peak of resident memory; None where it cannot be told."""
    warm = run()
    if isinstance(warm, Usage):
        return warm.megabytes
    del warm
    gc.collect()
    status = Path("/proc/self/status")
    if not status.exists():
        return None
    if trim := getattr(ctypes.CDLL(None), "malloc_trim", None):
        trim(0)  # what is free but kept would hide as much of the peak
    Path("/proc/self/clear_refs").write_text("5")  # the peak starts again from here
    before = _kilobytes(status, "VmRSS")
    result = run()
    after = _kilobytes(status, "VmHWM")
    del result
    return (after - before) * 1024 / 1e6


def process(
    command: list[str],
    *,
    one_thread: bool,
    source: Path | str = os.devnull,
    target: Path | str = os.devnull,
) -> Usage:
    """Return what a command takes; in one thread it stays on one processor, whatever its libraries like."""
    cpu = max(os.sched_getaffinity(0)) if one_thread and hasattr(os, "sched_getaffinity") else -1
    launch = [
        sys.executable,
        str(ROOT / "benchmarks" / "launch.py"),
        str(cpu),
        str(source),
        str(target),
    ]
    done = subprocess.run([*launch, *command], cwd=ROOT, capture_output=True, text=True)
    seconds, size, cpu_seconds, code = (done.stdout.split() or ["0", "0", "0", "1"])[-4:]
    if done.returncode or int(code):
        raise RuntimeError(f"{' '.join(command)}: {done.stderr.strip()[-2000:]}")
    return Usage(float(seconds), int(size) / 1e6, float(cpu_seconds))


def _kilobytes(status: Path, field: str) -> int:
    return next(
        int(line.split()[1]) for line in status.read_text().splitlines() if line.startswith(field)
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
