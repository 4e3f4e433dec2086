"""Bin by bin, in a list."""


def clip_histogram(h, *, limit=4.0):
    top = float(limit) / len(h)
    excess = sum(max(float(x) - top, 0) for x in h)
    room = sum(max(top - float(x), 0) for x in h)
    result = []
    for x in h:
        x = min(float(x), top)
        result.append(x + (top - x) * excess / room if excess else x)
    return result
