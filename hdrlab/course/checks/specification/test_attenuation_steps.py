"""Checks of attenuation_steps(lL, alpha, beta), Fattal's attenuation: states (k, lL_k, slope,
phi, Phi).
"""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.compare import finite, parts, points, require, same, states
from hdrlab.tonemap import fattal

INNER = (slice(24, -24), slice(24, -24))


def draw_inputs(rng, shape=(128, 144)):
    """Return log luminance with soft light, a few steep edges and some texture."""
    soft = gaussian_filter(rng.standard_normal(shape), 12)
    y, x = np.indices(shape)
    lamp = np.hypot(y - rng.integers(40, 88), x - rng.integers(40, 104)) < rng.integers(14, 24)
    return (2 * soft / soft.std() + 3.0 * lamp + 0.05 * rng.standard_normal(shape)).astype(
        np.float32
    )


def get_answer(subject, lL, **options):
    """Return the states, and ln Phi of the last one, at full size."""
    answer = [
        parts(state, 5, what="a state")
        for state in states(subject.attenuation_steps(lL, **options))
    ]
    Phi = finite(answer[-1][4], lL.shape, what="Phi").astype(float)
    require((Phi > 0).all(), f"Phi: expected attenuations above 0, got {Phi.min():.3g}", answer=Phi)
    return answer, np.log(Phi)


# right iterations may differ in their steps, which small inputs show most
check_one_input = None


def test_there_is_a_state_for_each_level(subject, rng):
    """Halve the image as long as its shorter side stays at 32 pixels or more.

    Yield the coarsest level first and the full image last.

    128 x 144 pixels have three levels, with 32, 64 and 128 rows.
    """
    lL = draw_inputs(rng)
    answer, _ = get_answer(subject, lL, alpha=0.1, beta=0.9)
    rows = np.array([np.shape(state[3])[0] for state in answer])
    same(rows, [32, 64, 128], 0, what="the number of rows of phi in each state")


@points(3, needs="test_the_last_phi_combines_all_levels")
def test_every_level_attenuates_a_ramp_by_the_same_factor(subject, rng):
    """On a ramp, every gradient equals the mean gradient, so phi is the same everywhere.

    Is your phi the right value or its inverse? Slopes above alpha times the mean must become
    smaller.

    phi = (a / gradient) (gradient / a)^beta with a = alpha mean. Phi is the product of phi over all
    levels.
    """
    c = float(rng.uniform(0.01, 0.05))
    lL = np.broadcast_to(np.arange(160, dtype=np.float32) * np.float32(c), (128, 160)).copy()
    answer, lPhi = get_answer(subject, lL, alpha=0.1, beta=0.9)
    same(len(answer), 3, 0, what="the number of levels of 128 x 160 pixels")
    expected = np.full(lPhi.shape, 0.3 * np.log(0.1))
    same(lPhi[INNER], expected[INNER], 0.04, what="ln Phi of a ramp", picture=True)


@points(3)
def test_beta_of_1_changes_nothing_and_alpha_is_a_factor(subject, rng):
    """With beta = 1, phi must be 1 everywhere.

    phi = (gradient / a)^(beta - 1).

    a is alpha times the mean gradient of each level. So another alpha multiplies all of Phi by one
    number.
    """
    lL = draw_inputs(rng)
    _, none = get_answer(subject, lL, alpha=0.1, beta=1.0)
    same(none, np.zeros(lL.shape), 1e-3, what="ln Phi with beta = 1", picture=True)
    weaker, stronger = (get_answer(subject, lL, alpha=alpha, beta=0.8)[1] for alpha in (0.1, 0.3))
    expected = np.full(lL.shape, 3 * 0.2 * np.log(3))
    same(
        stronger - weaker,
        expected,
        0.05,
        what="ln Phi with alpha = 0.3 minus ln Phi with alpha = 0.1",
    )


@points(4)
def test_each_level_is_attenuated_by_its_own_slopes(subject, rng):
    """Which gradient do you use for which phi? Plot each level's image next to its phi.

    Phi_k is Phi_(k+1), enlarged, times phi_k. Compute phi_k from the gradients of level k.

    The mean gradient is that of level k, too.
    """
    lL = draw_inputs(rng)
    answer, _ = get_answer(subject, lL, alpha=0.1, beta=0.8)
    for state in answer:
        slope = finite(state[2], np.shape(state[1]), what="the slope").astype(float)
        phi = finite(state[3], np.shape(state[1]), what="phi").astype(float)
        steep = slope > 0.2 * slope.mean()
        expected = np.where(steep, (np.maximum(slope, 1e-9) / (0.1 * slope.mean())) ** -0.2, np.nan)
        what = f"ln phi of level {int(state[0])}"
        same(np.log(phi), np.log(expected), 0.02, what=what, picture=True, where=steep)
        level = fattal.slope(state[1].astype(np.float32), 0)
        inner = (slice(4, -4), slice(4, -4))
        fitted = (slope * level).sum() / (level * level).sum() * level
        steps, expected = (picture[inner] / level.mean() for picture in (slope, fitted))
        same(steps, expected, 0.25, what="the slope", picture=True)


@points(5)
def test_the_last_phi_combines_all_levels(subject, rng):
    """Compare Phi with the image: Phi must be small where the luminance jumps, at every scale.

    Start at the coarsest level. Enlarge Phi, and multiply it by phi of the next finer level.

    Enlarge with linear interpolation. Repeated pixels leave blocks.
    """
    lL = draw_inputs(rng)
    _, lPhi = get_answer(subject, lL, alpha=0.1, beta=0.85)
    truth = np.log(list(fattal.attenuation_steps(lL, alpha=0.1, beta=0.85))[-1].Phi)
    soft = gaussian_filter(lPhi - truth, 3)
    same(
        soft[INNER],
        np.zeros(lL.shape)[INNER],
        0.2,
        what="ln Phi minus the correct one",
        picture=True,
    )


@points(1, needs="test_each_level_is_attenuated_by_its_own_slopes")
def test_a_slope_below_noise_counts_as_noise(subject, rng):
    """What does your phi do to a gradient of almost 0?

    It must not amplify it without limit: that would be noise.

    Use max(slope, noise * mean) in place of the slope.
    """
    noise = float(rng.uniform(0.3, 0.6))
    answer, _ = get_answer(subject, draw_inputs(rng), alpha=0.1, beta=0.8, noise=noise)
    for state in answer:
        slope = finite(state[2], np.shape(state[1]), what="the slope").astype(float)
        expected = -0.2 * np.log(np.maximum(slope / slope.mean(), noise) / 0.1)
        what = f"ln phi of level {int(state[0])} with noise={noise:.2g}"
        same(np.log(np.asarray(state[3], float)), expected, 0.02, what=what, picture=True)


@points(1, needs="test_the_last_phi_combines_all_levels")
def test_phi_is_enlarged_by_linear_interpolation(subject, rng):
    """Divide your last Phi by its phi. Do you see blocks of 2 x 2 equal pixels?

    They come from repeated pixels, and become edges in the image.

    Interpolate along straight lines, for example with scipy.ndimage.map_coordinates and order=1.
    """
    answer, _ = get_answer(subject, draw_inputs(rng), alpha=0.1, beta=0.8)
    enlarged = np.asarray(answer[-1][4], float) / np.asarray(answer[-1][3], float)
    steps = np.abs(np.diff(enlarged[INNER], axis=1))
    equal = float(np.mean(steps < 1e-3 * steps.mean()))
    message = f"Phi / phi of the full image: {equal:.0%} of the neighbors in a row are equal"
    require(equal < 0.3, message, answer=enlarged, kind="image")
