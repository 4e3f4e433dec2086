"""Compute what a class learned: the normalized gain of each concept (Hake 1998).

b, a    percent of right answers before and after the course, of the students who answered both times
g       normalized gain (a - b) / (100 - b): which part of what was missing the class has learned

The interval holds 95 % of the gains of 2000 classes that are drawn from this one with replacement
(bootstrap). Students who chose "I don't know" or nothing did not answer right.

Hake, Interactive-engagement versus traditional methods, American Journal of Physics 66, 64 (1998).
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F64, Mask
from hdrlab.course.question_bank.answers import Answers, ClassAnswers, MatchedAnswers
from hdrlab.course.question_bank.inventory import CONCEPTS, all_questions
from hdrlab.course.question_bank.inventory.question import DONT_KNOW, ConceptQuestion
from hdrlab.show.pages.templates import render_page

PAGE_TEMPLATE = "gain_page.html"
RESAMPLED_CLASSES = 2000
RESAMPLING_SEED = 1998
INTERVAL_PERCENTILES = (2.5, 97.5)
MIN_STUDENTS_OF_INTERVAL = 10  # of fewer students, the resampled classes are too similar
ALL_CONCEPTS = "All questions"


class Interval(NamedTuple):
    """The ends of an interval of gains."""

    low: float
    high: float


@dataclass(frozen=True, kw_only=True)
class WrongChoice:
    """A wrong answer that students still choose after the course.

    Attributes
    ----------
    number : of the question
    question : the question
    text : the answer
    count : how many students chose it
    """

    number: int
    question: ConceptQuestion
    text: str
    count: int

    @property
    def misconception(self) -> str:
        """The misconception that leads to the answer."""
        return self.question.misconceptions[self.text]


@dataclass(frozen=True, kw_only=True)
class Gain:
    """What a class knew before and after the course about some questions.

    Attributes
    ----------
    title : of the concept or the question
    before, after : percent of right answers
    gain : the normalized gain; None if all answers were right before the course
    interval : of the gain; None for a single question, for too few students, and if it has no
        bounds
    unknown_before, unknown_after : percent of answers that are missing or "I don't know"
    remaining : the most frequent wrong answer after the course; None if there is none
    """

    title: str
    before: float
    after: float
    gain: float | None
    interval: Interval | None
    unknown_before: float
    unknown_after: float
    remaining: WrongChoice | None


@dataclass(frozen=True, kw_only=True)
class ClassGain:
    """The gains of a class.

    Attributes
    ----------
    students : number of students who answered before and after the course
    total : over all questions
    concepts : of each concept with a question in both files
    questions : of each question in both files, by its number
    missing : numbers of the questions that are not in both files
    """

    students: int
    total: Gain
    concepts: tuple[Gain, ...]
    questions: dict[int, Gain]
    missing: tuple[int, ...]


def normalized_gain(before: float, after: float) -> float | None:
    """Return g = (after - before) / (100 - before), in percent; None where before is 100.

    Examples
    --------
    >>> normalized_gain(20.0, 60.0), normalized_gain(50.0, 40.0), normalized_gain(100.0, 90.0)
    (0.5, -0.2, None)
    """
    if before == 100:
        return None
    return (after - before) / (100 - before)


def bootstrap_interval(before: F64, after: F64) -> Interval | None:
    """Return the interval of the gain of a class from the percent of right answers of each student.

    Parameters
    ----------
    before, after : (n,) percent of right answers of each student

    Returns
    -------
    The percentiles 2.5 and 97.5 of the gain over resampled classes; None for fewer than 10
    students, or if a resampled class knew everything before the course, so that it has no gain.
    """
    n = len(before)
    if n < MIN_STUDENTS_OF_INTERVAL:
        return None
    rng = np.random.default_rng(RESAMPLING_SEED)
    drawn = rng.integers(n, size=(RESAMPLED_CLASSES, n))
    before_means = before[drawn].mean(axis=1)
    after_means = after[drawn].mean(axis=1)
    if np.any(before_means == 100):
        return None
    gains = (after_means - before_means) / (100 - before_means)
    low, high = np.percentile(gains, INTERVAL_PERCENTILES)
    return Interval(float(low), float(high))


def compute_gain(before: ClassAnswers, after: ClassAnswers, matched: MatchedAnswers) -> ClassGain:
    """Return the gain of a class over all questions, and of each concept and question.

    Parameters
    ----------
    before, after : the answers of the class, see `answers.read_answers`
    matched : the students in both, see `answers.match_students`
    """
    asked = sorted(set(before.questions) & set(after.questions))
    questions = all_questions()
    indices = {question.name: index for index, question in enumerate(questions)}
    concepts = []
    for concept in CONCEPTS:
        members = [indices[question.name] for question in concept.questions]
        members = [index for index in members if index in asked]
        if members:
            concepts.append(_gain(concept.title, members, matched))
    by_question = {}
    for index in asked:
        by_question[index + 1] = _gain(questions[index].stem, [index], matched, with_interval=False)
    return ClassGain(
        students=len(matched.before),
        total=_gain(ALL_CONCEPTS, asked, matched),
        concepts=tuple(concepts),
        questions=by_question,
        missing=tuple(index + 1 for index in range(len(questions)) if index not in asked),
    )


def _gain(
    title: str, indices: Sequence[int], matched: MatchedAnswers, *, with_interval: bool = True
) -> Gain:
    """Return the gain over the questions with these indices."""
    before = 100 * _is_right(matched.before, indices).mean(axis=1)
    after = 100 * _is_right(matched.after, indices).mean(axis=1)
    before_mean = float(before.mean())
    after_mean = float(after.mean())
    return Gain(
        title=title,
        before=before_mean,
        after=after_mean,
        gain=normalized_gain(before_mean, after_mean),
        interval=bootstrap_interval(before, after) if with_interval else None,
        unknown_before=_unknown_percent(matched.before, indices),
        unknown_after=_unknown_percent(matched.after, indices),
        remaining=_most_frequent_wrong(matched.after, indices),
    )


def _is_right(students: Sequence[Answers], indices: Sequence[int]) -> Mask:
    """Return (students, questions), True where an answer is right."""
    questions = all_questions()
    right = {index: questions[index].right for index in indices}
    rows = [[student.chosen[index] == right[index] for index in indices] for student in students]
    return np.array(rows, bool)


def _unknown_percent(students: Sequence[Answers], indices: Sequence[int]) -> float:
    chosen = [student.chosen[index] for student in students for index in indices]
    unknown = sum(text in ("", DONT_KNOW) for text in chosen)
    return 100 * unknown / len(chosen)


def _most_frequent_wrong(students: Sequence[Answers], indices: Sequence[int]) -> WrongChoice | None:
    """Return the wrong answer that most students chose; of several, that of the first question."""
    questions = all_questions()
    counts: Counter[tuple[int, str]] = Counter()
    for index in indices:
        for student in students:
            if student.chosen[index] in questions[index].misconceptions:
                counts[index, student.chosen[index]] += 1
    if not counts:
        return None
    (index, text), count = counts.most_common(1)[0]
    return WrongChoice(number=index + 1, question=questions[index], text=text, count=count)


def describe_left_out(class_gain: ClassGain, matched: MatchedAnswers) -> list[str]:
    """Return notes about students and questions that do not count; they name no student."""
    notes = []
    for unmatched, when in ((matched.only_before, "before"), (matched.only_after, "after")):
        if unmatched:
            notes.append(f"Left out because they answered only {when} the course: {len(unmatched)}")
    if class_gain.missing:
        numbers = ", ".join(str(number) for number in class_gain.missing)
        notes.append(f"Questions that are not in both files: {numbers}")
    return notes


def gain_page(class_gain: ClassGain, notes: Sequence[str] = ()) -> str:
    """Return the page about the gains of a class as HTML. It names no student.

    Parameters
    ----------
    class_gain : see `compute_gain`
    notes : about students or questions that do not count
    """
    return render_page(Path(__file__).parent, PAGE_TEMPLATE, gain=class_gain, notes=list(notes))
