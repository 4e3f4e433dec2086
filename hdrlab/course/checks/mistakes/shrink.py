"""Known mistakes in `shrink`, the task of hdrlab.align.mtb.shrink."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "shrink_cuts_fractions",
    says="Truncation makes every pixel darker, by 3/8 on average. Round instead.",
)
def cuts_fractions(Y):
    Y = Y[: len(Y) // 2 * 2, : Y.shape[1] // 2 * 2].astype(np.uint16)
    return ((Y[::2, ::2] + Y[1::2, ::2] + Y[::2, 1::2] + Y[1::2, 1::2]) // 4).astype(np.uint8)


@mistake(
    "shrink_cuts_fractions_twice",
    says="You average pairs and then pairs of pairs, and truncate each time, so every level is "
    "darker. Add all four pixels and round once.",
)
def cuts_fractions_twice(Y):
    Y = Y[: len(Y) // 2 * 2, : Y.shape[1] // 2 * 2].astype(np.uint16)
    return (((Y[::2, ::2] + Y[1::2, ::2]) // 2 + (Y[::2, 1::2] + Y[1::2, 1::2]) // 2) // 2).astype(
        np.uint8
    )


@mistake(
    "shrink_overflows",
    says="The sum of four bytes does not fit into a byte and wraps around, so bright regions "
    "turn dark. Use a wider type.",
)
def overflows(Y):
    Y = Y[: len(Y) // 2 * 2, : Y.shape[1] // 2 * 2]
    return ((Y[::2, ::2] + Y[1::2, ::2] + Y[::2, 1::2] + Y[1::2, 1::2] + 2) // 4).astype(np.uint8)


@mistake(
    "shrink_skips_pixels",
    says="You take every second pixel and drop the others, so noise stays and fine texture "
    "causes aliasing. Average four pixels.",
    misses_method=True,
)
def skips_pixels(Y):
    Y = Y[: len(Y) // 2 * 2, : Y.shape[1] // 2 * 2].astype(np.uint16)
    return Y[::2, ::2].astype(np.uint8)
