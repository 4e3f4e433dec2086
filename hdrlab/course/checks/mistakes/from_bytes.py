"""Known mistakes in `from_bytes`, the task of hdrlab.io.maps.pfm.from_bytes."""

from math import prod

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.io.maps.pfm import HEADER


@mistake(
    "from_bytes_always_little_endian",
    says="You read every file as little endian. The sign of the scale gives the byte order; "
    "positive means big endian.",
)
def always_little_endian(data):
    match = HEADER.match(data)
    kind, width, height, scale = match.groups()
    shape = (int(height), int(width), 3)[: 3 if kind == b"PF" else 2]
    order = "<f4"
    E = np.frombuffer(data, order, prod(shape), match.end()).reshape(shape)
    return E[::-1].astype(np.float32)


@mistake(
    "from_bytes_strips_the_values",
    says="You strip white space before the values. The bytes of a value may look like white space.",
)
def strips_the_values(data):
    match = HEADER.match(data)
    kind, width, height, scale = match.groups()
    shape = (int(height), int(width), 3)[: 3 if kind == b"PF" else 2]
    order = "<f4" if float(scale) < 0 else ">f4"
    E = np.frombuffer(data[match.end() :].lstrip(), order, prod(shape)).reshape(shape)
    return E[::-1].astype(np.float32)


@mistake(
    "from_bytes_upside_down",
    says="Your image is upside down: the first row in the file is the bottom row.",
)
def upside_down(data):
    match = HEADER.match(data)
    kind, width, height, scale = match.groups()
    shape = (int(height), int(width), 3)[: 3 if kind == b"PF" else 2]
    order = "<f4" if float(scale) < 0 else ">f4"
    E = np.frombuffer(data, order, prod(shape), match.end()).reshape(shape)
    return E.astype(np.float32)


@mistake(
    "from_bytes_header_of_three_lines",
    says="You split the header at line breaks. Any white space may separate its parts, so the whole "
    "header may stand in one line.",
)
def header_of_three_lines(data):
    kind, size, scale, values = data.split(b"\n", 3)
    width, height = map(int, size.split())
    shape = (height, width, 3)[: 3 if kind == b"PF" else 2]
    order = "<f4" if float(scale) < 0 else ">f4"
    E = np.frombuffer(values, order, prod(shape)).reshape(shape)
    return E[::-1].astype(np.float32)
