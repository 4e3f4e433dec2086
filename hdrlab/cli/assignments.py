"""Options and steps that the commands about assignments share."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hdrlab.cli import common
from hdrlab.errors import InputError

if TYPE_CHECKING:
    from hdrlab.course import plan as plans
    from hdrlab.course.grading.results import Result
    from hdrlab.course.reports.receipts import SigningKey

TIERS = ["strict", "container", "practice"]

plan_option = click.option(
    "--plan",
    type=common.EXISTING_FILE,
    help="Course plan to use instead of the package's plan.toml.",
)
homework_option = click.option(
    "--homework",
    metavar="NAME",
    help="Assignment, such as hw2.  [default: from the file name]",
)
secret_option = click.option(
    "--secret-file",
    type=common.INPUT_PATH,
    help="File with the course's secret. If it does not exist, hdrlab creates it.",
)
tier_option = common.choice_option(
    "--tier",
    TIERS,
    help="Sandbox: strict (bubblewrap), container (inside a disposable container) or practice "
    "(none; not for credit).",
)


def find_homework(submission: Path, name: str | None, plan: Path | None) -> "plans.Homework":
    """Return the homework of a name, or the one whose name occurs in the submission's file name."""
    from hdrlab.course import plan as plans

    homeworks = plans.read(plan).homeworks
    names = ", ".join(homeworks)
    if name is None:
        matches = [known for known in homeworks if known in submission.stem.lower()]
        if len(matches) != 1:
            raise InputError(
                f"{submission.name}: the file name contains no homework's name; "
                f"pass --homework, one of {names}"
            )
        return homeworks[matches[0]]
    if name not in homeworks:
        raise InputError(f"there is no homework {name!r}; pass --homework, one of {names}")
    return homeworks[name]


def read_secret(file: Path | None) -> tuple[str, str]:
    """Return the course's secret, and a note for the instructor, "" if there is nothing to note."""
    from hdrlab.course import plan as plans

    if file is None:
        return "", "for practice only: without --secret-file, anybody can compute the inputs"
    secret, is_new = plans.read_secret(file)
    if is_new:
        return secret, f"{file}: created a secret for the course; do not lose or share this file"
    return secret, ""


def echo_secret_note(note: str) -> None:
    """Print the note of `read_secret` on standard error, if there is one."""
    if note:
        common.echo_notes([note])


def read_receipt_key(file: Path | None) -> "SigningKey | None":
    """Return the key that signs receipts, or None without a file; note it if the key is new."""
    if file is None:
        return None
    common.require_modules("class", ["cryptography"])
    from hdrlab.course.reports import receipts

    key, is_new = receipts.read_private_key(file)
    if is_new:
        common.echo_notes(
            [
                f"{file}: created a key that signs receipts; do not lose or share this file, and "
                f"publish {receipts.public_key_path(file)}"
            ]
        )
    return key


def grade_submission(
    submission: Path, homework: "plans.Homework", conditions: "plans.GradingOptions"
) -> "Result":
    """Return the result of a submission, while a terminal shows how many checks are done."""
    from hdrlab.core.steps import last
    from hdrlab.course.grading import grader
    from hdrlab.course.sandbox.session import Unavailable
    from hdrlab.course.scratch import temporary_folder

    if not submission.exists():
        raise FileNotFoundError(2, "no such file", str(submission))
    try:
        with temporary_folder():
            steps: Any = grader.grade_steps(submission, homework, conditions)
            return last(common.progress(steps, homework.name))
    except Unavailable as error:
        raise common.tier_error(str(error)) from None
