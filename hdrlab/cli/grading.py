"""Commands about assignments: a student's check, and an instructor's grade."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hdrlab.cli import common
from hdrlab.course import plan as plans
from hdrlab.errors import InputError

if TYPE_CHECKING:
    from hdrlab.course.reports.results import Result

FILE = click.Path(path_type=Path, exists=True, dir_okay=False)
FOLDER = click.Path(path_type=Path, exists=True, file_okay=False)
PLAN = click.option(
    "--plan", type=FILE, help="A plan of your own instead of the package's plan.toml."
)
HOMEWORK = click.option(
    "--homework", metavar="NAME", help="Such as hw2; by default the file's name says it."
)

SECRET = click.option(
    "--secret-file", type=common.FILE, help="Draws students' inputs; made on first use."
)


@common.command()
@click.argument("submission", type=click.Path(path_type=Path))
@HOMEWORK
@click.option("--task", metavar="NAME", help="Only this one, such as gsolve.")
@click.option(
    "--hints", type=click.IntRange(0, 3), default=0, help="So many hints of what does not hold."
)
@click.option("--page", type=common.OUT, help="The same as a page with pictures: a .html file.")
@PLAN
def check(asked: Any) -> None:
    """Check SUBMISSION, a notebook or a Python file, as often as you like. Not for credit.

    Your functions run in a process of their own, which is no sandbox: check what you trust.
    """
    from hdrlab.course.reports import feedback
    from hdrlab.io.files import write

    homework = homework_of(asked.submission, asked.homework, asked.plan)
    if asked.task is not None:
        tasks = {one.id: one for one in homework.tasks}
        if asked.task not in tasks:
            raise InputError(f"expected a task out of {', '.join(tasks)}, got {asked.task!r}")
        homework = homework._replace(tasks=(tasks[asked.task],))
    conditions = plans.GradingOptions(tier="practice", draw=asked.page is not None)
    result = _graded(asked.submission, homework, conditions)
    click.echo(feedback.text(result, hints=asked.hints))
    if asked.page is not None:
        click.echo(write(asked.page, feedback.page(result)))


@common.command()
@click.argument("submission", type=click.Path(path_type=Path))
@HOMEWORK
@common.choice(
    "--tier", ["strict", "container", "practice"], help="How its code is kept apart; see doctor."
)
@click.option("--hidden", type=FOLDER, help="Folder with checks of your own, test_<task>.py.")
@click.option("-o", "--out", type=common.OUT, default="results", help="Folder for the results.")
@click.option("--student", default="", help="Draws this student's own inputs; needs --secret-file.")
@SECRET
@click.option(
    "--timeout", type=click.FloatRange(0.1), default=10.0, help="Seconds for an answer, see above."
)
@click.option(
    "--roster", type=FILE, help="Of a class: CSV with student, and name, team where wanted."
)
@click.option(
    "--received", type=FILE, help="Of a class: CSV with file and received, for files' own times."
)
@click.option(
    "--before", type=FILE, multiple=True, help="Gradebook of an earlier homework. Repeatable."
)
@click.option(
    "--moodle", type=FILE, help="Of a class: the assignment's grading worksheet, to be filled in."
)
@click.option(
    "--only", metavar="WHO", multiple=True, help="Of a class, this student or team. Repeatable."
)
@click.option("--since", type=click.DateTime(), help="Of a class, what has come since then, UTC.")
@click.option("--regrade", is_flag=True, help="Of a class, anew what was graded before.")
@click.option(
    "--jobs", type=click.IntRange(1), help="Submissions at a time.  [default: processors]"
)
@click.option(
    "--cluster", metavar="ADDRESS", help="Of a class, on this Dask cluster, tcp://HOST:8786."
)
@PLAN
def grade(asked: Any) -> None:
    """Grade SUBMISSION, a notebook or a Python file, and write the results in every form.

    Its code never runs in the process that scores it. A tier that this machine cannot give is an
    error. An answer may take the seconds of --timeout, a check 3 times and a submission 20 times as
    many.

    The file of --secret-file holds a line that nobody else knows, and is not to be lost.

    A folder is a class: with --roster, every submission in it is graded, several at a time, and a
    gradebook and a page about the class are written. Stopped at any moment, the next run finishes
    the rest.
    """
    from hdrlab.course.reports import feedback, gradebook
    from hdrlab.course.scratch import temporary_folder

    if asked.student and asked.secret_file is None:
        raise InputError(
            "expected --secret-file with --student: else anybody could draw the same inputs"
        )
    secret, note = secret_of(asked.secret_file)
    conditions = plans.GradingOptions(
        asked.tier, asked.student, secret, asked.hidden, asked.timeout
    )
    if asked.submission.is_dir():
        from hdrlab.cli import classroom

        with temporary_folder():
            classroom.grade_folder(classroom.class_of(conditions, asked))
        click.echo(note, nl=bool(note), err=True)
        return
    homework = homework_of(asked.submission, asked.homework, asked.plan)
    result = _graded(asked.submission, homework, conditions)
    click.echo(feedback.text(result, private=True))
    if not result.for_credit:
        click.echo(f"note: for practice. {result.why_practice}", err=True)
    if secret:
        click.echo(note, nl=bool(note), err=True)
    gradebook.write_results(asked.out, result)
    click.echo(asked.out / "feedback.html")


@common.command()
def doctor() -> None:
    """Say which tiers of isolation this machine can give, and what is missing for the others."""
    from hdrlab.course.sandbox import doctor as visiting

    for tier, works, credit, says, remedy in visiting.report():
        answer, worth = "yes" if works else "no", "for credit" if credit else "practice"
        click.echo(f"{tier:<10}{answer:<5}{worth:<12}{says}")
        if remedy:
            click.echo(f"{'':<10}{remedy}")


def homework_of(submission: Path, name: str | None, plan: Path | None) -> plans.Homework:
    """Return the homework that is asked for, or the one whose name stands in the file's."""
    homeworks = plans.read(plan).homeworks
    if name is None:
        fitting = [one for one in homeworks if one in submission.stem.lower()]
        if len(fitting) != 1:
            names = ", ".join(homeworks)
            raise InputError(f"expected --homework, one of {names}: {submission.name} does not say")
        (name,) = fitting
    if name not in homeworks:
        raise InputError(f"expected a homework out of {', '.join(homeworks)}, got {name!r}")
    return homeworks[name]


def secret_of(file: Path | None) -> tuple[str, str]:
    """Return the course's secret, and a note where it was made, or where there is none."""
    if file is None:
        return "", "note: for practice: without --secret-file the inputs are public"
    secret, made = plans.read_secret(file)
    return (
        secret,
        f"note: {file}: a new secret for the course; keep it, and keep it to yourself" * made,
    )


def _graded(
    submission: Path, homework: plans.Homework, conditions: plans.GradingOptions
) -> "Result":
    """Return the Result, while a terminal shows how many checks have been answered."""
    from hdrlab.core.steps import last
    from hdrlab.course import grading
    from hdrlab.course.sandbox.running import Unavailable
    from hdrlab.course.scratch import temporary_folder

    if not submission.exists():
        raise FileNotFoundError(2, "no such file", str(submission))
    try:
        with temporary_folder():
            steps: Any = grading.grade_steps(submission, homework, conditions)
            return last(common.progress(steps, homework.name))
    except Unavailable as error:
        raise common.no_tier(str(error)) from None
