"""`hdrlab grade` on a folder: a whole class, with what instructors need afterwards."""

import os
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hdrlab.cli import common

if TYPE_CHECKING:
    from hdrlab.course.grading import Conditions
    from hdrlab.course.plan import Homework


def grade_folder(
    folder: Path,
    out: Path,
    homework: "Homework",
    conditions: "Conditions",
    *,
    plan: Path | None,
    roster: Path | None,
    received: Path | None,
    before: tuple[Path, ...],
    only: tuple[str, ...],
    since: datetime | None,
    regrade: bool,
    jobs: int | None,
) -> None:
    """Grade what a class has handed in; what was graded before is not graded again."""
    from hdrlab.course import classroom, gradebook, handins, journal, marks, results, sheets
    from hdrlab.course import plan as plans
    from hdrlab.course import roster as lists

    if roster is None:
        raise ValueError("expected --roster, which says who is in the class")
    since = since.replace(tzinfo=UTC) if since else None
    students = lists.read(roster)
    times = _times(received) if received else {}
    counted, notes = handins.find(folder, students, times)
    for note in notes:
        click.echo(f"note: {note}", err=True)
    everything = classroom.pieces(counted, homework, conditions)
    names = {students.team_of([one]) if one not in counted else one for one in only}
    wanted = [
        piece
        for piece in everything
        if (not only or piece.owner in names) and (since is None or counted[piece.owner].received >= since)
    ]
    grader = classroom.Grader(homework.name, plan, conditions)
    steps = journal.done_steps(
        wanted, grader.result, out / "results", jobs=jobs or os.cpu_count() or 1, again=regrade
    )
    done = list(common.progress(steps, homework.name, len(wanted)))
    lost = [f"{one.piece.owner}: {one.why}" for one in done if one.result is None]
    for said in lost:
        click.echo(f"warning: {said}", err=True)
    kept = journal.results(out / "results", {piece.owner: piece for piece in everything})
    graded = {team: results.from_json(data) for team, data in kept.items()}
    for one in done:
        if one.result and one.piece.owner in graded:
            gradebook.write_results(out / "feedback" / one.piece.owner, graded[one.piece.owner])
    late = plans.read(plan).late
    rows = marks.marks(students, homework, counted, classroom.points(graded), late, marks.read(before))
    sheets.write_csv(out / "gradebook.csv", marks.COLUMNS, rows, private=True)
    sheets.write_csv(out / "canvas.csv", *marks.canvas(rows, homework), private=True)
    page = classroom.page(homework, graded.values(), [*notes, *lost])
    journal.write(out / "class.html", page.encode())
    fresh = sum(one.fresh for one in done if one.result)
    click.echo(f"{out / 'class.html'}: {len(graded)} of {len(counted)} graded, {fresh} of them now")


def _times(path: Path) -> dict[str, datetime]:
    """Return when files came, from a table with the columns file and received."""
    from hdrlab.course import sheets

    times = {}
    for row in sheets.read_csv(path):
        try:
            times[row["file"]] = datetime.fromisoformat(row["received"])
        except (KeyError, ValueError):
            raise ValueError(
                f"{path}: expected the columns file and received, 2026-03-01T12:00+01:00"
            ) from None
        if times[row["file"]].tzinfo is None:
            raise ValueError(f"{path}: expected times with a zone, got {row['received']}")
    return times
