"""`hdrlab grade` on a folder, a whole class, and `hdrlab regrade`, what corrected checks would change for it.

`asked` holds the options of a class by name, as the command line gave them.
"""

import json
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from hdrlab.cli import common, grading
from hdrlab.course import plan as plans
from hdrlab.errors import InputError

# options of a run; the others are of the class, and a regrade takes them as they were
OF_A_RUN = ("submission", "out", "only", "since", "regrade", "jobs", "cluster")

if TYPE_CHECKING:
    from hdrlab.course.classroom.handins import Submission, SubmissionScan
    from hdrlab.course.classroom.jobs import Executor, GradingJob, JobResult
    from hdrlab.course.classroom.run import GradingContext


class Class(NamedTuple):
    """A class that is graded: by what, what has come, what there is to do, and the options."""

    course: "GradingContext"
    found: "SubmissionScan"
    jobs: "list[GradingJob]"
    asked: Any


def class_of(conditions: plans.GradingOptions, asked: Any) -> Class:
    """Return a class with what it has handed in, as the options of `hdrlab grade` name it."""
    from hdrlab.course.classroom import handins, marks, roster as lists, run as classroom

    if asked.roster is None:
        raise InputError("expected --roster, which says who is in the class")
    homework = grading.homework_of(asked.submission, asked.homework, asked.plan)
    late, before = plans.read(asked.plan).late, marks.read(asked.before)
    course = classroom.GradingContext(lists.read(asked.roster), homework, conditions, late, before)
    times = handins.read_times(asked.received) if asked.received else {}
    found = handins.find(asked.submission, course.roster, times)
    return Class(course, found, classroom.make_jobs(found.submissions, homework, conditions), asked)


def grade_folder(whole: Class) -> None:
    """Grade what a class has handed in; what was graded before is not graded again."""
    from hdrlab.course.classroom import jobs, run as classroom

    course, found, pieces, asked = whole
    common.say("note", found.notes)
    options = {name: value for name, value in vars(asked).items() if name not in OF_A_RUN}
    since = asked.since.replace(tzinfo=UTC) if asked.since else None
    wanted = classroom.select_submissions(found.submissions, course.roster, asked.only, since)
    with jobs.lock_folder(asked.out):
        text = json.dumps([asked.submission, options], default=lambda path: str(path.resolve()))
        jobs.write_private_file(asked.out / "asked.json", text.encode())
        done = graded(whole, [piece for piece in pieces if piece.owner in wanted], asked.out)
        lost = [f"{one.job.owner}: {one.problem}" for one in done if one.problem]
        common.say("warning", lost)
        page, count = write_books(whole, lost)
        _compare(asked.out, course, found.submissions)
    fresh = sum(one.is_new for one in done if one.path)
    click.echo(f"{page}: {count} of {len(found.submissions)} graded, {fresh} of them now")


def write_books(whole: Class, lost: Sequence[str] = ()) -> tuple[Path, int]:
    """Write all that is about the whole class; return its page, and how many works have a result."""
    from hdrlab.course.classroom import moodle, overview, run as classroom

    course, found, pieces, asked = whole
    counted = overview.tally(classroom.read_results(asked.out, pieces))
    *_, page = overview.write(asked.out, course, found, counted, lost)
    if asked.moodle:
        rows = overview.marks_of(course, found, counted)
        common.say(
            "note", moodle.write(asked.out, asked.moodle, rows, course.roster, course.homework)
        )
    return page, len(counted.points)


def graded(whole: Class, wanted: "Sequence[GradingJob]", out: Path) -> "list[JobResult]":
    """Return what became of each submission; its feedback is written as soon as its result is there."""
    from hdrlab.course.classroom import jobs, run as classroom

    folder, course, asked = out / "results", whole.course, whole.asked
    before, rest = ([], [*wanted]) if asked.regrade else jobs.split_finished(folder, wanted)
    done = [classroom.write_feedback(out, one) for one in before]
    if before:
        click.echo(f"{len(before)} of {len(wanted)} were graded before", err=True)
    if rest:
        with _executor(course, asked) as executor:
            jobs.delete_results(folder, rest)
            steps = (
                classroom.write_feedback(out, one) for one in jobs.run_jobs(rest, executor, folder)
            )
            done += common.progress(steps, course.homework.name, len(rest))
    return done


def _compare(out: Path, course: "GradingContext", submissions: "Mapping[str, Submission]") -> None:
    """Write what is alike among all that was handed in, also what was graded before."""
    try:
        from hdrlab.course.overlap import alike
    except ImportError as error:
        click.echo(f'note: similar.html needs {error.name}: pip install "hdrlab[class]"', err=True)
        return
    if len(submissions) > alike.MOST:
        click.echo(f"note: no similar.html, which compares at most {alike.MOST:,} works", err=True)
        return
    steps = alike.write_steps(out, course.homework, submissions, course.conditions.secret)
    list(common.progress(steps, "what is alike", len(submissions)))


def _executor(course: "GradingContext", asked: Any) -> "Executor":
    """Return those who grade: processes of this machine, or the workers of a cluster."""
    from hdrlab.course.classroom import run as classroom
    from hdrlab.course.classroom.executors import processes
    from hdrlab.course.sandbox import doctor

    grader = classroom.Grader(
        course.homework, course.conditions, classroom.read_hidden_checks(course.conditions.hidden)
    )
    if asked.cluster is None:
        found = doctor.examine(
            course.conditions.tier
        )  # tried once, and not missed by each submission
        if not found.works:
            raise common.no_tier(found.says)
        return processes.Processes(grader.grade, asked.jobs)
    if asked.jobs is not None:
        raise InputError(
            "expected --jobs or --cluster: a cluster grades as many at a time as it has threads"
        )
    common.require("cluster", ["dask", "distributed"])
    from hdrlab.course.classroom.executors import cluster

    return cluster.Cluster(asked.cluster, grader.grade, grader.check_available)


@common.command()
@click.argument("results", type=grading.FOLDER)
@grading.HOMEWORK
@common.choice(
    "--policy", ["replace", "never-lower", "only-listed"], help="Which new results are to count."
)
@click.option(
    "--only", metavar="WHO", multiple=True, help="Of only-listed, a student or team. Repeatable."
)
@click.option(
    "--requests", type=grading.FILE, multiple=True, help="CSV with student, task and words."
)
@click.option("--why", default="", help="A sentence for the journal.")
@click.option(
    "--jobs", type=click.IntRange(1), help="Submissions at a time.  [default: processors]"
)
@click.option("--cluster", metavar="ADDRESS", help="On this Dask cluster, tcp://HOST:8786.")
@click.option("--apply", is_flag=True, help="Let it count, with a signed line in the journal.")
def regrade(
    results: Path, requests: Sequence[Path], only: Sequence[str], policy: str, **how: Any
) -> None:
    """Grade anew what the checks have changed of a class, and show who would move, by how much and why.

    RESULTS is what `hdrlab grade` has written of the class. Nothing in it changes before --apply.
    """
    from hdrlab.course.classroom import jobs, regrade as review, run
    from hdrlab.course.scratch import temporary_folder

    whole = _as_graded(results, how)
    course, pieces = whole.course, whole.jobs
    words = review.requests(requests, course.roster)
    listed = {course.roster.find_team(name) for name in only} | set(words)
    with temporary_folder(), jobs.lock_folder(results):
        _, changed = jobs.split_finished(results / "results", pieces)
        done = graded(whole, changed, results / "regrade")
        common.say("warning", [f"{one.job.owner}: {one.problem}" for one in done if one.problem])
        moves = review.moves(results, pieces, policy, listed, words)
        click.echo(review.text(moves))
        click.echo(review.write(results, moves, course.homework.points, policy))
        if how["apply"]:
            now = datetime.now(UTC).isoformat(timespec="seconds")
            secret, why = course.conditions.secret, how["why"]
            review.apply(results, moves, pieces, secret, policy=policy, why=why, when=now)
            for one in jobs.split_finished(results / "results", pieces)[0]:
                run.write_feedback(results, one)
            click.echo(write_books(whole)[0])


def _as_graded(results: Path, how: dict[str, Any]) -> Class:
    """Return a class as it was graded, by the options of then but for those that are given."""
    file = results / "asked.json"
    if not file.is_file():
        raise InputError(
            f"{results}: expected the results of a class that `hdrlab grade` has graded"
        )
    folder, said = json.loads(file.read_bytes())
    given = {name: value for name, value in how.items() if value is not None}
    context = grading.grade.make_context("grade", [folder], default_map=said)
    asked = SimpleNamespace(**context.params | given | {"out": results})
    # a class's own secret is never made anew: all inputs would be others
    secret = (
        plans.read_secret(asked.secret_file.resolve(strict=True))[0] if asked.secret_file else ""
    )
    conditions = plans.GradingOptions(asked.tier, "", secret, asked.hidden, asked.timeout)
    return class_of(conditions, asked)
