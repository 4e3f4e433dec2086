"""`hdrlab grade` on a class, in a process of its own, and what it takes of the machine.

seconds  of the wall clock
cpu      seconds of all processors, of the command and of whatever it started
own      those of the command's own process alone, which no number of workers makes fewer
total    MB that all its processes hold at once, at most; what they share is counted once
largest  MB of the largest of them
"""

import os
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from benchmarks.experiments import Skipped
from benchmarks.measure import ROOT, THREADS
from hdrlab.course.sandbox import tiers

TICK = 0.2  # seconds between two looks at the processes
TIMEOUT = (
    10  # seconds for one answer, as usual: what never ends is waited for so long, check by check
)
HERTZ = os.sysconf("SC_CLK_TCK") if hasattr(os, "sysconf") else 100


class Used(NamedTuple):
    """What a run took; the letters are above."""

    seconds: float
    cpu: float
    own: float
    total: float
    largest: float


def grade(folder: Path, out: Path, *words: str, beside: Sequence[int] = ()) -> Used:
    """Grade the class of a folder into `out`; `words` are further options, `beside` a cluster's processes.

    Raises
    ------
    Skipped
        Where this machine has no strict tier.
    RuntimeError
        Where the command fails, with what it said.
    """
    try:
        tiers.choose("strict")
    except tiers.Unavailable as reason:
        raise Skipped(str(reason)) from None
    command = [
        sys.executable,
        "-m",
        "hdrlab",
        "grade",
        str(folder / "submissions"),
        "--homework",
        "hw2",
    ]
    for option, name in (
        ("roster", "roster.csv"),
        ("plan", "plan.toml"),
        ("received", "received.csv"),
        ("secret-file", "secret.txt"),
    ):
        command += [f"--{option}", str(folder / name)]
    return watched([*command, "--timeout", str(TIMEOUT), "-o", str(out), *words], beside)


def watched(command: Sequence[str], beside: Sequence[int] = ()) -> Used:
    """Return what a command took, with all that it started, and what it made others do that were there."""
    env = os.environ | dict.fromkeys(THREADS, "1")
    before = sum(_cpu(child_process, 4) for root in beside for child_process in tree(root))
    began = time.perf_counter()
    own = 0.0
    total = 0.0
    largest = 0.0
    with subprocess.Popen(
        command, cwd=ROOT, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    ) as process:
        assert process.stderr is not None
        os.set_blocking(process.stderr.fileno(), False)
        output = b""
        while True:
            ended, status, usage = os.wait4(process.pid, os.WNOHANG)
            if ended:
                break
            output = (output + (process.stderr.read() or b""))[-4000:]
            own = max(own, _cpu(process.pid, 2))
            held = [
                _megabytes(child_process)
                for root in (process.pid, *beside)
                for child_process in tree(root)
            ]
            total = max(total, sum(held))
            largest = max(largest, max(held, default=0.0))
            time.sleep(TICK)
        seconds = time.perf_counter() - began
        process.returncode = os.waitstatus_to_exitcode(status)
        output += process.stderr.read() or b""
    if process.returncode:
        raise RuntimeError(output.decode(errors="replace").strip()[-2000:])
    others = sum(_cpu(child_process, 4) for root in beside for child_process in tree(root)) - before
    return Used(seconds, usage.ru_utime + usage.ru_stime + others, own, total, largest)


def tree(root: int) -> Iterator[int]:
    """Yield a process and all that come from it, by their numbers."""
    children: dict[int, list[int]] = {}
    for entry in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # it has ended meanwhile
            children.setdefault(int(_stat(int(entry.name))[1]), []).append(int(entry.name))
    waiting = [root]
    while waiting:
        process = waiting.pop()
        yield process
        waiting += children.get(process, [])


def _stat(process: int) -> list[str]:
    """Return the fields of /proc/N/stat behind the name, which may hold anything: state, parent, ..."""
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()


def _cpu(process: int, fields: int) -> float:
    """Return the seconds of a process: user and system, and with four fields its ended children's, too."""
    with suppress(OSError):
        return sum(map(int, _stat(process)[11 : 11 + fields])) / HERTZ
    return 0.0


def _megabytes(process: int) -> float:
    """Return what a process holds, its share of what it shares; all of it where the kernel does not say."""
    for file, field in (
        (f"/proc/{process}/smaps_rollup", "Pss:"),
        (f"/proc/{process}/status", "VmRSS:"),
    ):
        with suppress(OSError):
            for line in Path(file).read_text().splitlines():
                if line.startswith(field):
                    return int(line.split()[1]) * 1024 / 1e6
    return 0.0
