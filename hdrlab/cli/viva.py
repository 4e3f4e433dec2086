"""The command that prepares an oral examination on a student's own code: `viva`."""

from dataclasses import dataclass
from pathlib import Path

import click

from hdrlab.cli import assignments, common

# the examiner that runs in the sandbox, module:class
EXAMINER = "hdrlab.course.viva.examining:Examining"


@dataclass(frozen=True)
class VivaOptions:
    """The options that the pages repeat, so that the questions can be made again."""

    submission: Path
    student: str
    tier: str
    seed: int | None


@click.command(cls=common.Command)
@click.argument("submission", type=click.Path(path_type=Path, exists=True))
@assignments.homework_option
@assignments.tier_option
@click.option(
    "-o", "--out", type=common.OUTPUT_PATH, help="Folder for the pages.  [default: viva/NAME]"
)
@click.option(
    "--photographs",
    type=common.EXISTING_FILE,
    multiple=True,
    help="Photo to use in the questions. Repeatable.  [default: an embedded scene]",
)
@click.option(
    "--student",
    default="",
    show_default=False,
    help="Student for whom to write the questions. Requires --secret-file.",
)
@click.option(
    "--seed", type=click.IntRange(0), help="Seed, to get other questions for a second exam."
)
@assignments.secret_option
@assignments.plan_option
def viva(
    *,
    submission: Path,
    homework: str | None,
    tier: str,
    out: Path | None,
    photographs: tuple[Path, ...],
    student: str,
    seed: int | None,
    secret_file: Path | None,
    plan: Path | None,
) -> None:
    """Write five questions about SUBMISSION for an oral exam.

    SUBMISSION is a notebook or a Python file of a student. For each question, hdrlab changes one
    detail of a function that passes all checks, and runs the changed function to compute the
    answer. The questions show whether students understand the code, but not who wrote it.

    hdrlab writes the questions to viva.html, quiz.html (to print) and oral.html (for the
    conversation), the answers to examiner.html, and a practice notebook, viva.ipynb.
    """
    from hdrlab.course import plan as plans, scratch
    from hdrlab.course.grading import grader
    from hdrlab.course.sandbox.session import Unavailable
    from hdrlab.course.viva import pages
    from hdrlab.io.files import write

    assignment = assignments.find_homework(submission, homework, plan)
    secret, note = assignments.read_secret(secret_file)
    conditions = plans.GradingOptions(tier=tier, student=student, secret=secret, draw=False)
    drawn_seed = seed
    if drawn_seed is None:
        drawn_seed = plans.seed(secret, student, f"viva {assignment.name}")
    folder = out or Path("viva") / submission.stem
    # a folder that cannot be written is reported before the work starts
    folder.mkdir(parents=True, exist_ok=True)
    read, assignment = grader.read_tasks(submission, assignment, conditions)
    try:
        with scratch.temporary_folder():
            steps = grader.iter_events(
                read,
                assignment,
                conditions,
                by=EXAMINER,
                seed=str(drawn_seed),
                photographs=pages.photographs(photographs),
            )
            questions = list(common.progress(steps, "viva"))
    except Unavailable as error:
        raise common.tier_error(str(error)) from None
    common.echo_notes(read.problems)
    options = VivaOptions(submission=submission, student=student, tier=tier, seed=seed)
    for name, text in pages.pages(questions, homework=assignment, asked=options, read=read):
        click.echo(write(folder / name, text))
    (folder / "examiner.html").chmod(0o600)
    assignments.echo_secret_note(note)
