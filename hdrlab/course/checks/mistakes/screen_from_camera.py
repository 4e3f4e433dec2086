"""Known mistakes in `screen_from_camera`, the task of hdrlab.capture.development.screen_from_camera."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "screen_from_camera_not_normalized",
    says="You inverted A without dividing its rows by their sums. White balance was applied before, "
    "so that C changes the color of white.",
    misses_method=True,
)
def not_normalized(M, P):
    return np.linalg.inv(np.asarray(M) @ P)


@mistake(
    "screen_from_camera_normalized_after_inverting",
    says="You divide the rows of the inverse by their sums. Gray stays gray, but colors are wrong: "
    "divide the rows of A before you invert it.",
    misses_method=True,
)
def normalized_after_inverting(M, P):
    C = np.linalg.inv(np.asarray(M) @ P)
    return C / C.sum(axis=1, keepdims=True)


@mistake(
    "screen_from_camera_not_inverted",
    says="Your matrix takes the screen's RGB to the camera's channels. C is the other direction: "
    "invert it.",
    misses_method=True,
)
def not_inverted(M, P):
    A = np.asarray(M) @ P
    return A / A.sum(axis=1, keepdims=True)


@mistake(
    "screen_from_camera_matrices_swapped",
    says="You multiply the matrices in the wrong order. P comes first, from RGB to XYZ, and M second: "
    "as a product, A = M P.",
    misses_method=True,
)
def matrices_swapped(M, P):
    A = np.asarray(P) @ M
    return np.linalg.inv(A / A.sum(axis=1, keepdims=True))
