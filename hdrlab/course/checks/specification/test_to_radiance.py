"""RGBE as radiance: to_radiance(pixels) -> E (H, W, 3)."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, require, same


def drawn(rng):
    pixels = rng.integers(0, 256, (9, 11, 4), dtype=np.uint8)
    pixels[..., 3] = rng.integers(110, 146, (9, 11))
    return pixels


def test_every_pixel_is_three_radiances(subject, rng):
    """The exponent is no channel of the answer.

    The answer is (H, W, 3).

    Nothing in it is below 0.
    """
    E = finite(subject.to_radiance(drawn(rng)), (9, 11, 3), what="E")
    require((E >= 0).all(), f"E: expected radiance of at least 0, got {float(E.min()):.3g}")


@points(5)
def test_a_mantissa_is_a_fraction_of_256(subject):
    """The pixel (145, 215, 87, 103) can be read as 4.32e-06 and more: which factor is missing?

    A mantissa is a fraction of 256.

    E = m / 256 2^(e - 128).
    """
    pixels = np.array([[[149, 150, 151, 128], [128, 64, 32, 129]]], np.uint8)
    expected = [[[149 / 256, 150 / 256, 151 / 256], [1, 0.5, 0.25]]]
    same(subject.to_radiance(pixels), expected, 0.005, what="E")


@points(3)
def test_dark_and_bright_exponents_are_powers_of_two(subject, rng):
    """What is 110 - 128 in uint8?

    Bytes do not go below 0: the exponent wraps around.

    Turn the exponent into int or float before you subtract 128.
    """
    pixels = drawn(rng)
    scale = 2.0 ** (pixels[..., 3:].astype(float) - 128)
    came = finite(subject.to_radiance(pixels), (9, 11, 3), what="E")
    same(came / scale, pixels[..., :3] / 256, 0.003, what="E 2^(128 - e)")


@points(2)
def test_the_exponent_0_is_black(subject, rng):
    """The exponent 0 has a meaning of its own.

    Whatever its mantissas, such a pixel is black.

    E = 0 where e = 0.
    """
    pixels, black = drawn(rng), rng.random((9, 11)) < 0.3
    pixels[black] = 0
    came = finite(subject.to_radiance(pixels), (9, 11, 3), what="E")
    same(came[black], np.zeros((black.sum(), 3)), 0, what="E where all bytes are 0")
    scale = 2.0 ** (pixels[..., 3:].astype(float) - 128)
    same((came / scale)[~black], pixels[~black][:, :3] / 256, 0.003, what="E 2^(128 - e) elsewhere")
