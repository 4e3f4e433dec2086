"""Known mistakes in `scale_steps`, the task of hdrlab.tonemap.reinhard.scale_steps."""

from itertools import pairwise

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.tonemap.reinhard import WIDTHS, Scale, response


@mistake(
    "scale_steps_surround_kept",
    says="You never update the surround. At each width, compare the center with the next larger "
    "blur, not always with the same one.",
)
def surround_kept(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    even = np.array(True)
    adaptation = np.zeros(1, np.float32)
    for width, V1 in zip(WIDTHS, blurred[:-1], strict=False):
        V = response(V1, blurred[1], width=width, key=key, phi=phi)
        even = even & (np.abs(V) < threshold)
        adaptation = V1 if width == WIDTHS[0] else np.where(even, V1, adaptation)
        yield Scale(width, V1, V, even, adaptation)


@mistake(
    "scale_steps_index_as_width",
    says="s is the width in pixels: 1, 1.6, 2.56 ... 26.8. You used the index of the step.",
)
def index_as_width(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    def response(V1, V2, *, width, key=0.18, phi=8.0):
        return (V1 - V2) / (2**phi * key / (WIDTHS.index(width) + 1) ** 2 + V1)

    even = np.array(True)
    adaptation = np.zeros(1, np.float32)
    for width, (V1, V2) in zip(WIDTHS, pairwise(blurred), strict=False):
        V = response(V1, V2, width=width, key=key, phi=phi)
        even = even & (np.abs(V) < threshold)
        adaptation = V1 if width == WIDTHS[0] else np.where(even, V1, adaptation)
        yield Scale(width, V1, V, even, adaptation)


@mistake(
    "scale_steps_does_not_stop",
    says="A pixel stops at the first width that is not even. You continue, and take a larger "
    "width beyond an edge that happens to be even again.",
)
def does_not_stop(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    even = np.array(True)
    adaptation = np.zeros(1, np.float32)
    for width, (V1, V2) in zip(WIDTHS, pairwise(blurred), strict=False):
        V = response(V1, V2, width=width, key=key, phi=phi)
        even = np.abs(V) < threshold
        adaptation = V1 if width == WIDTHS[0] else np.where(even, V1, adaptation)
        yield Scale(width, V1, V, even, adaptation)


@mistake(
    "scale_steps_sign_kept",
    says="You compare V itself with the threshold. Next to a lamp, V of a dark pixel is "
    "negative and always below it. Use |V|.",
)
def sign_kept(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    even = np.array(True)
    adaptation = np.zeros(1, np.float32)
    for width, (V1, V2) in zip(WIDTHS, pairwise(blurred), strict=False):
        V = response(V1, V2, width=width, key=key, phi=phi)
        even = even & (V < threshold)
        adaptation = V1 if width == WIDTHS[0] else np.where(even, V1, adaptation)
        yield Scale(width, V1, V, even, adaptation)
