"""Values in big endian order by a dtype, the header's number plainly 1, each part on the list of lines."""

import numpy as np


def to_bytes(E):
    values = np.asarray(E, dtype=np.dtype(">f4"))
    if values.ndim == 3:
        lines = [b"PF"]
    elif values.ndim == 2:
        lines = [b"Pf"]
    else:
        raise ValueError(f"radiance has {values.ndim} axes, not 2 or 3")
    lines.append(" ".join(str(n) for n in (values.shape[1], values.shape[0])).encode("ascii"))
    lines.append(b"1")
    lines.append(np.ascontiguousarray(values[::-1]).tobytes())
    return b"\n".join(lines)
