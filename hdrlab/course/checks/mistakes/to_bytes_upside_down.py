"""Your picture is upside down: the rows of a PFM file run from the bottom to the top."""

from hdrlab.io.maps import pfm


def to_bytes(E):
    return pfm.to_bytes(E[::-1])
