"""Questions about the response curve of a camera."""

from fractions import Fraction

import numpy as np

from hdrlab.course.question_bank.inventory.question import Concept, ConceptQuestion, WrongAnswer
from hdrlab.radiance.merge import frame_mean

GAMMA = 2.2
TOP = 255


def twice_the_light() -> ConceptQuestion:
    """Ask for the pixel value of twice the light in a photo with a gamma."""
    value = 100
    factor = 2
    return ConceptQuestion(
        name="twice-the-light",
        stem=f"In a photo file, a pixel value (0 to {TOP}) is proportional to light^(1/{GAMMA}), the "
        f"light to the power of 1/{GAMMA}. A wall has the value {value}. In a second photo, it gets "
        "twice the light. Which value does it have there?",
        right=f"about {value * factor ** (1 / GAMMA):.0f}",
        because=f"2 to the power of 1/{GAMMA} is {factor ** (1 / GAMMA):.2f}: the curve makes the "
        "step smaller.",
        wrong=(
            WrongAnswer(
                f"about {value * factor}", "Takes pixel values for proportional to the light."
            ),
            WrongAnswer(
                f"about {min(value * factor**GAMMA, TOP):.0f}, the largest value",
                f"Uses the curve in the wrong direction, with the power {GAMMA}.",
            ),
            WrongAnswer(f"about {value * GAMMA:.0f}", f"Takes the exponent {GAMMA} for a factor."),
        ),
        notebook="04_response_gsolve",
        section="Three pixels",
    )


def light_from_a_curve() -> ConceptQuestion:
    """Ask for the ratio of two lights from pixel values, a measured curve and exposure times."""
    exposures = {50: 2, 100: 8, 200: 40}
    lamp = 200
    lamp_time = 1
    wall = 100
    wall_time = 4
    table = ", ".join(f"{value} means {exposure}" for value, exposure in exposures.items())

    def ratio(lamp_exposure: float, wall_exposure: float) -> float:
        X = np.array([lamp_exposure, wall_exposure], np.float64)
        t = np.array([lamp_time, wall_time], np.float64)
        lights = [frame_mean(np.ones(1), X[k : k + 1], t[k : k + 1]) for k in range(2)]
        return float(lights[0] / lights[1])

    X_lamp = exposures[lamp]
    X_wall = exposures[wall]
    return ConceptQuestion(
        name="light-from-a-curve",
        stem="A camera's curve was measured: the pixel value "
        f"{table} units of collected light. A lamp has the value {lamp} in a photo that collected "
        f"light for {lamp_time} s. A wall has {wall} in a photo of {wall_time} s. How much more "
        "light does the lamp send per second?",
        right=f"{ratio(X_lamp, X_wall):g} times as much",
        because=f"The lamp gives {X_lamp} units in {lamp_time} s, the wall {X_wall} in {wall_time} "
        "s.",
        wrong=(
            WrongAnswer(
                f"{X_lamp / X_wall:g} times as much", "Forgets to divide by the exposure times."
            ),
            WrongAnswer(
                f"{ratio(lamp, wall):g} times as much",
                "Takes pixel values for light, without the curve.",
            ),
            WrongAnswer(
                f"{X_lamp * lamp_time / (X_wall * wall_time):g} times as much",
                "Multiplies by the exposure times instead of dividing.",
            ),
        ),
        notebook="10_radiance_map",
        section="The estimates for one pixel",
    )


def equal_values() -> ConceptQuestion:
    """Ask what equal pixel values in photos with different times mean."""
    times = (1, 4)
    value = 60
    longer_value = 180
    right = Fraction(times[0], times[1])
    values = Fraction(value, longer_value)
    return ConceptQuestion(
        name="equal-values",
        stem=f"Two photos differ only in their exposure times, {times[0]} s and {times[1]} s. "
        f"Surface A has the pixel value {value} in the first and {longer_value} in the second. "
        f"Surface B has the value {value} in the second. How much light does B send, compared with "
        "A?",
        right=f"{right} of the light of A",
        because="Equal pixel values mean equal collected light, whatever the camera's curve is. B "
        f"needed {times[1]} times as long for it.",
        wrong=(
            WrongAnswer(
                f"{values} of the light of A", "Takes the ratio of pixel values for that of lights."
            ),
            WrongAnswer("as much light as A", "Forgets that the photos have different times."),
            WrongAnswer(
                f"{right * values} of the light of A",
                "Corrects for the time and for the ratio of pixel values; the time is enough.",
            ),
        ),
        notebook="04_response_gsolve",
        section="Three pixels",
    )


CONCEPT = Concept("The response curve", (twice_the_light(), light_from_a_curve(), equal_values()))
