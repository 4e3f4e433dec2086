"""Checks of refine(X, start, reach), the motion between two photos near a start: (dy, dx, r phi)."""

import numpy as np

from hdrlab.align import cerman
from hdrlab.course.checks.compare import points, same

SHAPE = (44, 56)
# half of the diagonal, pixels
RADIUS = np.hypot(*SHAPE) / 2
# pixels: how far searches for the same minimum may end apart
TOLERANCE = 0.1
# the light outside of a window, compared with that of the room
SKY_LIGHT = 60
WAVE_COUNT = 14


def move(motion, x, y):
    """Return where pixels (x, y) of the moving photo lie on the fixed one."""
    dy, dx, arc = motion
    phi = arc / RADIUS
    u = x - (SHAPE[1] - 1) / 2
    v = y - (SHAPE[0] - 1) / 2
    moved_x = np.cos(phi) * u - np.sin(phi) * v + (SHAPE[1] - 1) / 2 + dx
    moved_y = np.sin(phi) * u + np.cos(phi) * v + (SHAPE[0] - 1) / 2 + dy
    return moved_x, moved_y


class Scene:
    """Light that varies smoothly, known at every place, not only at whole pixels."""

    def __init__(self, rng):
        self.angles = rng.uniform(0, np.pi, WAVE_COUNT)
        self.lengths = rng.uniform(9, 30, WAVE_COUNT)
        self.phases = rng.uniform(0, 2 * np.pi, WAVE_COUNT)

    def light(self, x, y):
        total = np.zeros(np.shape(x))
        for angle, length, phase in zip(self.angles, self.lengths, self.phases, strict=True):
            along = x * np.cos(angle) + y * np.sin(angle)
            total += np.cos(2 * np.pi * along / length + phase)
        return np.exp(0.2 * total)


def photograph(scene, motion):
    """Return X (2, h, w), the fixed photo and the moving one."""
    y, x = np.indices(SHAPE).astype(float)
    return np.stack([scene.light(x, y), scene.light(*move(motion, x, y))]).astype(np.float32)


def photograph_window(room, sky, motion, drift):
    """Return X (2, h, w) of a room with a window, behind which bright clouds drift."""
    y, x = np.indices(SHAPE).astype(float)
    moved_x, moved_y = move(motion, x, y)
    inside = window(x, y)
    moved_inside = window(moved_x, moved_y)
    fixed = room.light(x, y) * (1 - inside) + SKY_LIGHT * sky.light(x, y) * inside
    clouds = SKY_LIGHT * sky.light(*move(drift, x, y))
    moving = room.light(moved_x, moved_y) * (1 - moved_inside) + clouds * moved_inside
    return np.stack([fixed, moving]).astype(np.float32)


def window(x, y):
    """Return where the window is: 1 inside, 0 outside."""
    distance = np.hypot(x - 0.6 * SHAPE[1], y - 0.4 * SHAPE[0])
    return 1 / (1 + np.exp((distance - 8) / 0.7))


def draw_motion(rng, turned=True):
    """Return a motion (dy, dx, r phi) of one or two pixels in each of the three."""
    motion = rng.uniform(0.6, 1.8, 3) * rng.choice([-1, 1], 3)
    return motion * [1, 1, turned]


def draw_start(rng):
    """Return a start that is between whole pixels, near no motion at all."""
    return rng.uniform(0.1, 0.4, 3) * rng.choice([-1, 1], 3)


def on_the_sheet(motion):
    """Return a motion (dy, dx, r phi) in the order and with the signs of the sheet."""
    order = [0, 1, 2]
    signs = [1, 1, 1]
    return np.asarray(motion, float)[order] * signs


def same_motion(subject, X, start, motion, what="(dy, dx, r phi)"):
    same(subject.refine(X, on_the_sheet(start)), on_the_sheet(motion), TOLERANCE, what=what)


# a few pixels do not determine a motion
check_one_input = None


@points(7)
def test_a_shift_is_found_to_a_tenth_of_a_pixel(subject, rng):
    """At which motion are the two photos most alike?

    Where the mean of d^2 is smallest. For that you need the moving photo between its pixels.

    Compute the error of one motion as a function of its three numbers. Then let
    scipy.optimize.minimize(..., method="Nelder-Mead") search, from a simplex of about a pixel.
    """
    motion = draw_motion(rng, turned=False)
    X = photograph(Scene(rng), motion)
    same_motion(
        subject, X, draw_start(rng), motion, "(dy, dx, r phi) of a photo that is only shifted"
    )


@points(7)
def test_a_rotation_is_found_with_the_shift(subject, rng):
    """The camera also turned. About which point, and in which direction?

    About the middle, ((w - 1)/2, (h - 1)/2). A positive angle turns clockwise.

    The third number is r phi, with r half of the diagonal, and phi in radians.
    """
    motion = draw_motion(rng)
    same_motion(subject, photograph(Scene(rng), motion), draw_start(rng), motion)


@points(4)
def test_discarded_pixels_take_no_part(subject, rng):
    """A pixel is NaN in one of the photos. What is its d?

    It has none.

    Take the mean over the pixels that both photos have, not over a sum that includes zeros.
    """
    motion = draw_motion(rng)
    X = photograph(Scene(rng), motion)
    X[1, 16:32, :24] = np.nan
    X[0, :10] = np.nan
    X[0, 36:41, 40:48] = np.nan
    same_motion(subject, X, draw_start(rng), motion, "(dy, dx, r phi) with discarded pixels")


@points(4)
def test_the_brightest_part_does_not_decide(subject, rng):
    """Clouds drift behind a window, much brighter than the room. What do the photos follow?

    The clouds, if you take a - b. The room, if you divide it by the light.

    d = (a - b) / ((a + b)/2) is from -2 to 2, whatever the light is.
    """
    motion = draw_motion(rng)
    drift = motion - 1.3 * np.sign(motion)
    X = photograph_window(Scene(rng), Scene(rng), motion, drift)
    start = draw_start(rng)
    expected = cerman.refine(X, start)
    same_motion(subject, X, start, expected, "(dy, dx, r phi) with clouds behind a window")


@points(3)
def test_the_search_begins_at_the_start(subject, rng):
    """The photos are ten pixels apart or more. Does a search that begins at 0 find this?

    No: there are many places where photos fit a little. That is why `start` is given.

    Begin at `start`, with steps of about a pixel.
    """
    motion = rng.uniform(9, 12, 3) * rng.choice([-1, 1], 3) * [1, 1, 0.2]
    start = motion + rng.uniform(-0.8, 0.8, 3)
    X = photograph(Scene(rng), motion)
    same_motion(subject, X, start, motion, "(dy, dx, r phi) of photos that are far apart")
