"""Known mistakes in `solve_by_svd`, the task of hdrlab.response.debevec.solve_by_svd."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "solve_by_svd_nothing_left_out",
    says="You divide by singular values that are only rounding errors, so x is huge. Leave out "
    "those of at most rtol times the largest.",
)
def nothing_left_out(A, b, *, rtol=1e-10):
    U, sigma, Vt = np.linalg.svd(np.asarray(A, np.float64), full_matrices=False)
    kept = sigma > 0
    return Vt[kept].T @ (U[:, kept].T @ b / sigma[kept])


@mistake(
    "solve_by_svd_v_not_transposed",
    says="You use the columns of numpy's Vh. It is V transposed, so the vectors v_i are its rows.",
)
def v_not_transposed(A, b, *, rtol=1e-10):
    U, sigma, Vt = np.linalg.svd(np.asarray(A, np.float64), full_matrices=False)
    kept = sigma > rtol * sigma[0]
    return Vt[:, kept] @ (U[:, kept].T @ b / sigma[kept])


@mistake(
    "solve_by_svd_limit_absolute",
    says="You compare the singular values with rtol itself. Compare them with rtol times the "
    "largest, so that the unit does not matter.",
)
def limit_absolute(A, b, *, rtol=1e-10):
    U, sigma, Vt = np.linalg.svd(np.asarray(A, np.float64), full_matrices=False)
    kept = sigma > rtol
    return Vt[kept].T @ (U[:, kept].T @ b / sigma[kept])
