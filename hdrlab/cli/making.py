"""Commands that make the course: its handouts, other systems' forms of it, tasks of an instructor's own."""

from pathlib import Path
from typing import Any

import click

from hdrlab.cli import common
from hdrlab.cli.grading import FILE, FOLDER, PLAN, SECRET, secret_of
from hdrlab.course import plan as plans
from hdrlab.errors import InputError


@common.main.group()
def course() -> None:
    """Make the course: its handouts, and other systems' forms of it."""


@course.command()
@click.option(
    "--sources", type=FOLDER, default="solutions", help="The prose, a file for each homework."
)
@click.option("--out", type=common.OUT, default="assignments", help="Folder for the handouts.")
@click.option(
    "--solutions", type=common.FILE, help="Folder for the worked notebooks, which are run for it."
)
@click.option("--jobs", type=click.IntRange(1), default=2, help="How many notebooks run at a time.")
@click.option(
    "--variants", type=FILE, metavar="ROSTER", help="A sheet for each team of this class."
)
@SECRET
@PLAN
def build(sources: Path, out: Path, solutions: Path | None, jobs: int, **of_class: Any) -> None:
    """Make the handouts anew: the sources' prose, the library's functions, the plan's points and dates.

    With --variants, sheets of which the plan's parameters are drawn by --secret-file, a folder for
    each team.
    """
    from hdrlab.course.classroom import roster
    from hdrlab.course.material import handouts, solutions as filled
    from hdrlab.course.site import execute

    common.require("course", ["jupytext"])
    plan, file = plans.read(of_class["plan"]), of_class["variants"]
    try:
        made = handouts.build_steps(plan, sources, out, solutions, jobs=jobs)
        if file is not None:
            secret, note = secret_of(of_class["secret_file"])
            if not secret:
                raise InputError(
                    "expected --secret-file with --variants, which draws them, as for grade"
                )
            click.echo(note, nl=bool(note), err=True)
            teams = roster.read(file).teams()
            made = filled.build_for_teams_steps(plan, sources, teams, secret, out, solutions)
        common.list_files(common.progress(made, "handouts"))
    except execute.NotebookError as error:
        raise click.ClickException(str(error)) from None


@course.command()
@click.option(
    "--nbgrader", type=common.OUT, metavar="DIR", help="A course for nbgrader, in this folder."
)
@click.option(
    "--gradescope", type=common.OUT, metavar="DIR", help="An autograder zip for each homework."
)
@click.option(
    "--hidden", type=FOLDER, help="Folder with checks of your own, test_<task>.py; for Gradescope."
)
@SECRET
@PLAN
def export(asked: Any) -> None:
    """Write the course in the form of another system, whose tests call the same checks."""
    from hdrlab.course.export import gradescope as to_gradescope, nbgrader as to_nbgrader

    if asked.nbgrader is None and asked.gradescope is None:
        raise InputError("expected --nbgrader DIR or --gradescope DIR")
    read = plans.read(asked.plan)
    if asked.nbgrader is not None:
        common.list_files(to_nbgrader.export(read, asked.nbgrader))
    if asked.gradescope is not None:
        secret, note = secret_of(asked.secret_file)
        click.echo(note, nl=bool(note), err=True)
        secrets = {"hidden": asked.hidden, "plan_file": asked.plan, "secret": secret}
        made = to_gradescope.export(read, asked.gradescope, **secrets)
        common.list_files(made)


@course.command("new-task")
@click.argument("task")
@click.option(
    "--folder", type=common.FILE, default="our-tasks", help="Its place, beside the package."
)
@click.option("--homework", default="extra", help="The homework that it belongs to.")
def new_task(task: str, folder: Path, homework: str) -> None:
    """Begin a task of your own: an example that works, whole, to be changed file by file."""
    from hdrlab.course.material import own_task

    common.list_files(own_task.write(folder, task, homework))
    click.echo(f"to try it: python -m pytest {folder}")


@course.command()
@click.argument("folder", type=common.FILE)
@PLAN
def pack(folder: Path, plan: Path | None) -> None:
    """Write the model solutions into FOLDER: each homework filled in with the library's functions."""
    from hdrlab.course.material import solutions

    common.list_files(solutions.write(plans.read(plan), folder))


@course.command()
@click.argument("folder", type=common.FILE)
def toy(folder: Path) -> None:
    """Make a toy class in FOLDER: a dozen submissions of hw2, good, late, wrong and hostile, to be graded."""
    from hdrlab.course.classroom import toy as classes
    from hdrlab.course.sandbox import doctor

    made = classes.write(folder)
    click.echo(
        f"{folder / 'README.md'}: what each of {len(made)} submissions of {classes.HOMEWORK} is"
    )
    command, strict = classes.COMMAND.format(folder=folder), doctor.examine("strict")
    if not strict.works:
        click.echo(f"note: {common.no_tier(strict.says)}", err=True)
        command += " --tier practice"
    click.echo(f"to grade it: {command}")
