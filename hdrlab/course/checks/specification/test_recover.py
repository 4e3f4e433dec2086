"""Mitsunaga and Nayar's response: recover(images, times) -> g, ln exposure of each level, g[128] = 0."""

import numpy as np

from hdrlab.capture import camera, responses
from hdrlab.course.checks import laws
from hdrlab.course.checks.compare import as_shape, finite, numbers, points, require, same
from hdrlab.response import mitsunaga

SHOWN = slice(25, 246)


def asked(subject, images, times, channels=(), **knobs):
    """Return g, moved to g[128] = 0; ln 0 at level 0 is taken for half of level 1."""
    came = numbers(subject.recover(images, times, **knobs), what="g")
    g = as_shape(came, (256, *channels), "g").astype(float)
    g[0] = np.where(np.isneginf(g[0]), g[1] - np.log(2), g[0])
    g = finite(g, (256, *channels), what="g")
    return g - g[128]


def photographs(rng, response, frames=5, shape=(60, 80)):
    """Return a Bracket a stop apart, hardly any noise."""
    E = (10.0 ** rng.uniform(-1.5, 1.5, shape)).astype(np.float32)
    return camera.shoot(
        E, camera.times_around(E, frames, stops=1), camera.Camera(response=response), rng=rng
    )


def settled(rng):
    """Return a response and its photographs, of which a polynomial of order 5 rises by itself.

    Where it falls, readings of the paper part ways: a clamp, a constraint, or none.
    """
    for _ in range(20):
        response = laws.drawn_response(rng)
        taken = photographs(rng, response)
        g = mitsunaga.recover(taken.images, taken.times, order=5)
        slope = 255 * np.diff(np.exp(g - g[255]))[1:].min()
        if slope > 0.01 and laws.curve_error(g, responses.true_g(response)) < 0.005:
            break
    return response, taken


def same_curve(g, response, tolerance):
    """Compare f^-1 = exp g, its unit fitted, over levels 10 to 250."""
    truth = responses.true_g(response)
    error = laws.curve_error(g, truth)
    said = f"g: expected the curve of the camera within {tolerance:.1%}, got {error:.1%}"
    require(error <= tolerance, said, expected=truth, came=g, kind="curve")


def test_every_level_above_0_has_a_finite_g(subject, rng):
    """One number for each of 256 levels.

    f^-1(0) = 0, whose logarithm is minus infinity; no other level may have that, and none NaN.

    Level 0 may have minus infinity, or a part of what level 1 has.
    """
    taken = photographs(rng, "linear", frames=3)
    asked(subject, taken.images, taken.times, order=3)


@points(7)
def test_the_curve_of_a_camera_comes_out(subject, rng):
    """Plot f^-1 over M, from 0 to 1: it goes through (0, 0) and (1, 1).

    With known ratios R the error sum (f^-1(M_q) - R f^-1(M_q+1))^2 is least squares in the
    coefficients.

    Use samples between 0.05 and 0.98 in both frames alone, and let f^-1(1) = 1 fix the scale.
    """
    for _ in range(2):
        response, taken = settled(rng)
        same_curve(asked(subject, taken.images, taken.times, order=5), response, 0.025)


@points(5, needs="test_the_curve_of_a_camera_comes_out")
def test_frames_in_another_order_give_the_same_curve(subject, rng):
    """The ratio in eq. 5 is that of a frame to the next longer one: below 1.

    R = t_q / t_q+1, and not its inverse.

    Sort the frames by their times first.
    """
    response, taken = settled(rng)
    order = rng.permutation(len(taken.times))
    shuffled = asked(subject, taken.images[order], taken.times[order], order=5)
    same_curve(shuffled, response, 0.025)


@points(5, needs="test_the_curve_of_a_camera_comes_out")
def test_rough_times_are_corrected(subject, rng):
    """The method takes the times for rough. Which quantity does it correct?

    With the curve known, R is the quotient of the sums of f^-1 over the two frames.

    Alternate: coefficients, ratios, coefficients, until f^-1 changes by less than eps.
    """
    for frame, factor in ((1, 1.3), (2, 1 / 1.3)):
        taken = photographs(rng, "linear", frames=4)
        rough = taken.times.copy()
        rough[frame] *= factor  # of one frame in the middle; an error a stop could not be seen
        same_curve(asked(subject, taken.images, rough, order=3), "linear", 0.015)


@points(4, needs="test_the_curve_of_a_camera_comes_out")
def test_the_curve_rises_at_all_levels(subject, rng):
    """A level that is brighter can never mean less light.

    ln f^-1 needs f^-1 above 0, and g that rises.

    Clamp the increments of f^-1 from level to level before you take the logarithm.
    """
    for response in (laws.drawn_response(rng), laws.drawn_response(rng)):
        taken = photographs(rng, response)
        g = asked(subject, taken.images, taken.times, order=6)
        falls = np.sum(np.diff(g) < -1e-6)
        require(falls == 0, f"g: expected a curve that rises, got {falls} falls", came=g)
        same_curve(g, response, 0.05)


@points(4, needs="test_the_curve_of_a_camera_comes_out")
def test_three_equal_channels_have_the_curve_of_gray(subject, rng):
    """Each channel has its own curve.

    g of colour photographs is (256, 3).

    Gray is what comes out in each of three equal channels.
    """
    taken = photographs(rng, "gamma", frames=4)
    rgb = asked(subject, np.stack([taken.images] * 3, axis=-1), taken.times, (3,), order=5)
    gray = asked(subject, taken.images, taken.times, order=5)
    same(rgb[SHOWN], np.stack([gray] * 3, axis=-1)[SHOWN], 0.02, what="g at levels 25 to 245")
    same_curve(gray, "gamma", 0.025)
