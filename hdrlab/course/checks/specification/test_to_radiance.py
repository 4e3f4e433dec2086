"""Checks of to_radiance(pixels), RGBE as radiance: E (H, W, 3)."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, require, same


def draw_inputs(rng):
    pixels = rng.integers(0, 256, (9, 11, 4), dtype=np.uint8)
    pixels[..., 3] = rng.integers(110, 146, (9, 11))
    return pixels


def test_every_pixel_is_three_radiances(subject, rng):
    """Do not return the exponent as a channel.

    The result has the shape (H, W, 3).

    No value is below 0.
    """
    E = finite(subject.to_radiance(draw_inputs(rng)), (9, 11, 3), what="E")
    require((E >= 0).all(), f"E: expected radiance of at least 0, got {float(E.min()):.3g}")


@points(5)
def test_a_mantissa_is_a_fraction_of_256(subject):
    """Are your values 256 times too large? For the pixel (145, 215, 87, 103), E is about 1.7e-08,
    2.5e-08 and 1.0e-08.

    Divide the mantissas by 256.

    E = m / 256 2^(e - 128).
    """
    pixels = np.array([[[149, 150, 151, 128], [128, 64, 32, 129]]], np.uint8)
    expected = [[[149 / 256, 150 / 256, 151 / 256], [1, 0.5, 0.25]]]
    same(subject.to_radiance(pixels), expected, 0.005, what="E")


@points(3)
def test_dark_and_bright_exponents_are_powers_of_two(subject, rng):
    """What is 110 - 128 in uint8?

    A byte cannot be below 0: the difference wraps around.

    Convert the exponent to int or float before you subtract 128.
    """
    pixels = draw_inputs(rng)
    scale = 2.0 ** (pixels[..., 3:].astype(float) - 128)
    answer = finite(subject.to_radiance(pixels), (9, 11, 3), what="E")
    same(answer / scale, pixels[..., :3] / 256, 0.003, what="E 2^(128 - e)")


@points(2)
def test_the_exponent_0_is_black(subject, rng):
    """The exponent 0 has a special meaning.

    Such a pixel is black, whatever its mantissas are.

    E = 0 where e = 0.
    """
    pixels = draw_inputs(rng)
    black = rng.random((9, 11)) < 0.3
    pixels[black, 3] = 0
    answer = finite(subject.to_radiance(pixels), (9, 11, 3), what="E")
    same(answer[black], np.zeros((black.sum(), 3)), 1e-37, what="E where the exponent is 0")
    scale = 2.0 ** (pixels[..., 3:].astype(float) - 128)
    same(
        (answer / scale)[~black], pixels[~black][:, :3] / 256, 0.003, what="E 2^(128 - e) elsewhere"
    )
