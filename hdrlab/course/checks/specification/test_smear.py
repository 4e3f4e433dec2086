"""Checks of smear(x, h), what a sensor sees of a moving object: y (n + m - 1, ...)."""

from hdrlab.beyond import flutter
from hdrlab.course.checks.compare import finite, points, same


def draw_inputs(rng, channels=()):
    """Return an object x (n, ...) and a shutter h (m,), which begins open and is not symmetric."""
    x = rng.uniform(0.2, 1, (int(rng.integers(20, 30)), *channels))
    h = (rng.random(int(rng.integers(8, 14))) < 0.5).astype(float)
    h[:2] = 1
    h[-3:] = [0, 0, 1]
    return x, h


@points(6)
def test_each_open_chop_adds_the_object_where_it_is(subject, rng):
    """The object moves one pixel per chop. Where is it in chop k?

    k pixels further down, and it adds its light there if the shutter is open, h[k] = 1.

    y[i] = sum over k of h[k] x[i - k] / m: each chop is the m-th part of the exposure.
    """
    x, h = draw_inputs(rng)
    same(subject.smear(x, h), flutter.smear(x, h), 1e-5, what="y", kind="curve")


@points(2)
def test_each_channel_moves_in_the_same_way(subject, rng):
    """x has three columns, the channels. Along which axis does the object move?

    Along the first one.

    Smear each column by itself; y is (n + m - 1, 3).
    """
    x, h = draw_inputs(rng, (3,))
    same(subject.smear(x, h), flutter.smear(x, h), 1e-5, what="y in color", picture=True)


@points(2, needs="test_each_open_chop_adds_the_object_where_it_is")
def test_the_light_is_the_open_fraction_of_the_time(subject, rng):
    """The shutter is open for half of the chops. How much of the light arrives?

    Half of it.

    The sum of y is the sum of x, times the number of open chops, divided by m.
    """
    x, h = draw_inputs(rng)
    y = finite(subject.smear(x, h), (len(x) + len(h) - 1,), what="y")
    same(y.sum(), x.sum() * h.mean(), 1e-4 * x.sum(), what="the sum of y")
