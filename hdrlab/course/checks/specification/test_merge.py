"""The radiance map: merge(images, times, g, w) -> E (H, W[, 3])."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.capture import camera, responses
from hdrlab.core import weights
from hdrlab.course.checks.compare import finite, points, require, same
from hdrlab.radiance.merge import merge

G = responses.true_g("gamma")
TIMES = np.array([0.25, 0.5, 1.0])


def smooth(rng, shape=(48, 64)):
    """Return radiance (H, W) without single pixels that stand out, about 0.1 to 1."""
    noise = gaussian_filter(rng.standard_normal(shape), 4)
    return np.exp(0.5 * noise / noise.std() - 1).astype(np.float32)


def photographs(rng, E, times=TIMES):
    """Return 8-bit photographs (P, H, W) with noise, of levels 20 to 235: each frame measures all."""
    M = responses.RESPONSES["gamma"].f(
        np.clip(0.3 * E * np.reshape(times, (-1,) + (1,) * E.ndim), 0, 1)
    )
    return np.clip(np.round(255 * M + 3 * rng.standard_normal(M.shape)), 20, 235).astype(np.uint8)


def same_map(came, truth, tolerance=0.01, **knobs):
    """Compare the logarithms of two maps: radiance is right or wrong by a factor."""
    E = finite(came, truth.shape, what="E").astype(float)
    require(
        np.all(E > 0),
        f"E: expected radiance above 0, got {np.sum(E <= 0)} values that are not",
        came=E,
    )
    same(np.log(E), np.log(truth), tolerance, what="ln E", picture=truth.ndim == 2, **knobs)


def test_every_pixel_has_a_finite_radiance(subject, rng):
    """The map has the size of a photograph.

    Sum over the frames, the first axis.

    Nothing in it may be NaN, infinite or below 0.
    """
    images = photographs(rng, smooth(rng))
    E = finite(subject.merge(images, TIMES, G), images.shape[1:], what="E")
    require((E >= 0).all(), f"E: expected radiance of at least 0, got {float(E.min()):.3g}", came=E)


@points(8)
def test_it_is_the_weighted_mean_of_the_logarithms(subject, rng):
    """Divide by the sum of the weights, not by the number of frames.

    Each frame says ln E = g(Z) - ln t; the natural logarithm, as in g.

    ln E = sum_j w(Z_j) (g(Z_j) - ln t_j) / sum_j w(Z_j), and E = exp(ln E).
    """
    images = photographs(rng, smooth(rng))
    same_map(subject.merge(images, TIMES, G), merge(images, TIMES, G))


@points(6)
def test_the_radiance_of_a_simulated_camera_comes_back(subject, rng):
    """Compare your map with the scene that the photographs were made of, not only by its looks.

    A pixel of level 128 in a frame of 2 seconds has radiance exp(g[128]) / 2.

    Is the exposure time subtracted as a natural logarithm, from each frame its own?
    """
    E = np.float32(2.0 ** rng.uniform(-3, 3)) * smooth(rng)
    times = camera.times_around(E, 7, stops=1)
    taken = camera.shoot(E, times, camera.Camera(response="gamma"))
    came = np.log(
        finite(subject.merge(taken.images, taken.times, G), E.shape, what="E").astype(float)
    )
    ratio = came - np.log(E)
    same(
        ratio - np.median(ratio),
        np.zeros(E.shape),
        0.06,
        what="ln E less that of the scene",
        picture=True,
    )
    step = np.log(
        finite(subject.merge(taken.images, 8 * taken.times, G), E.shape, what="E").astype(float)
    )
    same(step, came - np.log(8), 1e-3, what="ln E with times 8 times as long", picture=True)


@points(5)
def test_the_weights_that_are_given_are_used(subject, rng):
    """Two frames may disagree. Whom does the map believe, and how much?

    The argument w holds the weights; None stands for the hat.

    Look up w[Z] for each pixel and frame, of the w that is given.
    """
    images = photographs(rng, smooth(rng))
    for w in (weights.gaussian(), 0.05 + np.linspace(0, 1, 256) ** 2):
        same_map(subject.merge(images, TIMES, G, w), merge(images, TIMES, G, w))


@points(3)
def test_the_order_of_the_frames_does_not_matter(subject, rng):
    """Does any line of yours take the first frame for the shortest?

    times[j] belongs to images[j].

    Sort both together, or neither.
    """
    images, order = photographs(rng, smooth(rng)), [1, 2, 0]
    same_map(subject.merge(images[order], TIMES[order], G), merge(images, TIMES, G))


@points(3)
def test_each_channel_is_read_by_its_own_curve(subject, rng):
    """Colour photographs are (P, H, W, 3).

    Every channel is merged by the same formula; g may be (256, 3), a curve each.

    g[Z[..., c], c] looks up the channel's own curve.
    """
    images = np.stack([photographs(rng, smooth(rng)) for _ in range(3)], axis=-1)
    g = np.stack([G, responses.true_g("linear"), responses.true_g("film")], axis=-1)
    same_map(subject.merge(images, TIMES, g), merge(images, TIMES, g))
