"""Known mistakes in `to_bytes`, the task of hdrlab.io.maps.pfm.to_bytes."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.io.maps.pfm import header_of


@mistake(
    "to_bytes_float64",
    says="The values of a PFM file are float32, 4 bytes each. You wrote float64, 8 bytes.",
)
def float64(E):
    E = np.asarray(E)
    return header_of(E) + E[::-1].astype("<f8").tobytes()


@mistake(
    "to_bytes_height_first",
    says="The second line is the width and then the height. The shape of an array has the "
    "opposite order.",
)
def height_first(E):
    def header_of(E):
        return f"{'PF' if E.ndim == 3 else 'Pf'}\n{E.shape[0]} {E.shape[1]}\n-1.0\n".encode()

    E = np.asarray(E)
    return header_of(E) + E[::-1].astype("<f4").tobytes()


@mistake(
    "to_bytes_upside_down",
    says="Your image is upside down: the rows of a PFM file run from bottom to top.",
)
def upside_down(E):
    E = np.asarray(E)
    return header_of(E) + E.astype("<f4").tobytes()


@mistake(
    "to_bytes_wrong_order_of_bytes",
    says="Your header says little endian (-1.0), but your values are big endian, so a reader "
    "gets wrong values.",
)
def wrong_order_of_bytes(E):
    E = np.asarray(E)
    return header_of(E) + E[::-1].astype(">f4").tobytes()


@mistake(
    "to_bytes_height_first_upside_down",
    says="Your header has the height before the width, and your rows run from top to bottom. A PFM "
    "file needs the width first, and its rows run from bottom to top.",
)
def height_first_upside_down(E):
    E = np.asarray(E)
    header = f"{'PF' if E.ndim == 3 else 'Pf'}\n{E.shape[0]} {E.shape[1]}\n-1.0\n"
    return header.encode() + E.astype("<f4").tobytes()
