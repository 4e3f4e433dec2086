"""Write the similarity report of a class, for instructors: pairs side by side, and the report's limits.

similar.html   caveats, the histogram of all pairs, the listed pairs, code that is also in the library
similar.csv    the listed pairs as a table

Both depend on the submissions alone: the same class gives the same bytes.
"""

import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from copydetect import CodeFingerprint, compare_files

from hdrlab.course import plan
from hdrlab.course.similarity import comparison, student_code
from hdrlab.course.source_code import inline
from hdrlab.course.students import csv_tables
from hdrlab.course.students.anonymity import Anonymity
from hdrlab.course.submissions.class_folder import Submission
from hdrlab.course.variants import rewording
from hdrlab.io.files import write
from hdrlab.show.pages.templates import templates

TEMPLATE = "report.html"
MAX_SUBMISSIONS = 1_000  # half a million pairs, which take a gigabyte
MAX_PAIRS_WITH_CODE = 100
MAX_TABLE_ROWS = 10_000
MIN_SHOWN_FRACTION = 0.3  # of a task, from which its code is shown
MAX_SHOWN_CHARACTERS = 8_000  # of a task
COLUMNS = ("one", "other", "share", "one in other", "other in one", "tasks on the other's sheet")
Passage = tuple[str, bool]  # a part of a text, and whether it is also in the other text


@dataclass(frozen=True)
class AskedVariants:
    """The variants of tasks that a team is asked, and those on its sheet where they differ, by task."""

    asked: dict[str, str]
    on_sheet: dict[str, str]


@dataclass(frozen=True)
class Row:
    """The comparison of one task of a pair, or of all tasks together (task ""), with both texts."""

    task: str
    first_in_second: float
    second_in_first: float
    first: tuple[Passage, ...] = ()
    second: tuple[Passage, ...] = ()


def write_steps(
    out: Path,
    homework: plan.Homework,
    submissions: Mapping[str, Submission],
    secret: str = "",
    anonymity: Anonymity | None = None,
) -> Iterator[str]:
    """Yield each team once its code is read, then write the report and the table of a class.

    Parameters
    ----------
    out : folder of the results
    homework : the assignment
    submissions : the submission of each team that counts
    secret : the secret of the course, which draws the variants of tasks
    anonymity : codes of the teams, if the readers must not see names
    """
    codes = []
    asked = {}
    shown_codes = []
    for team_code in read_codes(homework, submissions):
        shown = team_code if anonymity is None else hide_names(team_code, anonymity)
        asked[shown.team] = asked_variants(homework, team_code, secret)
        shown_codes.append(shown)
    shown_codes.sort(key=lambda code: code.team)
    for code in comparison.fingerprint_steps(shown_codes):
        codes.append(code)
        yield code.code.team
    handout = student_code.handout_code(homework.name)
    result = comparison.compare(codes, handout, library_code(homework))
    rows = []
    for pair in result.pairs[:MAX_TABLE_ROWS]:
        first = codes[pair.first].code.team
        second = codes[pair.second].code.team
        fractions = (pair.fraction, pair.first_in_second, pair.second_in_first)
        swapped = count_swapped_sheets(asked[first], asked[second])
        rows.append((first, second, *(f"{value:.3f}" for value in fractions), str(swapped)))
    csv_tables.write_csv(out / "similar.csv", COLUMNS, rows, private=True)
    write(out / "similar.html", render(homework, codes, result, asked), private=True)


def hide_names(code: student_code.TeamCode, anonymity: Anonymity) -> student_code.TeamCode:
    """Return a team's code under the code of the team, without the names of the class."""
    return code._replace(
        team=anonymity.teams[code.team],
        texts={task: anonymity.redact_code(text) for task, text in code.texts.items()},
        notes=tuple(anonymity.redact(note) for note in code.notes),
    )


def asked_variants(
    homework: plan.Homework, code: student_code.TeamCode, secret: str
) -> AskedVariants:
    """Return the variants that a team is asked, and those on its sheet that differ."""
    tasks = plan.draw_variants(homework, code.team, secret, code.variants).tasks
    asked = {task.id: task.variant for task in tasks}
    if code.variants is None:
        return AskedVariants(asked, {})
    on_sheet = {task: code.variants.get(task, "") for task in asked}
    differing = {task: name for task, name in on_sheet.items() if name != asked[task]}
    return AskedVariants(asked, differing)


def count_swapped_sheets(first: AskedVariants, second: AskedVariants) -> int:
    """Return the number of tasks for which one team's sheet has the other team's variant.

    Examples
    --------
    >>> first = AskedVariants({"f": "a", "g": "a"}, {"f": "b"})
    >>> count_swapped_sheets(first, AskedVariants({"f": "b", "g": "b"}, {}))
    1
    """
    first_has_second = first.on_sheet.items() & second.asked.items()
    second_has_first = second.on_sheet.items() & first.asked.items()
    return len(first_has_second) + len(second_has_first)


def library_code(homework: plan.Homework) -> str:
    """Return hdrlab's own functions of an assignment, all variants, as `student_code` reads a team's."""
    solutions = {
        task.id: inline.inlined({task.id: task.function})[task.id].text for task in homework.tasks
    }
    texts = []
    for task in homework.tasks:
        others = set(solutions) - {task.id}
        for variant in rewording.every(task.id) if task.parameters else ("",):
            text = rewording.reword(task.id, variant, solutions[task.id])
            texts.append(student_code.own_code(text, homework.name, others))
    return "\n".join(texts)


def read_codes(
    homework: plan.Homework, submissions: Mapping[str, Submission]
) -> Iterator[student_code.TeamCode]:
    """Yield the code that each team wrote itself, sorted by team; archives are unpacked."""
    tasks = [task.id for task in homework.tasks]
    for team, submission in sorted(submissions.items()):
        yield student_code.read(team, submission.path, homework.name, tasks)


def render(
    homework: plan.Homework,
    codes: Sequence[comparison.FingerprintedCode],
    result: comparison.SimilarityReport,
    asked: Mapping[str, AskedVariants],
) -> str:
    """Return the report as HTML; everything that students wrote is shown as text."""
    in_library = {}
    for task, fractions in result.library.items():
        in_library[task] = sorted(
            (codes[index].code.team, fraction)
            for index, fraction in fractions.items()
            if fraction >= comparison.MIN_LISTED_FRACTION
        )
    bin_width = 100 // comparison.HISTOGRAM_BINS
    environment = templates(Path(__file__).parent)
    environment.filters["percent"] = lambda fraction: int(100 * fraction + 1e-9)
    return environment.get_template(TEMPLATE).render(
        homework=homework,
        codes=[code.code for code in codes],
        bins=[(bin_width * index, int(count)) for index, count in enumerate(result.counts)],
        bin_width=bin_width,
        result=result,
        asked=asked,
        count_swapped_sheets=count_swapped_sheets,
        shown=[(pair, compare_tasks(result, pair)) for pair in result.pairs[:MAX_PAIRS_WITH_CODE]],
        library=in_library,
        limits=comparison,
        max_rows=MAX_TABLE_ROWS,
    )


def compare_tasks(result: comparison.SimilarityReport, pair: comparison.Pair) -> list[Row]:
    """Return the comparison of a pair: all tasks together, then each task that was compared."""
    rows = []
    tokens = []
    for task, prints in result.own.items():
        if pair.first in prints and pair.second in prints:
            first = prints[pair.first]
            second = prints[pair.second]
            rows.append(_compare_task(task, first, second))
            tokens.append((first.token_coverage, second.token_coverage))
    fractions = np.array([(row.first_in_second, row.second_in_first) for row in rows])
    weights = np.array(tokens)
    together = (fractions * weights).sum(axis=0) / weights.sum(axis=0)
    return [Row("", *together.tolist()), *rows]


def _compare_task(task: str, first: CodeFingerprint, second: CodeFingerprint) -> Row:
    """Return the comparison of one task, with both texts where enough of them is similar."""
    _, fractions, places = compare_files(first, second)
    first_in_second = float(fractions[0])
    second_in_first = float(fractions[1])
    if max(first_in_second, second_in_first) < MIN_SHOWN_FRACTION:
        return Row(task, first_in_second, second_in_first)
    return Row(
        task=task,
        first_in_second=first_in_second,
        second_in_first=second_in_first,
        first=split_passages(first.raw_code, places[0]),
        second=split_passages(second.raw_code, places[1]),
    )


def split_passages(text: str, places: np.ndarray) -> tuple[Passage, ...]:
    r"""Split a text into similar and other passages; a long text begins with its first similar line.

    Examples
    --------
    >>> split_passages("a = 1\nb = 2\nc = 3\n", np.array([[6], [12]]))
    (('a = 1\n', False), ('b = 2', True), ('\nc = 3\n', False))
    """
    begin = 0
    if len(text) > MAX_SHOWN_CHARACTERS:
        first_similar = int(places[0].min()) if places.size else 0
        begin = text.rfind("\n", 0, first_similar) + 1
    end = min(len(text), begin + MAX_SHOWN_CHARACTERS)
    passages = []
    position = begin
    for start, stop in places.T.astype(int).tolist():
        similar = text[start : min(stop, end)]
        if not similar.strip():
            continue
        passages.append((text[position:start], False))
        similar = similar.rstrip()
        passages.append((similar, True))
        position = start + len(similar)
    passages.append((text[position:end], False))
    return tuple((_mark_invisible(part), is_similar) for part, is_similar in passages if part)


def _mark_invisible(text: str) -> str:
    """Replace characters that are invisible or change the direction of writing by a visible mark."""
    invisible_categories = {"Cc", "Cf", "Cs", "Co", "Cn"}
    invisible = {
        character
        for character in set(text) - set("\n\t")
        if unicodedata.category(character) in invisible_categories
    }
    return "".join("\ufffd" if character in invisible else character for character in text)
