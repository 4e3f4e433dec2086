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
    results_read = (
        results.from_json(file.read_bytes()) for file in (out / "results").glob("*.json")
    )
    return {result.student: result for result in results_read}


def files(out: Path, member: Handed) -> dict[str, str]:
    """Return digests of all that a run has written about a team: its files, and its rows of the gradebook."""
    named = [
        *(out / "results").glob(f"{member.team}.*"),
        *(out / "feedback" / member.team).rglob("*"),
    ]
    files_found = {
        str(file.relative_to(out)): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in named
        if file.is_file()
    }
    rows = [
        row
        for row in csv_tables.read_csv(out / "gradebook.csv")
        if row["student"] in member.students
    ]
    return files_found | {f"row of {row['student']}": repr(row) for row in rows}


def differing(folder: Path, other_folder: Path, members: Iterable[Handed]) -> int:
    """Return of how many files and rows two runs say different things."""
    count = 0
    for team in members:
        a = files(folder, team)
        b = files(other_folder, team)
        count += sum(a.get(name) != b.get(name) for name in {*a, *b})
    return count


def lost(graded: Mapping[str, Result], members: Sequence[Handed]) -> int:
    """Return how many submissions have no result."""
    return len({member.team for member in members} - set(graded))


def gained(graded: Mapping[str, Result], members: Iterable[Handed]) -> float:
    """Return the most points that something hostile has got."""
    return max(
        (
            graded[member.team].score
            for member in members
            if member.hostile and member.team in graded
        ),
        default=0.0,
    )


def not_whole(graded: Mapping[str, Result], members: Iterable[Handed]) -> int:
    """Return how many of those that are right have less than all points."""
    right = [member for member in members if member.kind in ("right", "equivalent")]
    return sum(
        member.team not in graded or graded[member.team].score < graded[member.team].max_score
        for member in right
    )


def not_named(graded: Mapping[str, Result], members: Iterable[Handed]) -> float:
    """Return the share of the mistakes that were not recognised, in percent."""
    known = {member.name: member for member in misconceptions.known()}
    wrong = [member for member in members if member.kind == "mistake"]
    missed = [
        member
        for member in wrong
        if member.team not in graded
        or graded[member.team].misconceptions.get(known[member.which].task)
        != known[member.which].sentence
    ]
    return 100 * len(missed) / max(len(wrong), 1)


def not_refused(graded: Mapping[str, Result], members: Iterable[Handed]) -> int:
    """Return how many archives with a trap were not refused with a line."""
    traps = [
        graded[member.team].problems if member.team in graded else ()
        for member in members
        if member.kind == "trap"
    ]
    return sum(
        not any(line.startswith("The archive is refused: ") for line in trap_text)
        for trap_text in traps
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
