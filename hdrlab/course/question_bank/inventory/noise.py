"""Questions about the noise of a sensor."""

import numpy as np

from hdrlab.capture import ranges
from hdrlab.capture.sensor import Sensor
from hdrlab.course.question_bank.inventory.question import Concept, ConceptQuestion, WrongAnswer

NOTEBOOK = "01_dynamic_range_and_the_sensor"
NO_ROUNDING = 1e-9  # electrons per level of a converter whose rounding adds no noise


def snr_of(electrons: float, *, read_noise: float) -> float:
    """Return the signal-to-noise ratio of a pixel with this mean number of electrons."""
    sensor = Sensor(full_well=electrons, read_noise=read_noise, gain=NO_ROUNDING)
    return float(ranges.snr(1.0, sensor))


def shot_noise() -> ConceptQuestion:
    """Ask how much the number of photons scatters at four times the light."""
    dark = 100
    bright = 4 * dark
    dark_noise = dark / snr_of(dark, read_noise=0.0)
    bright_noise = bright / snr_of(bright, read_noise=0.0)
    return ConceptQuestion(
        name="shot-noise",
        stem="A pixel counts the photons that arrive, and they arrive by chance. Where it counts "
        f"{dark} on average, a single count typically differs from the average by "
        f"{dark_noise:.0f}. By how much does a single count typically differ where the average is "
        f"{bright}?",
        right=f"by {bright_noise:.0f} photons",
        because="The scatter grows as the square root of the number of photons.",
        wrong=(
            WrongAnswer(
                f"by {bright * dark_noise / dark:.0f} photons",
                "Thinks that the noise is proportional to the light.",
            ),
            WrongAnswer(
                f"by {dark_noise:.0f} photons",
                "Thinks that the noise does not depend on the light.",
            ),
            WrongAnswer(
                f"by {dark_noise * dark_noise / bright_noise:.0f} photons",
                "Thinks that the noise becomes smaller with more light; only its ratio to the light"
                " does.",
            ),
        ),
        notebook=NOTEBOOK,
        section="Shot noise: the noise of light itself",
    )


def mean_of_photos() -> ConceptQuestion:
    """Ask how much noise is left in the mean of several photos."""
    noise = 8
    photos = 16
    return ConceptQuestion(
        name="mean-of-photos",
        stem=f"You take {photos} photos of a scene in which nothing moves, all with the same "
        f"settings. At each pixel, chance makes a single photo err by about {noise}. You average "
        "the photos. By about how much does the average err?",
        right=f"by {noise / np.sqrt(photos):.0f}",
        because="Independent errors cancel partly: the error of the mean falls as the square root "
        "of the number of photos.",
        wrong=(
            WrongAnswer(
                f"by {noise / photos}",
                "Divides by the number of photos; independent errors do not cancel that well.",
            ),
            WrongAnswer(f"by {noise}", "Thinks that averaging does not reduce the noise."),
            WrongAnswer(
                f"by {noise * np.sqrt(photos):.0f}",
                "Takes the error of the sum; it must be divided by the number of photos.",
            ),
        ),
        notebook="10_radiance_map",
        section="How sure is each pixel?",
    )


def two_sources_of_noise() -> ConceptQuestion:
    """Ask for the signal-to-noise ratio with shot noise and read noise."""
    electrons = 100
    read_noise = 10
    photon_noise = electrons / snr_of(electrons, read_noise=0.0)
    return ConceptQuestion(
        name="two-sources-of-noise",
        stem=f"A pixel collects {electrons} electrons on average. By chance, their number scatters "
        f"by {photon_noise:.0f}. Reading the pixel adds another, independent scatter of "
        f"{read_noise}. How large is the average signal, compared with its total "
        "scatter?",
        right=f"{snr_of(electrons, read_noise=read_noise):.2g} times as large",
        because="The squares of independent scatters add: the total is the root of 200, about 14.",
        wrong=(
            WrongAnswer(
                f"{electrons / (photon_noise + read_noise):.2g} times as large",
                "Adds the scatters; for independent ones, the squares add.",
            ),
            WrongAnswer(
                f"{electrons / photon_noise:.2g} times as large",
                "Counts only one of the two sources of noise.",
            ),
            WrongAnswer(
                f"{electrons / (photon_noise**2 + read_noise**2):.2g} times as large",
                "Divides by the variance instead of its square root.",
            ),
        ),
        notebook=NOTEBOOK,
        section="Measuring gain and read noise: photon transfer",
    )


CONCEPT = Concept("Sensor noise", (shot_noise(), mean_of_photos(), two_sources_of_noise()))
