"""The exposure that a meter asks for: optimum(EV_pre, B_pre, B_opt) -> EV_opt."""

import numpy as np

from hdrlab.course.checks.compare import points, same


@points(3)
def test_a_reading_too_bright_by_so_many_stops_asks_for_as_many(subject, rng):
    """The reading is four times what it should be. How many stops are that?

    Two. A higher exposure value lets less light in.

    EV_opt = EV_pre + log2(B_pre / B_opt).
    """
    EV, stops = float(rng.uniform(4, 14)), rng.permutation([-2.0, 1.0, 2.0])
    for n in stops:
        same(
            subject.optimum(EV, 0.18 * 2**n),
            EV + n,
            1e-3,
            what=f"EV after a reading off by {n:g} stops",
        )


@points(2)
def test_what_the_reading_should_be_is_asked(subject, rng):
    """Not every meter takes the world for 18 % gray. Where does B_opt stand in your formula?

    A higher B_opt wants more light, so a lower exposure value.

    Subtract log2 B_opt.
    """
    EV, B, B_opt = rng.uniform(4, 14), rng.uniform(0.05, 0.9), rng.uniform(0.3, 0.6)
    same(
        subject.optimum(EV, B, B_opt),
        EV + np.log2(B / B_opt),
        1e-3,
        what=f"EV for B_opt = {B_opt:.2f}",
    )
