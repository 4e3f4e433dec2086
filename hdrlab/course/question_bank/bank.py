"""Collect the questions of notebooks or of the inventory, and write them in a file's format."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import nbformat

from hdrlab.course.authoring import execute
from hdrlab.course.question_bank import moodle, paper, qti, task_questions
from hdrlab.course.question_bank.inventory import all_questions
from hdrlab.course.question_bank.inventory.question import ConceptQuestion
from hdrlab.course.question_bank.questions import (
    ChoiceQuestion,
    LessonQuestions,
    collect_questions,
)
from hdrlab.course.site import pages
from hdrlab.errors import InputError
from hdrlab.io import files

WRITERS: dict[str, Callable[[Sequence[LessonQuestions]], str | bytes]] = {
    ".xml": moodle.to_moodle,
    ".zip": qti.to_package,
    ".html": paper.to_page,
}
INVENTORY_TITLE = "Concept inventory"
INVENTORY_INSTRUCTIONS = (
    "Choose one answer to each question. You may use a calculator, but no notes, books or other "
    "help. You will answer the same questions before and after the course, to show what the course "
    "teaches. They do not count for your grade. If you do not know an answer, say so instead of "
    "guessing."
)


def require_format(out: Path) -> None:
    """Raise an InputError if the suffix of a file names no format of a question bank."""
    if out.suffix.lower() not in WRITERS:
        raise InputError(
            f"{out}: a question bank is Moodle XML (.xml), a package of QTI 2.1 (.zip) or a page to "
            "print (.html); pass -o with one of these suffixes"
        )


def collect_steps(
    notebooks: Sequence[Path], cache: Path, *, jobs: int
) -> Iterator[LessonQuestions]:
    """Run notebooks, and yield the questions of each when it is done."""
    for executed in execute.run_steps(notebooks, cache, jobs=jobs):
        notebook = nbformat.read(executed.executed, 4)
        name = executed.source.stem
        title = pages.title_of(notebook) or name
        yield LessonQuestions(title, tuple(collect_questions(notebook, name)))


def inventory_lesson() -> LessonQuestions:
    """Return the questions of the concept inventory as choices."""
    questions = tuple(_to_choices(question) for question in all_questions())
    return LessonQuestions(
        INVENTORY_TITLE, questions, instructions=INVENTORY_INSTRUCTIONS, is_asked_again=True
    )


def task_lessons() -> list[LessonQuestions]:
    """Return the questions about the tasks of the course, which need no student's code."""
    return list(task_questions.lessons())


def _to_choices(question: ConceptQuestion) -> ChoiceQuestion:
    options = question.options
    return ChoiceQuestion(
        name=f"inventory-{question.name}",
        context="",
        text=question.stem,
        because=question.because,
        labels=options,
        right=options.index(question.right),
        misconceptions=tuple(question.misconceptions.get(text, "") for text in options),
    )


def write(lessons: Sequence[LessonQuestions], out: Path) -> None:
    """Write questions, sorted by the titles of their notebooks."""
    require_format(out)
    in_order = sorted(lessons, key=lambda lesson: lesson.title)
    files.write(out, WRITERS[out.suffix.lower()](in_order))
