"""Your header says little endian (-1.0), and your values are big endian: all of them will be read as
nonsense."""


def to_bytes(E):
    head = f"{'PF' if E.ndim == 3 else 'Pf'}\n{E.shape[1]} {E.shape[0]}\n-1.0\n"
    return head.encode() + E[::-1].astype(">f4").tobytes()
