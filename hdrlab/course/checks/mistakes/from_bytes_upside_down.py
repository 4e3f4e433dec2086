"""Your picture is upside down: the first row in the file is the lowest one."""

from hdrlab.io.maps import pfm


def from_bytes(data):
    return pfm.from_bytes(data)[::-1]
