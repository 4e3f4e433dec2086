"""Known mistakes in `focus`, the task of hdrlab.enhance.battiato.focus."""

import numpy as np
from scipy.ndimage import laplace

from hdrlab.course.checks.mistakes import mistake
from hdrlab.enhance.battiato import NOISE


@mistake(
    "focus_noise_counts",
    says="You count every pixel, so noise looks sharp. Set values of at most `noise` to 0.",
)
def noise_counts(block, *, noise=NOISE):
    return float(np.abs(laplace(block, mode="nearest")).mean())


@mistake(
    "focus_mean_of_the_edges",
    says="You average over the pixels above the noise only. Divide by the number of all pixels.",
)
def mean_of_the_edges(block, *, noise=NOISE):
    edges = np.abs(laplace(block, mode="nearest"))
    return float(edges[edges > noise].mean()) if np.any(edges > noise) else 0.0


@mistake(
    "focus_zeros_around_the_block",
    says="You put zeros around the block, so its border looks like a sharp edge. Repeat the border.",
)
def zeros_around_the_block(block, *, noise=NOISE):
    edges = np.abs(laplace(block, mode="constant"))
    return float(np.where(edges > noise, edges, 0).mean())


@mistake(
    "focus_noise_subtracted",
    says="You subtract the noise from the values above it. Keep these values as they are, and set "
    "only the others to 0.",
)
def noise_subtracted(block, *, noise=NOISE):
    edges = np.abs(laplace(block, mode="nearest"))
    return float(np.maximum(edges - noise, 0).mean())


@mistake(
    "focus_sign_kept",
    says="You do not take the absolute value, so the dark side of an edge is lost. Take |Laplacian|.",
)
def sign_kept(block, *, noise=NOISE):
    edges = laplace(block, mode="nearest")
    return float(np.where(edges > noise, edges, 0).mean())
