"""Questions about files with a shared exponent, gamma, and displays for HDR."""

import numpy as np

from hdrlab.course.question_bank.inventory.question import Concept, ConceptQuestion, WrongAnswer
from hdrlab.io.maps import rgbe
from hdrlab.tonemap import transfer

GAMMA = 2.2
TOP = 255


def shared_exponent() -> ConceptQuestion:
    """Ask what a file with a common factor for three colors makes of a small one."""
    color = np.array([1600, 800, 3], np.float32)
    red, green, blue = color
    stored = rgbe.to_radiance(rgbe.to_pixels(color[None, None]))[0, 0]
    step = red / rgbe.to_pixels(color[None, None])[0, 0, 0]
    return ConceptQuestion(
        name="shared-exponent",
        stem=f"A file stores red, green and blue as whole numbers from 0 to {TOP}, with one common "
        "factor that multiplies all three. The factor is the smallest power of two (1, 2, 4, ...) "
        "for which all three numbers fit. Numbers are rounded down. A pixel has red "
        f"{red:g}, green {green:g}, blue {blue:g}. Which blue is read back?",
        right=f"blue {stored[2]:g}",
        because=f"For red, the factor must be {step:g}, so blue can only be 0, {step:g}, "
        f"{2 * step:g} and so on.",
        wrong=(
            WrongAnswer(f"blue {blue:g}", "Gives each color a factor of its own."),
            WrongAnswer(f"blue {step:g}", "Rounds every color up to at least one step."),
            WrongAnswer(
                f"blue {red / (TOP + 1):g}",
                "Divides the largest color by 256; the factor is a power of two.",
            ),
        ),
        notebook="13_files",
        section="The error of a shared exponent",
    )


def checkerboard() -> ConceptQuestion:
    """Ask which pixel value looks as bright as a fine checkerboard."""
    white_fraction = 0.5
    middle_gray = 0.18
    return ConceptQuestion(
        name="checkerboard",
        stem=f"The light of a display is proportional to value^{GAMMA}, the pixel value (0 to {TOP}) "
        f"to the power of {GAMMA}. From afar, a fine checkerboard of black (0) and white ({TOP}) "
        "looks evenly gray. Which single pixel value gives the same gray?",
        right=f"about {TOP * white_fraction ** (1 / GAMMA):.0f}",
        because="The eye averages light, not pixel values. Half of the light needs 255 times 0.5 to "
        f"the power of 1/{GAMMA}.",
        wrong=(
            WrongAnswer(
                f"about {TOP * white_fraction:.0f}", "Averages pixel values instead of light."
            ),
            WrongAnswer(
                f"about {TOP * white_fraction**GAMMA:.0f}",
                f"Uses the power of {GAMMA} in the wrong direction.",
            ),
            WrongAnswer(
                f"about {TOP * middle_gray ** (1 / GAMMA):.0f}",
                f"Takes the gray card of photographers, {middle_gray:.0%} of the light, for half "
                "of it.",
            ),
        ),
        notebook="08_calibration_without_a_bracket",
        section="A display shows fifteen mixtures",
    )


def absolute_code() -> ConceptQuestion:
    """Ask how bright a PQ signal is on a brighter display."""
    luminance = 100
    peak = 1000
    brighter_peak = 4000
    shown = float(transfer.pq_inverse(transfer.pq(luminance)))
    ratio = brighter_peak / peak
    return ConceptQuestion(
        name="absolute-code",
        stem="A film for HDR displays is coded with PQ (the standard ST 2084). On an ideal "
        "display whose brightest "
        f"white has {peak:,} cd/m² (the unit of luminance), a wall has {luminance}. The same film "
        f"runs on an ideal display with up to {brighter_peak:,}. Which luminance does the wall have"
        " there?",
        right=f"{shown:.0f} cd/m²",
        because="A PQ code stands for a luminance, whatever the display can reach. A gamma, in "
        "contrast, stands for a fraction of the display's white.",
        wrong=(
            WrongAnswer(
                f"{luminance * ratio:.0f} cd/m²",
                "Thinks of a code for a fraction of the display's white, as a gamma is.",
            ),
            WrongAnswer(
                f"{luminance / ratio:.0f} cd/m²",
                "Thinks that a brighter display must show the rest darker.",
            ),
            WrongAnswer(
                f"{luminance * np.sqrt(ratio):.0f} cd/m²",
                "Thinks that the display spreads the code over its range of stops.",
            ),
        ),
        notebook="25_a_picture_that_lights_up",
        section="Codes for HDR screens: PQ and HLG",
    )


CONCEPT = Concept("Files and displays", (shared_exponent(), checkerboard(), absolute_code()))
