"""A loop over the pixels, a list of lists."""


def one(value, g, sigma, alpha, beta):
    d = abs(value - g)
    r = sigma * (d / sigma) ** alpha if d <= sigma else sigma + beta * (d - sigma)
    return g + r if value > g else g - r


def remap(lL, g, *, sigma, alpha, beta):
    return [[one(float(value), g, sigma, alpha, beta) for value in row] for row in lL]
