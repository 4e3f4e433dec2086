"""Self-calibration by marginal maximum likelihood: the same camera as in `mitsunaga`, every pixel as it is.

Z      pixel levels   (N, P), 0 ... 255: pixel i in frame q, frames from short to long
c      coefficients   (order - 1,) of the polynomial f^-1: see `mitsunaga`
R      ratios         (P - 1,), exposure of frame q over that of frame q + 1
sigma  noise          standard deviation of brightness, 0 ... 1
theta  unknowns       (A,) = (c, tau[:-1], ln sigma), tau the ln exposures over the longest
p      density        (K,), how often a pixel has which exposure: see `likelihood`
s      scores         (N, A), derivatives of ln P(Z_i) by theta

The scheme of `mitsunaga` takes each M for exact on both sides of eq. 5. But f^-1(M) errs by the
noise of M times its slope, and pixels chosen by their own value are chosen by their own noise; both
tilt the valley of the u-ambiguity, and no stop can mend that. Here the exposure of a pixel is
integrated over, the noise is part of the model, and nothing is cut or averaged. Steps of EM for p
and of Fisher scoring for theta alternate, from where `self_calibration` stopped.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, Indices, describe
from hdrlab.core.steps import last
from hdrlab.errors import InputError
from hdrlab.response import likelihood, polynomial
from hdrlab.response.mitsunaga import curve
from hdrlab.response.self_calibration import MAX_ORDER, calibrate as self_calibrate, levels_by_time

# the smallest slope of f^-1
MIN_SLOPE = 2e-3
# the smallest sigma, half a level: with less noise the nodes are too far apart
MIN_NOISE = 2e-3
# the initial guess of sigma
INITIAL_NOISE = 0.005
# number of nodes
_NODE_COUNT = 400
# A step is halved at most this often until it raises the likelihood.
_MAX_HALVINGS = 12
# EM steps for the density before theta changes
_INITIAL_EM_STEPS = 5
# The fit runs twice, with a support for this many times the noise: wide at first, as theta is far off.
_SUPPORT_WIDTHS = (3.0, 2.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """The fit after a step.

    Attributes
    ----------
    c : (order - 1,) coefficients
    R : (P - 1,) ratios
    sigma : noise
    likelihood : log-likelihood
    promise : gain in log-likelihood that the step promised
    """

    c: F64
    R: F64
    sigma: float
    likelihood: float
    promise: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Task:
    """What does not change while theta is improved.

    Attributes
    ----------
    at : nodes
    near : their support
    prior : (A,) theta that the prior prefers
    stiffness : (A, A) inverse covariance of the prior
    """

    at: likelihood.Nodes
    near: likelihood.Support
    prior: F64
    stiffness: F64


@dataclass(frozen=True, kw_only=True, eq=False)
class Point:
    """The likelihood at some unknowns.

    Attributes
    ----------
    theta : (A,) unknowns
    likelihood : log-likelihood
    weights : shares of the supporting nodes
    scores : (N, A) derivatives for each pixel
    """

    theta: F64
    likelihood: float
    weights: F64
    scores: F64


def _pack(c: F64, R: F64) -> F64:
    """Return theta of c, limited to rising curves, ratios R and the initial noise."""
    tau = np.cumsum(np.log(R)[::-1])[::-1]
    return np.concatenate([polynomial.limit_slope(c), tau, [np.log(INITIAL_NOISE)]])


def unpack(theta: F64, frames: int) -> tuple[F64, F64, float]:
    """Return c, tau and sigma of theta."""
    cut = len(theta) - frames
    return theta[:cut], np.append(theta[cut:-1], 0), float(np.exp(theta[-1]))


def evaluate(theta: F64, p: F64, task: Task) -> Point:
    """Return the Point at theta for a density p."""
    c, tau, sigma = unpack(theta, len(task.near.at))
    q, k, z = task.near.cells
    m, J = likelihood.predict(c, tau, task.at)
    P, dm, ds = likelihood.masses(m[q, k], sigma, z)
    ln, weights = likelihood.posterior(P, p, task.near)
    penalty = ((theta - task.prior) @ task.stiffness @ (theta - task.prior)) / 2
    return Point(
        theta=theta,
        likelihood=float(ln.sum() - penalty),
        weights=weights,
        scores=likelihood.scores(weights, task.near, J, dm, ds),
    )


def ascend(here: Point, task: Task) -> tuple[Point, float]:
    """Return the Point after a step of Fisher scoring, and the gain in log-likelihood that it promised.

    The step is F^-1 s, with s the sum of the scores and F = sum s_i s_i^T, the information in the
    pixels, both with the prior's share. It is halved until f^-1 rises everywhere and the likelihood
    does.
    """
    s = here.scores.sum(axis=0) - task.stiffness @ (here.theta - task.prior)
    F = here.scores.T @ here.scores + task.stiffness
    step = np.linalg.solve(F + 1e-9 * np.diag(np.diag(F)) + 1e-12 * np.eye(len(F)), s)
    p = likelihood.density(here.weights, task.near, len(task.at.x))
    for half in range(_MAX_HALVINGS):
        theta = here.theta + step / 2**half
        theta[-1] = max(theta[-1], np.log(MIN_NOISE))
        c, _, _ = unpack(theta, len(task.near.at))
        if polynomial.slope(polynomial.GRID, c).min() >= MIN_SLOPE:
            there = evaluate(theta, p, task)
            if there.likelihood >= here.likelihood:
                return there, float(s @ step)
    return here, 0.0


def begin(Z: Indices, theta: F64, blur: float) -> tuple[likelihood.Nodes, likelihood.Support, F64]:
    """Return nodes, their support under `blur` times the noise, and p after five steps of EM."""
    c, tau, sigma = unpack(theta, Z.shape[1])
    at = likelihood.nodes(c, tau, _NODE_COUNT)
    m = likelihood.predict(c, tau, at)[0]
    near = likelihood.support(Z, likelihood.table(m, blur * sigma))
    q, k, z = near.cells
    P = likelihood.masses(m[q, k], sigma, z)[0]
    p = np.full(len(at.x), 1 / len(at.x))
    for _ in range(_INITIAL_EM_STEPS):
        p = likelihood.density(likelihood.posterior(P, p, near)[1], near, len(p))
    return at, near, p


def fit_steps(
    Z: ArrayLike,
    c: ArrayLike,
    R: ArrayLike,
    *,
    stated: ArrayLike | None = None,
    trust: float = np.inf,
    tolerance: float = 0.01,
    max_iterations: int = 30,
) -> Iterator[State]:
    """Yield the State after each step from c and R on, until a step promises less than `tolerance`.

    Twice: first with a wide support, for theta is far; then with nodes and support where it has
    come to. Each ln R is drawn to the `stated` one (R itself by default) as to a measurement with
    error `trust`.
    """
    Z = np.asarray(Z)
    c = np.asarray(c, dtype=np.float64)
    R = np.asarray(R, dtype=np.float64)
    stated = R if stated is None else np.asarray(stated, dtype=np.float64)
    if Z.ndim != 2 or Z.dtype.kind not in "iu" or not R.shape == stated.shape == (Z.shape[1] - 1,):
        raise InputError(
            f"expected levels Z (N, P) and R (P - 1,), got {describe(Z)} and {describe(R)}"
        )
    theta = _pack(c, R)
    prior = _pack(c, stated)
    stiff = likelihood.stiffness(len(theta), Z.shape[1], trust)
    for blur in _SUPPORT_WIDTHS:
        at, near, p = begin(Z, theta, blur)
        task = Task(at=at, near=near, prior=prior, stiffness=stiff)
        here = evaluate(theta, p, task)
        for _ in range(max_iterations):
            here, promise = ascend(here, task)
            theta = here.theta
            c, tau, noise = unpack(theta, Z.shape[1])
            yield State(
                c=c,
                R=np.exp(tau[:-1] - tau[1:]),
                sigma=noise,
                likelihood=here.likelihood,
                promise=promise,
            )
            if promise < tolerance:
                break


def fit(
    Z: ArrayLike,
    c: ArrayLike,
    R: ArrayLike,
    *,
    stated: ArrayLike | None = None,
    trust: float = np.inf,
    tolerance: float = 0.01,
    max_iterations: int = 30,
) -> State:
    """Return the last State of `fit_steps`, which has the same parameters."""
    states = fit_steps(
        Z, c, R, stated=stated, trust=trust, tolerance=tolerance, max_iterations=max_iterations
    )
    return last(states)


def calibrate(
    images: ArrayLike,
    times: ArrayLike,
    *,
    order: int | None = MAX_ORDER,
    trust: float = 0.005,
    pixels: int = 10_000,
    valid: ArrayLike | None = None,
    tolerance: float = 0.01,
    max_iterations: int = 30,
) -> list[State]:
    """Return the last State of each channel of a bracket, starting where `self_calibration` stops.

    For cameras that are polynomials of this order. For others, the misfit may cost more than the
    noise that it takes care of, and `mitsunaga` comes nearer. Parameters as of `recover`, and those
    of `fit_steps`; `mitsunaga.curve(state.c)` is the response g. It takes seconds a channel.

    >>> ramp = np.linspace(1, 100, 2500).reshape(50, 50)  # a linear camera
    >>> images = np.clip(np.round(ramp * np.array([1, 2, 4])[:, None, None]), 0, 255).astype(np.uint8)
    >>> state = calibrate(images, [0.01, 0.02, 0.04], order=2)[0]
    >>> bool(abs(curve(state.c)[200] - np.log(200 / 128)) < 0.01)
    True
    """
    start = self_calibrate(images, times, order=order, valid=valid)
    Z, stated = levels_by_time(images, times, pixels, valid=valid)
    return [
        fit(
            Z_channel,
            c,
            start.R,
            stated=stated,
            trust=trust,
            tolerance=tolerance,
            max_iterations=max_iterations,
        )
        for Z_channel, c in zip(Z, start.c, strict=True)
    ]


def recover(
    images: ArrayLike,
    times: ArrayLike,
    *,
    order: int | None = None,
    trust: float = 0.005,
    pixels: int = 1500,
    valid: ArrayLike | None = None,
) -> F64:
    """Return the response g that makes the pixel levels likeliest, each channel by itself.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs, aligned; 16 bits are read at 256 levels.
    times : (P,) float
        Exposure times in seconds, at least two different ones.
    order : int, optional
        Of the polynomial; by default the one that `self_calibration` chooses.
    trust : float
        How far the ratios may be from those of the times, as a standard deviation of ln R. Where no
        polynomial is the camera, its misfit tilts the valley as noise did: then the times know
        better.
    pixels : int
        How many to take, on an even grid. A second or two a channel; more of them take longer, and
        change little where the camera is no polynomial.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.

    Returns
    -------
    (256,) or (256, 3) float64
        g, the ln exposure of each level, rising; g[128] = 0 in every channel.

    Raises
    ------
    ValueError
        For fewer than two photographs or two times, and photographs that share no levels worth
        using.

    References
    ----------
    The model is that of Mitsunaga and Nayar, Radiometric self calibration, CVPR 1999; the estimator
    is ours.

    Examples
    --------
    >>> ramp = np.linspace(1, 100, 2500).reshape(50, 50)  # a linear camera
    >>> images = np.clip(np.round(ramp * np.array([1, 2, 4])[:, None, None]), 0, 255).astype(np.uint8)
    >>> g = recover(images, [0.01, 0.02, 0.04])
    >>> bool(abs(g[200] - np.log(200 / 128)) < 0.01)
    True
    """
    states = calibrate(
        images,
        times,
        order=order,
        trust=trust,
        pixels=pixels,
        valid=valid,
        tolerance=0.5,
        max_iterations=10,
    )
    g = np.stack([curve(state.c) for state in states], axis=-1)
    return g.reshape(256, *np.shape(images)[3:])
