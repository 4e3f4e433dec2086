"""A regular expression for the header."""

import re

import numpy as np


def from_bytes(data):
    kind, W, H, scale = (m := re.match(rb"(P[Ff])\s+(\d+)\s+(\d+)\s+(\S+)\s", data)).groups()
    E = np.frombuffer(data[m.end() :], "<f4" if float(scale) < 0 else ">f4")
    return E.reshape((int(H), int(W), 3) if kind == b"PF" else (int(H), int(W)))[::-1]
