"""Robertson's turns: recover_steps(Z, times, w, smoothness=0) -> states that begin with f (256,)."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from hdrlab.capture import responses
from hdrlab.core import weights
from hdrlab.course.checks.compare import Different, finite, same, states
from hdrlab.response import robertson

W = weights.cut(weights.gaussian(), below=0.02)
SHOWN = slice(12, 245)


def samples(rng, response, N=900, P=6):
    """Return Z (N, P) and t (P,) of a camera, frames a stop apart, without noise but for the rounding."""
    E = 2.0 ** (10 * (np.arange(N) + rng.random(N)) / N - 5)  # even over ten stops
    t = 2.0 ** (np.arange(P) - P // 2)
    M = responses.RESPONSES[response].f(np.clip(0.2 * E[:, None] * t, 0, 1))
    return np.clip(np.round(255 * M), 0, 255).astype(int), t


def same_curve(f, truth, tolerance):
    """Compare at levels 12 to 244, smoothed over a few: a level that three pixels have is off by chance."""
    f, truth = (gaussian_filter1d(one, 3)[SHOWN] for one in (f, truth))
    same(f, truth, tolerance * truth[-1], what="f at levels 12 to 244", kind="curve")


def asked(subject, Z, t, **knobs):
    """Return f of every state, in shares of f(128): a scale of f and one of E cancel."""
    came = states(subject.recover_steps(Z, t, W, smoothness=0.0, **knobs), what="the states")
    found = []
    for state in came:
        f = finite(state[0] if isinstance(state, tuple | list) else state, (256,), what="f").astype(float)
        if not f[128] > 0:
            raise Different(f"f: expected a response above 0, got {f[128]:.3g} at level 128")
        found.append(f / f[128])
    return found


@pytest.mark.points(5)
def test_the_turns_end_at_the_curve_of_the_camera(subject, rng):
    """Plot f after every turn: where does it go?

    One turn: E from f, then f from E, then divide f by f(128).

    Let the turns go on until f hardly changes; about thirty are enough.
    """
    for response in ("gamma", "film"):
        Z, t = samples(rng, response)
        f = asked(subject, Z, t, turns=25)[-1]
        truth = np.exp(responses.true_g(response))
        scale = np.sum(f[SHOWN] * truth[SHOWN]) / np.sum(f[SHOWN] ** 2)
        same_curve(scale * f, truth, 0.03)


@pytest.mark.points(3)
def test_one_turn_is_a_weighted_mean_and_then_a_plain_one(subject, rng):
    """A turn is two means, one after the other. Which of them has weights?

    The irradiance is a weighted mean; the new f(m) is the plain mean of E t over the pixels of level m.

    Do not weight the update: all its pixels have one level.
    """
    Z, t = rng.integers(15, 250, (900, 4)), rng.uniform(0.2, 1, 4)
    line, shown = np.arange(256) / 128, slice(15, 249)
    truth = robertson.update(Z, t, robertson.irradiance(Z, t, line, W))
    found = asked(subject, Z, t, turns=3, tolerance=0.0)
    if len(found) < 2:
        raise Different(f"expected a state before the first turn and one after each, got {len(found)}")
    same(found[1][shown], truth[shown] / truth[128], 0.01, what="f after the first turn", kind="curve")


@pytest.mark.points(3)
def test_the_truth_is_where_the_turns_rest(subject, rng):
    """A linear camera's response is where the turns begin: what should they change?

    Start from a line, not from an exponential.

    f(m) = m / 128 is the line with f(128) = 1.
    """
    x = np.sort(rng.permutation(np.arange(5, 62))[:45])
    Z, t = np.stack([x, 2 * x, 4 * x], axis=1), np.array([1.0, 2.0, 4.0])
    shown = np.unique(Z)
    truth = np.where(np.isin(np.arange(256), shown) & (W > 0), np.arange(256) / 128, np.nan)
    for f in asked(subject, Z, t, turns=5):
        same(f, truth, 2e-3, what="f of a linear camera", kind="curve", where=~np.isnan(truth))


@pytest.mark.points(3)
def test_levels_that_no_pixel_has_are_filled_from_their_neighbours(subject, rng):
    """Some levels no pixel has. What is their mean?

    0 / 0 is NaN, and one NaN spoils every sum of the next turn.

    Fill empty levels from their neighbours: np.interp over those that have pixels.
    """
    Z, t = samples(rng, "gamma")
    whole, even = (asked(subject, z, t, turns=12)[-1] for z in (Z, Z // 2 * 2))
    same_curve(even, whole, 0.03)


@pytest.mark.points(2)
def test_each_turn_is_a_state_and_moves_the_curve_less(subject, rng):
    """Yield a state before the first turn, and one after each.

    Each state is another array: one that is changed in place shows the last turn everywhere.

    The changes from turn to turn become smaller.
    """
    Z, t = samples(rng, "gamma")
    found = asked(subject, Z, t, turns=8, tolerance=0.0)
    moved = [float(np.abs(b - a)[SHOWN].max()) for a, b in zip(found, found[1:], strict=False)]
    if len(found) < 8 or not 0 < moved[-1] < 0.5 * moved[0]:
        raise Different(f"expected 9 states that move less and less, got {len(found)} that move by {moved}")


@pytest.mark.points(2)
def test_the_unit_of_time_does_not_matter(subject, rng):
    """Seconds or milliseconds: who could tell from the photographs?

    Times that are all 1000 times as long make E a thousandth, and leave f.

    Divide f by f(128) at the end of every turn.
    """
    Z, t = samples(rng, "film")
    one, other = (asked(subject, Z, factor * t, turns=6)[-1] for factor in (1.0, 1000.0))
    same_curve(other, one, 0.005)
