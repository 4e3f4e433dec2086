"""Known mistakes in `divergence`, the task of hdrlab.core.filters.poisson.divergence."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "divergence_forward",
    says="You use forward differences, like those of the gradient. The divergence needs backward "
    "differences; otherwise the image shifts by a pixel.",
    misses_method=True,
)
def forward(G):
    Gy = np.pad(G[0], ((0, 1), (0, 0)))
    Gx = np.pad(G[1], ((0, 0), (0, 1)))
    return np.diff(Gy, axis=0) + np.diff(Gx, axis=1)


@mistake(
    "divergence_rolls_around",
    says="np.roll wraps from one border of the image to the other. Before the first row and "
    "column the gradient is 0.",
)
def rolls_around(G):
    Gy = np.vstack([G[0, -2:-1], G[0, :-1], G[0, -2:-1]])
    Gx = np.hstack([G[1, :, -2:-1], G[1, :, :-1], G[1, :, -2:-1]])
    return np.diff(Gy, axis=0) + np.diff(Gx, axis=1)


@mistake(
    "divergence_wrong_sign",
    says="Your divergence has the opposite sign. It is the flow out of a pixel, G(x) - G(x - 1).",
)
def wrong_sign(G):
    Gy = np.pad(G[0, :-1], ((1, 1), (0, 0)))
    Gx = np.pad(G[1, :, :-1], ((0, 0), (1, 1)))
    return -np.diff(Gy, axis=0) - np.diff(Gx, axis=1)


@mistake(
    "divergence_across_the_edges",
    says="You use the last row of Gy and the last column of Gx. These steps lead out of the image, "
    "where nothing flows: use 0 in their place.",
)
def across_the_edges(G):
    Gy = np.pad(G[0], ((1, 0), (0, 0)))
    Gx = np.pad(G[1], ((0, 0), (1, 0)))
    return np.diff(Gy, axis=0) + np.diff(Gx, axis=1)
