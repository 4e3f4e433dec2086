"""Read the answers of a class to the concept inventory from a CSV file.

The file is a table with a line for each student. It is either Moodle's quiz report "Responses",
whose columns "Response 1", "Response 2", ... hold the text of the chosen answers and "-" where a
student chose none, or a table of your own with the columns student, q1, q2, ..., whose cells hold
the letters of the printed questions.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from hdrlab.course.classroom import moodle
from hdrlab.course.question_bank.inventory import all_questions
from hdrlab.course.question_bank.inventory.question import ConceptQuestion
from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.students import csv_tables
from hdrlab.course.students.csv_tables import CsvRow, CsvTable
from hdrlab.course.students.roster import fold
from hdrlab.errors import InputError

ID_COLUMNS = ("student", *moodle.ID_COLUMNS)  # the first one that both files have counts
QUESTION_COLUMN = re.compile(r"(?:q|response) ?(\d{1,4})", re.ASCII)
LETTER = re.compile(r"([a-z])[).]?", re.ASCII | re.IGNORECASE)
NO_ANSWER = ("", "-")
LETTERS = "abcde"
MAX_SHOWN_CHARACTERS = 40  # of a cell, in a message


@dataclass(frozen=True)
class Answers:
    """What one student answered.

    Attributes
    ----------
    line : the line of the file
    ids : the student's ids by column, "" where a cell is empty
    chosen : the text of the chosen answer by the index of its question; "" for none
    """

    line: int
    ids: dict[str, str]
    chosen: dict[int, str]


@dataclass(frozen=True)
class ClassAnswers:
    """The answers of a class: the file that they come from, its columns of ids, and its students.

    Attributes
    ----------
    path : the file
    id_columns : the columns that may identify a student, see ID_COLUMNS
    questions : the indices of the questions that the file has
    students : the students who answered at least one question
    """

    path: Path
    id_columns: tuple[str, ...]
    questions: tuple[int, ...]
    students: tuple[Answers, ...]


@dataclass(frozen=True)
class MatchedAnswers:
    """The answers of the students who are in both files, in the same order.

    Attributes
    ----------
    before, after : of each student
    only_before, only_after : ids of students who are in one file only
    """

    before: tuple[Answers, ...]
    after: tuple[Answers, ...]
    only_before: tuple[str, ...]
    only_after: tuple[str, ...]


def read_answers(path: str | Path) -> ClassAnswers:
    """Return the answers of a class. Lines without any answer are left out.

    Raises
    ------
    InputError
        For a file that is no such table, or with an answer that its question does not have. The
        message names the file, and the line and the column of a cell.
    """
    path = Path(path)
    table = csv_tables.read_table(path)
    id_columns = tuple(name for name in ID_COLUMNS if name in table.columns)
    if not id_columns:
        raise InputError(
            f"{path}: expected a column with the name {_listed(ID_COLUMNS)}, "
            f"got {_shorten(', '.join(table.columns))!r}; separate the columns by commas"
        )
    columns = _question_columns(path, table)
    students = [_answers(path, row, id_columns, columns) for row in table.rows]
    answered = tuple(student for student in students if any(student.chosen.values()))
    if not answered:
        raise InputError(f"{path}: expected at least one answer, got none")
    return ClassAnswers(path, id_columns, tuple(columns), answered)


def match_students(before: ClassAnswers, after: ClassAnswers) -> MatchedAnswers:
    """Return the answers of the students who are in both files.

    Raises
    ------
    InputError
        If the files have no column of ids in common that is filled in, if an id occurs twice in a
        file, or if no student is in both.
    """
    column = _common_id_column(before, after)
    first = _by_id(before, column)
    second = _by_id(after, column)
    matched = [key for key in first if key in second]
    if not matched:
        raise InputError(
            f"{before.path} and {after.path}: no student is in both. The column {column!r} has "
            f"{before.students[0].ids[column]!r} in the first file and "
            f"{after.students[0].ids[column]!r} in the second; export both with the same ids"
        )
    return MatchedAnswers(
        before=tuple(first[key] for key in matched),
        after=tuple(second[key] for key in matched),
        only_before=tuple(first[key].ids[column] for key in first if key not in second),
        only_after=tuple(second[key].ids[column] for key in second if key not in first),
    )


def describe_unmatched(matched: MatchedAnswers, before: Path, after: Path) -> list[str]:
    """Return a note for each file with students who are not in the other one, with their ids."""
    notes = []
    for path, ids in ((before, matched.only_before), (after, matched.only_after)):
        if ids:
            shown = ", ".join(sanitize_line(text, MAX_SHOWN_CHARACTERS) for text in ids)
            notes.append(f"{path}: left out, because only this file has them: {shown}")
    return notes


def _question_columns(path: Path, table: CsvTable) -> dict[int, str]:
    """Return the column of each question, by the index of the question."""
    count = len(all_questions())
    columns: dict[int, str] = {}
    for name in table.columns:
        found = QUESTION_COLUMN.fullmatch(name)
        if found is None:
            continue
        index = int(found[1]) - 1
        if not 0 <= index < count:
            raise InputError(
                f"{path}, line 1, column {name!r}: the inventory has the questions 1 to {count}"
            )
        if index in columns:
            raise InputError(
                f"{path}, line 1, column {name!r}: question {index + 1} has two columns; remove one"
            )
        columns[index] = name
    if not columns:
        raise InputError(
            f"{path}, line 1: expected columns q1 to q{count}, or Response 1 to Response {count} of "
            "Moodle's quiz report 'Responses'; the report 'Grades' does not have the answers"
        )
    return columns


def _answers(
    path: Path, row: CsvRow, id_columns: Iterable[str], columns: dict[int, str]
) -> Answers:
    questions = all_questions()
    chosen = {}
    for index, column in columns.items():
        where = f"{path}, line {row.line}, column {column!r}"
        chosen[index] = _chosen_text(row.cells[column], questions[index], index + 1, where)
    ids = {name: csv_tables.unescape_cell(row.cells[name]) for name in id_columns}
    return Answers(row.line, ids, chosen)


def _chosen_text(cell: str, question: ConceptQuestion, number: int, where: str) -> str:
    """Return the text of the answer that a cell names by its letter or by the text itself."""
    text = csv_tables.unescape_cell(cell)
    if text in NO_ANSWER:
        return ""
    letter = LETTER.fullmatch(text)
    if letter is not None and letter[1].lower() in LETTERS:
        return question.options[LETTERS.index(letter[1].lower())]
    for option in question.options:
        if _comparable(option) == _comparable(text):
            return option
    raise InputError(
        f"{where}: expected a letter from {LETTERS[0]} to {LETTERS[-1]} or the text of an answer to "
        f"question {number} of the inventory, such as {question.right!r}, got {_shorten(text)!r}. "
        "In a quiz, the questions must have the order of the inventory"
    )


def _comparable(text: str) -> str:
    return " ".join(fold(text).split())


def _common_id_column(before: ClassAnswers, after: ClassAnswers) -> str:
    """Return the first column of ids that both files have, and that is filled in throughout."""
    common = [name for name in before.id_columns if name in after.id_columns]
    if not common:
        raise InputError(
            f"{before.path} has the ids {_listed(before.id_columns)}, and {after.path} has "
            f"{_listed(after.id_columns)}; export both with the same column of ids"
        )
    empty = ""
    for column in common:
        for answers in (before, after):
            lines = [student.line for student in answers.students if not student.ids[column]]
            if lines:
                empty = empty or f"{answers.path}, line {lines[0]}, column {column!r}: empty"
                break
        else:
            return column
    raise InputError(f"{empty}; fill in the student's id, or export another column of ids")


def _by_id(answers: ClassAnswers, column: str) -> dict[str, Answers]:
    """Return the students of a file by their ids, without differences of upper and lower case."""
    students: dict[str, Answers] = {}
    for student in answers.students:
        key = fold(student.ids[column])
        if key in students:
            raise InputError(
                f"{answers.path}, line {student.line}, column {column!r}: "
                f"{student.ids[column]!r} is in line {students[key].line}, too; keep one attempt of "
                "each student. Moodle's report has an option for that"
            )
        students[key] = student
    return students


def _listed(names: Sequence[str]) -> str:
    return ", ".join(repr(name) for name in names)


def _shorten(text: str) -> str:
    return text if len(text) <= MAX_SHOWN_CHARACTERS else text[:MAX_SHOWN_CHARACTERS] + "..."
