"""A wrong solve: wrong sign."""

from hdrlab.core import poisson

TASK = "solve"
MISCONCEPTION = "Your picture is a negative: the eigenvalues of the Laplacian are negative, 2 cos(...) - 2."


def solve(f):
    return -poisson.solve(f)
