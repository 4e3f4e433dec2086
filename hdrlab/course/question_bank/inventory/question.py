"""A question of the concept inventory: its right answer and three wrong ones, all computed."""

import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from hdrlab.course.checks.mistakes import mistakes_of

DONT_KNOW = "I don't know"


class WrongAnswer(NamedTuple):
    """An answer that a misconception leads to, and a sentence that says what the misconception is."""

    text: str
    misconception: str


@dataclass(frozen=True, kw_only=True)
class ConceptQuestion:
    """A question with one right answer and three wrong ones.

    Attributes
    ----------
    name : a name that stays the same when the question is reworded
    stem : the question, for somebody who has not taken the course
    right : the right answer
    because : why it is right
    wrong : the wrong answers, each with its misconception
    notebook : the name of the notebook that treats the concept
    section : the heading of the notebook's section
    """

    name: str
    stem: str
    right: str
    because: str
    wrong: tuple[WrongAnswer, WrongAnswer, WrongAnswer]
    notebook: str
    section: str

    @property
    def options(self) -> tuple[str, ...]:
        """The answers in the order of the quiz: shuffled, the same each time, DONT_KNOW last."""
        rng = random.Random(self.name)
        answers = [self.right, *(answer.text for answer in self.wrong)]
        return (*sorted(answers, key=lambda _: rng.random()), DONT_KNOW)

    @property
    def misconceptions(self) -> dict[str, str]:
        """The misconception that leads to each wrong answer."""
        return dict(self.wrong)


def known_mistake(task: str, name: str) -> Callable[..., Any]:
    """Return the wrong function of a known mistake, by the id of its task and its full name."""
    functions = {known.name: known.function for known in mistakes_of(task)}
    return functions[name]


class Concept(NamedTuple):
    """A concept of the course, and the questions about it."""

    title: str
    questions: tuple[ConceptQuestion, ...]
