"""Do the tests see? The library is changed a little, once at a time, and the quick tier is asked each time.

lessons   the rooms of the lessons, core to beyond, with fast, diagnostics and pipeline
grader    what grades, on the side that a submission does not reach: plan, checks, sandbox, classroom

Of all mutants (`mutants`) MUTANTS are drawn in each of the two, the same ones each time. A mutant's
tests are those that run its line, and then those that run anything else of its file (`known`). A
mutant is killed where one of them fails, ends otherwise, or takes ten times as long. The survivors
are printed: read them as hints to promises that no test states. Many change no result at all, so
the share that is killed is no target.

`MUTANTS=40 python -m benchmarks mutation` is a shorter run, and `MUTANTS_SEED=2` draws others.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from queue import Queue
from typing import IO, Any, NamedTuple

import numpy as np
from tqdm import tqdm

from benchmarks.experiments import Experiment
from benchmarks.measure import ROOT, THREADS
from benchmarks.mutation.known import Known, known
from benchmarks.mutation.mutants import Mutant, of

HERE = Path(__file__).parent
MUTANTS = int(os.environ.get("MUTANTS", "250"))
SEED = int(os.environ.get("MUTANTS_SEED", "1"))
PROCESSES = os.cpu_count() or 1
ROOMS = (
    *(
        "core",
        "capture",
        "align",
        "response",
        "calibration",
        "radiance",
        "tonemap",
        "enhance",
        "beyond",
    ),
    *("fast", "diagnostics", "pipeline"),
)
GRADER = (
    *("grading.py", "plan.py", "submission.py", "scratch.py", "checks/*.py", "classroom/**/*.py"),
    *("source_code/*.py", "submissions/**/*.py", "sandbox/*.py", "reports/*.py"),
)
# seconds of tests that are asked of a mutant: of those that run its line, and of those that run its
# file
NEAR = 240.0
FAR = 60.0
CLOSE = "killed, %"


class Fate(NamedTuple):
    """A mutant, and whether a test saw it; `tests` is how many were asked."""

    mutant: Mutant
    killed: bool
    tests: int


class Forked:
    """A copy of the repository, and the process that runs tests in it."""

    def __init__(self, tree: Path) -> None:
        environment = os.environ | dict.fromkeys(THREADS, "1")
        environment |= {"PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}
        command = [sys.executable, str(HERE / "forked.py")]
        self.tree = tree
        self.process = subprocess.Popen(
            command,
            cwd=tree,
            env=environment,
            text=True,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )

    def run(self, tests: Sequence[str], seconds: float) -> int:
        """Return the exit code of the tests."""
        requests, answers = _pipes(self.process)
        requests.write(json.dumps({"tests": list(tests), "seconds": seconds}) + "\n")
        requests.flush()
        return int(answers.readline())

    @contextmanager
    def changed(self, mutant: Mutant) -> Iterator[None]:
        """Hold the change in the tree."""
        path = self.tree / mutant.file
        before = path.read_text(encoding="utf8")
        state = path.stat()
        path.write_text(mutant.applied(before), encoding="utf8")
        try:
            yield
        finally:
            path.write_text(before, encoding="utf8")
            # its compiled form is true again
            os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns))

    def end(self) -> None:
        """End the process."""
        self.process.kill()
        self.process.communicate()


def _pipes(process: "subprocess.Popen[str]") -> tuple[IO[str], IO[str]]:
    if process.stdin is None or process.stdout is None:
        raise RuntimeError("the process was started without pipes")
    return process.stdin, process.stdout


def fate(mutant: Mutant, trees: "Queue[Forked]", tests: Known) -> Fate:
    """Return what becomes of a mutant."""
    forked = trees.get()
    count = 0
    try:
        with forked.changed(mutant):
            for chosen, most in ((tests.near, NEAR), (tests.far, FAR)):
                some = within(chosen(mutant.file, mutant.line), tests.seconds, most)
                count += len(some)
                if some and forked.run(some, 60 + 10 * sum(tests.seconds[test] for test in some)):
                    return Fate(mutant, True, count)
        return Fate(mutant, False, count)
    finally:
        trees.put(forked)


def within(tests: Sequence[str], seconds: dict[str, float], most: float) -> list[str]:
    """Return the first tests that together take so many seconds at most."""
    total = np.cumsum([seconds[test] for test in tests])
    return list(tests[: int(np.searchsorted(total, most, side="right"))])


def copies(folder: Path, count: int) -> list[Path]:
    """Return copies of the repository's files, compiled, with the real data beside them."""
    trees = [folder / f"tree-{k}" for k in range(count)]
    for tree in trees:
        shutil.copytree(
            ROOT,
            tree,
            ignore=shutil.ignore_patterns(".git", "__pycache__", ".*_cache", "*.egg-info"),
        )
        subprocess.run(
            [sys.executable, "-m", "compileall", "-q", "hdrlab", "tests"], cwd=tree, check=True
        )
    data = ROOT.parent / "shared"
    if data.exists():
        (folder / "shared").symlink_to(data)
    return trees


@cache
def quick_tier() -> Known:
    """Return which tests run what; both rows ask for it."""
    with tempfile.TemporaryDirectory(prefix="hdrlab-mutation-") as scratch:
        folder = Path(scratch).resolve()
        return known(copies(folder, 1)[0], folder)


def fates(files: Sequence[str]) -> list[Fate]:
    """Return what becomes of MUTANTS mutants of these files, drawn by SEED."""
    every = of(ROOT, sorted(files))
    order = np.random.default_rng(SEED).permutation(len(every))
    drawn = [every[k] for k in sorted(order[:MUTANTS])]
    with tempfile.TemporaryDirectory(prefix="hdrlab-mutation-") as scratch:
        folder = Path(scratch).resolve()
        trees = copies(folder, PROCESSES)
        tests = quick_tier()
        running: Queue[Forked] = Queue()
        started = [Forked(tree) for tree in trees]
        try:
            for worker in started:
                running.put(worker)
                some = within(sorted(tests.seconds), tests.seconds, 20)
                if code := worker.run(some, 600):
                    raise RuntimeError(f"tests end with {code} before anything is changed")
            with ThreadPoolExecutor(PROCESSES) as pool:
                work = pool.map(lambda mutant: fate(mutant, running, tests), drawn)
                return list(tqdm(work, total=len(drawn), desc="mutants", leave=False, disable=None))
        finally:
            for worker in started:
                worker.end()


def table(results: list[Fate]) -> str:
    """Return a line a room, and one for each survivor."""
    lines = [f"  {'room':<28}{'mutants':>9}{'killed':>8}"]
    rooms: dict[str, list[Fate]] = {}
    for result in results:
        rooms.setdefault("/".join(result.mutant.file.split("/")[1:-1])[:27] or "(top)", []).append(
            result
        )
    for room, own in sorted(rooms.items()):
        killed = sum(result.killed for result in own)
        lines.append(f"  {room:<28}{len(own):>9}{killed:>8}")
    left = [result for result in results if not result.killed]
    lines += ["  not seen:", *(f"  {result.mutant.said} ({result.tests} tests)" for result in left)]
    return "\n".join(lines)


def figures(files: Sequence[str]) -> dict[str, Any]:
    """Print the table of mutants of some files, and return how many the tests see."""
    results = fates(files)
    print(table(results), flush=True)
    return {
        "mutants": len(results),
        CLOSE: 100 * sum(result.killed for result in results) / len(results),
    }


def lessons(_: Path) -> dict[str, Any]:
    """Return how many mutants of the lessons are seen."""
    return figures(
        [
            str(path.relative_to(ROOT))
            for room in ROOMS
            for path in ROOT.glob(f"hdrlab/{room}/**/*.py")
        ]
    )


def grader(_: Path) -> dict[str, Any]:
    """Return how many mutants of the grader's trusted side are seen."""
    return figures(
        [
            str(path.relative_to(ROOT))
            for name in GRADER
            for path in ROOT.glob(f"hdrlab/course/{name}")
        ]
    )


ROWS = (
    Experiment("lessons", "mutants of the lessons, in the quick tier", lessons, ()),
    Experiment("grader", "mutants of the grader, in the quick tier", grader, ()),
)
