"""Levels of 65535."""


def decode_half(bits):
    return bits / 65535
