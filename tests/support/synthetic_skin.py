"""Skin as a camera sees it, computed: what the model of its colours is tested on."""

import numpy as np

from hdrlab.core.colour import decode_srgb, encode_srgb
from hdrlab.enhance.skin import DARK, LIGHT

BLOOD = np.array([0.0, 0.12, 0.08])  # how much more of it takes from R, G, B, in ln


def synthetic(count=4000, *, rng=0):
    """Return the levels (count, 3) of computed skin, light and dark in equal parts, in light and in shade."""
    rng = np.random.default_rng(rng)
    light, dark = (np.log(decode_srgb(np.array(levels) / 255)) for levels in (LIGHT, DARK))
    melanin = rng.uniform(-0.25, 1.5, (count, 1))
    ln = light + melanin * (dark - light) - rng.normal(0, 1, (count, 1)) * BLOOD
    lamp = rng.normal(0, 0.1, (count, 1)) * np.array([1, 0, -1]) + rng.normal(0, 0.03, (count, 3))
    ln = ln + lamp + rng.uniform(np.log(0.25), np.log(1.1), (count, 1))
    return 255 * encode_srgb(np.minimum(np.exp(ln), 1))
