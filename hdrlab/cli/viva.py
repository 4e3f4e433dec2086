"""`hdrlab viva`: an oral examination on a student's own functions, which writes itself."""

from pathlib import Path
from typing import Any

import click

from hdrlab.cli import common, grading
from hdrlab.course import plan as plans

EXAMINER = "hdrlab.course.viva.examining:Examining"


@common.command()
@click.argument("submission", type=click.Path(path_type=Path, exists=True))
@grading.HOMEWORK
@common.choice(
    "--tier", ["strict", "container", "practice"], help="How its code is kept apart; see doctor."
)
@click.option("-o", "--out", type=common.OUT, help="Folder for the sheets.  [default: viva/NAME]")
@click.option(
    "--photographs", type=grading.FILE, multiple=True, help="Photograph to ask about. Repeatable."
)
@click.option(
    "--student", default="", help="Draws this student's own questions, with --secret-file."
)
@click.option("--seed", type=click.IntRange(0), help="Draws other questions, for a second try.")
@grading.SECRET
@grading.PLAN
def viva(asked: Any) -> None:
    """Write five questions on the code of SUBMISSION, a notebook or a Python file, for an oral examination.

    Each is about one of its functions that keep every promise, with one small change, and was
    answered by running it. viva.html, quiz.html and oral.html ask; examiner.html has the answers;
    viva.ipynb is for practice. They show whether somebody understands the code, and not who wrote
    it.
    """
    from hdrlab.course import grading as grader, scratch
    from hdrlab.course.sandbox.running import Unavailable
    from hdrlab.course.viva import pages
    from hdrlab.io.files import write

    homework = grading.homework_of(asked.submission, asked.homework, asked.plan)
    secret, note = grading.secret_of(asked.secret_file)
    conditions = plans.GradingOptions(asked.tier, asked.student, secret, draw=False)
    seed = (
        plans.seed(secret, asked.student, f"viva {homework.name}")
        if asked.seed is None
        else asked.seed
    )
    out = asked.out or Path("viva") / asked.submission.stem
    out.mkdir(parents=True, exist_ok=True)  # better known before the work, where it cannot be
    read, homework = grader.read_tasks(asked.submission, homework, conditions)
    more = {"by": EXAMINER, "seed": str(seed), "photographs": pages.photographs(asked.photographs)}
    try:
        with scratch.temporary_folder():
            steps = grader.heard_steps(read, homework, conditions, **more)
            found = [*common.progress(steps, "viva")]
    except Unavailable as error:
        raise common.no_tier(str(error)) from None
    common.say("note", read.problems)
    for name, text in pages.pages(found, homework=homework, asked=asked, read=read):
        click.echo(write(out / name, text))
    (out / "examiner.html").chmod(0o600)
    click.echo(note, nl=bool(note), err=True)
