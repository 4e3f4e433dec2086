"""Questions about exposure: time, aperture, and the light meter."""

from hdrlab.capture import metering
from hdrlab.capture.exposure import equivalent_time
from hdrlab.course.question_bank.inventory.question import (
    Concept,
    ConceptQuestion,
    WrongAnswer,
    known_mistake,
)

NOTEBOOK = "02_exposure_and_metering"
SETTINGS = "The exposure value: three settings, one number"


def time_of_a_smaller_aperture() -> ConceptQuestion:
    """Ask which time makes up for a larger f-number."""
    time = 1 / 100
    F = 4
    F_new = 8
    right_time = float(equivalent_time(time, F, F_new))
    aperture_once = known_mistake("equivalent_time", "equivalent_time_aperture_once")
    inverted = known_mistake("equivalent_time", "equivalent_time_inverted")
    return ConceptQuestion(
        name="time-of-a-smaller-aperture",
        stem="The f-number of a lens is its focal length divided by the diameter of its opening. "
        f"At f/{F}, an exposure time of {format_time(time)} gives a photo of the right "
        f"brightness. Which time gives the same brightness at f/{F_new}?",
        right=format_time(right_time),
        because="Half the diameter is a quarter of the area, so the light needs four times as long.",
        wrong=(
            WrongAnswer(
                format_time(aperture_once(time, F, F_new)),
                "Takes the diameter of the opening instead of its area.",
            ),
            WrongAnswer(
                format_time(inverted(time, F, F_new)),
                "Takes a larger f-number for a larger opening.",
            ),
            WrongAnswer(
                format_time(time),
                "Thinks that the f-number changes only the sharpness, not the light.",
            ),
        ),
        notebook=NOTEBOOK,
        section=SETTINGS,
    )


def time_of_three_stops() -> ConceptQuestion:
    """Ask which time gives a number of stops more light."""
    time = 1 / 80
    stops = 3
    return ConceptQuestion(
        name="time-of-three-stops",
        stem="Photographers call a factor of two in light a stop. A photo with an exposure time of "
        f"{format_time(time)} is {stops} stops too dark. You change only the time. Which time is "
        "right?",
        right=format_time(time * 2**stops),
        because=f"{stops} doublings are a factor of {2**stops}.",
        wrong=(
            WrongAnswer(format_time(time * stops), f"Takes {stops} stops for a factor of {stops}."),
            WrongAnswer(
                format_time(time * 2 * stops),
                "Adds the factors of two instead of multiplying them.",
            ),
            WrongAnswer(
                format_time(time / 2**stops), "Shortens the time, which makes the photo darker."
            ),
        ),
        notebook=NOTEBOOK,
        section=SETTINGS,
    )


def snow_and_the_meter() -> ConceptQuestion:
    """Ask how an automatic camera exposes snow."""
    snow = 0.9
    # the change of the exposure value that the meter makes, where 0 is the right exposure of snow
    change = metering.optimum(0.0, snow)
    wrong_way = known_mistake("optimum", "optimum_wrong_way")
    natural_logarithm = known_mistake("optimum", "optimum_natural_logarithm")
    return ConceptQuestion(
        name="snow-and-the-meter",
        stem="An automatic camera exposes each photo as if the scene reflected "
        f"{metering.MIDDLE_GRAY:.0%} of the light on average. You photograph a field of snow, "
        f"which reflects {snow:.0%}. How does the snow come out? (Photographers call a factor of "
        "two in light a stop.)",
        right=describe_change(change),
        because="The camera makes the snow as dark as a gray surface: 18/90 is a fifth of the light "
        "that it should have.",
        wrong=(
            WrongAnswer(
                describe_change(wrong_way(0.0, snow)),
                "Thinks that a bright scene makes the camera expose more.",
            ),
            WrongAnswer(
                describe_change(natural_logarithm(0.0, snow)),
                "Takes the natural logarithm; stops are the logarithm to base 2.",
            ),
            WrongAnswer(
                describe_change(0.0),
                "Thinks that the camera recognizes how bright a surface is by itself.",
            ),
        ),
        notebook=NOTEBOOK,
        section="Scenes that mislead a meter: snow, and a black locomotive",
    )


def format_time(seconds: float) -> str:
    """Return an exposure time as photographers write it: 1/50 s."""
    return f"1/{1 / seconds:.0f} s"


def describe_change(exposure_value: float) -> str:
    """Return how a photo with a change of the exposure value looks; one more halves the light."""
    if not exposure_value:
        return "as bright as it should be"
    direction = "dark" if exposure_value > 0 else "bright"
    return f"{abs(exposure_value):.1f} stops too {direction}"


CONCEPT = Concept(
    "Exposure", (time_of_a_smaller_aperture(), time_of_three_stops(), snow_and_the_meter())
)
