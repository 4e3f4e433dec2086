"""Questions about local tone mapping: halos, edge-preserving filters, and gradients."""

import numpy as np
from scipy.ndimage import uniform_filter1d

from hdrlab.core.filters.bilateral import bilateral
from hdrlab.course.question_bank.inventory.question import Concept, ConceptQuestion, WrongAnswer

WHOLE_ROW = 1e4  # a spatial sigma, pixels, with which all pixels of a short row count the same
ANY_DIFFERENCE = 1e6  # a range sigma with which no difference of brightness matters


def halo() -> ConceptQuestion:
    """Ask what a division by the local average does next to an edge."""
    dark = 1
    bright = 100
    row = np.array([dark] * 4 + [bright] * 4, np.float64)
    divided = row / uniform_filter1d(row, 3, mode="nearest")
    return ConceptQuestion(
        name="halo",
        stem="To reduce contrast, a program divides each pixel of a row by the average of itself "
        f"and its two neighbors. The row is {', '.join(f'{value:g}' for value in row)}. How does "
        "the fourth pixel come out, compared with the second?",
        right=describe_ratio(divided[3] / divided[1]),
        because="Its average contains the bright neighbor: (1 + 1 + 100) / 3 = 34. "
        "Such a dark seam along an edge is a halo.",
        wrong=(
            WrongAnswer(
                describe_ratio(divided[2] / divided[1]),
                "Thinks that equal pixels come out equal; a local operator looks at the neighbors.",
            ),
            WrongAnswer(
                describe_ratio(divided[4] / divided[1]),
                "Takes the bright side of the edge: there, pixels become brighter.",
            ),
            WrongAnswer(describe_ratio(dark / bright), "Divides by the bright neighbor alone."),
        ),
        notebook="14_global_against_local",
        section="Chiu: a scale for every pixel",
    )


def edge_preserving_mean() -> ConceptQuestion:
    """Ask what a filter that ignores very different neighbors does at an edge."""
    row = np.array([50, 52, 54, 200, 202], np.float32)
    limit = 20
    middle = len(row) // 2
    filtered = bilateral(row[None], sigma_s=WHOLE_ROW, sigma_r=limit).mean[0, middle]
    blurred = bilateral(row[None], sigma_s=WHOLE_ROW, sigma_r=ANY_DIFFERENCE).mean[0, middle]
    nearest = row[middle - 1 : middle + 2].mean()
    return ConceptQuestion(
        name="edge-preserving-mean",
        stem="A filter replaces each pixel by the average of itself and the two pixels on either "
        f"side, but leaves out pixels that differ from it by more than {limit}. What becomes of "
        f"the middle pixel of the row {', '.join(f'{value:g}' for value in row)}?",
        right=f"about {filtered:.0f}",
        because="Only 50, 52 and 54 count. The filter smooths on each side of the edge, and not "
        "across it.",
        wrong=(
            WrongAnswer(
                f"about {blurred:.0f}",
                "Forgets the limit of the differences, so that the filter blurs the edge.",
            ),
            WrongAnswer(
                f"about {row[middle]:.0f}, as before",
                "Thinks that the filter does nothing at an edge.",
            ),
            WrongAnswer(
                f"about {nearest:.0f}",
                "Takes nearness in the row for nearness in brightness.",
            ),
        ),
        notebook="15_durand",
        section="The bilateral filter at one pixel",
    )


def compressed_gradients() -> ConceptQuestion:
    """Ask for the range of a row whose large steps were halved."""
    row = np.array([0, 1, 1, 9, 9])
    limit = 2
    steps = np.diff(row)
    is_large = np.abs(steps) > limit
    compressed = row[0] + np.cumsum(np.where(is_large, steps / 2, steps))
    return ConceptQuestion(
        name="compressed-gradients",
        stem="The logarithm of the brightness along a row is "
        f"{', '.join(str(value) for value in row)}. A program halves each step between neighbors "
        f"that is larger than {limit}, keeps the other steps, and adds all steps up again, "
        f"starting at {row[0]}. What is the last value?",
        right=f"the value {compressed[-1]:g}",
        because="The steps 1, 0, 8, 0 become 1, 0, 4, 0. The large contrast shrinks, and the small "
        "one stays.",
        wrong=(
            WrongAnswer(
                f"the value {row[-1] / 2:g}",
                "Halves the whole range, and with it the small steps.",
            ),
            WrongAnswer(
                f"the value {row[-1]:g}",
                "Thinks that changed steps leave the values where they were.",
            ),
            WrongAnswer(
                f"the value {(steps[is_large] / 2).sum():g}", "Forgets to add the small steps."
            ),
        ),
        notebook="17_fattal",
        section="In one dimension",
    )


def describe_ratio(ratio: float) -> str:
    """Return how bright a pixel is, compared with another one."""
    if np.isclose(ratio, 1):
        return "equally bright"
    return f"{ratio:.2g} times brighter" if ratio > 1 else f"{1 / ratio:.3g} times darker"


CONCEPT = Concept(
    "Halos, edges and gradients", (halo(), edge_preserving_mean(), compressed_gradients())
)
