"""`python -m benchmarks [SUBJECT ...] [--rows A,B] [--seed N]`: measure, print; 1 if a hold is missed."""

import argparse
import json
import os
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

from benchmarks import peers, table
from benchmarks.experiments import Experiment, Skipped, findings
from benchmarks.measure import measured, rows_of
from benchmarks.rows import Outcome, Row, verdicts

HERE = Path(__file__).parent
STOPPED = 130  # the exit code of what Ctrl-C ends


def subjects() -> list[str]:
    """Return the names of the modules and folders here that have ROWS, read as text and not imported."""
    files = [*HERE.glob("*.py"), *HERE.glob("*/__init__.py")]
    with_rows = [file for file in files if "\nROWS" in file.read_text(encoding="utf8")]
    names = [file.parent.name if file.stem == "__init__" else file.stem for file in with_rows]
    return sorted(name.removesuffix("_") for name in names)


def chosen(subject: str, names: str | None) -> list[Row | Experiment]:
    """Return the rows of a subject with these names, separated by commas, or those of a whole run."""
    rows: list[Row | Experiment] = list(rows_of(subject))
    if names is None:
        return [row for row in rows if not getattr(row, "only_by_name", False)]
    return [row for row in rows if row.name in names.split(",")]


def parse(arguments: list[str] | None) -> argparse.Namespace:
    """Return the options, or end with what is wrong with them."""
    parser = argparse.ArgumentParser(
        "python -m benchmarks", description="hdrlab beside its peers, and papers."
    )
    parser.add_argument(
        "subjects", nargs="*", metavar="SUBJECT", help=f"{', '.join(subjects())}; all by default"
    )
    parser.add_argument("--rows", metavar="A,B", help="these rows alone")
    parser.add_argument("--json", metavar="FILE", type=Path, help="write the figures here, too")
    parser.add_argument(
        "--data",
        metavar="DIR",
        type=Path,
        help="read measured curves and maps here, not in ../shared/data; keep photographs for next time",
    )
    parser.add_argument(
        "--seed",
        metavar="N",
        type=int,
        default=0,
        help="draw other brackets in brackets-peers and verdicts-sound; 0 by default",
    )
    options = parser.parse_args(arguments)
    options.subjects = options.subjects or subjects()
    if unknown := set(options.subjects) - set(subjects()):
        parser.error(
            f"expected subjects out of {', '.join(subjects())}, got {', '.join(sorted(unknown))}"
        )
    known = [row.name for subject in options.subjects for row in rows_of(subject)]
    if options.rows and (unknown := set(options.rows.split(",")) - set(known)):
        parser.error(f"expected rows out of {', '.join(known)}, got {', '.join(sorted(unknown))}")
    return options


def run(subject: str, rows: list[Row | Experiment], folder: Path, seed: int) -> Iterator[Outcome]:
    """Measure, print and yield a subject's rows; one that breaks does not stop the others."""
    load = f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}"
    print(f"{subject} on {load}; {peers.versions()}\n", flush=True)
    for row in rows:
        results: Mapping[str, Any] | None
        try:
            results, line = done(subject, row, folder, seed)
        except Skipped as reason:
            results = {}
            line = f"{row.name}: skipped, {reason}"
        except RuntimeError as error:
            results = None
            line = f"{row.name}: failed, {error}"
        print(line + "\n", flush=True)
        yield row, results


def done(
    subject: str, row: Row | Experiment, folder: Path, seed: int
) -> tuple[Mapping[str, Any], str]:
    """Return the figures of a row, and its block of the table."""
    if isinstance(row, Experiment):
        result = findings(row, folder, seed)
        return result, table.experiment(row, result)
    results, missing = measured(subject, row, folder)
    return results, table.block(row, results, missing)


def plain(figures: Any) -> Any:
    """Return figures as JSON has them."""
    return figures._asdict() if hasattr(figures, "_asdict") else figures


def main(arguments: list[str] | None = None) -> int:
    """Return the exit code: 0 where every hold that could be judged is met."""
    arguments = sys.argv[1:] if arguments is None else arguments
    if arguments[:1] == ["fuzz"]:  # it has options of its own
        return int(import_module("benchmarks.fuzz").main(arguments[1:]))
    if arguments[:1] == ["pictures"]:  # it writes pictures, for people to look at
        return int(import_module("benchmarks.pictures").main(arguments[1:]))
    options = parse(arguments)
    start = time.perf_counter()
    outcomes: list[Outcome] = []
    stopped = False
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.data or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        try:
            for subject in options.subjects:
                rows = chosen(subject, options.rows)
                outcomes.extend(run(subject, rows, folder, options.seed))
        except KeyboardInterrupt:
            stopped = True
    print(f"{table.summary(outcomes)}; it took {time.perf_counter() - start:.0f} s")
    if options.json:
        figures = {
            row.name: {who: plain(value) for who, value in (results_of_row or {}).items()}
            for row, results_of_row in outcomes
        }
        options.json.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf8")
    if stopped:
        print("stopped before the end", file=sys.stderr)
        return STOPPED
    return int(any(line == "MISSED" for _, _, line in verdicts(outcomes)))


if __name__ == "__main__":
    sys.exit(main())
