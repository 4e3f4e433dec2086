"""A spot meter: spot(shape, at, share) -> w (H, W)."""

from hdrlab.capture import metering
from hdrlab.course.checks.compare import finite, points, same


def drawn(rng):
    """Return a shape, a place off its middle, and a share that is a whole number of pixels."""
    H, W = int(rng.integers(20, 30)), int(rng.integers(36, 48))
    at = float(rng.uniform(0.3, 0.45)), float(rng.uniform(0.55, 0.7))
    return (H, W), {"at": at, "share": int(rng.integers(20, 60)) / (H * W)}


@points(4)
def test_the_pixels_that_are_nearest_count(subject, rng):
    """Which pixels lie in a disc around a place?

    Those that are nearest to it, measured in pixels down and right.

    A pixel's middle is at (y + 1/2, x + 1/2), and the place at (at[0] H, at[1] W).
    """
    for shape, knobs in (drawn(rng) for _ in range(12)):
        w = finite(subject.spot(shape, **knobs), shape, what="w")
        same(
            w > 0,
            metering.spot(shape, **knobs) > 0,
            0,
            what="the pixels of weight above 0",
            picture=True,
        )


@points(3, needs="test_the_pixels_that_are_nearest_count")
def test_they_count_alike_and_together_one(subject, rng):
    """Which weight has each of k pixels that count alike?

    All weights add up to 1.

    w = 1 / k in the disc, and 0 elsewhere.
    """
    shape, knobs = drawn(rng)
    for share in (knobs["share"], 0.12, 1.0):  # of a spot, a partial and an average meter
        w = metering.spot(shape, at=knobs["at"], share=share)
        came = subject.spot(shape, at=knobs["at"], share=share)
        same(came, w, 1e-3 * float(w.max()), what=f"w of a share of {share:.3g}", picture=True)
