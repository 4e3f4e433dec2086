"""Pixel values of skin, computed from a model of melanin, blood and lighting."""

import numpy as np

from hdrlab.core.colour import decode_srgb, encode_srgb
from hdrlab.enhance.skin import DARK, LIGHT

BLOOD_ABSORPTION = np.array([0.0, 0.12, 0.08])  # of R, G, B, in natural logarithms


def sample_skin(count=4000, *, rng=0):
    """Return sRGB values of random skin, light and dark in equal parts, in light and in shade.

    Parameters
    ----------
    count : number of pixels
    rng : seed or Generator

    Returns
    -------
    (count, 3) float64 in 0..255
    """
    rng = np.random.default_rng(rng)
    log_light = np.log(decode_srgb(np.array(LIGHT) / 255))
    log_dark = np.log(decode_srgb(np.array(DARK) / 255))
    melanin = rng.uniform(-0.25, 1.5, (count, 1))
    blood = rng.normal(0, 1, (count, 1))
    log_reflectance = log_light + melanin * (log_dark - log_light) - blood * BLOOD_ABSORPTION
    lamp_temperature = rng.normal(0, 0.1, (count, 1)) * np.array([1, 0, -1])
    lamp_noise = rng.normal(0, 0.03, (count, 3))
    shade = rng.uniform(np.log(0.25), np.log(1.1), (count, 1))
    linear = np.exp(log_reflectance + lamp_temperature + lamp_noise + shade)
    return 255 * encode_srgb(np.minimum(linear, 1))
