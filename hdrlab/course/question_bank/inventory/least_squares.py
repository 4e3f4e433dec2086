"""Questions about least squares: what is unknown, what is minimized, and what stays undetermined."""

import numpy as np

from hdrlab.core.weights import hat
from hdrlab.course.question_bank.inventory.question import Concept, ConceptQuestion, WrongAnswer
from hdrlab.radiance.merge import frame_mean
from hdrlab.response import debevec

NOTEBOOK = "22_least_squares_and_svd"


def number_of_unknowns() -> ConceptQuestion:
    """Ask how many unknowns the equations for a response curve have."""
    levels = 256
    places = 50
    photos = 5
    Z = np.ones((places, photos), np.int64)
    A, _ = debevec.system(Z, np.zeros(photos), 1.0, hat(levels))
    return ConceptQuestion(
        name="number-of-unknowns",
        stem=f"You look for a camera's curve, one number for each of the {levels} pixel values. You "
        f"use {places} places of a scene in {photos} photos with known exposure times. The light "
        "does not change between the photos, but you do not know how much light the places send. "
        "How many numbers are unknown?",
        right=f"{A.shape[1]} numbers",
        because=f"Unknown are the {levels} numbers of the curve, and one light for each of the "
        f"{places} places. Each place gives {photos} equations.",
        wrong=(
            WrongAnswer(f"{levels} numbers", "Forgets that the light of the places is unknown."),
            WrongAnswer(
                f"{places * photos} numbers", "Counts the equations instead of the unknowns."
            ),
            WrongAnswer(
                f"{levels + places * photos} numbers",
                "Gives each place another light in each photo; it sends the same light to all.",
            ),
        ),
        notebook="04_response_gsolve",
        section="How many samples, how smooth?",
    )


def common_factor_of_times() -> ConceptQuestion:
    """Ask what a common factor of all exposure times changes."""
    ratio = 10
    factor = 2
    true_times = np.array([1.0, 4.0])
    lights = np.array([[ratio], [1]])
    X = lights * true_times
    W = np.ones(len(true_times))
    lamp, wall = (frame_mean(W, exposures, true_times / factor) for exposures in X)
    return ConceptQuestion(
        name="common-factor-of-times",
        stem="A program computes from photos and their exposure times how much light each place "
        "sends per second. By mistake, all the times in its list are half of the true ones. A lamp "
        f"really sends {ratio} times as much light as a wall. Which ratio does the program find?",
        right=f"{lamp / wall:g} to 1",
        because="All lights become twice as large. Ratios stay the same.",
        wrong=(
            WrongAnswer(
                f"{ratio * factor:g} to 1", "Lets the factor change only the brighter of the two."
            ),
            WrongAnswer(
                f"{ratio / factor:g} to 1", "Lets the factor change only the darker of the two."
            ),
            WrongAnswer(
                f"{ratio ** (1 / factor):.1f} to 1",
                "Takes the factor for an exponent; only a power of the times would change ratios.",
            ),
        ),
        notebook="04_response_gsolve",
        section="Real photos, and two lists of times",
    )


def what_is_minimized() -> ConceptQuestion:
    """Ask which estimate minimizes the sum of squares."""
    lengths = np.array([10.0, 10.0, 16.0])
    A = np.ones((len(lengths), 1))
    estimate = np.linalg.lstsq(A, lengths, rcond=None)[0][0]
    return ConceptQuestion(
        name="what-is-minimized",
        stem="You measure the same length three times: "
        f"{lengths[0]:g} mm, {lengths[1]:g} mm and {lengths[2]:g} mm. You look for the length whose "
        "squared differences from the three measurements have the smallest sum. Which one is it?",
        right=f"{estimate:g} mm",
        because="The mean minimizes the sum of squared differences, so an outlier pulls it along.",
        wrong=(
            WrongAnswer(
                f"{np.median(lengths):g} mm",
                "Takes the median, which minimizes the sum of absolute differences.",
            ),
            WrongAnswer(
                f"{(lengths.min() + lengths.max()) / 2:g} mm",
                "Takes the middle of the range, which minimizes the largest difference.",
            ),
            WrongAnswer(
                f"{np.exp(np.log(lengths).mean()):.1f} mm",
                "Takes the geometric mean, which minimizes squared differences of logarithms.",
            ),
        ),
        notebook=NOTEBOOK,
        section="Equations that contradict each other",
    )


CONCEPT = Concept(
    "Least squares", (number_of_unknowns(), common_factor_of_times(), what_is_minimized())
)
