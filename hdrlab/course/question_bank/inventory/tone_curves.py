"""Questions about tone mapping with one curve for all pixels."""

import numpy as np

from hdrlab.course.question_bank.inventory.question import (
    Concept,
    ConceptQuestion,
    WrongAnswer,
    known_mistake,
)
from hdrlab.tonemap import reinhard

NOTEBOOK = "16_reinhard"


def contrast_of_highlights() -> ConceptQuestion:
    """Ask how much contrast a compressing curve leaves in the highlights."""
    L = np.array([100, 200], np.float32)
    shown = reinhard.display(L, L)
    ratio = float(L[1] / L[0])
    return ConceptQuestion(
        name="contrast-of-highlights",
        stem="A program shows the brightness L of a scene as L / (1 + L) of the display's white. "
        f"Two clouds have L = {L[0]:g} and L = {L[1]:g}. How much brighter is the second cloud on "
        "the display?",
        right=describe_increase(shown[1] / shown[0]),
        because=f"They become {shown[0]:.3f} and {shown[1]:.3f} of white: the curve is nearly flat "
        "in the highlights.",
        wrong=(
            WrongAnswer(
                describe_increase(ratio), "Thinks that the curve keeps the contrast of the scene."
            ),
            WrongAnswer(
                describe_increase(np.sqrt(ratio)),
                "Thinks of a gamma, which keeps the same part of the contrast everywhere.",
            ),
            WrongAnswer(
                describe_increase(np.log(L[1]) / np.log(L[0])),
                "Thinks of a logarithm, which never becomes flat.",
            ),
        ),
        notebook=NOTEBOOK,
        section="The curve",
    )


def average_of_a_scene() -> ConceptQuestion:
    """Ask how a scene with a lamp is scaled by its geometric mean."""
    key = 0.18
    L = np.array([1, 1, 1, 10_000], np.float32)
    wall = L[0]
    arithmetic_mean = known_mistake("log_average", "log_average_linear")
    scaled = reinhard.scale_to_key(L, key=key)
    twice = scaled[0] * key
    return ConceptQuestion(
        name="average-of-a-scene",
        stem=f"Three of four places have the brightness {wall:g}, and a lamp at the fourth has "
        f"{L[-1]:,.0f}. A program multiplies all brightnesses by one factor, so that their "
        "geometric mean (the fourth root of the product of the four) becomes "
        f"{key:.0%} of white. How is the brightness {wall:g} shown?",
        right=describe_part(scaled[0]),
        because="The geometric mean is 10, and the rest is a tenth of it. A lamp moves it far less "
        "than the arithmetic mean.",
        wrong=(
            WrongAnswer(
                describe_part(key * wall / arithmetic_mean(L)),
                "Takes the arithmetic mean, which the lamp alone decides.",
            ),
            WrongAnswer(describe_part(twice), f"Multiplies by {key:.0%} twice."),
            WrongAnswer(
                describe_part(key * wall / np.median(L)),
                "Takes the median, which ignores the lamp.",
            ),
        ),
        notebook=NOTEBOOK,
        section="The key",
    )


def one_curve_for_two_rooms() -> ConceptQuestion:
    """Ask how much contrast one curve leaves in two parts of a scene."""
    room = 100
    view = 100
    display = 100
    left = display ** (np.log(room) / np.log(room * view))
    return ConceptQuestion(
        name="one-curve-for-two-rooms",
        stem=f"A room has brightnesses from 1 to {room}, the view through its window from {room} to "
        f"{room * view:,}. A display shows contrasts of up to {display}:1. A single rising curve, "
        "used for all pixels, gives the room and the view the same contrast. How much "
        "contrast can each get at most?",
        right=describe_contrast(left),
        because="With one curve the contrasts multiply: 10:1 for the room, and 10:1 above it for "
        "the view.",
        wrong=(
            WrongAnswer(
                describe_contrast(room),
                "Thinks that one curve keeps both; only an operator that differs from place to"
                " place can.",
            ),
            WrongAnswer(
                describe_contrast(display / 2), "Halves the contrast; contrasts are factors."
            ),
            WrongAnswer(
                describe_contrast(display / view),
                "Thinks of a plain scaling, which leaves no contrast in the room.",
            ),
        ),
        notebook="14_global_against_local",
        section="What is a global operator?",
    )


def describe_increase(ratio: float) -> str:
    """Return by how many percent something is brighter, with one digit after the point."""
    return f"{round(100 * (float(ratio) - 1), 1):g}% brighter"


def describe_part(fraction: float) -> str:
    """Return a fraction of white in percent."""
    return f"as {100 * fraction:.2g}% of white"


def describe_contrast(ratio: float) -> str:
    """Return a contrast; in words, because spreadsheets take 10:1 for a time."""
    return f"a contrast of {ratio:.0f}:1"


CONCEPT = Concept(
    "Global tone mapping",
    (contrast_of_highlights(), average_of_a_scene(), one_curve_for_two_rooms()),
)
