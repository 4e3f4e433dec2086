"""Which tests of the quick tier run which line, and how long each takes: found by one run with coverage."""

import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections import defaultdict
from pathlib import Path
from typing import NamedTuple

import coverage

from benchmarks.measure import THREADS

# tests that run a file unseen by coverage: from outside, or in processes of their own
SANDBOX = (
    "tests/course/test_grading.py::test_in_a_sandbox_the_library_earns_all_points_and_a_blank_none"
)
KNOBS = "tests/test_knobs.py::test_every"
AFAR = {
    "hdrlab/": (
        f"{KNOBS}_knob_stands_where_its_list_says",
        f"{KNOBS}_constant_stands_where_its_list_says",
    ),
    "hdrlab/course/": (f"{SANDBOX}[project]",),
}


class Known(NamedTuple):
    """`lines`: file -> line -> tests that run it; `seconds`: of each test, with what it sets up."""

    lines: dict[str, dict[int, set[str]]]
    seconds: dict[str, float]

    def near(self, file: str, line: int) -> list[str]:
        """Return the tests that run a line, the shortest first."""
        return sorted(self.lines.get(file, {}).get(line, set()), key=self._taken)

    def far(self, file: str, line: int) -> list[str]:
        """Return the other tests that run the file: a line may be run as it is imported."""
        own = (
            set().union(*self.lines.get(file, {}).values()) if self.lines.get(file) else set[str]()
        )
        own |= {test for start, tests in AFAR.items() if file.startswith(start) for test in tests}
        return sorted(own - set(self.near(file, line)), key=self._taken)

    def _taken(self, test: str) -> tuple[float, str]:
        return self.seconds.get(test, 0.0), test


def known(tree: Path, folder: Path) -> Known:
    """Return what a run of the quick tier in a tree tells; RuntimeError where a test fails."""
    data = folder / "coverage"
    results = folder / "quick.xml"
    command = [sys.executable, "-m", "pytest", "--tier=quick", "-q", f"--junitxml={results}"]
    command += [
        "--cov=hdrlab",
        "--cov-context=test",
        "--cov-report=",
        f"--basetemp={folder / 'tmp'}",
    ]
    environment = (
        os.environ
        | dict.fromkeys(THREADS, "1")
        | {"COVERAGE_FILE": str(data), "PYTHONPATH": str(tree)}
    )
    ran = subprocess.run(command, cwd=tree, env=environment, capture_output=True, text=True)
    if ran.returncode:
        raise RuntimeError(f"the quick tier fails before anything is changed: {ran.stdout[-500:]}")
    seconds: dict[str, float] = {}
    for case in ET.parse(results).iter("testcase"):
        seconds[f"{case.get('classname')}::{case.get('name')}"] = float(case.get("time", 0))
    coverage_data = coverage.CoverageData(str(data))
    coverage_data.read()
    lines: dict[str, dict[int, set[str]]] = {}
    for file in coverage_data.measured_files():
        contexts = coverage_data.contexts_by_lineno(file)
        own: dict[int, set[str]] = defaultdict(set)
        for line, names in contexts.items():
            own[line] |= {name.rpartition("|")[0] for name in names if "|" in name}
        lines[Path(file).relative_to(tree).as_posix()] = dict(own)
    every = set().union(*(tests for own in lines.values() for tests in own.values()))
    return Known(
        lines, {test: seconds.get(_junit(test), 0.0) for test in every.union(*AFAR.values())}
    )


def _junit(address: str) -> str:
    """Return an address in the form in which results name it."""
    file, _, rest = address.partition("::")
    path = file.removesuffix(".py").replace("/", ".")
    *classes, name = _parts(rest)
    return f"{'.'.join([path, *classes])}::{name}"


def _parts(rest: str) -> list[str]:
    plain, bracket, argument = rest.partition("[")
    *classes, name = plain.split("::")
    return [*classes, name + bracket + argument]
