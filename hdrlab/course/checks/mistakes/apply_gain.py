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
    says="You mix the light of the image and the scene in the ratio W. W is a fraction of the "
    "stops instead: 2^(W G).",
)
def part_of_the_light(sdr, g, low, high, *, W=1.0, gamma=1.0, k=OFFSETS):
    k_sdr, k_hdr = np.asarray(k)
    G = low + np.subtract(high, low) * g ** np.divide(1, gamma)
    return sdr + W * ((sdr + k_sdr) * 2**G - k_hdr - sdr)


@mistake(
    "apply_gain_low_in_full",
    says="You apply the fraction W only to the part of the gain above low. It applies to the "
    "whole gain G, including low: W = 0 shows the image itself.",
)
def low_in_full(sdr, g, low, high, *, W=1.0, gamma=1.0, k=OFFSETS):
    k_sdr, k_hdr = np.asarray(k)
    G = low + np.subtract(high, low) * g ** np.divide(1, gamma)
    return (sdr + k_sdr) * 2 ** (low + W * (G - low)) - k_hdr


@mistake(
    "apply_gain_offset_left",
    says="Your light still includes the scene's offset, so black is gray. Subtract k[1] at the "
    "end.",
)
def offset_left(sdr, g, low, high, *, W=1.0, gamma=1.0, k=OFFSETS):
    k_sdr, k_hdr = np.asarray(k)
    G = low + np.subtract(high, low) * g ** np.divide(1, gamma)
    return (sdr + k_sdr) * 2 ** (W * G)


@mistake(
    "apply_gain_gamma_twice",
    says="You raise the map to the power gamma a second time. The encoder did that already; "
    "undo it with the power 1 / gamma.",
)
def gamma_twice(sdr, g, low, high, *, W=1.0, gamma=1.0, k=OFFSETS):
    k_sdr, k_hdr = np.asarray(k)
    G = low + np.subtract(high, low) * g ** np.asarray(gamma)
    return (sdr + k_sdr) * 2 ** (W * G) - k_hdr
