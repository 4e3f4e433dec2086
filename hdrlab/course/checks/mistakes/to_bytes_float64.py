"""The values of a PFM file are float32, of 4 bytes; you wrote float64, of 8."""


def to_bytes(E):
    head = f"{'PF' if E.ndim == 3 else 'Pf'}\n{E.shape[1]} {E.shape[0]}\n-1.0\n"
    return head.encode() + E[::-1].astype("<f8").tobytes()
