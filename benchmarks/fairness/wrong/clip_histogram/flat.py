"""The mean in each bin."""


def clip_histogram(h, *, limit=4.0):
    return 0.5 * h + 0.5 / len(h)
