"""The commands that build the course: `course build`, `export`, `new-task`, `pack` and `toy`."""

from pathlib import Path

import click

from hdrlab.cli import assignments, common
from hdrlab.course import plan as plans
from hdrlab.errors import InputError


@click.group(cls=common.Group)
def course() -> None:
    """Build the course: its handouts, and exports for other systems."""


@course.command()
@click.option(
    "--sources",
    type=common.EXISTING_FOLDER,
    default="solutions",
    help="Folder with the text of each homework.",
)
@click.option(
    "--out", type=common.OUTPUT_PATH, default="assignments", help="Folder for the handouts."
)
@click.option(
    "--solutions",
    type=common.INPUT_PATH,
    help="Folder for the solved notebooks. hdrlab executes them.",
)
@click.option(
    "--jobs",
    type=click.IntRange(1),
    default=2,
    help="Number of notebooks to run at the same time.",
)
@click.option(
    "--variants",
    type=common.EXISTING_FILE,
    metavar="ROSTER",
    help="Class list (CSV) with the teams that get handouts of their own.",
)
@assignments.secret_option
@assignments.plan_option
def build(
    *,
    sources: Path,
    out: Path,
    solutions: Path | None,
    jobs: int,
    variants: Path | None,
    secret_file: Path | None,
    plan: Path | None,
) -> None:
    """Build the handouts from the texts, the library's functions, and the plan's points and dates.

    With --variants, hdrlab writes a folder with handouts for each team. The plan's parameters in
    them are determined by the secret of --secret-file.
    """
    from hdrlab.course.authoring import execute, handouts, solutions as solved
    from hdrlab.course.students import roster

    common.require_modules("course", ["jupytext"])
    course_plan = plans.read(plan)
    try:
        if variants is None:
            written = handouts.build_steps(course_plan, sources, out, solutions, jobs=jobs)
        else:
            secret, note = assignments.read_secret(secret_file)
            if not secret:
                raise InputError(
                    "--variants needs --secret-file: the secret determines each team's parameters"
                )
            assignments.echo_secret_note(note)
            teams = roster.read(variants).teams()
            written = solved.build_for_teams_steps(
                course_plan, sources, teams, secret, out, solutions
            )
        common.echo_paths(common.progress(written, "handouts"))
    except execute.NotebookError as error:
        raise click.ClickException(str(error)) from None


@course.command()
@click.option(
    "--nbgrader", type=common.OUTPUT_PATH, metavar="DIR", help="Folder for a course of nbgrader."
)
@click.option(
    "--gradescope",
    type=common.OUTPUT_PATH,
    metavar="DIR",
    help="Folder for Gradescope's autograders, a zip file for each homework.",
)
@click.option(
    "--hidden",
    type=common.EXISTING_FOLDER,
    help="Folder with your own checks, test_<task>.py, for Gradescope.",
)
@assignments.secret_option
@assignments.plan_option
def export(
    *,
    nbgrader: Path | None,
    gradescope: Path | None,
    hidden: Path | None,
    secret_file: Path | None,
    plan: Path | None,
) -> None:
    """Export the course to another system. Its tests call the same checks."""
    from hdrlab.course.authoring.export import (
        gradescope as gradescope_export,
        nbgrader as nbgrader_export,
    )

    if nbgrader is None and gradescope is None:
        raise InputError("nothing to export; pass --nbgrader DIR or --gradescope DIR")
    course_plan = plans.read(plan)
    if nbgrader is not None:
        common.echo_paths(nbgrader_export.export(course_plan, nbgrader))
    if gradescope is not None:
        secret, note = assignments.read_secret(secret_file)
        assignments.echo_secret_note(note)
        written = gradescope_export.export(
            course_plan, gradescope, hidden=hidden, plan_file=plan, secret=secret
        )
        common.echo_paths(written)


@course.command("new-task")
@click.argument("task")
@click.option(
    "--folder",
    type=common.INPUT_PATH,
    default="our-tasks",
    help="Folder for the task, outside the package.",
)
@click.option("--homework", default="extra", help="Homework that the task belongs to.")
def new_task(*, task: str, folder: Path, homework: str) -> None:
    """Create a task of your own: a complete example that works, to change file by file."""
    from hdrlab.course.authoring import own_task

    common.echo_paths(own_task.write(folder, task, homework))
    click.echo(f"to try it: python -m pytest {folder}")


@course.command()
@click.argument("folder", type=common.INPUT_PATH)
@assignments.plan_option
def pack(*, folder: Path, plan: Path | None) -> None:
    """Write the model solutions into FOLDER: each homework, solved with the library's functions."""
    from hdrlab.course.authoring import solutions

    common.echo_paths(solutions.write(plans.read(plan), folder))


@course.command()
@click.argument("folder", type=common.INPUT_PATH)
def toy(*, folder: Path) -> None:
    """Create an example class in FOLDER: a dozen good, late, wrong and hostile submissions."""
    from hdrlab.course.authoring import toy_class as toy_class
    from hdrlab.course.grading import doctor

    written = toy_class.write(folder)
    click.echo(
        f"{folder / 'README.md'}: describes the {len(written)} submissions of {toy_class.HOMEWORK}"
    )
    command = toy_class.COMMAND.format(folder=folder)
    strict_tier = doctor.examine("strict")
    if not strict_tier.works:
        common.echo_notes([common.tier_error(strict_tier.says)])
        command += " --tier practice"
    click.echo(f"to grade it: {command}")
