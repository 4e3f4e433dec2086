"""Known mistakes in `to_radiance`, the task of hdrlab.io.maps.rgbe.to_radiance."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.io.maps.rgbe import SCALE


@mistake(
    "to_radiance_exponent_wraps",
    says="The exponent is a byte: below 128, e - 128 wraps around. Turn it into int first.",
)
def exponent_wraps(pixels):
    return np.where(
        pixels[..., 3:] > 0,
        pixels[..., :3] / 256 * 2.0 ** (pixels[..., 3:] - np.uint8(128)).astype(float),
        0,
    )


@mistake(
    "to_radiance_not_over_256",
    says="A mantissa is a fraction of 256, and you did not divide: your radiance is 256 times "
    "too large, like a triple that one lecture prints.",
)
def not_over_256(pixels):
    return 256.0 * pixels[..., :3] * SCALE[pixels[..., 3:]]


@mistake(
    "to_radiance_mantissa_from_1",
    says="You read the mantissa like that of a float, 1 + m / 256; here it is m / 256 itself.",
)
def mantissa_from_1(pixels):
    return np.where(pixels[..., 3:] > 0, (256.0 + pixels[..., :3]) * SCALE[pixels[..., 3:]], 0)
