"""Peels one part after the other off the front; big endian values are swapped; the result can be written."""

import numpy as np


def peel(data):
    data = data.lstrip()
    word = data.split(maxsplit=1)[0]
    return word, data[len(word) :]


def from_bytes(data):
    rest = bytes(data)
    words = []
    while len(words) < 4:
        word, rest = peel(rest)
        words.append(word)
    kind, size, number = words[0], (int(words[2]), int(words[1])), float(words[3])
    if kind == b"PF":
        size += (3,)
    elif kind != b"Pf":
        raise ValueError(f"{kind!r} is no portable float map")
    n = int(np.prod(size))
    values = np.array(np.frombuffer(rest[1 : 1 + 4 * n], dtype="<u4"))
    if number > 0:
        values = values.byteswap()
    bits = values.astype(np.uint32).view(np.float32)
    return np.ascontiguousarray(np.flip(bits.reshape(size), axis=0))
