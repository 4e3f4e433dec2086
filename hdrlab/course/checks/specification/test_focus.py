"""Checks of focus(block, noise), the sharpness of a block: a number."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.enhance import battiato

SHAPE = (24, 30)


def draw_inputs(rng):
    """Return a block with noise, steps and spots."""
    y, x = np.indices(SHAPE)
    block = 60 + 50 * (x > rng.integers(8, 20)) + 40 * (y > rng.integers(6, 16))
    return block + 90 * (rng.random(SHAPE) < 0.05) + np.rint(rng.normal(0, 2, SHAPE))


def same_focus(subject, block, what="F", **options):
    F = battiato.focus(block, **options)
    same(subject.focus(block, **options), F, 1e-4 * F, what=what)


@points(3)
def test_without_noise_all_edges_count(subject, rng):
    """How do you measure edges in all directions at once?

    By the Laplacian: the sum of the four neighbors, minus four times the pixel. Its sign says
    which side of an edge a pixel is on.

    Take the mean of its absolute value over all pixels of the block.
    """
    same_focus(subject, draw_inputs(rng), noise=0.0, what="F for a noise of 0")


@points(4)
def test_values_that_noise_explains_count_as_0(subject, rng):
    """A flat wall has noise, and so a Laplacian. Is it sharp?

    No: values of at most `noise` are no edges.

    Set them to 0, and divide by the number of all pixels of the block.
    """
    for noise in (20.0, float(rng.uniform(45, 65))):
        same_focus(subject, draw_inputs(rng), noise=noise, what=f"F for a noise of {noise:.3g}")


@points(3)
def test_the_edge_of_the_block_is_no_edge_of_the_scene(subject, rng):
    """A pixel in the first row has no neighbor above. What stands in for it?

    The pixel itself, so that a block of one value has no edges.

    Repeat the first and last rows and columns, for example with np.pad(block, 1, mode="edge").
    """
    flat = np.full(SHAPE, float(rng.integers(80, 200)))
    same(subject.focus(flat, noise=20.0), 0, 1e-9, what="F of a block of one value")
    ramp = (
        flat + 30 * (np.arange(SHAPE[1]) == 0) + 25 * (np.arange(SHAPE[0]) == SHAPE[0] - 1)[:, None]
    )
    same_focus(subject, ramp, noise=10.0, what="F of a block with bright edges")
