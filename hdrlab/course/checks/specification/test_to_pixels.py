"""Checks of to_pixels(E), radiance as RGBE: (H, W, 4), three mantissas and their shared
exponent.
"""

import numpy as np

from hdrlab.course.checks.compare import finite, points, require, same
from hdrlab.io.maps import rgbe


def draw_inputs(rng):
    """Return E (9, 11, 3) in which no brightest channel is so close to a power of 2 that
    rounding reaches it.
    """
    channels = rng.permuted(np.insert(rng.uniform(0.02, 1, (9, 11, 2)), 0, 1, axis=-1), axis=-1)
    brightest = 2.0 ** rng.integers(-20, 21, (9, 11, 1)) * rng.uniform(0.5, 0.99, (9, 11, 1))
    return (brightest * channels).astype(np.float32)


def get_answer(subject, E):
    pixels = finite(subject.to_pixels(E), (*E.shape[:2], 4), what="the pixels").astype(float)
    message = f"expected whole numbers from 0 to 255, got {pixels.min():.4g} to {pixels.max():.4g}"
    require(((pixels >= 0) & (pixels <= 255) & (pixels == np.round(pixels))).all(), message)
    return pixels


def check_one_input(subject, E):
    """Compare what the bytes mean, because a mantissa may be rounded up or down."""
    pixels = get_answer(subject, E)
    m, e = np.split(pixels, [3], axis=-1)
    brightest = E.max(axis=-1, keepdims=True)
    scale = np.where(brightest > 0, brightest, 1)
    same(m / 256 * 2.0 ** (e - 128) / scale, E / scale, 1 / 127, what="E / its brightest channel")
    same(e, rgbe.to_pixels(E)[..., 3:], 0, what="the exponents")


def test_every_pixel_is_four_bytes(subject, rng):
    """A pixel has three mantissas and an exponent.

    The result has the shape (H, W, 4).

    All values are whole numbers from 0 to 255.
    """
    get_answer(subject, draw_inputs(rng))


@points(4)
def test_decoding_restores_the_radiance_to_one_part_in_128(subject, rng):
    """Decode what you have encoded: E = m / 256 2^(e - 128).

    The exponent comes from the brightest channel; np.frexp gives it.

    m = floor(256 E / 2^(e - 128)). Do not forget the 256 or the 128.
    """
    E = draw_inputs(rng)
    # a mantissa of 255.9 must not be rounded up to 256
    E[0, :3] = [
        [1.999, 0.5, 0.25],
        [0.03, 0.9985, 0.4],
        [0.1, 0.2, 3.997],
    ]
    m, e = np.split(get_answer(subject, E), [3], axis=-1)
    brightest = E.max(axis=-1, keepdims=True)
    same(
        m / 256 * 2.0 ** (e - 128) / brightest,
        E / brightest,
        1 / 127,
        what="E / its brightest channel",
    )


@points(3, needs="test_decoding_restores_the_radiance_to_one_part_in_128")
def test_the_largest_mantissa_is_128_or_more(subject, rng):
    """How much of the range from 0 to 255 do your mantissas use?

    The mantissa of the brightest channel must be between 128 and 255.

    The brightest channel is f 2^x with 0.5 <= f < 1, and e = x + 128.
    """
    pixels = get_answer(subject, draw_inputs(rng))
    largest = pixels[..., :3].max(axis=-1)
    message = f"expected a largest mantissa of 128 or more in every pixel, got {largest.min():g}"
    require((largest >= 128).all(), message)


@points(3)
def test_twice_the_light_adds_one_to_the_exponent_and_black_is_zero(subject, rng):
    """What happens to the four bytes at twice the light?

    The mantissas stay, and the exponent grows by one. Black is (0, 0, 0, 0).

    Avoid log2(0): use np.where for black pixels.
    """
    E = draw_inputs(rng)
    E[2, 3] = 0
    truth = rgbe.to_pixels(E).astype(float)
    lit = E.max(axis=-1, keepdims=True) > 0
    encoded = get_answer(subject, E)
    doubled = get_answer(subject, 2 * E)
    same(
        doubled - encoded,
        lit * np.array([0, 0, 0, 1]),
        0,
        what="the change of the bytes at twice the light",
    )
    same(encoded[..., 3], truth[..., 3], 0, what="the exponents")


@points(2, needs="test_decoding_restores_the_radiance_to_one_part_in_128")
def test_an_exact_power_of_two_is_no_exception(subject, rng):
    """The brightest channel is exactly 1. What are its mantissa and its exponent?

    128 and 129: a mantissa of 256 does not fit into a byte.

    Use np.frexp, or floor(log2(...)) + 1. ceil(log2(...)) is one too small for exact powers.
    """
    E = draw_inputs(rng)
    for k in range(6):
        E[k] *= np.float32(2.0 ** (k - 3)) / E[k].max(axis=-1, keepdims=True)
    brightest = E.max(axis=-1)
    is_power = brightest == 2.0 ** np.round(np.log2(brightest))
    pixels = get_answer(subject, E)
    largest = pixels[..., :3].max(axis=-1)
    same(largest, np.full(largest.shape, 128), 0, what="the largest mantissa", where=is_power)
    exponent = np.log2(brightest) + 129
    same(pixels[..., 3], exponent, 0.1, what="the exponent", where=is_power)
