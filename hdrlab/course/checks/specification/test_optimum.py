"""Checks of optimum(EV_pre, B_pre, B_opt), the exposure that a meter recommends: EV_opt."""

import numpy as np

from hdrlab.course.checks.compare import points, same


@points(3)
def test_a_reading_that_is_off_by_n_stops_changes_the_exposure_by_n(subject, rng):
    """The reading is four times what it should be. How many stops is that?

    Two. A higher exposure value lets in less light.

    EV_opt = EV_pre + log2(B_pre / B_opt).
    """
    EV = float(rng.uniform(4, 14))
    stops = rng.permutation([-2.0, 1.0, 2.0])
    for n in stops:
        same(
            subject.optimum(EV, 0.18 * 2**n),
            EV + n,
            1e-3,
            what=f"EV after a reading that is off by {n:g} stops",
        )


@points(2)
def test_the_target_reading_can_be_chosen(subject, rng):
    """Not every meter assumes 18 % gray. Do you use the argument B_opt?

    A higher B_opt needs more light, so the exposure value is lower.

    Subtract log2(B_opt).
    """
    EV = rng.uniform(4, 14)
    B = rng.uniform(0.05, 0.9)
    B_opt = rng.uniform(0.3, 0.6)
    same(
        subject.optimum(EV, B, B_opt),
        EV + np.log2(B / B_opt),
        1e-3,
        what=f"EV for B_opt = {B_opt:.2f}",
    )
