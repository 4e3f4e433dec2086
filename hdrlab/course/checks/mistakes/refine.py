"""Known mistakes in `refine`, the task of hdrlab.align.cerman.refine."""

import numpy as np
import scipy

from hdrlab.align import light
from hdrlab.align.cerman import rigid
from hdrlab.core.filters import warp
from hdrlab.course.checks.mistakes import mistake


def search(error, start):
    corners = np.asarray(start, float) + np.vstack([np.zeros(3), np.eye(3)])
    options = {"initial_simplex": corners, "xatol": 0.01, "fatol": 1e-9}
    return scipy.optimize.minimize(error, start, method="Nelder-Mead", options=options).x


def mean_square(X, H):
    return light.error(light.differences(X, H, light.lattice(X.shape[1:])))


@mistake(
    "refine_opposite",
    says="Your motion moves the fixed photo onto the moving one. It must move the moving photo: "
    "look up the moving photo where the inverse motion takes a pixel of the fixed one.",
)
def opposite(X, start, *, reach=1.0):
    shape = X.shape[1:]
    return search(lambda motion: mean_square(X, np.linalg.inv(rigid(shape, motion))), start)


@mistake(
    "refine_absolute_differences",
    says="You compare a - b, so the brightest parts decide. Divide by the light, (a + b)/2.",
)
def absolute_differences(X, start, *, reach=1.0):
    shape = X.shape[1:]
    p = light.lattice(shape)
    column, row = p.astype(int).T

    def mean_square_difference(motion):
        q = warp.apply(np.linalg.inv(rigid(shape, motion)), p)
        b = scipy.ndimage.map_coordinates(X[1].astype(float), q.T[::-1], order=1, cval=np.nan)
        return light.error(X[0][row, column] - b)

    return search(mean_square_difference, start)


@mistake(
    "refine_in_radians",
    says="Your third number is the angle. It must be r phi, in pixels: multiply the angle by half "
    "of the diagonal.",
)
def in_radians(X, start, *, reach=1.0):
    shape = X.shape[1:]
    best_motion = search(lambda motion: mean_square(X, rigid(shape, motion)), start)
    return best_motion / [1, 1, np.hypot(*shape) / 2]


@mistake(
    "refine_about_the_corner",
    says="You turn the photo about its first pixel. Turn it about its middle, ((w - 1)/2, "
    "(h - 1)/2).",
)
def about_the_corner(X, start, *, reach=1.0):
    shape = X.shape[1:]
    best_motion = search(lambda motion: mean_square(X, rigid(shape, motion)), start)
    H = rigid(shape, best_motion)
    return np.array([H[1, 2], H[0, 2], best_motion[2]])


@mistake(
    "refine_counterclockwise",
    says="Your angle is positive if the photo turns counterclockwise. It must turn clockwise. Note "
    "that y points down.",
)
def counterclockwise(X, start, *, reach=1.0):
    shape = X.shape[1:]
    best_motion = search(lambda motion: mean_square(X, rigid(shape, motion)), start)
    return best_motion * [1, 1, -1]


@mistake(
    "refine_exchanged",
    says="You return (dx, dy, r phi). The order is (dy, dx, r phi): down comes first.",
)
def exchanged(X, start, *, reach=1.0):
    shape = X.shape[1:]
    best_motion = search(lambda motion: mean_square(X, rigid(shape, motion)), start)
    return best_motion[[1, 0, 2]]


@mistake(
    "refine_discarded_are_black",
    says="You set discarded pixels to 0, so they count as black. Leave them out of the mean.",
)
def discarded_are_black(X, start, *, reach=1.0):
    shape = X.shape[1:]
    filled = np.nan_to_num(X)
    return search(lambda motion: mean_square(filled, rigid(shape, motion)), start)
