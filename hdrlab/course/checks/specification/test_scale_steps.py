"""Checks of scale_steps(blurred), Reinhard's local scales: states (width, centre, response,
even, adaptation).
"""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.compare import parts, points, same, states
from hdrlab.tonemap import reinhard

CLOSE = 2e-4  # a response so close to the threshold may fall on either side


def draw_inputs(rng, shape=(48, 64)):
    """Return V1 at each of the nine widths, for an image with edges and texture."""
    y, x = np.indices(shape)
    lit = (np.hypot(y - rng.integers(10, 38), x - rng.integers(10, 54)) < rng.integers(6, 12)) * 8.0
    Lm = ((0.2 + lit) * np.exp(0.15 * rng.standard_normal(shape) + 0.02 * x)).astype(np.float32)
    return [gaussian_filter(Lm, s / 4) for s in reinhard.WIDTHS]


def get_answer(subject, blurred, **options):
    """Return the states, each with its five parts."""
    return [
        parts(state, 5, what="a state") for state in states(subject.scale_steps(blurred, **options))
    ]


def doubtful(truth, threshold=0.05):
    """Return where a response is so close to the threshold that rounding decides."""
    return np.any([np.abs(np.abs(state.response) - threshold) < CLOSE for state in truth], axis=0)


def same_adaptation(answer, truth, what, sure):
    """Compare the adaptations of the last states, divided by the largest value."""
    scale = truth[-1].adaptation.max()
    same(
        answer[-1][4] / scale,
        truth[-1].adaptation / scale,
        1e-3,
        what=what,
        picture=True,
        where=sure,
    )


# right iterations may differ in their steps, which small inputs show most
check_one_input = None


@points(4)
def test_each_response_compares_a_width_with_the_next(subject, rng):
    """The surround of one width is the center of the next width, so nine blurs give eight
    responses.

    In the formula, s is the width in pixels (1, 1.6, 2.56, ...), not the number of the step.

    V = (V1 - V2) / (2^phi a / s^2 + V1).
    """
    blurred = draw_inputs(rng)
    truth = list(reinhard.scale_steps(blurred))
    answer = get_answer(subject, blurred)
    same(len(answer), 8, 0, what="the number of states")
    for state, expected in zip(answer, truth, strict=True):
        same(
            state[2], expected.response, 1e-3, what=f"V at width {expected.width:.3g}", picture=True
        )


@points(4)
def test_a_pixel_takes_the_largest_even_width(subject, rng):
    """Try the widths from small to large. When does a pixel stop?

    When |V| reaches the threshold, the neighborhood of the pixel stays as it is at all larger
    widths.

    even = even & (|V| < threshold). Set the adaptation to the center V1 where the pixel is still
    even.
    """
    blurred = draw_inputs(rng)
    truth = list(reinhard.scale_steps(blurred))
    answer = get_answer(subject, blurred)
    sure = ~doubtful(truth)
    same_adaptation(answer, truth, "the adaptation", sure)
    for state, expected in zip(answer, truth, strict=True):
        same(
            state[3],
            expected.even,
            0,
            what=f"even at width {expected.width:.3g}",
            picture=True,
            where=sure,
        )


def test_a_uniform_image_takes_the_largest_neighborhood(subject, rng):
    """What is the response of a uniform image?

    It is 0 at every width, so every pixel takes the largest width.

    At the largest width, the adaptation is the center V1(26.8) of the last step, not its surround.
    """
    level = float(rng.uniform(0.1, 2))
    blurred = [np.full((12, 15), level * (1 + 1e-3 * k), np.float32) for k in range(9)]
    answer = get_answer(subject, blurred)
    same(answer[-1][4], blurred[7], 2e-4 * level, what="the adaptation of a uniform image")


@points(4)
def test_key_phi_and_threshold_are_used(subject, rng):
    """Do you use the arguments key (a), phi (the sharpening) and threshold?

    A larger phi makes V smaller, so the neighborhoods become larger.

    Use 2^phi a / s^2 with the values that you are given.
    """
    blurred = draw_inputs(rng)
    for options in ({"phi": 12.0}, {"key": 0.72}, {"threshold": 0.02}):
        truth = list(reinhard.scale_steps(blurred, **options))
        answer = get_answer(subject, blurred, **options)
        sure = ~doubtful(truth, options.get("threshold", 0.05))
        ((knob, value),) = options.items()
        same_adaptation(answer, truth, f"the adaptation with {knob}={value}", sure)
