"""Known mistakes in `apply_gain`, the task of hdrlab.core.gainmap.apply_gain."""

import numpy as np

from hdrlab.core.gainmap import OFFSETS
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "apply_gain_powers_of_e",
    says="You take exp of the gain. Gains are stops, and each stop doubles the light: 2^(W G).",
    misses_method=True,
)
def powers_of_e(sdr, g, low, high, *, W=1.0, gamma=1.0, k=OFFSETS):
    k_sdr, k_hdr = np.asarray(k)
    G = low + np.subtract(high, low) * g ** np.divide(1, gamma)
    return (sdr + k_sdr) * np.exp(W * G) - k_hdr


@mistake(
    "apply_gain_part_of_the_light",
    says="You mix picture and scene, W parts of the light between them. W is a part of the "
    "stops: 2^(W G).",
)
def part_of_the_light(sdr, g, low, high, *, W=1.0, gamma=1.0, k=OFFSETS):
    k_sdr, k_hdr = np.asarray(k)
    G = low + np.subtract(high, low) * g ** np.divide(1, gamma)
    return sdr + W * ((sdr + k_sdr) * 2**G - k_hdr - sdr)


@mistake(
    "apply_gain_low_in_full",
    says="You take the part W of what is above low alone. It is a part of the whole gain G, "
    "low as well: W = 0 shows the picture.",
)
def low_in_full(sdr, g, low, high, *, W=1.0, gamma=1.0, k=OFFSETS):
    k_sdr, k_hdr = np.asarray(k)
    G = low + np.subtract(high, low) * g ** np.divide(1, gamma)
    return (sdr + k_sdr) * 2 ** (low + W * (G - low)) - k_hdr


@mistake(
    "apply_gain_offset_left",
    says="The scene's offset is still in your light, so black is gray. Take k[1] off at the end.",
)
def offset_left(sdr, g, low, high, *, W=1.0, gamma=1.0, k=OFFSETS):
    k_sdr, k_hdr = np.asarray(k)
    G = low + np.subtract(high, low) * g ** np.divide(1, gamma)
    return (sdr + k_sdr) * 2 ** (W * G)


@mistake(
    "apply_gain_gamma_twice",
    says="You raise the map to gamma once more. It was raised when it was made: undo that by "
    "the power 1 / gamma.",
)
def gamma_twice(sdr, g, low, high, *, W=1.0, gamma=1.0, k=OFFSETS):
    k_sdr, k_hdr = np.asarray(k)
    G = low + np.subtract(high, low) * g ** np.asarray(gamma)
    return (sdr + k_sdr) * 2 ** (W * G) - k_hdr
