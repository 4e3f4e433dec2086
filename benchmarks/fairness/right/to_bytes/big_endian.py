"""Big endian, scale 1."""


def to_bytes(E):
    head = b"%s\n%d %d\n1.0\n" % (b"PF" if E.ndim == 3 else b"Pf", E.shape[1], E.shape[0])
    return head + E[::-1].astype(">f4").tobytes()
