"""Known mistakes in `gsolve`, the task of hdrlab.response.debevec.gsolve."""

import numpy as np

from hdrlab.course.checks.mistakes import Question, mistake
from hdrlab.response.debevec import Solution

# two photos of two pixels that no straight line fits: g(2) = 6 s / (1 + 10 s) for s = lambda squared
LAMBDA_INPUTS = "Z = np.array([[0, 2], [0, 1]])\n"
LAMBDA_WHY = r"$6 s / (1 + 10 s)$ with $s = \lambda^2"
LAMBDA_QUESTIONS = (
    Question(
        code=LAMBDA_INPUTS + "gsolve(Z, np.array([0.0, 1.0]), 1, np.ones(3))[0][1]",
        why="One row fixes the middle of the curve: $g(1) = 0$. What remains is $g(2)$. The sum of "
        rf"squares is smallest if it is {LAMBDA_WHY}$. Use this in the next questions.",
        because=r"$$\sum_{i,j}",
    ),
    Question(
        code=LAMBDA_INPUTS + "gsolve(Z, np.array([0.0, 1.0]), 0.5, np.ones(3))[0][2]",
        why=f"{LAMBDA_WHY} = 0.25$: 1.5 / 3.5.",
        because=r"$$\sum_{i,j}",
    ),
    Question(
        code=LAMBDA_INPUTS + "gsolve(Z, np.array([0.0, 1.0]), 0.1, np.ones(3))[0][2]",
        why=f"{LAMBDA_WHY} = 0.01$: 0.06 / 1.1. Nearly without smoothness, g follows the photos.",
        because=r"$$\sum_{i,j}",
    ),
)


@mistake(
    "gsolve_weight_of_the_neighbour",
    says="The weight of the smoothness row of z is w(z), the weight of its middle. You used the "
    "weight of a neighbor.",
)
def weight_of_the_neighbour(Z, B, smoothness, w):
    def system(Z, B, smoothness, w):
        N, P = Z.shape
        n = len(w)
        A = np.zeros((N * P + n - 1, n + N))
        b = np.zeros(N * P + n - 1)
        for k, (i, j) in enumerate(np.ndindex(N, P)):
            wij = w[Z[i, j]]
            A[k, Z[i, j]] = wij
            A[k, n + i] = -wij
            b[k] = wij * B[j]
        A[N * P, n // 2] = 1
        for z in range(1, n - 1):
            A[N * P + z, z - 1 : z + 2] = smoothness * w[z + 1] * np.array([1, -2, 1])
        return A, b

    Z = np.asarray(Z)
    B = np.asarray(B, np.float64)
    w = np.asarray(w, np.float64)
    n = len(w)
    A, b = system(Z, B, smoothness, w)
    x, _, rank, _ = np.linalg.lstsq(A, b, rcond=None)
    reached = np.flatnonzero(A[:, :n].any(axis=0))
    return Solution(np.interp(np.arange(n), reached, x[reached]), np.asarray(x[n:]))


@mistake(
    "gsolve_smoothness_not_weighted",
    says="The smoothness rows need a weight, too: lambda w(z) (g(z - 1) - 2 g(z) + g(z + 1)). "
    "Without w(z), the ends are as stiff as the middle.",
)
def smoothness_not_weighted(Z, B, smoothness, w):
    def system(Z, B, smoothness, w):
        N, P = Z.shape
        n = len(w)
        A = np.zeros((N * P + n - 1, n + N))
        b = np.zeros(N * P + n - 1)
        for k, (i, j) in enumerate(np.ndindex(N, P)):
            wij = w[Z[i, j]]
            A[k, Z[i, j]] = wij
            A[k, n + i] = -wij
            b[k] = wij * B[j]
        A[N * P, n // 2] = 1
        for z in range(1, n - 1):
            A[N * P + z, z - 1 : z + 2] = smoothness * np.array([1, -2, 1])
        return A, b

    Z = np.asarray(Z)
    B = np.asarray(B, np.float64)
    w = np.asarray(w, np.float64)
    n = len(w)
    A, b = system(Z, B, smoothness, w)
    x, _, rank, _ = np.linalg.lstsq(A, b, rcond=None)
    reached = np.flatnonzero(A[:, :n].any(axis=0))
    return Solution(np.interp(np.arange(n), reached, x[reached]), np.asarray(x[n:]))


@mistake(
    "gsolve_right_side_not_weighted",
    says="The weight multiplies the whole row: w (g - lE) = w B. Your right-hand side has no "
    "weight.",
    questions=(
        Question(
            code="Z = np.array([[1, 2]])\n"
            "g, lE = gsolve(Z, np.array([0.0, 1.0]), 1, np.ones(4))\n"
            "g[1]",
            why="Here n = 4, so g(2) = 0. g(1) = lE + 0 and g(2) = lE + 1, so g(1) is 1 "
            "below g(2).",
            because=r"$$\sum_{i,j}",
        ),
        Question(
            code="Z = np.array([[1, 2]])\n"
            "g, lE = gsolve(Z, np.array([0.0, 1.0]), 1, np.full(4, 2.0))\n"
            "g[1]",
            why="All weights are 2. The weight multiplies the whole bracket, B too, so the "
            "solution stays the same.",
            because=r"$$\sum_{i,j}",
        ),
        Question(
            code="Z = np.array([[1, 2]])\n"
            "g, lE = gsolve(Z, np.array([0.0, 1.0]), 1, np.full(4, 0.5))\n"
            "lE[0]",
            why="lE = g(1) - 0 = -1, whatever the common weight is.",
            because=r"$$\sum_{i,j}",
        ),
    ),
)
def right_side_not_weighted(Z, B, smoothness, w):
    def system(Z, B, smoothness, w):
        N, P = Z.shape
        n = len(w)
        A = np.zeros((N * P + n - 1, n + N))
        b = np.zeros(N * P + n - 1)
        for k, (i, j) in enumerate(np.ndindex(N, P)):
            wij = w[Z[i, j]]
            A[k, Z[i, j]] = wij
            A[k, n + i] = -wij
            b[k] = B[j]
        A[N * P, n // 2] = 1
        for z in range(1, n - 1):
            A[N * P + z, z - 1 : z + 2] = smoothness * w[z] * np.array([1, -2, 1])
        return A, b

    Z = np.asarray(Z)
    B = np.asarray(B, np.float64)
    w = np.asarray(w, np.float64)
    n = len(w)
    A, b = system(Z, B, smoothness, w)
    x, _, rank, _ = np.linalg.lstsq(A, b, rcond=None)
    reached = np.flatnonzero(A[:, :n].any(axis=0))
    return Solution(np.interp(np.arange(n), reached, x[reached]), np.asarray(x[n:]))


@mistake(
    "gsolve_not_weighted",
    says="Your data rows have no weight, so clipped pixels, which only give a bound, bend your "
    "curve.",
)
def not_weighted(Z, B, smoothness, w):
    def system(Z, B, smoothness, w):
        N, P = Z.shape
        n = len(w)
        A = np.zeros((N * P + n - 1, n + N))
        b = np.zeros(N * P + n - 1)
        for k, (i, j) in enumerate(np.ndindex(N, P)):
            wij = 1
            A[k, Z[i, j]] = wij
            A[k, n + i] = -wij
            b[k] = wij * B[j]
        A[N * P, n // 2] = 1
        for z in range(1, n - 1):
            A[N * P + z, z - 1 : z + 2] = smoothness * w[z] * np.array([1, -2, 1])
        return A, b

    Z = np.asarray(Z)
    B = np.asarray(B, np.float64)
    w = np.asarray(w, np.float64)
    n = len(w)
    A, b = system(Z, B, smoothness, w)
    x, _, rank, _ = np.linalg.lstsq(A, b, rcond=None)
    reached = np.flatnonzero(A[:, :n].any(axis=0))
    return Solution(np.interp(np.arange(n), reached, x[reached]), np.asarray(x[n:]))


@mistake(
    "gsolve_lambda_inverted",
    says="Your curve becomes rougher when lambda grows. Multiply the smoothness rows by "
    "lambda; do not divide.",
    questions=LAMBDA_QUESTIONS,
)
def lambda_inverted(Z, B, smoothness, w):
    def system(Z, B, smoothness, w):
        N, P = Z.shape
        n = len(w)
        A = np.zeros((N * P + n - 1, n + N))
        b = np.zeros(N * P + n - 1)
        for k, (i, j) in enumerate(np.ndindex(N, P)):
            wij = w[Z[i, j]]
            A[k, Z[i, j]] = wij
            A[k, n + i] = -wij
            b[k] = wij * B[j]
        A[N * P, n // 2] = 1
        for z in range(1, n - 1):
            A[N * P + z, z - 1 : z + 2] = 1 / smoothness * w[z] * np.array([1, -2, 1])
        return A, b

    Z = np.asarray(Z)
    B = np.asarray(B, np.float64)
    w = np.asarray(w, np.float64)
    n = len(w)
    A, b = system(Z, B, smoothness, w)
    x, _, rank, _ = np.linalg.lstsq(A, b, rcond=None)
    reached = np.flatnonzero(A[:, :n].any(axis=0))
    return Solution(np.interp(np.arange(n), reached, x[reached]), np.asarray(x[n:]))


@mistake(
    "gsolve_lambda_read_as_1",
    says="What looks like the digit 1 in the printed listing is the letter l, for lambda. Your "
    "smoothness rows ignore lambda.",
    questions=LAMBDA_QUESTIONS,
)
def lambda_read_as_1(Z, B, smoothness, w):
    def system(Z, B, smoothness, w):
        N, P = Z.shape
        n = len(w)
        A = np.zeros((N * P + n - 1, n + N))
        b = np.zeros(N * P + n - 1)
        for k, (i, j) in enumerate(np.ndindex(N, P)):
            wij = w[Z[i, j]]
            A[k, Z[i, j]] = wij
            A[k, n + i] = -wij
            b[k] = wij * B[j]
        A[N * P, n // 2] = 1
        for z in range(1, n - 1):
            A[N * P + z, z - 1 : z + 2] = w[z] * np.array([1, -2, 1])
        return A, b

    Z = np.asarray(Z)
    B = np.asarray(B, np.float64)
    w = np.asarray(w, np.float64)
    n = len(w)
    A, b = system(Z, B, smoothness, w)
    x, _, rank, _ = np.linalg.lstsq(A, b, rcond=None)
    reached = np.flatnonzero(A[:, :n].any(axis=0))
    return Solution(np.interp(np.arange(n), reached, x[reached]), np.asarray(x[n:]))


@mistake(
    "gsolve_log2_of_the_times",
    says="B is the natural logarithm of the times. You used base 2, so every difference of B is "
    "1.44 times too large.",
    questions=(
        Question(
            code="Z = np.array([[1, 2]])\n"
            "g, lE = gsolve(Z, np.array([0.0, 0.0]), 1, np.ones(4))\n"
            "g[1]",
            why="Here n = 4, so g(2) = 0. Both photos have the same time, so g(1) = g(2).",
            because=r"$$\sum_{i,j}",
        ),
        Question(
            code="Z = np.array([[1, 2]])\n"
            "g, lE = gsolve(Z, np.array([0.0, 1.0]), 1, np.ones(4))\n"
            "g[1]",
            why="g(1) = lE + 0 and g(2) = lE + 1, so g(1) is 1 below g(2) = 0. B goes into "
            "the equation as it is.",
            because=r"$$\sum_{i,j}",
        ),
        Question(
            code="Z = np.array([[1, 2]])\ng, lE = gsolve(Z, np.log([1, 2]), 1, np.ones(4))\ng[1]",
            why="B is already the natural logarithm of the times, so g(1) is ln 2 below g(2) = 0.",
            because=r"$$\sum_{i,j}",
        ),
    ),
)
def log2_of_the_times(Z, B, smoothness, w):
    def system(Z, B, smoothness, w):
        N, P = Z.shape
        n = len(w)
        A = np.zeros((N * P + n - 1, n + N))
        b = np.zeros(N * P + n - 1)
        for k, (i, j) in enumerate(np.ndindex(N, P)):
            wij = w[Z[i, j]]
            A[k, Z[i, j]] = wij
            A[k, n + i] = -wij
            b[k] = wij * B[j] / np.log(2)
        A[N * P, n // 2] = 1
        for z in range(1, n - 1):
            A[N * P + z, z - 1 : z + 2] = smoothness * w[z] * np.array([1, -2, 1])
        return A, b

    Z = np.asarray(Z)
    B = np.asarray(B, np.float64)
    w = np.asarray(w, np.float64)
    n = len(w)
    A, b = system(Z, B, smoothness, w)
    x, _, rank, _ = np.linalg.lstsq(A, b, rcond=None)
    reached = np.flatnonzero(A[:, :n].any(axis=0))
    return Solution(np.interp(np.arange(n), reached, x[reached]), np.asarray(x[n:]))


@mistake(
    "gsolve_root_of_lambda",
    says="Your smoothness rows contain the square root of lambda. In the sum, lambda is inside "
    "the square, so the row contains lambda itself.",
    questions=LAMBDA_QUESTIONS,
    fixes=(
        ("** 0.5", ""),
        ("np.sqrt", ""),
    ),
)
def root_of_lambda(Z, B, smoothness, w):
    def system(Z, B, smoothness, w):
        N, P = Z.shape
        n = len(w)
        A = np.zeros((N * P + n - 1, n + N))
        b = np.zeros(N * P + n - 1)
        for k, (i, j) in enumerate(np.ndindex(N, P)):
            wij = w[Z[i, j]]
            A[k, Z[i, j]] = wij
            A[k, n + i] = -wij
            b[k] = wij * B[j]
        A[N * P, n // 2] = 1
        for z in range(1, n - 1):
            A[N * P + z, z - 1 : z + 2] = smoothness**0.5 * w[z] * np.array([1, -2, 1])
        return A, b

    Z = np.asarray(Z)
    B = np.asarray(B, np.float64)
    w = np.asarray(w, np.float64)
    n = len(w)
    A, b = system(Z, B, smoothness, w)
    x, _, rank, _ = np.linalg.lstsq(A, b, rcond=None)
    reached = np.flatnonzero(A[:, :n].any(axis=0))
    return Solution(np.interp(np.arange(n), reached, x[reached]), np.asarray(x[n:]))


def _solve(Z, B, w, data_weights, smoothness_factors):
    """Return the solution with these weights of the data, and factors of the smoothness rows."""
    Z = np.asarray(Z)
    N, P = Z.shape
    n = len(w)
    A = np.zeros((N * P + n - 1, n + N))
    b = np.zeros(N * P + n - 1)
    for k, (i, j) in enumerate(np.ndindex(N, P)):
        weight = data_weights[Z[i, j]]
        A[k, Z[i, j]] = weight
        A[k, n + i] = -weight
        b[k] = weight * B[j]
    A[N * P, n // 2] = 1
    for z in range(1, n - 1):
        A[N * P + z, z - 1 : z + 2] = smoothness_factors[z] * np.array([1, -2, 1])
    x = np.linalg.lstsq(A, b, rcond=None)[0]
    reached = np.flatnonzero(A[:, :n].any(axis=0))
    return Solution(np.interp(np.arange(n), reached, x[reached]), np.asarray(x[n:]))


@mistake(
    "gsolve_lambda_squared",
    says="Your smoothness rows contain the square of lambda. Each row is squared in the sum, so the "
    "row contains lambda itself.",
    questions=LAMBDA_QUESTIONS,
    fixes=(("** 2", ""),),
)
def lambda_squared(Z, B, smoothness, w):
    w = np.asarray(w, np.float64)
    return _solve(Z, B, w, w, smoothness**2 * w)


@mistake(
    "gsolve_weight_of_the_value_below",
    says="The smoothness row of z has the weight w(z). In a loop that starts at 0, the middle of the "
    "row is z + 1: use its weight.",
)
def weight_of_the_value_below(Z, B, smoothness, w):
    w = np.asarray(w, np.float64)
    return _solve(Z, B, w, w, smoothness * np.roll(w, 1))


@mistake(
    "gsolve_root_of_lambda_not_weighted",
    says="Your smoothness rows contain the root of lambda and no weight. The row of z is lambda w(z) "
    "(g(z - 1) - 2 g(z) + g(z + 1)).",
    questions=LAMBDA_QUESTIONS,
)
def root_of_lambda_not_weighted(Z, B, smoothness, w):
    w = np.asarray(w, np.float64)
    return _solve(Z, B, w, w, np.full(len(w), smoothness**0.5))


@mistake(
    "gsolve_lambda_squared_not_weighted",
    says="Your smoothness rows contain the square of lambda and no weight. The row of z is lambda "
    "w(z) (g(z - 1) - 2 g(z) + g(z + 1)).",
    questions=LAMBDA_QUESTIONS,
)
def lambda_squared_not_weighted(Z, B, smoothness, w):
    w = np.asarray(w, np.float64)
    return _solve(Z, B, w, w, np.full(len(w), smoothness**2))


@mistake(
    "gsolve_nothing_weighted",
    says="You use no weights at all: clipped pixels bend your curve. Multiply the data rows by "
    "w(Z) and the smoothness rows by w(z).",
    questions=(
        Question(
            code="Z = np.array([[1, 2]])\n"
            "g, lE = gsolve(Z, np.array([0.0, 1.0]), 1, np.ones(4))\n"
            "g[1]",
            why="Here n = 4, so g(2) = 0. g(1) = lE + 0 and g(2) = lE + 1, so g(1) is 1 "
            "below g(2).",
            because=r"$$\sum_{i,j}",
        ),
        Question(
            code="Z = np.array([[1, 2, 3]])\n"
            "w = np.array([1.0, 1, 1, 0])\n"
            "g, lE = gsolve(Z, np.array([0.0, 1, 5]), 1, w)\n"
            "g[1]",
            why="The value 3 has the weight 0, so the third photo says nothing. The answer "
            "is that of two photos.",
            because=r"$$\sum_{i,j}",
        ),
        Question(
            code="Z = np.array([[1, 2, 3]])\n"
            "w = np.array([1.0, 1, 1, 0])\n"
            "g, lE = gsolve(Z, np.array([0.0, 1, 100]), 1, w)\n"
            "lE[0]",
            why="Only the photo with the weight 0 has changed. lE = g(1) - 0 = -1 as before.",
            because=r"$$\sum_{i,j}",
        ),
    ),
)
def nothing_weighted(Z, B, smoothness, w):
    ones = np.ones(len(w))
    return _solve(Z, B, w, ones, smoothness * ones)
