"""`hdrlab grade` on a folder: a whole class, with what instructors need afterwards.

`asked` holds the options of a class by name, as the command line gave them.
"""

import json
from collections.abc import Mapping, Sequence
from datetime import UTC
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from hdrlab.cli import common, grading
from hdrlab.course import plan as plans

# options of a run; the others are of the class, and a regrade takes them as they were
OF_A_RUN = ("submission", "out", "only", "since", "regrade", "jobs", "cluster")

if TYPE_CHECKING:
    from hdrlab.course.classroom.handins import Found, Handin
    from hdrlab.course.classroom.journal import Done, Executor, Piece
    from hdrlab.course.classroom.run import Course


class Class(NamedTuple):
    """A class that is graded: by what, what has come, what there is to do, and the options."""

    course: "Course"
    found: "Found"
    pieces: "list[Piece]"
    asked: Any


def class_of(conditions: plans.Conditions, asked: Any) -> Class:
    """Return a class with what it has handed in, as the options of `hdrlab grade` name it."""
    from hdrlab.course.classroom import handins, marks, roster as lists, run as classroom

    if asked.roster is None:
        raise ValueError("expected --roster, which says who is in the class")
    homework = grading.homework_of(asked.submission, asked.homework, asked.plan)
    late, before = plans.read(asked.plan).late, marks.read(asked.before)
    course = classroom.Course(lists.read(asked.roster), homework, conditions, late, before)
    times = handins.read_times(asked.received) if asked.received else {}
    found = handins.find(asked.submission, course.roster, times)
    return Class(course, found, classroom.pieces(found.handins, homework, conditions), asked)


def grade_folder(whole: Class) -> None:
    """Grade what a class has handed in; what was graded before is not graded again."""
    from hdrlab.course.classroom import journal, run as classroom

    course, found, pieces, asked = whole
    common.say("note", found.notes)
    options = {name: value for name, value in vars(asked).items() if name not in OF_A_RUN}
    since = asked.since.replace(tzinfo=UTC) if asked.since else None
    wanted = classroom.select_handins(found.handins, course.roster, asked.only, since)
    with journal.lock_folder(asked.out):
        text = json.dumps([asked.submission, options], default=lambda path: str(path.resolve()))
        journal.write(asked.out / "asked.json", text.encode())
        done = graded(whole, [piece for piece in pieces if piece.owner in wanted], asked.out)
        lost = [f"{one.piece.owner}: {one.why}" for one in done if one.why]
        common.say("warning", lost)
        page, count = write_books(whole, lost)
        _compare(asked.out, course, found.handins)
    fresh = sum(one.fresh for one in done if one.result)
    click.echo(f"{page}: {count} of {len(found.handins)} graded, {fresh} of them now")


def write_books(whole: Class, lost: Sequence[str] = ()) -> tuple[Path, int]:
    """Write all that is about the whole class; return its page, and how many works have a result."""
    from hdrlab.course.classroom import moodle, overview, run as classroom

    course, found, pieces, asked = whole
    counted = overview.tally(classroom.read(asked.out, pieces))
    *_, page = overview.write(asked.out, course, found, counted, lost)
    if asked.moodle:
        rows = overview.marks_of(course, found, counted)
        common.say("note", moodle.write(asked.out, asked.moodle, rows, course.roster, course.homework))
    return page, len(counted.points)


def graded(whole: Class, wanted: "Sequence[Piece]", out: Path) -> "list[Done]":
    """Return what became of each submission; its feedback is written as soon as its result is there."""
    from hdrlab.course.classroom import journal, run as classroom

    folder, course, asked = out / "results", whole.course, whole.asked
    before, rest = ([], [*wanted]) if asked.regrade else journal.parted(folder, wanted)
    done = [classroom.write_feedback(out, one) for one in before]
    if before:
        click.echo(f"{len(before)} of {len(wanted)} were graded before", err=True)
    if rest:
        with _executor(course, asked) as executor:
            journal.forget(folder, rest)
            steps = (classroom.write_feedback(out, one) for one in journal.done_steps(rest, executor, folder))
            done += common.progress(steps, course.homework.name, len(rest))
    return done


def _compare(out: Path, course: "Course", handins: "Mapping[str, Handin]") -> None:
    """Write what is alike among all that was handed in, also what was graded before."""
    try:
        from hdrlab.course.overlap import alike
    except ImportError as error:
        click.echo(f'note: similar.html needs {error.name}: pip install "hdrlab[class]"', err=True)
        return
    if len(handins) > alike.MOST:
        click.echo(f"note: no similar.html, which compares at most {alike.MOST:,} works", err=True)
        return
    steps = alike.write_steps(out, course.homework, handins, course.conditions.secret)
    list(common.progress(steps, "what is alike", len(handins)))


def _executor(course: "Course", asked: Any) -> "Executor":
    """Return those who grade: processes of this machine, or the workers of a cluster."""
    from hdrlab.course.classroom import run as classroom
    from hdrlab.course.classroom.executors import processes
    from hdrlab.course.sandbox import doctor

    grader = classroom.Grader(course.homework, course.conditions, classroom.hidden(course.conditions.hidden))
    if asked.cluster is None:
        found = doctor.examine(course.conditions.tier)  # tried once, and not missed by each submission
        if not found.works:
            raise common.no_tier(found.says)
        return processes.Processes(grader.result, asked.jobs)
    if asked.jobs is not None:
        raise ValueError("expected --jobs or --cluster: a cluster grades as many at a time as it has threads")
    common.require("cluster", ["dask", "distributed"])
    from hdrlab.course.classroom.executors import cluster

    return cluster.Cluster(asked.cluster, grader.result, grader.ready)
