"""The difference of the values, in a 32nd."""


def offset(average, target=128.0, *, a=1.79, c=0.192):
    return min(8, max(-8, (target - average) / 32))
