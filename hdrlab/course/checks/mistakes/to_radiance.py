"""Known mistakes in `to_radiance`, the task of hdrlab.io.maps.rgbe.to_radiance."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.io.maps.rgbe import SCALE


@mistake(
    "to_radiance_exponent_wraps",
    says="The exponent is a byte. Where it is below 128, e - 128 wraps around. Convert it to int "
    "first.",
)
def exponent_wraps(pixels):
    return np.where(
        pixels[..., 3:] > 0,
        pixels[..., :3] / 256 * 2.0 ** (pixels[..., 3:] - np.uint8(128)).astype(float),
        0,
    )


@mistake(
    "to_radiance_not_over_256",
    says="The mantissa must be divided by 256. Your radiance is 256 times too large, like an "
    "example in one lecture.",
)
def not_over_256(pixels):
    return 256.0 * pixels[..., :3] * SCALE[pixels[..., 3:]]


@mistake(
    "to_radiance_mantissa_from_1",
    says="You decode the mantissa as in a float, 1 + m / 256. In RGBE it is m / 256.",
)
def mantissa_from_1(pixels):
    return np.where(pixels[..., 3:] > 0, (256.0 + pixels[..., :3]) * SCALE[pixels[..., 3:]], 0)


@mistake(
    "to_radiance_over_255",
    says="You divide the mantissa by 255. It is a binary fraction: divide by 256.",
)
def over_255(pixels):
    return 256 / 255 * pixels[..., :3] * SCALE[pixels[..., 3:]]
