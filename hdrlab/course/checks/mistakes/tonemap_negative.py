"""A wrong tonemap: negative."""

from hdrlab.tonemap import reinhard

TASK = "tonemap"
MISCONCEPTION = "Bright places come out dark: somewhere a sign or a quotient is upside down."


def tonemap(L):
    return 1 - reinhard.tonemap(L)
