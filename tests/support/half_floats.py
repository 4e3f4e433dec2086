"""Decode the half floats that hdrlab embeds in pages, for tests that check their values."""

import zlib

import numpy as np


def decode_half_floats(data, scale, shape):
    """Return the values of compressed half floats.

    Parameters
    ----------
    data : zlib-compressed differences between the bit patterns of neighbouring half floats; all low
        bytes come before all high bytes
    scale : the factor by which the values were multiplied before they were stored
    shape : (H, W) or (H, W, 3)

    Returns
    -------
    (H, W) or (H, W, 3) float64 values
    """
    low_bytes, high_bytes = np.frombuffer(zlib.decompress(data), np.uint8).reshape(2, -1)
    differences = high_bytes.astype("<u2") << 8 | low_bytes
    channel_count = 3 if len(shape) == 3 else 1
    bits = np.cumsum(differences.reshape(-1, channel_count), axis=0, dtype="<u2")
    return bits.view("<f2").astype(np.float64).reshape(shape) / scale
