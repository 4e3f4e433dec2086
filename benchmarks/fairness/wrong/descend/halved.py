"""Each value is half of the one before."""


def descend(T, start, *, low=12.0):
    series = [float(start)]
    while series[-1] / 2 >= low:
        series.append(series[-1] / 2)
    return series
