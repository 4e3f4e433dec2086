"""All differences made smaller by beta, details as well."""


def remap(lL, g, *, sigma, alpha, beta):
    return g + beta * (lL - g)
