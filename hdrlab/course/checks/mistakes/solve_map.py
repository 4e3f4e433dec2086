"""Known mistakes in `solve_map`, the task of hdrlab.response.space.solve_map."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "solve_map_prior_ignored",
    says="You ignore the prior. Add a row with 1 / sd_k for each coefficient, and a 0 to b.",
    misses_method=True,
)
def prior_ignored(A, b, sd):
    return np.linalg.lstsq(A, b)[0]


@mistake(
    "solve_map_not_squared",
    says="You add 1 / sd to A^T A. There the squares belong: 1 / sd^2.",
)
def not_squared(A, b, sd):
    return np.linalg.solve(A.T @ A + np.diag(1 / sd), A.T @ b)


@mistake(
    "solve_map_multiplied_by_sd",
    says="Your penalty is |c sd|^2, so a coefficient that varies much is held fast. Divide by sd.",
)
def multiplied_by_sd(A, b, sd):
    return np.linalg.solve(A.T @ A + np.diag(sd**2), A.T @ b)


@mistake(
    "solve_map_one_penalty_for_all",
    says="You give all coefficients the same penalty. Each has a spread of its own: divide c_k by "
    "sd_k.",
)
def one_penalty_for_all(A, b, sd):
    return np.linalg.solve(A.T @ A + np.eye(len(sd)) / np.mean(sd**2), A.T @ b)
