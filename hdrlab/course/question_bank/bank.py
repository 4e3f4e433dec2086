"""Run notebooks, collect their questions, and write them in the format of a file's suffix."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import nbformat

from hdrlab.course.authoring import execute
from hdrlab.course.question_bank import moodle, paper
from hdrlab.course.question_bank.questions import LessonQuestions, collect_questions
from hdrlab.course.site import pages
from hdrlab.errors import InputError
from hdrlab.io import files

WRITERS = {".xml": moodle.to_moodle, ".html": paper.to_page}


def require_format(out: Path) -> None:
    """Raise an InputError if the suffix of a file names no format of a question bank."""
    if out.suffix.lower() not in WRITERS:
        raise InputError(
            f"{out}: a question bank is Moodle XML (.xml) or a page to print (.html); "
            "pass -o with one of these suffixes"
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


def write(lessons: Sequence[LessonQuestions], out: Path) -> None:
    """Write the questions of notebooks, sorted by their titles."""
    require_format(out)
    in_order = sorted(lessons, key=lambda lesson: lesson.title)
    files.write(out, WRITERS[out.suffix.lower()](in_order))
