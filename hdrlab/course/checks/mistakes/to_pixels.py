"""Known mistakes in `to_pixels`, the task of hdrlab.io.maps.rgbe.to_pixels."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "to_pixels_exponent_of_red",
    says="You use the exponent of the red channel. Use that of the brightest channel; "
    "otherwise the others overflow.",
)
def exponent_of_red(E):
    brightest = E.max(axis=-1, keepdims=True)
    _, exponent = np.frexp(E[..., :1])
    mantissa = np.minimum(np.ldexp(E, 8 - exponent), 255)
    pixels = np.concatenate([mantissa, exponent + 128], axis=-1)
    return np.where(brightest < 1e-32, 0, pixels).astype(np.uint8)  # Ward's limit: below it, black


@mistake(
    "to_pixels_exponent_too_large",
    says="Your exponent is one too large. All mantissas are below 128, so you lose one bit of "
    "precision. Check the limits of the largest mantissa.",
)
def exponent_too_large(E):
    brightest = E.max(axis=-1, keepdims=True)
    _, exponent = np.frexp(brightest)
    mantissa = np.ldexp(E, 7 - exponent)
    pixels = np.concatenate([mantissa, exponent + 129], axis=-1)
    return np.where(brightest < 1e-32, 0, pixels).astype(np.uint8)  # Ward's limit: below it, black


@mistake(
    "to_pixels_mantissa_rounds_to_256",
    says="You round a mantissa of 255.6 to 256, which does not fit into a byte and becomes 0. "
    "Truncate, or clip at 255.",
)
def mantissa_rounds_to_256(E):
    brightest = E.max(axis=-1, keepdims=True)
    _, exponent = np.frexp(brightest)
    mantissa = np.round(np.ldexp(E, 8 - exponent))
    pixels = np.concatenate([mantissa, exponent + 128], axis=-1)
    # Ward's limit: below it, black
    return np.where(brightest < 1e-32, 0, pixels).astype(np.int64).astype(np.uint8)


@mistake(
    "to_pixels_not_times_256",
    says="Your mantissas are fractions, truncated to 0. Multiply them by 256 before you "
    "convert them to bytes.",
)
def not_times_256(E):
    brightest = E.max(axis=-1, keepdims=True)
    _, exponent = np.frexp(brightest)
    mantissa = np.ldexp(E, -exponent)
    pixels = np.concatenate([mantissa, exponent + 128], axis=-1)
    return np.where(brightest < 1e-32, 0, pixels).astype(np.uint8)  # Ward's limit: below it, black


@mistake(
    "to_pixels_exact_powers_wrap",
    says="Where the brightest channel is an exact power of 2, your mantissa is 256, which does not "
    "fit into a byte. Use np.frexp, or floor(log2(...)) + 1.",
)
def exact_powers_wrap(E):
    brightest = E.max(axis=-1, keepdims=True)
    exponent = np.ceil(np.log2(np.maximum(brightest, 1e-32))).astype(int)
    mantissa = np.floor(np.ldexp(E, 8 - exponent)) % 256
    pixels = np.concatenate([mantissa, exponent + 128], axis=-1)
    return np.where(brightest < 1e-32, 0, pixels).astype(np.uint8)  # Ward's limit: below it, black
