"""`hdrlab grade` on a folder: a whole class, with what instructors need afterwards.

`asked` holds the options of a class by name, as the command line gave them.
"""

from collections.abc import Mapping, Sequence
from datetime import UTC
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hdrlab.cli import common
from hdrlab.course import plan as plans

if TYPE_CHECKING:
    from hdrlab.course.classroom.handins import Handin
    from hdrlab.course.classroom.journal import Done, Executor, Piece
    from hdrlab.course.classroom.run import Course


def grade_folder(folder: Path, out: Path, course: "Course", asked: Any) -> None:
    """Grade what a class has handed in; what was graded before is not graded again."""
    from hdrlab.course.classroom import handins, journal, moodle, overview
    from hdrlab.course.classroom import run as classroom

    times = handins.read_times(asked.received) if asked.received else {}
    found = handins.find(folder, course.roster, times)
    common.say("note", found.notes)
    since = asked.since.replace(tzinfo=UTC) if asked.since else None
    everything = classroom.pieces(found.handins, course.homework, course.conditions)
    wanted = classroom.select_handins(found.handins, course.roster, asked.only, since)
    with journal.lock_folder(out):
        done = _graded([piece for piece in everything if piece.owner in wanted], out, course, asked)
        lost = [f"{one.piece.owner}: {one.why}" for one in done if one.why]
        common.say("warning", lost)
        counted = overview.tally(classroom.read(out, everything))
        *_, page = overview.write(out, course, found, counted, lost)
        if asked.moodle:
            rows = overview.marks_of(course, found, counted)
            common.say("note", moodle.write(out, asked.moodle, rows, course.roster, course.homework))
        _compare(out, course, found.handins)
    fresh = sum(one.fresh for one in done if one.result)
    click.echo(f"{page}: {len(counted.points)} of {len(found.handins)} graded, {fresh} of them now")


def _graded(wanted: "Sequence[Piece]", out: Path, course: "Course", asked: Any) -> "list[Done]":
    """Return what became of each submission; its feedback is written as soon as its result is there."""
    from hdrlab.course.classroom import journal
    from hdrlab.course.classroom import run as classroom

    folder = out / "results"
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
    steps = alike.write_steps(out, course.homework, handins)
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


def course_of(
    homework: plans.Homework, conditions: plans.Conditions, plan: Path | None, asked: Any
) -> "Course":
    """Return what a class is graded by, read from the files that were named."""
    from hdrlab.course.classroom import marks
    from hdrlab.course.classroom import roster as lists
    from hdrlab.course.classroom import run as classroom

    if asked.roster is None:
        raise ValueError("expected --roster, which says who is in the class")
    late, before = plans.read(plan).late, marks.read(asked.before)
    return classroom.Course(lists.read(asked.roster), homework, conditions, late, before)
