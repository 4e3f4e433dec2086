"""Questions about the tasks of the course, without anybody's code.

They have kinds of `hdrlab viva`, whose questions are about a student's own functions:

value      what a function returns for an input that is small enough to compute by hand
diagnosis  which mistake explains a wrong answer to such an input
promise    which check a known mistake fails
picture    which image a known mistake makes of a scene

The right answers are those of the course's own functions, and the wrong ones those of the known
mistakes in `checks/mistakes`. All of them are computed when the bank is written. The questions show
no line of a solution.
"""

import inspect
import random
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

import numpy as np

from hdrlab import scenes
from hdrlab.core import colour
from hdrlab.course import plan
from hdrlab.course.checks import inprocess, misconceptions
from hdrlab.course.checks.mistakes import KnownMistake, mistakes_of
from hdrlab.course.question_bank.questions import ChoiceQuestion, Image, LessonQuestions
from hdrlab.io import web

VALUE_TITLE = "Tasks: what a function returns"
DIAGNOSIS_TITLE = "Tasks: find the mistake"
PROMISE_TITLE = "Tasks: which check fails"
PICTURE_TITLE = "Tasks: which image has the mistake"
WRONG_OPTIONS = 3
PUBLIC_SEED = 0
IMAGE_SHAPE = (96, 128)


@dataclass(frozen=True, kw_only=True)
class SmallCall:
    """A call of a task's function whose answer can be computed by hand.

    Attributes
    ----------
    task : the id of the task
    ask : the question, which gives the formula where students may have forgotten it
    args, kwargs : the arguments
    read : the text of the part of an answer that the question asks for
    """

    task: str
    ask: str
    args: tuple[Any, ...]
    kwargs: dict[str, Any] = field(default_factory=dict)
    read: Callable[[Any], str] = lambda answer: number(answer)

    def answer(self, function: Callable[..., Any]) -> str:
        """Return what a function answers, as text; "" if it fails."""
        answer = misconceptions.call_quietly(function, self.args, self.kwargs)
        return "" if answer is None else self.read(answer)


def number(answer: Any, unit: str = "") -> str:
    """Return a number with three digits, and its unit.

    Examples
    --------
    >>> number(np.array([[0.25361]]), "s")
    '0.254 s'
    """
    value = float(np.ravel(answer)[0])
    return f"{value:.3g} {unit}".strip()


def used_values(answer: Any) -> str:
    """Return which of the pixel values 96, 100, 104 and 105 are True in a mask."""
    return ", ".join(str(value) for value, used in zip(EXCLUDED, answer, strict=True) if used)


def listed(answer: Any) -> str:
    """Return the numbers of an array with three digits."""
    return ", ".join(f"{value:.3g}" for value in np.ravel(answer))


EXCLUDED = np.array([96, 100, 104, 105], np.uint8)
LINEAR_G = np.log(np.maximum(np.arange(256), 0.5) / 128)
FOUR_VALUES = np.bincount([10] * 3 + [20] + [30] * 4 + [60] * 2, minlength=256)
GRADIENTS = np.array([[[1.0, 2.0], [4.0, 5.0]], [[0.0, 1.0], [4.0, 2.0]]])
MEAN_COUNTS = np.array([0.0, 100.0, 300.0])
VARIANCES = np.array([5.0, 60.0, 150.0])

SMALL_CALLS = (
    SmallCall(
        task="ev",
        ask="A lens at f/8 is open for 1/60 s at ISO 400. What is the exposure value, at ISO 100, "
        "of a scene that these settings expose correctly?",
        args=(8.0, 1 / 60),
        kwargs={"S": 400},
        read=lambda answer: f"EV {number(answer)}",
    ),
    SmallCall(
        task="equivalent_time",
        ask="A photo was taken at f/8, 1/60 s and ISO 400. Which time gives the same pixel values "
        "at f/4 and ISO 200?",
        args=(1 / 60, 8.0, 4.0),
        kwargs={"S": 400, "S_new": 200},
        read=lambda answer: number(1000 * np.asarray(answer), "ms"),
    ),
    SmallCall(
        task="threshold",
        ask="Of ten pixels, three have the value 10, one has 20, four have 30 and two have 60. "
        "Which value is the threshold for the fraction q = 0.3: the lowest with at least this "
        "fraction of the pixels at or below it?",
        args=(FOUR_VALUES, 0.3),
    ),
    SmallCall(
        task="exclusion",
        ask="The threshold of a bitmap is 100, and the noise reaches 4 pixel values far. Four "
        "pixels have the values 96, 100, 104 and 105. Which of them are compared, |Y - t| > 4?",
        args=(EXCLUDED, 100),
        read=used_values,
    ),
    SmallCall(
        task="hat",
        ask="The hat weights eight pixel values, 0 to 7, and is divided by its largest weight. "
        "What is the weight of the value 2?",
        args=(8,),
        read=lambda answer: number(answer[2] / np.max(answer)),
    ),
    SmallCall(
        task="irradiance",
        ask="Robertson's irradiance is sum w t X / sum w t^2. A pixel has the exposure X = 1 in a "
        "photo of 1 s and X = 6 in a photo of 4 s. Both weights are 1. What is its irradiance?",
        args=(
            np.array([[1, 3]]),
            np.array([1.0, 4.0]),
            np.array([0.5, 1.0, 2.0, 6.0]),
            np.array([0.0, 1.0, 2.0, 1.0]),
        ),
    ),
    SmallCall(
        task="merge",
        ask="A linear camera needs the exposure 1 for the value 128. A pixel has the value 64 in a "
        "photo of 1 s and 192 in a photo of 2 s. What is its radiance in Debevec's map, with hat "
        "weights?",
        args=(np.array([[[64]], [[192]]], np.uint8), np.array([1.0, 2.0]), LINEAR_G),
    ),
    SmallCall(
        task="variance",
        ask="A pixel has the exposure X = 0.5. The full well is N = 1000 electrons at X = 1, the "
        "read noise R is 10 electrons, and a pixel value is D = 0.004 wide. What is the variance "
        "of X?",
        args=(np.array([0.5]), np.array([0.004]), 1000.0, 10.0),
    ),
    SmallCall(
        task="log_average",
        ask="An image has four pixels of the luminance 1, 10, 100 and 1000. What is its log "
        "average, approximately?",
        args=(np.array([[1.0, 10.0], [100.0, 1000.0]], np.float32),),
    ),
    SmallCall(
        task="compress",
        ask="Durand compresses a base from 1 to 3 (log10) to the contrast 10, so that the bright "
        "end becomes 0. What becomes of the base 1.5?",
        args=(np.array([[1.5]]), 1.0, 3.0),
        kwargs={"contrast": 10.0},
    ),
    SmallCall(
        task="divergence",
        ask="The gradients of an image of 2 x 2 pixels are: down 1, 2 (upper row) and 4, 5; to the "
        "right 0, 1 (upper row) and 4, 2. The divergence is the sum of backward differences. What "
        "is it at the lower left pixel, if gradients across the edge count as 0?",
        args=(GRADIENTS,),
        read=lambda answer: number(answer[1][0]),
    ),
    SmallCall(
        task="optimum",
        ask="A meter suggests EV 8, at which the image has the mean brightness 0.06. It should be "
        "0.24. Which EV is right?",
        args=(8.0, 0.06, 0.24),
        read=lambda answer: f"EV {number(answer)}",
    ),
    SmallCall(
        task="weighted_variance",
        ask="Three photos give a pixel the radiance 1, 2 and 6, with the weights 2, 1 and 1. What "
        "is the weighted variance?",
        args=(np.array([[1.0], [2.0], [6.0]]), np.array([[2.0], [1.0], [1.0]])),
    ),
    SmallCall(
        task="to_pixels",
        ask="Which four bytes does RGBE store for the color (3, 1, 64)?",
        args=(np.array([[[3.0, 1.0, 64.0]]], np.float32),),
        read=listed,
    ),
    SmallCall(
        task="brightness_transfer",
        ask="Photo A has 4, 8, 8 and 4 pixels of the values 0 to 3, and photo B has 2, 4, 10 and 8. "
        "A value z reaches from z - 1/2 to z + 1/2. Which position in B corresponds to the value "
        "1 of A?",
        args=(np.array([4, 8, 8, 4]), np.array([2, 4, 10, 8])),
        read=lambda answer: number(answer[1]).replace("nan", "unknown"),
    ),
    SmallCall(
        task="line",
        ask="A camera's noise has the variance 5 in the dark, 60 at the mean 100 and 150 at the "
        "mean 300. What is the slope of the line of variance over mean, fitted with weights 1 / V^2?",
        args=(MEAN_COUNTS, VARIANCES),
    ),
)

# known mistakes that fail one check of their task
PROMISES = (
    ("hat", "hat_of_256_levels"),
    ("threshold", "threshold_goes_on"),
    ("shift", "shift_without_the_frame"),
    ("update", "update_nan_taken_for_0"),
    ("bound", "bound_flags_swapped"),
    ("ratio_steps", "ratio_steps_never_back"),
    ("log_average", "log_average_absolute_delta"),
    ("display", "display_white_by_Lm_alone"),
    ("layers", "layers_detail_sign"),
    ("divergence", "divergence_across_the_edges"),
    ("gain_map", "gain_map_not_clipped"),
    ("apply_gain", "apply_gain_offset_left"),
)

# known mistakes that make images of their own, the one that is asked for first
PICTURES = {
    "tonemap": ("tonemap_divided_by_the_maximum", "tonemap_absolute_unit", "tonemap_negative"),
    "scale": ("scale_not_blurred", "scale_blur_of_the_inverse", "scale_times_luminance"),
}


def lessons() -> Iterator[LessonQuestions]:
    """Yield the questions of each kind."""
    values = [(call, distinct_mistakes(call)) for call in SMALL_CALLS]
    yield LessonQuestions(VALUE_TITLE, tuple(value_question(*pair) for pair in values))
    yield LessonQuestions(DIAGNOSIS_TITLE, tuple(diagnosis_question(*pair) for pair in values))
    yield LessonQuestions(PROMISE_TITLE, tuple(promise_questions()))
    yield LessonQuestions(PICTURE_TITLE, tuple(picture_questions()))


def solution(task: str) -> Callable[..., Any]:
    """Return the course's own function of a task."""
    return plan.function(plan.read().task(task))


def distinct_mistakes(call: SmallCall) -> list[KnownMistake]:
    """Return known mistakes whose answers to a call differ from the right one and from each other."""
    answers = {"", call.answer(solution(call.task))}
    distinct: list[KnownMistake] = []
    for mistake in mistakes_of(call.task):
        answer = call.answer(mistake.function)
        if answer not in answers and len(distinct) < WRONG_OPTIONS:
            answers.add(answer)
            distinct.append(mistake)
    return distinct


def value_question(call: SmallCall, mistakes: Sequence[KnownMistake]) -> ChoiceQuestion:
    """Ask for the right answer to a call; the wrong answers are those of known mistakes."""
    right = call.answer(solution(call.task))
    wrong = [(call.answer(mistake.function), mistake.sentence) for mistake in mistakes]
    return choices(f"task-value-{call.task}", call.ask, (right, ""), wrong, f"It is {right}.")


def diagnosis_question(call: SmallCall, mistakes: Sequence[KnownMistake]) -> ChoiceQuestion:
    """Ask which mistake explains a wrong answer to a call."""
    shown = random.Random(call.task).choice(mistakes)
    right = call.answer(solution(call.task))
    text = f"{call.ask} A program answers {call.answer(shown.function)}. What is wrong with it?"
    wrong = [
        (mistake.sentence, f"Then the answer would be {call.answer(mistake.function)}.")
        for mistake in mistakes
        if mistake is not shown
    ]
    nothing = ("Nothing: this is the right answer.", f"The right answer is {right}.")
    because = f"The right answer is {right}."
    return choices(
        f"task-diagnosis-{call.task}", text, (shown.sentence, ""), [*wrong, nothing], because
    )


def choices(
    name: str,
    text: str,
    right: tuple[str, str],
    wrong: Sequence[tuple[str, str]],
    because: str,
) -> ChoiceQuestion:
    """Return a question with its answers in an order that is the same each time."""
    options = [right, *wrong]
    random.Random(name).shuffle(options)
    return ChoiceQuestion(
        name=name,
        context="",
        text=text,
        because=because,
        labels=tuple(label for label, _ in options),
        right=options.index(right),
        misconceptions=tuple(misconception for _, misconception in options),
    )


def promise_questions() -> Iterator[ChoiceQuestion]:
    """Yield questions that ask which check of a task a known mistake fails."""
    for task, name in PROMISES:
        (mistake,) = [known for known in mistakes_of(task) if known.name == name]
        outcomes = run_checks(task, mistake.function)
        (failed,) = [check for check, holds in outcomes.items() if not holds]
        passed = [check for check, holds in outcomes.items() if holds]
        text = (
            f"A solution of the task {task} has a mistake, of which hdrlab says: "
            f"\u201c{mistake.sentence}\u201d Which of these checks does it fail?"
        )
        wrong = [(in_words(check), "It passes this check.") for check in passed[:WRONG_OPTIONS]]
        because = (
            f"hdrlab ran all checks of the task: it fails \u201c{in_words(failed)}\u201d only."
        )
        yield choices(f"task-promise-{task}", text, (in_words(failed), ""), wrong, because)


def run_checks(task: str, function: Callable[..., Any]) -> dict[str, bool]:
    """Return which checks of a task a function of hdrlab passes; it runs in this process."""
    module = import_module(f"hdrlab.course.checks.specification.test_{task}")
    checks = {name: check for name, check in vars(module).items() if name.startswith("test_")}
    outcomes = {}
    for name, check in checks.items():
        fixtures = {
            "subject": inprocess.Subject({task: function}),
            "rng": np.random.default_rng(PUBLIC_SEED),
        }
        parameters = inspect.signature(check).parameters
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            try:
                check(**{fixture: fixtures[fixture] for fixture in parameters})
                outcomes[name] = True
            except Exception:  # whatever a wrong function leads to, it fails the check
                outcomes[name] = False
    return outcomes


def in_words(check: str) -> str:
    """Return the name of a check as a sentence.

    Examples
    --------
    >>> in_words("test_any_number_of_levels_works")
    'Any number of levels works.'
    """
    words = check.removeprefix("test_").replace("_", " ")
    return f"{words[0].upper()}{words[1:]}."


def picture_questions() -> Iterator[ChoiceQuestion]:
    """Yield questions that ask which image a known mistake makes."""
    luminance = colour.luminance(scenes.room(IMAGE_SHAPE))
    for task, names in PICTURES.items():
        known = {mistake.name: mistake for mistake in mistakes_of(task)}
        mistakes = [known[name] for name in names]
        mistake_to_find = mistakes[0]
        versions = [
            (mistake_to_find.function, ""),
            *((mistake.function, mistake.sentence) for mistake in mistakes[1:]),
            (solution(task), "This is the image of the right solution."),
        ]
        rng = random.Random(task)
        rng.shuffle(versions)
        images = [
            web.encode_webp(render(task, function, luminance), lossless=True)
            for function, _ in versions
        ]
        labels = tuple(f"Image {letter}" for letter in "ABCD")
        text = (
            f"Four versions of the task {task} made these images of one room. One version has a "
            f"mistake, of which hdrlab says: \u201c{mistake_to_find.sentence}\u201d Which image is it?"
        )
        yield ChoiceQuestion(
            name=f"task-picture-{task}",
            context="",
            text=text,
            because="hdrlab ran all four versions.",
            labels=labels,
            right=[function for function, _ in versions].index(mistake_to_find.function),
            images=tuple(Image(content, alt) for content, alt in zip(images, labels, strict=True)),
            misconceptions=tuple(sentence for _, sentence in versions),
        )


def render(task: str, function: Callable[..., Any], luminance: Any) -> Any:
    """Return the 8-bit image (H, W) that a version of an operator makes of a luminance."""
    with np.errstate(all="ignore"):
        answer = np.asarray(function(luminance), np.float64)
    display = luminance * answer if task == "scale" else answer
    return colour.to_8bit(np.clip(display, 0, 1))
