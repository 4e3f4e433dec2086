"""Checks of spot(shape, at, share), a spot meter: weights w (H, W)."""

from hdrlab.capture import metering
from hdrlab.course.checks.compare import finite, points, same


def draw_inputs(rng):
    """Return a shape, a position off its center, and a fraction of the image that is a whole
    number of pixels.
    """
    H = int(rng.integers(20, 30))
    W = int(rng.integers(36, 48))
    at = float(rng.uniform(0.3, 0.45)), float(rng.uniform(0.55, 0.7))
    return (H, W), {"at": at, "share": int(rng.integers(20, 60)) / (H * W)}


SMALL_INPUTS = [
    ((2, 5), {"at": (0.3, 0.65), "share": 0.2}),
    ((3, 5), {"at": (0.3, 0.65), "share": 0.2}),
    ((4, 5), {"at": (0.3, 0.65), "share": 0.15}),
    ((4, 5), {"at": (0.3, 0.65), "share": 0.01}),
    ((4, 10), {"at": (0.3, 0.62), "share": 0.2}),
]


@points(4)
def test_the_nearest_pixels_are_used(subject, rng):
    """Which pixels are in a disc around a position?

    The nearest ones. Measure the distance in pixels, down and to the right.

    The center of a pixel is at (y + 1/2, x + 1/2), and the position is at (at[0] H, at[1] W).
    """
    cases = [draw_inputs(rng) for _ in range(12)]
    shape, options = cases[0]
    cases.append((shape, {**options, "share": 0.4 / (shape[0] * shape[1])}))  # still one pixel
    for shape, options in cases:
        w = finite(subject.spot(shape, **options), shape, what="w")
        same(
            w > 0,
            metering.spot(shape, **options) > 0,
            0,
            what="the pixels with a weight above 0",
            picture=True,
        )


@points(3, needs="test_the_nearest_pixels_are_used")
def test_the_used_pixels_have_equal_weights_that_sum_to_one(subject, rng):
    """k pixels have equal weights. What is the weight of each?

    All weights sum to 1.

    w = 1 / k in the disc, and 0 elsewhere.
    """
    shape, options = draw_inputs(rng)
    for share in (options["share"], 0.12, 1.0):  # a spot, a partial and an average meter
        w = metering.spot(shape, at=options["at"], share=share)
        answer = subject.spot(shape, at=options["at"], share=share)
        same(answer, w, 1e-3 * float(w.max()), what=f"w for share = {share:.3g}", picture=True)
