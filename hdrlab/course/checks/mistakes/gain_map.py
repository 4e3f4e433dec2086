"""Known mistakes in `gain_map`, the task of hdrlab.core.gainmap.gain_map."""

import numpy as np

from hdrlab.core.gainmap import OFFSETS, log_gain
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "gain_map_natural_logarithm",
    says="Your gain is a natural logarithm. low and high are stops, and one stop is twice the "
    "light: use log2.",
    misses_method=True,
)
def natural_logarithm(sdr, hdr, low, high, *, gamma=1.0, k=OFFSETS):
    def log_gain(sdr, hdr, *, k=OFFSETS):
        k_sdr, k_hdr = np.asarray(k)
        return np.log((hdr + k_hdr) / (sdr + k_sdr))

    return np.clip((log_gain(sdr, hdr, k=k) - low) / np.subtract(high, low), 0, 1) ** gamma


@mistake(
    "gain_map_without_offsets",
    says="You left out the offsets, so black has no finite gain. Add k[0] to the image and k[1] "
    "to the scene.",
)
def without_offsets(sdr, hdr, low, high, *, gamma=1.0, k=OFFSETS):
    def log_gain(sdr, hdr, *, k=OFFSETS):
        k_sdr, k_hdr = np.asarray(k)
        return np.log2(hdr / sdr)

    return np.clip((log_gain(sdr, hdr, k=k) - low) / np.subtract(high, low), 0, 1) ** gamma


@mistake(
    "gain_map_offsets_swapped",
    says="You swapped the offsets of scene and image: k is (k_sdr, k_hdr).",
)
def offsets_swapped(sdr, hdr, low, high, *, gamma=1.0, k=OFFSETS):
    def log_gain(sdr, hdr, *, k=OFFSETS):
        k_hdr, k_sdr = np.asarray(k)
        return np.log2((hdr + k_hdr) / (sdr + k_sdr))

    return np.clip((log_gain(sdr, hdr, k=k) - low) / np.subtract(high, low), 0, 1) ** gamma


@mistake(
    "gain_map_not_clipped",
    says="Gains below low or above high give map values outside 0 ... 1. Clip the map to 0 ... 1.",
)
def not_clipped(sdr, hdr, low, high, *, gamma=1.0, k=OFFSETS):
    return ((log_gain(sdr, hdr, k=k) - low) / np.subtract(high, low)) ** gamma


@mistake(
    "gain_map_gamma_inverted",
    says="You raise the fraction to 1 / gamma, as a reader of the map does. To make the map, "
    "raise it to gamma.",
)
def gamma_inverted(sdr, hdr, low, high, *, gamma=1.0, k=OFFSETS):
    return np.clip((log_gain(sdr, hdr, k=k) - low) / np.subtract(high, low), 0, 1) ** (1 / gamma)
