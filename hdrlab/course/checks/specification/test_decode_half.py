"""Checks of decode_half(bits), half floats: the values of an array of bits (uint16, any shape)."""

import numpy as np

from hdrlab.course.checks.compare import as_shape, numbers, points, require, same


def get_answer(subject, rng, e):
    """Return the student's values of 200 halves with exponents e, and the correct values."""
    shape = (10, 20)
    bits = (
        rng.integers(0, 2, shape) << 15 | rng.choice(e, shape) << 10 | rng.integers(1, 1024, shape)
    )
    bits = bits.astype(np.uint16)
    return subject.decode_half(bits), bits.view(np.float16).astype(np.float64)


@points(5)
def test_a_half_is_its_mantissa_times_a_power_of_two(subject, rng):
    """A half has 16 bits: one for the sign, five for the exponent e, ten for the mantissa m.

    The leading 1 of the mantissa is not stored, so the mantissa is 1 + m / 1024. The exponent e =
    15 stands for 2^0.

    The value is 2^(e - 15) (1 + m / 1024). Shift the bits right by 10 to get e, and keep the lowest
    10 bits for m.
    """
    answer, values = get_answer(subject, rng, np.arange(1, 31))
    shares = np.abs(as_shape(numbers(answer), values.shape) / values)
    same(
        shares,
        np.ones(values.shape),
        1e-6,
        what="absolute values, divided by the correct ones",
        picture=True,
    )


def test_the_first_bit_is_the_sign(subject, rng):
    """Which bit is set for a negative number?

    The highest one, which is worth 2^15.

    Shift the bits right by 15: the result is 1 for a negative number.
    """
    answer, values = get_answer(subject, rng, [15])
    same(
        np.sign(as_shape(numbers(answer), values.shape)),
        np.sign(values),
        0,
        what="signs",
        picture=True,
    )


@points(2)
def test_the_smallest_numbers_have_no_hidden_one(subject, rng):
    """What are the numbers with e = 0? With a hidden 1, none of them could be 0.

    For e = 0, the mantissa is m / 1024 without the 1, and the power is that of e = 1.

    The value is 2^-14 m / 1024.
    """
    answer, values = get_answer(subject, rng, [0])
    same(
        1e8 * numbers(answer),
        1e8 * values,
        1e-3,
        what="values with e = 0, times 10^8",
        picture=True,
    )
    same(subject.decode_half(np.zeros(3, np.uint16)), np.zeros(3), 0, what="three zeros")


@points(2)
def test_the_largest_exponent_is_infinity_or_nan(subject, rng):
    """e = 31 is not a power of two. What does it stand for?

    With m = 0 it is infinity, with its sign. With any other m it is NaN.

    Return np.inf with the sign where m is 0, and np.nan elsewhere.
    """
    bits = np.array(
        [0x7C00, 0xFC00, 0x7C00 + rng.integers(1, 1024), 0xFC00 + rng.integers(1, 1024)]
    )
    answer = as_shape(numbers(subject.decode_half(bits.astype(np.uint16)), what="the values"), (4,))
    message = f"expected inf, -inf, nan, nan, got {answer.tolist()}"
    require(np.array_equal(answer, [np.inf, -np.inf, np.nan, np.nan], equal_nan=True), message)
