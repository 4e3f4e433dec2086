"""The second line is the width and then the height; arrays have it the other way round."""


def to_bytes(E):
    head = f"{'PF' if E.ndim == 3 else 'Pf'}\n{E.shape[0]} {E.shape[1]}\n-1.0\n"
    return head.encode() + E[::-1].astype("<f4").tobytes()
