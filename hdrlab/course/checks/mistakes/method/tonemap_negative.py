"""Bright places come out dark: somewhere a sign or a quotient is upside down."""

from hdrlab.tonemap import reinhard


def tonemap(L, **knobs):
    return 1 - reinhard.tonemap(L, **knobs)
