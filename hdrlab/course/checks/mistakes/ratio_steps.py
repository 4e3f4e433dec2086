"""Known mistakes in `ratio_steps`, the task of hdrlab.radiance.ratios.ratio_steps."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.radiance.ratios import State, solve_ratio, square_errors


@mistake(
    "ratio_steps_weights_once",
    says="Your sums contain the weight v once. The sum of (v (y - k x))^2 squares it, so k = "
    "sum v^2 x y / sum v^2 x^2.",
)
def weights_once(found, *, limit=9.0, tolerance=1e-06, rounds=100):
    def solve_ratio(found, used):
        x, y, v = (part[used] for part in found)
        return float(np.sum(v * x * y) / np.sum(v * x**2))

    used = np.ones(len(found[0]), bool)
    k = solve_ratio(found, used)
    yield State(k, used, float(np.mean(square_errors(found, k))))
    for _ in range(rounds):
        errors = square_errors(found, k)
        used = errors <= limit * np.mean(errors[used])
        k_before = k
        k = solve_ratio(found, used)
        yield State(k, used, float(np.mean(square_errors(found, k)[used])))
        if abs(k - k_before) < tolerance:
            return


@mistake(
    "ratio_steps_never_back",
    says="A pair that you rejected once stays out. Test all pairs in each round, because "
    "outliers may have distorted the first k.",
)
def never_back(found, *, limit=9.0, tolerance=1e-06, rounds=100):
    used = np.ones(len(found[0]), bool)
    k = solve_ratio(found, used)
    yield State(k, used, float(np.mean(square_errors(found, k))))
    for _ in range(rounds):
        errors = square_errors(found, k)
        used = used & (errors <= limit * np.mean(errors[used]))
        k_before = k
        k = solve_ratio(found, used)
        yield State(k, used, float(np.mean(square_errors(found, k)[used])))
        if abs(k - k_before) < tolerance:
            return


@mistake(
    "ratio_steps_mean_of_all",
    says="Your V is the mean over all pairs, including outliers, so you reject too few. Take "
    "the mean over the pairs in use.",
)
def mean_of_all(found, *, limit=9.0, tolerance=1e-06, rounds=100):
    used = np.ones(len(found[0]), bool)
    k = solve_ratio(found, used)
    yield State(k, used, float(np.mean(square_errors(found, k))))
    for _ in range(rounds):
        errors = square_errors(found, k)
        used = errors <= limit * np.mean(errors)
        k_before = k
        k = solve_ratio(found, used)
        yield State(k, used, float(np.mean(square_errors(found, k)[used])))
        if abs(k - k_before) < tolerance:
            return
