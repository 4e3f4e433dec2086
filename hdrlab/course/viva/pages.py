"""Write the questions: for the student, on paper, for the examiner, and as a practice notebook."""

import base64
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import nbformat
import numpy as np

from hdrlab import scenes
from hdrlab.course.sanitize import sanitize_text
from hdrlab.course.viva import self_check
from hdrlab.course.viva.examining import MAX_QUESTIONS
from hdrlab.io import photos
from hdrlab.show.pages.templates import templates

# longer side of a photograph that questions show, approximately
PHOTOGRAPH_SIDE_PIXELS = 128
LETTERS = "ABCD"
PAGES = ("viva", "quiz", "oral", "examiner")
KERNEL = {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"}

Question = dict[str, Any]

tidy = partial(sanitize_text, max_length=20_000)


def photographs(files: Sequence[Path]) -> list[list[list[int]]]:
    """Return small photographs as gray levels; without files, an embedded scene."""
    images = [photos.read_photo(file) for file in files]
    if not images:
        images = [np.log(scenes.room() + 1e-6)]
    return [_gray_levels(image) for image in images]


def _gray_levels(image: np.ndarray) -> list[list[int]]:
    """Return an image as gray levels from 0 to 255, made smaller by leaving out pixels."""
    gray = image.reshape(*image.shape[:2], -1).mean(axis=-1)
    step = max(1, max(gray.shape) // PHOTOGRAPH_SIDE_PIXELS)
    small = gray[::step, ::step]
    value_range = np.ptp(small) or 1
    levels: list[list[int]] = (255 * (small - small.min()) / value_range).astype(int).tolist()
    return levels


def pages(lines: Sequence[dict[str, Any]], **context: Any) -> Iterator[tuple[str, str]]:
    """Yield the name and the text of each file.

    Parameters
    ----------
    lines : what the run of the checks wrote: the tasks that passed, and the questions
    **context : what the templates need beside: `homework`, `asked` and `read`
    """
    questions = [line["question"] for line in lines if "question" in line]
    passed = next(line["passed"] for line in lines if "passed" in line)
    context |= {"questions": questions, "passed": passed}
    environment = templates(Path(__file__).parent)
    environment.filters["tidy"] = tidy
    page = environment.get_template("viva.html")
    for sheet in PAGES:
        yield f"{sheet}.html", page.render(context, sheet=sheet, attached=False)
    macros = environment.get_template("question.html").make_module({**context, "attached": True})
    notebook = practice_notebook(questions, passed, context["homework"].title, macros)
    yield "viva.ipynb", nbformat.writes(notebook)


def practice_notebook(
    questions: Sequence[Question], passed: Sequence[str], title: str, macros: Any
) -> Any:
    """Return the notebook in which a student answers the questions and checks the letters.

    Parameters
    ----------
    questions : the questions, as the run of the checks wrote them
    passed : ids of the tasks that passed their checks
    title : the homework's title
    macros : the macros of question.html
    """
    letters = [LETTERS[question["right"]] for question in questions]
    explanations = [explanation(question) for question in questions]
    cells = [
        nbformat.v4.new_markdown_cell(introduction(questions, passed, title), id="viva-head"),
        nbformat.v4.new_code_cell(self_check.cell_text(letters, explanations), id="viva-check"),
    ]
    for number, question in enumerate(questions, 1):
        text = f"## {number}. `{question['task']}`\n\n{macros.question(question)}"
        cell = nbformat.v4.new_markdown_cell(text, id=f"viva-{number}")
        images = attached_images(question, macros)
        if images:
            cell["attachments"] = images
        cells.append(cell)
        cells.append(nbformat.v4.new_code_cell(f'check({number}, "")', id=f"viva-check-{number}"))
    metadata = {"kernelspec": KERNEL, "language_info": {"name": "python"}}
    return nbformat.v4.new_notebook(cells=cells, metadata=metadata, nbformat_minor=5)


def introduction(questions: Sequence[Question], passed: Sequence[str], title: str) -> str:
    """Return the text of the notebook's first cell."""
    paragraphs = [f"# Questions on your own work: {title}"]
    if len(questions) < MAX_QUESTIONS:
        functions = ", ".join(passed) or "none"
        paragraphs.append(
            f"**{len(questions)} of five questions.** There are no more questions in the functions "
            f"that pass all checks: {functions}."
        )
    paragraphs.append(
        "Each question shows one of your functions. Unless the question says otherwise, it "
        "contains one change, and the changed function was run. Exactly one option is what it "
        "returned: put its letter into the cell below. This is for practice: with four options, "
        "you can find the right one by trying all of them. The questions show whether you "
        "understand the code. They do not show who wrote it."
    )
    return "\n\n".join(paragraphs)


def explanation(question: Question) -> str:
    """Return what each option of a question comes from, one line an option."""
    lines = []
    for k, version in enumerate(question["versions"]):
        if question["kind"] != "line":
            code = version["function"].split("\n")[version["line"] - 1].strip()
            origin = f"line {version['line']}, {tidy(version['change'])}: {tidy(code)}"
        elif k < len(question["lines"]):
            line = question["lines"][k]
            origin = f"your code with the value of line {line} written out where its name was used"
        else:
            origin = "your code as it is"
        lines.append(f"{LETTERS[k]} comes from {origin}")
    return "\n".join(lines)


def attached_images(question: Question, macros: Any) -> dict[str, dict[str, str]]:
    """Return the figures of a question as attachments of a notebook cell, by file name."""
    figures: dict[str, str] = {}
    if "given" in question:
        figures["given.svg"] = macros.svg(question["given"])
    if "own" in question:
        figures["own.svg"] = macros.svg(question["own"], question.get("marks", ()))
    if question["kind"] == "picture":
        for letter, figure in zip(LETTERS, question["figures"], strict=True):
            figures[f"{letter}.svg"] = macros.svg(figure)
    return {
        name: {"image/svg+xml": base64.b64encode(str(svg).encode()).decode()}
        for name, svg in figures.items()
    }
