"""You read every file as little endian; the sign of the scale says which it is, and positive is big
endian."""

from hdrlab.io.maps import pfm


def from_bytes(data):
    head = pfm.from_bytes(data)
    scale = float(data.split()[3])
    return head if scale < 0 else head.byteswap()
