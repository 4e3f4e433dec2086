"""Known mistakes in `tonemap`, the task of hdrlab.tonemap.reinhard.tonemap."""

import numpy as np

from hdrlab.course.checks.mistakes import Question, mistake
from hdrlab.tonemap.reinhard import (
    as_light,
    automatic_key,
    display,
    local_adaptation,
    scale_to_key,
    white_point,
)


@mistake(
    "tonemap_absolute_unit",
    says="Your curve uses absolute L, so the same scene in other units gives another image. Scale"
    " L by its log average first.",
    misses_method=True,
)
def absolute_unit(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    L = as_light(L)
    return L / (1 + L)


@mistake(
    "tonemap_divided_by_the_maximum",
    says="You divide by the brightest pixel, so one hot pixel darkens the whole image. Use a "
    "percentile or a curve.",
    misses_method=True,
)
def divided_by_the_maximum(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    L = as_light(L)
    return (L / max(float(L.max()), 1e-30)) ** (1 / 2.2)


@mistake(
    "tonemap_negative",
    says="Bright regions come out dark: a sign or a quotient is inverted.",
    misses_method=True,
)
def negative(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    L = as_light(L)
    a = automatic_key(L) if key == "auto" else key
    Lm = scale_to_key(L, key=a)
    white = white_point(Lm) if white is None else white
    V1 = local_adaptation(Lm, key=a, phi=phi, threshold=threshold) if local else Lm
    return 1 - np.asarray(display(Lm, V1, white), np.float32)


@mistake(
    "tonemap_not_clipped",
    says="Your image has values outside 0 ... 1. A display cannot show them, and 8-bit files wrap"
    " around. Clip it.",
    questions=(
        Question(
            code="tonemap(np.full((2, 2), 5.0), key=1.0, white=np.inf)[0, 0]",
            why="All pixels are equal, so the log average is 5, and the scaled luminance is "
            "1: 1 / (1 + 1).",
            because=r"$$L_d = \frac",
        ),
        Question(
            code="tonemap(np.full((2, 2), 5.0), key=3.0, white=1.0)[0, 0]",
            why="The scaled luminance is 3. The fraction is 3 (1 + 3) / (1 + 3) = 3, which "
            "is clipped.",
            because="$L_d$ is clipped at 1.",
        ),
        Question(
            code="tonemap(np.array([[1.0, 4.0]]), key=1.0, white=1.0)[0, 1]",
            why="The log average is 2, so the scaled luminance of the second pixel is 2. "
            "The fraction is 2 (1 + 2) / (1 + 2) = 2, which is clipped.",
            because="$L_d$ is clipped at 1.",
        ),
    ),
)
def not_clipped(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    L = as_light(L)
    a = automatic_key(L) if key == "auto" else key
    Lm = scale_to_key(L, key=a)
    white = white_point(Lm) if white is None else white
    V1 = local_adaptation(Lm, key=a, phi=phi, threshold=threshold) if local else Lm
    return np.asarray(Lm * (1 + Lm / white**2) / (1 + V1), np.float32)


@mistake(
    "tonemap_absolute_delta",
    says="You add delta itself to L, whatever the unit of L is. Add delta times the median of the "
    "pixels that are not black.",
)
def absolute_delta(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    L = as_light(L)
    if not np.any(L):
        return np.zeros(L.shape, np.float32)
    Lm = key * L / np.exp(np.log(L + 1e-6).mean(dtype=np.float64))
    white = white_point(Lm) if white is None else white
    V1 = local_adaptation(Lm, key=key, phi=phi, threshold=threshold) if local else Lm
    return np.asarray(display(Lm, V1, white), np.float32)
