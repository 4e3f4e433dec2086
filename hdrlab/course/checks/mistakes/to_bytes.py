"""Known mistakes in `to_bytes`, the task of hdrlab.io.maps.pfm.to_bytes."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.io.maps.pfm import header_of


@mistake(
    "to_bytes_float64",
    says="The values of a PFM file are float32, of 4 bytes; you wrote float64, of 8.",
)
def float64(E):
    E = np.asarray(E)
    return header_of(E) + E[::-1].astype("<f8").tobytes()


@mistake(
    "to_bytes_height_first",
    says="The second line is the width and then the height; arrays have it the other way round.",
)
def height_first(E):
    def header_of(E):
        return f"{'PF' if E.ndim == 3 else 'Pf'}\n{E.shape[0]} {E.shape[1]}\n-1.0\n".encode()

    E = np.asarray(E)
    return header_of(E) + E[::-1].astype("<f4").tobytes()


@mistake(
    "to_bytes_upside_down",
    says="Your picture is upside down: the rows of a PFM file run from the bottom to the top.",
)
def upside_down(E):
    E = np.asarray(E)
    return header_of(E) + E.astype("<f4").tobytes()


@mistake(
    "to_bytes_wrong_order_of_bytes",
    says="Your header says little endian (-1.0), and your values are big endian: all of them "
    "will be read as nonsense.",
)
def wrong_order_of_bytes(E):
    E = np.asarray(E)
    return header_of(E) + E[::-1].astype(">f4").tobytes()
