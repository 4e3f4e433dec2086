"""Collect the questions of an executed notebook that have a right choice or a number as an answer.

Questions whose answer is a drawn curve or a place in an image stay in the notebooks: a quiz cannot
mark them.
"""

import base64
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

from hdrlab.course.site import live

PREDICT = re.compile(r"\*\*Predict\.\*\*\s*(.+)\Z", re.DOTALL)
ACCEPTED_FRACTION_OF_SCALE = 0.1  # the same error is small in the notebook


@dataclass(frozen=True)
class Image:
    """An image of an answer: its WebP file, and what it shows."""

    content: bytes
    alt: str


@dataclass(frozen=True)
class ChoiceQuestion:
    """A question with several answers, one of which is right.

    Attributes
    ----------
    name : a name that stays the same when the bank is written again
    context : the paragraph before the question, Markdown
    text : the question
    because : why the answer is right
    labels : the answers
    right : index of the right answer
    images : an image of each answer, or none
    misconceptions : the misconception that leads to each wrong answer, or none
    """

    name: str
    context: str
    text: str
    because: str
    labels: tuple[str, ...]
    right: int
    images: tuple[Image, ...] = ()
    misconceptions: tuple[str, ...] = ()


@dataclass(frozen=True)
class NumberQuestion:
    """A question whose answer is a number.

    Attributes
    ----------
    name, context, text, because : see `ChoiceQuestion`
    truth : the right answer
    low, high : the ends of the scale on which students answer
    unit : its unit, "" if it has none
    misconceptions : none; a wrong number does not say how it came about
    """

    name: str
    context: str
    text: str
    because: str
    truth: float
    low: float
    high: float
    unit: str
    misconceptions: tuple[()] = ()

    @property
    def tolerance(self) -> float:
        """The largest error of an answer that counts as right."""
        return ACCEPTED_FRACTION_OF_SCALE * (self.high - self.low)

    @property
    def instruction(self) -> str:
        """What students are asked to write."""
        unit = f" ({self.unit})" if self.unit else ""
        return f"Answer with a number from {self.low:g} to {self.high:g}{unit}."


Question = ChoiceQuestion | NumberQuestion


class LessonQuestions(NamedTuple):
    """The title of a notebook or of a test, and its questions in order.

    Attributes
    ----------
    title, questions : see above
    instructions : what students read before the first question
    is_asked_again : whether students answer the same questions a second time. Then the answers keep
        their order, and a quiz shows no explanations.
    """

    title: str
    questions: tuple[Question, ...]
    instructions: str = ""
    is_asked_again: bool = False


def collect_questions(notebook: Any, name: str) -> Iterator[Question]:
    """Yield the questions of an executed notebook; `name` is the notebook's name."""
    widgets = {id(output): widget for output, widget in live.widgets(notebook, name)}
    context = ""
    for cell in notebook.cells:
        if cell["cell_type"] == "markdown":
            asked = PREDICT.search("".join(cell["source"]))
            context = asked[1].strip() if asked else context
            continue
        for output in cell.get("outputs", []):
            if id(output) in widgets and widgets[id(output)].question:
                question = _question(widgets[id(output)].state, f"{name}-{cell['id']}", context)
                context = ""
                if question is not None:
                    yield question


def _question(state: dict[str, Any], name: str, context: str) -> Question | None:
    """Return the question of a widget's state; None for a curve or a place."""
    shared = {
        "name": name,
        "context": context,
        "text": state["question"],
        "because": state["because"],
    }
    if state["kind"] == "choice":
        contents = [base64.b64decode(image["base64"]) for image in state["pictures"]]
        images = [Image(*pair) for pair in zip(contents, state["alts"], strict=False)]
        labels = tuple(state["labels"])
        return ChoiceQuestion(**shared, labels=labels, right=state["truth"], images=tuple(images))
    if state["kind"] == "number":
        low, high, _ = state["scale"]
        return NumberQuestion(
            **shared, truth=state["truth"], low=low, high=high, unit=state["unit"]
        )
    return None
