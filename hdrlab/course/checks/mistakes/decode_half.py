"""Known mistakes in `decode_half`, the task of hdrlab.io.maps.exr.decode_half."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "decode_half_bias_of_16",
    says="Your values are half as large as they should be. The exponent 15, not 16, means 2^0.",
)
def bias_of_16(bits):
    bits = np.asarray(bits, np.int64)
    sign = 1 - 2 * (bits >> 15)
    e = bits >> 10 & 31
    m = bits & 1023
    value = np.where(e > 0, 1024 + m, 2 * m) * 2.0 ** (e - 26)
    value[e == 31] = np.where(m[e == 31] > 0, np.nan, np.inf)
    return (sign * value).astype(np.float32)


@mistake(
    "decode_half_hidden_one_forgotten",
    says="The leading 1 of a mantissa is not stored. A normal number is 1 + m / 1024 times its "
    "power of two.",
)
def hidden_one_forgotten(bits):
    bits = np.asarray(bits, np.int64)
    sign = 1 - 2 * (bits >> 15)
    e = bits >> 10 & 31
    m = bits & 1023
    value = np.where(e > 0, m, 2 * m) * 2.0 ** (e - 25)
    value[e == 31] = np.where(m[e == 31] > 0, np.nan, np.inf)
    return (sign * value).astype(np.float32)


@mistake(
    "decode_half_smallest_have_the_one",
    says="Where e = 0 there is no hidden 1, and the power is 2^-14. The value is 2^-14 m / "
    "1024; otherwise 0 could not be stored.",
)
def smallest_have_the_one(bits):
    bits = np.asarray(bits, np.int64)
    sign = 1 - 2 * (bits >> 15)
    e = bits >> 10 & 31
    m = bits & 1023
    value = (1024 + m) * 2.0 ** (e - 25)
    value[e == 31] = np.where(m[e == 31] > 0, np.nan, np.inf)
    return (sign * value).astype(np.float32)


@mistake(
    "decode_half_sign_lost",
    says="All your values are positive. The first of the 16 bits is the sign.",
)
def sign_lost(bits):
    bits = np.asarray(bits, np.int64)
    e = bits >> 10 & 31
    m = bits & 1023
    value = np.where(e > 0, 1024 + m, 2 * m) * 2.0 ** (e - 25)
    value[e == 31] = np.where(m[e == 31] > 0, np.nan, np.inf)
    return value.astype(np.float32)
