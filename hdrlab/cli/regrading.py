"""`hdrlab regrade`: what corrected checks would change for a class, and the change once it was seen."""

import json
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import click

from hdrlab.cli import classroom, common, grading
from hdrlab.course import plan as plans


@common.command()
@click.argument("results", type=grading.FOLDER)
@grading.HOMEWORK
@common.choice("--policy", ["replace", "never-lower", "only-listed"], help="Which new results are to count.")
@click.option("--only", metavar="WHO", multiple=True, help="Of only-listed, a student or team. Repeatable.")
@click.option("--requests", type=grading.FILE, multiple=True, help="CSV with student, task and words.")
@click.option("--why", default="", help="A sentence for the journal.")
@click.option("--jobs", type=click.IntRange(1), help="Submissions at a time.  [default: processors]")
@click.option("--cluster", metavar="ADDRESS", help="On this Dask cluster, tcp://HOST:8786.")
@click.option("--apply", is_flag=True, help="Let it count, with a signed line in the journal.")
def regrade(results: Path, requests: Sequence[Path], only: Sequence[str], policy: str, **how: Any) -> None:
    """Grade anew what the checks have changed of a class, and show who would move, by how much and why.

    RESULTS is what `hdrlab grade` has written of the class. Nothing in it changes before --apply.
    """
    from hdrlab.course.classroom import journal, regrade as review, run
    from hdrlab.course.scratch import temporary_folder

    whole = _as_graded(results, how)
    course, pieces = whole.course, whole.pieces
    words = review.requests(requests, course.roster)
    listed = {course.roster.team_of([one]) for one in only} | set(words)
    with temporary_folder(), journal.lock_folder(results):
        _, changed = journal.parted(results / "results", pieces)
        done = classroom.graded(whole, changed, results / "regrade")
        common.say("warning", [f"{one.piece.owner}: {one.why}" for one in done if one.why])
        moves = review.moves(results, pieces, policy, listed, words)
        click.echo(review.text(moves))
        click.echo(review.write(results, moves, course.homework.points, policy))
        if how["apply"]:
            now = datetime.now(UTC).isoformat(timespec="seconds")
            secret, why = course.conditions.secret, how["why"]
            review.apply(results, moves, pieces, secret, policy=policy, why=why, when=now)
            for one in journal.parted(results / "results", pieces)[0]:
                run.write_feedback(results, one)
            click.echo(classroom.write_books(whole)[0])


def _as_graded(results: Path, how: dict[str, Any]) -> classroom.Class:
    """Return a class as it was graded, by the options of then but for those that are given."""
    file = results / "asked.json"
    if not file.is_file():
        raise ValueError(f"{results}: expected the results of a class that `hdrlab grade` has graded")
    folder, said = json.loads(file.read_bytes())
    given = {name: value for name, value in how.items() if value is not None}
    context = grading.grade.make_context("grade", [folder], default_map=said)
    asked = SimpleNamespace(**context.params | given | {"out": results})
    # a class's own secret is never made anew: all inputs would be others
    secret = plans.read_secret(asked.secret_file.resolve(strict=True))[0] if asked.secret_file else ""
    conditions = plans.Conditions(asked.tier, "", secret, asked.hidden, asked.timeout)
    return classroom.class_of(conditions, asked)
