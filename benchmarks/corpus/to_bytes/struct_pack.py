import struct


def to_bytes(E):
    h, w = E.shape[:2]
    kind = "PF" if E.ndim == 3 else "Pf"
    head = kind + "\n" + str(w) + " " + str(h) + "\n-1.0\n"
    body = b""
    for row in range(h - 1, -1, -1):
        values = E[row].ravel()
        body += struct.pack("<" + "f" * len(values), *[float(v) for v in values])
    return head.encode("ascii") + body
