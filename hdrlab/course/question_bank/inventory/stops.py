"""Questions about dynamic range and stops."""

import numpy as np

from hdrlab.capture import planning, ranges
from hdrlab.course.question_bank.inventory.question import (
    Concept,
    ConceptQuestion,
    WrongAnswer,
    known_mistake,
)

SENSOR = "01_dynamic_range_and_the_sensor"


def stops_of_a_ratio() -> ConceptQuestion:
    """Ask how many stops a contrast has."""
    ratio = 1000
    contrast = ranges.dynamic_range(ratio, 1)
    return ConceptQuestion(
        name="stops-of-a-ratio",
        stem=f"Photographers call a factor of two in light a stop. The brightest spot of a scene "
        f"sends {ratio} times as much light as the darkest. About how many stops is that?",
        right=f"{contrast.stops:.0f} stops",
        because=f"{contrast.stops:.0f} doublings are a factor of about {ratio}.",
        wrong=(
            WrongAnswer(
                f"{contrast.decades:.0f} stops", "Counts factors of ten; a stop is a factor of two."
            ),
            WrongAnswer(
                f"{np.log(ratio):.0f} stops",
                "Takes the natural logarithm; stops are the logarithm to base 2.",
            ),
            WrongAnswer(
                f"{ratio / 2:.0f} stops", "Divides the contrast by two; stops count doublings."
            ),
        ),
        notebook=SENSOR,
        section="Luminances from moonlight to sunlight",
    )


def levels_of_the_brightest_stop() -> ConceptQuestion:
    """Ask how many pixel values of a linear sensor lie in its brightest stop."""
    bits = 12
    levels = ranges.levels_per_stop(bits)
    total = 2**bits
    return ConceptQuestion(
        name="levels-of-the-brightest-stop",
        stem=f"A sensor stores light as whole numbers from 0 to {total - 1}. Twice the light gives "
        f"twice the number. How many of these {total} numbers describe the brightest factor of "
        "two in light, from half of the largest light up to the largest?",
        right=f"about {levels[0]} numbers",
        because="The numbers are proportional to light, so the upper half of the light has half of "
        "the numbers. Each darker factor of two has half as many as the one above it.",
        wrong=(
            WrongAnswer(
                f"about {total / bits:.0f} numbers",
                "Gives each stop the same number of pixel values, as after a logarithm.",
            ),
            WrongAnswer(
                f"about {levels[-1]} number",
                "Looks at the wrong end: the darkest stop has the fewest pixel values.",
            ),
            WrongAnswer(
                f"about {ranges.levels_per_stop(8)[0]} numbers",
                "Counts the pixel values of an 8-bit image.",
            ),
        ),
        notebook=SENSOR,
        section="What a bit is worth",
    )


def photos_for_a_scene() -> ConceptQuestion:
    """Ask how many photos cover the range of a scene."""
    scene = 15
    usable = 8
    step = 2
    overlap = usable - step
    first_forgotten = known_mistake("count", "count_first_forgotten")
    overlap_forgotten = known_mistake("count", "count_overlap_forgotten")
    rounded_down = known_mistake("count", "count_rounded_down")
    return ConceptQuestion(
        name="photos-for-a-scene",
        stem=f"Photographers call a factor of two in light a stop. One photo records a range of "
        f"{usable} stops, and the scene spans {scene}. Each further photo gets {step} "
        "stops more light than the "
        "one before. How many photos cover the whole scene?",
        right=f"{planning.count(scene, usable, overlap)} photos",
        because=f"The first photo covers {usable} stops. Each further one adds {step}, and the last "
        "incomplete step needs a photo, too.",
        wrong=(
            WrongAnswer(
                f"{first_forgotten(scene, usable, overlap)} photos",
                "Forgets that the first photo covers its whole range.",
            ),
            WrongAnswer(
                f"{overlap_forgotten(scene, usable, overlap)} photos",
                "Ignores that neighboring photos cover mostly the same part of the scene.",
            ),
            WrongAnswer(
                f"{rounded_down(scene, usable, overlap)} photos",
                "Leaves the last stops of the scene without a photo.",
            ),
        ),
        notebook="02_exposure_and_metering",
        section="Planning a bracket",
    )


CONCEPT = Concept(
    "Dynamic range and stops",
    (stops_of_a_ratio(), levels_of_the_brightest_stop(), photos_for_a_scene()),
)
