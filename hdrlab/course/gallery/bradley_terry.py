"""Estimate from votes on pairs how good each artifact is: the model of Bradley and Terry.

theta_i      strength of artifact i; the mean of all strengths is 0
P(i > j)     1 / (1 + exp(theta_j - theta_i)), the probability that a voter prefers i to j
wins_ij      number of votes for i on the pair of i and j
H            second derivatives of the negative log-likelihood: the information matrix

Bradley and Terry, Rank analysis of incomplete block designs, Biometrika 39(3/4), 1952. The
likelihood alone has no maximum if an artifact wins or loses all its pairs. So each artifact also
gets half a win and half a loss against one of strength 0. Its strength is then finite, and a few
votes more count for much more than this.

The intervals assume that the votes are independent, and that all voters have the same taste. They
say how much the strengths would change with other votes, not with other artifacts.
"""

from dataclasses import dataclass

import numpy as np
from scipy import optimize
from scipy.special import expit, log_expit

from hdrlab.core.arrays import F64, ArrayLike
from hdrlab.errors import InputError

PRIOR_WINS = 0.5  # and as many losses, of each artifact against strength 0
INTERVAL_SIGMAS = 1.959963984540054  # of a normal distribution, for 95 %


@dataclass(frozen=True)
class Strengths:
    """The strength theta of each artifact, and its standard error."""

    theta: F64
    standard_error: F64

    @property
    def chance(self) -> F64:
        """The probability that a voter prefers each artifact to one of strength 0."""
        return expit(self.theta)

    @property
    def interval(self) -> tuple[F64, F64]:
        """The lower and the upper ends of the 95 % intervals of `chance`."""
        margin = INTERVAL_SIGMAS * self.standard_error
        return expit(self.theta - margin), expit(self.theta + margin)


def negative_log_likelihood(theta: F64, wins: F64) -> float:
    """Return -sum_ij wins_ij ln P(i > j), with the wins and losses against strength 0."""
    against_others = np.sum(wins * log_expit(theta[:, None] - theta[None, :]))
    against_zero = PRIOR_WINS * np.sum(log_expit(theta) + log_expit(-theta))
    return -float(against_others + against_zero)


def gradient(theta: F64, wins: F64) -> F64:
    """Return the first derivatives of `negative_log_likelihood`: expected less observed wins."""
    votes = wins + wins.T
    expected = votes * expit(theta[:, None] - theta[None, :])
    return np.sum(expected - wins, axis=1) + PRIOR_WINS * (2 * expit(theta) - 1)


def information(theta: F64, wins: F64) -> F64:
    """Return H, whose entries off the diagonal are -n_ij P(i > j) P(j > i) for n_ij votes."""
    votes = wins + wins.T
    difference = theta[:, None] - theta[None, :]
    between = votes * expit(difference) * expit(-difference)
    np.fill_diagonal(between, 0)
    with_zero = 2 * PRIOR_WINS * expit(theta) * expit(-theta)
    return np.diag(between.sum(axis=1) + with_zero) - between


def fit(wins: ArrayLike) -> Strengths:
    """Return the strengths of artifacts, with standard errors from the information matrix.

    Parameters
    ----------
    wins : (N, N), number of votes for i on the pair of i and j

    Raises
    ------
    InputError
        For an array of another shape, and for negative numbers.

    Examples
    --------
    >>> wins = np.array([[0, 8, 9], [2, 0, 7], [1, 3, 0]])
    >>> strengths = fit(wins)
    >>> bool(strengths.theta[0] > strengths.theta[1] > strengths.theta[2])
    True
    """
    wins = np.asarray(wins, np.float64)
    if wins.ndim != 2 or wins.shape[0] != wins.shape[1] or np.any(wins < 0):
        raise InputError(f"expected a square array of numbers of votes, got {wins.shape}")
    count = len(wins)
    if count == 0:
        return Strengths(np.zeros(0), np.zeros(0))
    solution = optimize.minimize(
        negative_log_likelihood,
        np.zeros(count),
        args=(wins,),
        method="trust-exact",
        jac=gradient,
        hess=information,
    )
    centering = np.eye(count) - 1 / count
    covariance = centering @ np.linalg.inv(information(solution.x, wins)) @ centering
    standard_error = np.sqrt(np.clip(np.diag(covariance), 0, None))
    return Strengths(solution.x - solution.x.mean(), standard_error)
