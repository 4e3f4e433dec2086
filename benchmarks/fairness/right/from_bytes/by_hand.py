"""Letter by letter."""

import numpy as np


def from_bytes(data):
    words, at = [], 0
    while len(words) < 4:
        word = b""
        while not data[at : at + 1].isspace():
            word, at = word + data[at : at + 1], at + 1
        at += 1
        if word:
            words.append(word)
    W, H = int(words[1]), int(words[2])
    C = 3 if words[0] == b"PF" else 1
    order = "<" if words[3].startswith(b"-") else ">"
    E = np.flip(np.frombuffer(data, order + "f4", H * W * C, at).reshape(H, W, C), axis=0).astype(
        float
    )
    return E if C == 3 else E[..., 0]
