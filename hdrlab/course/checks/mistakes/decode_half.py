"""Known mistakes in `decode_half`, the task of hdrlab.io.maps.exr.decode_half."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "decode_half_bias_of_16",
    says="Your values are half of what they should be: the exponent 15, not 16, stands for 2^0.",
)
def bias_of_16(bits):
    bits = np.asarray(bits, np.int64)
    sign, e, m = 1 - 2 * (bits >> 15), bits >> 10 & 31, bits & 1023
    value = np.where(e > 0, 1024 + m, 2 * m) * 2.0 ** (e - 26)
    value[e == 31] = np.where(m[e == 31] > 0, np.nan, np.inf)
    return (sign * value).astype(np.float32)


@mistake(
    "decode_half_hidden_one_forgotten",
    says="The first 1 of a mantissa is not among the bits: a normal number is 1 + m / 1024 "
    "times its power.",
)
def hidden_one_forgotten(bits):
    bits = np.asarray(bits, np.int64)
    sign, e, m = 1 - 2 * (bits >> 15), bits >> 10 & 31, bits & 1023
    value = np.where(e > 0, m, 2 * m) * 2.0 ** (e - 25)
    value[e == 31] = np.where(m[e == 31] > 0, np.nan, np.inf)
    return (sign * value).astype(np.float32)


@mistake(
    "decode_half_smallest_have_the_one",
    says="Where e = 0 there is no hidden 1, and the power is 2^-14: the value is 2^-14 m / "
    "1024, or there would be no 0.",
)
def smallest_have_the_one(bits):
    bits = np.asarray(bits, np.int64)
    sign, e, m = 1 - 2 * (bits >> 15), bits >> 10 & 31, bits & 1023
    value = (1024 + m) * 2.0 ** (e - 25)
    value[e == 31] = np.where(m[e == 31] > 0, np.nan, np.inf)
    return (sign * value).astype(np.float32)


@mistake(
    "decode_half_sign_lost",
    says="All your values are positive: the first of the 16 bits is the sign.",
)
def sign_lost(bits):
    bits = np.asarray(bits, np.int64)
    e, m = bits >> 10 & 31, bits & 1023
    value = np.where(e > 0, 1024 + m, 2 * m) * 2.0 ** (e - 25)
    value[e == 31] = np.where(m[e == 31] > 0, np.nan, np.inf)
    return value.astype(np.float32)
