"""Half floats: decode_half(bits) -> their values, of bits uint16 of any shape."""

import numpy as np

from hdrlab.course.checks.compare import as_shape, numbers, points, require, same


def asked(subject, rng, e):
    """Return the values of 200 halves whose exponents are e, and what they are."""
    shape = (10, 20)
    bits = (
        rng.integers(0, 2, shape) << 15 | rng.choice(e, shape) << 10 | rng.integers(1, 1024, shape)
    )
    bits = bits.astype(np.uint16)
    return subject.decode_half(bits), bits.view(np.float16).astype(np.float64)


@points(5)
def test_a_half_is_its_mantissa_times_a_power_of_two(subject, rng):
    """16 bits: the sign, five of the exponent e, ten of the mantissa m. What is the number?

    The first 1 of a mantissa is not written: it is 1 + m / 1024. And e = 15 stands for 2^0.

    2^(e - 15) (1 + m / 1024): shift the bits by 10 for e, and keep the last 10 for m.
    """
    came, values = asked(subject, rng, np.arange(1, 31))
    shares = np.abs(as_shape(numbers(came), values.shape) / values)
    same(
        shares, np.ones(values.shape), 1e-6, what="sizes, in shares of the right ones", picture=True
    )


def test_the_first_bit_is_the_sign(subject, rng):
    """Which bit says that a number is below 0?

    The first one, which is worth 2^15.

    Shifted by 15, the bits are 1 for a negative number.
    """
    came, values = asked(subject, rng, [15])
    same(
        np.sign(as_shape(numbers(came), values.shape)),
        np.sign(values),
        0,
        what="signs",
        picture=True,
    )


@points(2)
def test_the_smallest_have_no_hidden_one(subject, rng):
    """What are the numbers of e = 0? With a hidden 1 none of them could be 0.

    There the mantissa stands for itself, m / 1024, and the power is that of e = 1.

    2^-14 m / 1024.
    """
    came, values = asked(subject, rng, [0])
    same(1e8 * numbers(came), 1e8 * values, 1e-3, what="values of e = 0, times 10^8", picture=True)
    same(subject.decode_half(np.zeros(3, np.uint16)), np.zeros(3), 0, what="three zeros")


@points(2)
def test_the_largest_exponent_is_infinite_or_no_number(subject, rng):
    """e = 31 stands for no power. For what, then?

    Without a mantissa it is infinite, with the sign; with one it is no number, NaN.

    np.inf where m is 0, and np.nan elsewhere.
    """
    bits = np.array(
        [0x7C00, 0xFC00, 0x7C00 + rng.integers(1, 1024), 0xFC00 + rng.integers(1, 1024)]
    )
    came = as_shape(numbers(subject.decode_half(bits.astype(np.uint16)), what="the values"), (4,))
    said = f"expected inf, -inf, nan, nan, got {came.tolist()}"
    require(np.array_equal(came, [np.inf, -np.inf, np.nan, np.nan], equal_nan=True), said)
