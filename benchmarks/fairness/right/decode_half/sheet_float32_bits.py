import numpy as np


def decode_half(bits):
    """Build the float32 out of its own bits; subnormals by the formula."""
    b = np.asarray(bits).astype(np.uint32)
    s = (b & np.uint32(0x8000)) << np.uint32(16)
    e = (b >> np.uint32(10)) & np.uint32(31)
    m = b & np.uint32(1023)
    e32 = np.where(e == 31, np.uint32(255), e + np.uint32(112)).astype(np.uint32)
    word = np.atleast_1d(s | (e32 << np.uint32(23)) | (m << np.uint32(13)))
    out = word.astype(np.uint32).view(np.float32).reshape(b.shape)
    sub = m.astype(np.float32) * np.float32(2.0**-24)
    sub = np.where(s > 0, -sub, sub)
    return np.where(e == 0, sub, out).astype(np.float32)
