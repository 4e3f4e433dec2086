"""Questions about aligned photos, and about what moved between them."""

import numpy as np

from hdrlab.align import mtb
from hdrlab.core.arrays import Array
from hdrlab.course.question_bank.inventory.question import (
    Concept,
    ConceptQuestion,
    WrongAnswer,
    known_mistake,
)

NOTEBOOK = "03_alignment_mtb"
TOP = 255


def thresholds_that_agree() -> ConceptQuestion:
    """Ask which thresholds divide two photos of different exposure in the same way."""
    A = np.array([20, 40, 60, 80, 250])
    B = np.minimum(2 * A, TOP)
    histograms = [np.bincount(Z, minlength=TOP + 1) for Z in (A, B)]
    medians = [int(mtb.threshold(h, 0.5)) for h in histograms]
    mean = known_mistake("threshold", "threshold_mean")
    means = [mean(h, 0.5) for h in histograms]
    half_of_largest = [Z.max() // 2 for Z in (A, B)]
    middle = (TOP + 1) // 2
    return ConceptQuestion(
        name="thresholds-that-agree",
        stem=f"Five places have the values {join(A)} in photo A. Photo B gets twice the light: "
        f"{join(B)} ({TOP} is the largest possible value). In each photo, places above a threshold "
        "become white, the others black. Which thresholds for A and B make the same places white?",
        right=f"{medians[0]} and {medians[1]}",
        because="The median has as many places above it in both photos, whatever the exposure is. "
        "The mean moves when a value is clipped.",
        wrong=(
            WrongAnswer(
                f"{means[0]} and {means[1]}",
                "Takes the mean, which a few bright or clipped places move.",
            ),
            WrongAnswer(
                f"{middle} and {middle}",
                "Takes the same threshold for both, although one photo is brighter.",
            ),
            WrongAnswer(
                f"{half_of_largest[0]} and {half_of_largest[1]}",
                "Takes half of the largest value, which clipping limits.",
            ),
        ),
        notebook=NOTEBOOK,
        section="The threshold",
    )


def chained_shifts() -> ConceptQuestion:
    """Ask for the shift from the first photo to the third one."""
    third_to_second = 2
    second_to_first = 3
    steps = [(0, third_to_second), (0, second_to_first)]
    onto_second = mtb.chain_offsets([2, 1, 0], steps)
    first_to_third = int(onto_second[0, 1] - onto_second[2, 1])
    difference = second_to_first - third_to_second
    return ConceptQuestion(
        name="chained-shifts",
        stem=f"Photo 2 must move {second_to_first} pixels to the right to match photo 1. Photo 3 "
        f"must move {third_to_second} pixels to the right to match photo 2. How must photo 1 move "
        "to match photo 3?",
        right=describe_shift(first_to_third),
        because="The shifts add along the chain, and the way back has the opposite sign.",
        wrong=(
            WrongAnswer(
                describe_shift(-first_to_third),
                "Confuses how a photo has moved with how it must move: the sign is wrong.",
            ),
            WrongAnswer(describe_shift(-difference), "Subtracts shifts that add along the chain."),
            WrongAnswer(
                describe_shift(difference),
                "Subtracts shifts that add along the chain, and has the wrong sign.",
            ),
        ),
        notebook=NOTEBOOK,
        section="Chaining the offsets of all photos",
    )


def moved_between_photos() -> ConceptQuestion:
    """Ask at which place something has moved between three photos."""
    times = np.array([1, 2, 4])
    moved = np.array([80, 80, 80])
    dark, bright, clipped = (np.minimum(light * times, TOP) for light in (20, 60, 100))
    return ConceptQuestion(
        name="moved-between-photos",
        stem=f"Photos of {times[0]} s, {times[1]} s and {times[2]} s are taken from a tripod, "
        "in constant light. Pixel "
        f"values are proportional to the collected light, up to the largest value {TOP}. Here are "
        "the three values of four places. At which of them must something have moved?",
        right=join(moved),
        because="The collected light must double from photo to photo, up to the largest value. "
        f"Values that stay at {moved[0]} mean that the light changed.",
        wrong=(
            WrongAnswer(join(clipped), "Takes clipping for movement."),
            WrongAnswer(
                join(bright),
                "Takes the effect of the exposure time for movement: it is largest here.",
            ),
            WrongAnswer(join(dark), "Takes a dark place, which is only measured less well."),
        ),
        notebook="12_ghosts_and_flare",
        section="Weighted variance",
    )


def join(values: Array) -> str:
    """Return values as a list for a sentence."""
    return ", ".join(str(value) for value in values)


def describe_shift(pixels: int) -> str:
    """Return a shift in words; a positive one is to the right."""
    amount = "1 pixel" if abs(pixels) == 1 else f"{abs(pixels)} pixels"
    direction = "right" if pixels > 0 else "left"
    return f"{amount} to the {direction}"


CONCEPT = Concept(
    "Alignment and ghosts", (thresholds_that_agree(), chained_shifts(), moved_between_photos())
)
