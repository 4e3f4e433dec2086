"""A cursor that walks over the header byte by byte, struct for the values, rows put into their place."""

import struct

import numpy as np

WHITE = b" \t\r\n\v\f"


def next_word(data, at):
    while data[at] in WHITE:
        at += 1
    start = at
    while data[at] not in WHITE:
        at += 1
    return data[start:at], at


def from_bytes(data):
    kind, at = next_word(data, 0)
    width, at = next_word(data, at)
    height, at = next_word(data, at)
    number, at = next_word(data, at)
    at += 1
    if kind not in (b"PF", b"Pf"):
        raise ValueError("not a PFM file")
    W, H = int(width), int(height)
    channels = 3 if kind == b"PF" else 1
    order = "<" if float(number) < 0 else ">"
    E = np.zeros((H, W * channels), dtype=np.float32)
    for i in range(H):
        E[H - 1 - i] = struct.unpack_from(f"{order}{W * channels}f", data, at)
        at += 4 * W * channels
    return E.reshape(H, W, 3) if channels == 3 else E
