"""White bytes as a mask; the words are the runs between its steps; a view of the data, turned over."""

import numpy as np


def from_bytes(data):
    raw = np.frombuffer(data, dtype=np.uint8)
    head = raw[:400]
    white = np.isin(head, np.frombuffer(b" \t\n\r\x0b\x0c", dtype=np.uint8))
    step = np.diff(np.concatenate([[1], white.astype(int)]))
    starts, ends = np.flatnonzero(step == -1)[:4], np.flatnonzero(step == 1)[:4]
    kind, width, height, number = (head[a:b].tobytes().decode() for a, b in zip(starts, ends))
    first = int(ends[3]) + 1
    shape = (int(height), int(width), 3) if kind == "PF" else (int(height), int(width))
    last = first + 4 * int(np.prod(shape))
    if last > len(raw):
        raise ValueError("the file is too short")
    values = raw[first:last].tobytes()
    return np.ndarray(shape, dtype="<f4" if number.startswith("-") else ">f4", buffer=values)[::-1]
