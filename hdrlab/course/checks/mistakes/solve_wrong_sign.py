"""Your picture is a negative: the eigenvalues of the Laplacian are negative, 2 cos(...) - 2."""

from hdrlab.core.filters import poisson


def solve(divG):
    return -poisson.solve(divG)
