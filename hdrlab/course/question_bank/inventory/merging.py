"""Questions about merging photos: weights, and clipped pixels."""

import numpy as np

from hdrlab.core.arrays import F64
from hdrlab.core.weights import flat, hat
from hdrlab.course.question_bank.inventory.question import (
    Concept,
    ConceptQuestion,
    WrongAnswer,
    known_mistake,
)
from hdrlab.radiance import merge

NOTEBOOK = "10_radiance_map"
TOP = 255


def weighted_mean() -> ConceptQuestion:
    """Ask for the mean of two estimates with the weights of their pixel values."""
    Z = np.array([120, 215])
    estimates = np.array([12.0, 8.0])
    ramp = known_mistake("hat", "hat_ramp")
    zero_in_the_middle = known_mistake("hat", "hat_zero_in_the_middle")

    def mean_with(weights: F64) -> str:
        mean = merge.frame_mean(weights[Z], estimates, np.ones(2))
        return f"a brightness of {mean:.2g}"

    return ConceptQuestion(
        name="weighted-mean",
        stem="A program estimates the brightness of a place from two photos. Its pixel values are "
        f"{Z[0]} and {Z[1]} (of 0 to {TOP}), the estimates {estimates[0]:g} and {estimates[1]:g}. "
        "It weights each estimate by the distance of the pixel value from the nearer end of the "
        "range. What is the weighted mean?",
        right=mean_with(hat()),
        because=f"The weights are {Z[0]} and {TOP - Z[1]}, 3 to 1.",
        wrong=(
            WrongAnswer(mean_with(flat()), "Gives both photos the same weight."),
            WrongAnswer(
                mean_with(ramp()),
                "Gives bright pixel values the largest weight, up to the clipped ones.",
            ),
            WrongAnswer(
                mean_with(zero_in_the_middle()),
                "Gives the largest weight to the ends, where a pixel measures worst.",
            ),
        ),
        notebook=NOTEBOOK,
        section="The weighted mean",
    )


def clipped_pixel() -> ConceptQuestion:
    """Ask for the light of a pixel that one of three photos clips."""
    times = np.array([1.0, 4.0, 16.0])
    Z = np.array([20, 80, TOP], np.uint8)
    linear_curve = np.log(np.maximum(np.arange(TOP + 1), 0.5))
    E = merge.merge(Z.reshape(-1, 1, 1), times, linear_curve)
    everywhere = np.ones(len(times))
    return ConceptQuestion(
        name="clipped-pixel",
        stem="A camera's pixel values are proportional to the collected light, up to the largest "
        f"value {TOP}. Photos of {times[0]:g}, {times[1]:g} and {times[2]:g} s show a lamp with "
        f"the values {Z[0]}, {Z[1]} and {Z[2]}. By the best estimate, how fast does the lamp's value "
        "grow?",
        right=f"{float(E[0, 0]):.3g} per second",
        because="The last photo is clipped: it says only that there was at least that much light. "
        "The other two agree.",
        wrong=(
            WrongAnswer(
                f"{merge.frame_mean(everywhere, Z.astype(np.float64), times):.3g} per second",
                "Averages the clipped pixel with the others, which pulls the light down.",
            ),
            WrongAnswer(
                f"{Z[2] / times[2]:.3g} per second",
                "Trusts the brightest pixel value, although it is clipped.",
            ),
            WrongAnswer(
                f"{Z.mean():.3g} per second", "Averages pixel values and forgets the times."
            ),
        ),
        notebook=NOTEBOOK,
        section="Pixels that no photo measures",
    )


def weight_of_a_long_exposure() -> ConceptQuestion:
    """Ask how much more a long exposure counts where photons are the only noise."""
    times = np.array([1.0, 9.0])
    everywhere = np.ones(2)

    def influence_of_long(method: str) -> float:
        only_short = merge.METHODS[method](everywhere, times * [1, 0], times)
        only_long = merge.METHODS[method](everywhere, times * [0, 1], times)
        return float(only_long / only_short)

    best = influence_of_long("shot")
    return ConceptQuestion(
        name="weight-of-a-long-exposure",
        stem=f"Two photos collect the light of a wall for {times[0]:g} s and for {times[1]:g} s. "
        "Each gives an estimate of the light per second. The only noise is that photons arrive by "
        f"chance. In the best average, how much weight does the {times[1]:g} s estimate get, "
        "compared with the other?",
        right=f"{best:g} times the weight",
        because="The long photo counts nine times the photons, so the variance of its estimate is a "
        "ninth. The best weight is one over the variance.",
        wrong=(
            WrongAnswer(
                f"{np.sqrt(best):g} times the weight",
                "Weights by one over the standard deviation instead of the variance.",
            ),
            WrongAnswer(
                "the same weight", "Thinks that all photos measure the light equally well."
            ),
            WrongAnswer(
                f"{influence_of_long('likelihood'):g} times the weight",
                "Squares the time, which is right only for noise that does not depend on the light.",
            ),
        ),
        notebook=NOTEBOOK,
        section="Four kinds of mean",
    )


CONCEPT = Concept("Merging photos", (weighted_mean(), clipped_pixel(), weight_of_a_long_exposure()))
