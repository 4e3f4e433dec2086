"""What became of a class: who got what, whose files two runs agree on, and what a large class would take."""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from benchmarks.class_.grading import Used
from benchmarks.class_.handed import Handed
from hdrlab.course.checks import misconceptions
from hdrlab.course.grading import results
from hdrlab.course.grading.results import Result
from hdrlab.course.students import csv_tables

LARGE = 50_000  # submissions
WORKERS = (16, 64, 256)


def read(out: Path) -> dict[str, Result]:
    """Return the results of a run, by team."""
    found = (results.from_json(file.read_bytes()) for file in (out / "results").glob("*.json"))
    return {result.student: result for result in found}


def files(out: Path, one: Handed) -> dict[str, str]:
    """Return digests of all that a run has written about a team: its files, and its rows of the gradebook."""
    named = [*(out / "results").glob(f"{one.team}.*"), *(out / "feedback" / one.team).rglob("*")]
    found = {
        str(file.relative_to(out)): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in named
        if file.is_file()
    }
    rows = [
        row for row in csv_tables.read_csv(out / "gradebook.csv") if row["student"] in one.students
    ]
    return found | {f"row of {row['student']}": repr(row) for row in rows}


def differing(one: Path, other: Path, each: Iterable[Handed]) -> int:
    """Return of how many files and rows two runs say different things."""
    count = 0
    for team in each:
        a, b = files(one, team), files(other, team)
        count += sum(a.get(name) != b.get(name) for name in {*a, *b})
    return count


def lost(graded: Mapping[str, Result], each: Sequence[Handed]) -> int:
    """Return how many submissions have no result."""
    return len({one.team for one in each} - set(graded))


def gained(graded: Mapping[str, Result], each: Iterable[Handed]) -> float:
    """Return the most points that something hostile has got."""
    return max(
        (graded[one.team].score for one in each if one.hostile and one.team in graded), default=0.0
    )


def not_whole(graded: Mapping[str, Result], each: Iterable[Handed]) -> int:
    """Return how many of those that are right have less than all points."""
    right = [one for one in each if one.kind in ("right", "equivalent")]
    return sum(
        one.team not in graded or graded[one.team].score < graded[one.team].max_score
        for one in right
    )


def not_named(graded: Mapping[str, Result], each: Iterable[Handed]) -> float:
    """Return the share of the mistakes that were not recognised, in percent."""
    known = {one.name: one for one in misconceptions.known()}
    wrong = [one for one in each if one.kind == "mistake"]
    missed = [
        one
        for one in wrong
        if one.team not in graded
        or graded[one.team].misconceptions.get(known[one.which].task) != known[one.which].sentence
    ]
    return 100 * len(missed) / max(len(wrong), 1)


def not_refused(graded: Mapping[str, Result], each: Iterable[Handed]) -> int:
    """Return how many archives with a trap were not refused with a line."""
    traps = [
        graded[one.team].problems if one.team in graded else ()
        for one in each
        if one.kind == "trap"
    ]
    return sum(
        not any(line.startswith("The archive is refused: ") for line in said) for said in traps
    )


def size(out: Path) -> tuple[int, int]:
    """Return how many files a run has written, and their bytes."""
    sizes = [file.stat().st_size for file in out.rglob("*") if file.is_file()]
    return len(sizes), sum(sizes)


def results_size(out: Path) -> int:
    """Return the bytes of the results alone, which workers send back."""
    return sum(file.stat().st_size for file in (out / "results").glob("*.json"))


def core_hours(used: Used, count: int) -> float:
    """Return the hours that LARGE submissions would keep one processor busy, without the command's own."""
    return (used.cpu - used.own) / count * LARGE / 3600
