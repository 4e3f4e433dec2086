"""The commands of `hdrlab course`.

They are `build`, `export`, `gain`, `move`, `new-task`, `pack`, `questions`, `slides` and `toy`.
"""

import os
from datetime import datetime
from pathlib import Path

import click

from hdrlab.cli import assignments, common
from hdrlab.errors import InputError

SLIDES_MODULES = ("mdit_py_plugins", "ziamath")
jobs_option = click.option(
    "--jobs",
    type=click.IntRange(1),
    default=min(4, os.cpu_count() or 1),
    help="Number of notebooks to run at the same time.",
)


@click.group(cls=common.Group)
def course() -> None:
    """Build assignments, solutions and slides, and export the course."""


@course.command()
@click.option(
    "--sources",
    type=common.EXISTING_FOLDER,
    default="solutions",
    help="Folder with the text of each homework.",
)
@click.option(
    "-o",
    "--out",
    type=common.OUTPUT_PATH,
    default="assignments",
    help="Folder for the assignments.",
)
@click.option(
    "--solutions",
    type=common.INPUT_PATH,
    help="Folder for the solved and executed notebooks.",
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
    help="Class list (CSV), to build assignments for each team, see above.",
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
    """Build the assignments.

    hdrlab combines the texts, the library's functions and the course plan.

    With --variants, hdrlab makes a folder for each team, with the team's own variants of the tasks.
    The plan lists the parameters that vary. The secret of --secret-file determines their values.
    """
    from hdrlab.course import plan as plans
    from hdrlab.course.authoring import execute, handouts, solutions as solved
    from hdrlab.course.scratch import temporary_folder
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
                    "--variants needs --secret-file: the secret determines each team's variants"
                )
            assignments.echo_secret_note(note)
            teams = roster.read(variants, team_size=course_plan.team_size).teams()
            written = solved.build_for_teams_steps(
                course_plan, sources, teams, secret, out, solutions
            )
        with temporary_folder():
            common.echo_paths(common.progress(written, "handouts"))
    except execute.NotebookError as error:
        raise click.ClickException(str(error)) from None


@course.command()
@click.option(
    "--nbgrader", type=common.OUTPUT_PATH, metavar="DIR", help="Folder for an nbgrader course."
)
@click.option(
    "--gradescope",
    type=common.OUTPUT_PATH,
    metavar="DIR",
    help="Folder for Gradescope autograders, one zip file for each homework.",
)
@click.option(
    "--hidden",
    type=common.EXISTING_FOLDER,
    help="Folder with your own hidden checks, test_<task>.py, for Gradescope.",
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
    """Export the course to nbgrader or Gradescope."""
    from hdrlab.course import plan as plans
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


@course.command()
@click.argument("first_day", type=click.DateTime(["%Y-%m-%d"]), metavar="DATE")
@click.option(
    "-o",
    "--out",
    type=common.OUTPUT_PATH,
    required=True,
    help="The new plan, such as our-plan.toml.",
)
@click.option(
    "--holidays",
    type=common.EXISTING_FILE,
    help="Dates, one a line: the weeks of these days have no class.",
)
@assignments.plan_option
def move(*, first_day: datetime, out: Path, holidays: Path | None, plan: Path | None) -> None:
    """Give the plan the dates of a term whose first week begins on DATE.

    hdrlab writes a new plan, which you pass to the other commands with --plan.
    """
    from hdrlab.course import due_dates, plan as plans
    from hdrlab.course.authoring import term
    from hdrlab.io import files

    plan_path = plans.PLAN if plan is None else plan
    files.require_other([out], [plan_path, *([holidays] if holidays else [])])
    old_plan = plans.read(plan_path)
    free_days = term.read_holidays(holidays) if holidays else old_plan.holidays
    files.write(out, term.move(plan_path.read_text(encoding="utf8"), first_day.date(), free_days))
    unchanged = []
    for name, homework in plans.read(out).homeworks.items():
        click.echo(f"{name}: {due_dates.describe(homework.due)}")
        if homework.due == old_plan.homeworks[name].due:
            unchanged.append(name)
    if unchanged:
        common.echo_notes(
            [
                f"the date of {', '.join(unchanged)} did not change; a date moves with the term if "
                'the plan gives a week: due = { week = 3, day = "Friday", time = "23:59Z" }'
            ]
        )
    click.echo(f"{out}; to write the assignments: hdrlab course build --plan {out} -o our-sheets")


@course.command("new-task")
@click.argument("task")
@click.option(
    "-o",
    "--out",
    type=common.INPUT_PATH,
    default="our-tasks",
    help="Folder for the task, outside hdrlab.",
)
@click.option("--homework", default="extra", help="Homework that the task belongs to.")
def new_task(*, task: str, out: Path, homework: str) -> None:
    """Create a task of your own, from a complete example.

    The example works. Change it file by file.
    """
    from hdrlab.course.authoring import own_task

    common.echo_paths(own_task.write(out, task, homework))
    click.echo(f"to try it: python -m pytest {out}")


@course.command()
@click.argument("folder", type=common.INPUT_PATH)
@click.option(
    "--exercises",
    type=common.INPUT_PATH,
    default="solutions/exercises",
    help="Folder with the answers to the exercises, in a clone of hdrlab.",
)
@click.option(
    "--written",
    type=common.INPUT_PATH,
    default="solutions/written_questions.ipynb",
    help="Notebook of the written questions, in a clone of hdrlab.",
)
@assignments.plan_option
def pack(*, folder: Path, exercises: Path, written: Path, plan: Path | None) -> None:
    """Write model solutions to FOLDER, for instructors.

    hdrlab solves each homework with the library's functions. It copies the answers to the exercises
    of the notebooks, and the written questions with their model answers and marking schemes; it
    writes a sheet of these questions for students. The installed package does not contain these
    answers. Run the command in a clone of hdrlab, or pass --exercises and --written.
    """
    from hdrlab.course import plan as plans
    from hdrlab.course.authoring import solutions

    answers = sorted(exercises.glob("*.ipynb"))
    questions = written if written.is_file() else None
    common.echo_paths(solutions.write(plans.read(plan), folder, answers, questions))
    if not answers:
        common.echo_notes(
            [
                f"{exercises} has no answers to the exercises; run the command in a clone of "
                "hdrlab, or pass --exercises FOLDER"
            ]
        )
    if questions is None:
        common.echo_notes(
            [f"no written questions in {written}; run the command in a clone, or pass --written"]
        )


@course.command()
@click.argument("notebooks", nargs=-1, metavar="[NOTEBOOK]...")
@click.option(
    "-o",
    "--out",
    type=common.OUTPUT_PATH,
    default="questions.xml",
    help="Moodle XML (.xml), a package of QTI 2.1 (.zip), or a page to print, with the answers at "
    "its end (.html).",
)
@click.option(
    "--tasks",
    is_flag=True,
    help="Write questions about the tasks instead: values, mistakes, checks and images.",
)
@click.option(
    "--inventory",
    is_flag=True,
    help="Write the concept inventory instead: thirty questions to ask before and after the course.",
)
@jobs_option
def questions(
    *, notebooks: tuple[str, ...], out: Path, tasks: bool, inventory: bool, jobs: int
) -> None:
    """Write a question bank from the predictions of the notebooks.

    NOTEBOOK is the name or the number of a notebook of hdrlab, such as 04, or the path of a
    notebook of your own. By default, hdrlab uses all of its notebooks.

    The bank contains each question with a choice or a number as its answer. hdrlab runs the
    notebooks, which compute the right answers. Import the file into the question bank of a Moodle
    course as Moodle XML, or into another platform as QTI 2.1.

    With --tasks or --inventory, hdrlab runs no notebook. The questions of --tasks have the kinds of
    `hdrlab viva`, without a student's code. `hdrlab course gain` compares the answers to the
    inventory that students gave before and after the course.

    hdrlab keeps the executed notebooks in .NAME.cache next to the file. The next run executes only
    notebooks that have changed.
    """
    common.require_modules("site", SLIDES_MODULES)
    from hdrlab.course.authoring import execute
    from hdrlab.course.classroom.jobs import lock_folder
    from hdrlab.course.question_bank import bank
    from hdrlab.course.scratch import temporary_folder
    from hdrlab.course.site import pages
    from hdrlab.course.slides import decks
    from hdrlab.io import files

    bank.require_format(out)
    if inventory or tasks:
        if notebooks or inventory == tasks:
            raise InputError(
                "--inventory and --tasks use no notebooks; pass one of them, without names"
            )
        lessons = [bank.inventory_lesson()] if inventory else bank.task_lessons()
        bank.write(lessons, out)
        click.echo(f"{out}: {sum(len(lesson.questions) for lesson in lessons)} questions")
        return
    chosen = decks.find_notebooks(notebooks)
    files.require_other([out], chosen)
    # Jupyter needs a working folder; if it is gone, stop here and not in the middle
    os.getcwd()
    cache = pages.make_cache(out)
    with temporary_folder(), lock_folder(cache):
        steps = bank.collect_steps(chosen, cache, jobs=jobs)
        try:
            lessons = list(common.progress(steps, "notebooks", len(chosen)))
        except execute.NotebookError as error:
            raise click.ClickException(str(error)) from None
    bank.write(lessons, out)
    count = sum(len(lesson.questions) for lesson in lessons)
    click.echo(f"{out}: {count} questions of {len(lessons)} notebooks")


@course.command()
@click.argument("before", type=common.EXISTING_FILE)
@click.argument("after", type=common.EXISTING_FILE)
@click.option(
    "-o",
    "--out",
    type=common.OUTPUT_PATH,
    default="gain.html",
    help="Page about the class.",
)
def gain(*, before: Path, after: Path, out: Path) -> None:
    """Compare the answers of a class to the concept inventory before and after the course.

    BEFORE and AFTER are tables (CSV) with a line for each student: Moodle's quiz report
    "Responses", or a table with the columns student, q1, q2, ... and the letters of the answers.
    hdrlab matches the students by their ids, which the page does not name.

    The page shows the percentage of right answers before and after the course, the normalized gain
    of each concept, and the wrong answer that remains most frequent, with the section of the
    notebook to read again. `hdrlab course questions --inventory` writes the questions.
    """
    from hdrlab.course.question_bank import answers, gain as gains
    from hdrlab.io import files

    files.require_other([out], [before, after])
    files.require_suffix(out, [".html"], "a page")
    answers_before = answers.read_answers(before)
    answers_after = answers.read_answers(after)
    matched = answers.match_students(answers_before, answers_after)
    class_gain = gains.compute_gain(answers_before, answers_after, matched)
    files.write(out, gains.gain_page(class_gain, gains.describe_left_out(class_gain, matched)))
    common.echo_notes(answers.describe_unmatched(matched, before, after))
    total = class_gain.total
    shown = "" if total.gain is None else f", gain {total.gain:.2f}"
    students = "1 student" if class_gain.students == 1 else f"{class_gain.students} students"
    click.echo(f"{out}: {students} answered before and after{shown}")


@course.command()
@click.argument("notebooks", nargs=-1, metavar="[NOTEBOOK]...")
@click.option(
    "-o",
    "--out",
    type=common.OUTPUT_PATH,
    default="slides",
    help="Folder for the decks, one HTML file for each notebook.",
)
@jobs_option
def slides(*, notebooks: tuple[str, ...], out: Path, jobs: int) -> None:
    """Make a deck of slides from each notebook.

    NOTEBOOK is the name or the number of a notebook of hdrlab, such as 04, or the path of a
    notebook of your own. By default, hdrlab makes a deck from each of its notebooks.

    A deck is one HTML file with live widgets and speaker notes. It needs no server and no
    network. Open it in a browser. The key S shows the notes. To print it, or to save it as PDF,
    write ?print-pdf at the end of its address.

    hdrlab keeps the executed notebooks in .NAME.cache next to the folder. The next run executes
    only notebooks that have changed.
    """
    common.require_modules("site", SLIDES_MODULES)
    from hdrlab.course.authoring import execute
    from hdrlab.course.classroom.jobs import lock_folder
    from hdrlab.course.scratch import temporary_folder
    from hdrlab.course.site import pages
    from hdrlab.course.slides import decks
    from hdrlab.io import files

    chosen = decks.find_notebooks(notebooks)
    files.require_folder_name(out)
    # Jupyter needs a working folder; if it is gone, stop here and not in the middle
    os.getcwd()
    cache = pages.make_cache(out)
    out.mkdir(parents=True, exist_ok=True)
    written = []
    with temporary_folder(), lock_folder(cache):
        steps = decks.write_steps(chosen, out, cache, jobs=jobs)
        try:
            for deck in common.progress(steps, "decks", len(chosen)):
                click.echo(f"{deck.path}: {deck.slides} slides")
                written.append(deck)
        except execute.NotebookError as error:
            raise click.ClickException(str(error)) from None
    count = sum(deck.slides for deck in written)
    fresh = sum(deck.fresh for deck in written)
    click.echo(f"{out}: {len(written)} decks, {count} slides; run now: {fresh}")


@course.command()
@click.argument("folder", type=common.INPUT_PATH)
def toy(*, folder: Path) -> None:
    """Create an example class in FOLDER.

    It consists of a dozen submissions: some are correct, the others late, wrong or hostile.
    """
    from hdrlab.course.authoring import toy_class as toy_class
    from hdrlab.course.grading import doctor

    written = toy_class.write(folder)
    click.echo(
        f"{folder / 'README.md'}: describes the {len(written)} submissions of {toy_class.HOMEWORK}"
    )
    command = toy_class.COMMAND.format(folder=folder)
    strict_tier = doctor.examine("strict")
    if not strict_tier.works:
        common.echo_notes([common.tier_error(strict_tier.details)])
        command += " --tier practice"
    click.echo(f"to grade it: {command}")
