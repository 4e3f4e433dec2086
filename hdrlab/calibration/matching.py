"""The gamma and the black of a screen by eye: two matches on the screen itself, no instrument.

v        pixel value                   0 to 1, the code divided by 255
gamma    exponent of the screen
b        black                         light of v = 0, room light included; 1 = light of v = 1
F        light that reaches the eye    F = b + (1 - b) v^gamma, 1 = white
gray     v of a gray as bright as rows of black and white, one pixel high each
dark     mean v of the darkest patch that can be told from black
w        threshold of the eye          smallest visible difference, as a fraction of the light around it

The rows emit (F(0) + F(1)) / 2 on average. For the gray this means b + (1 - b) gray^gamma = (1 + b) / 2,
and so gray^gamma = 1/2: the black cancels, and the match measures gamma alone. Every match of
mixtures on one screen does so, because the black is added to both sides. So the black needs the
threshold of the eye: a patch of light x = dark^gamma on black is just visible if (1 - b) x = w b.

How far the results can be trusted: two lights look equal within about 2 %, which is 3 % of gamma.
The threshold w is 0.02 for a black of 2 cd/m2, 0.01 at 20 and 0.04 at 0.3 [DICOM PS3.14, the gray
scale standard display function], and nobody knows the black's luminance without an instrument. So
the black is known to a factor of 2, and the stops from black to white to 1 stop. A screen that
is no power law in the dark, such as one with the straight piece of sRGB, has a larger black than
this module finds.
"""

from dataclasses import dataclass

import numpy as np

from hdrlab.core.arrays import F64, Array, ArrayLike
from hdrlab.errors import InputError

MAX_CODE = 255
# w, and the w of a bright and of a dark room
THRESHOLD = 0.02
THRESHOLD_RANGE = (0.01, 0.04)
# relative difference between two lights that look equal
MATCH_ERROR = 0.02
# Stops from black to white for which settings are given: below, no picture can be shown; above,
# light that the eye itself scatters covers the black.
SETTING_STOPS = (4.0, 12.0)
SETTING_STEPS_PER_STOP = 2


@dataclass(frozen=True)
class Screen:
    """A screen in the light of its room.

    Attributes
    ----------
    gamma : exponent from pixel value to light
    black : b, the light of black as a fraction of white

    Examples
    --------
    >>> Screen(gamma=2.2, black=1 / 64).stops
    6.0
    """

    gamma: float
    black: float

    @property
    def stops(self) -> float:
        """Stops from black to white, log2(1 / b)."""
        return float(np.log2(1 / self.black))


def screen_light(v: ArrayLike, screen: Screen) -> F64:
    """Return F = b + (1 - b) v^gamma, the light that reaches the eye; 1 = white.

    Examples
    --------
    >>> screen_light([0, 0.5, 1], Screen(gamma=2.0, black=0.2)).round(3)
    array([0.2, 0.4, 1. ])
    """
    return screen.black + (1 - screen.black) * np.asarray(v, np.float64) ** screen.gamma


def gamma_of_match(gray: float) -> float:
    """Return gamma = ln(1/2) / ln(gray), from gray^gamma = 1/2.

    Examples
    --------
    >>> round(gamma_of_match(186 / 255), 2)
    2.2
    """
    return float(np.log(0.5) / np.log(gray))


def dithered_light(v: ArrayLike, gamma: float) -> F64:
    """Return the mean light of a patch whose pixels have the two codes next to v; black is left out.

    On a dark screen, code 1 is far above the threshold. A patch in which only some pixels have this
    code is darker.
    """
    codes = np.arange(MAX_CODE + 1)
    return np.interp(np.multiply(MAX_CODE, v), codes, (codes / MAX_CODE) ** gamma)


def black_of_threshold(dark: float, gamma: float, *, threshold: float = THRESHOLD) -> float:
    """Return b = x / (x + w), from (1 - b) x = w b, where x is the light of the darkest visible patch.

    Examples
    --------
    >>> round(black_of_threshold(8 / 255, 2.2), 3)
    0.024
    """
    x = dithered_light(dark, gamma)
    return float(x / (x + threshold))


def measure(gray: float, dark: float, *, threshold: float = THRESHOLD) -> Screen:
    """Return the gamma and the black of the screen on which a reader made two matches.

    Parameters
    ----------
    gray : pixel value, 0 to 1, that is as bright as rows of black and white
    dark : mean pixel value, 0 to 1, of the darkest patch that can be told from black
    threshold : w, the smallest visible difference, as a fraction of the light of black

    Returns
    -------
    Screen

    Raises
    ------
    InputError
        For pixel values that are not between 0 and 1, a dark patch that is not darker than the
        gray, or a threshold that is not positive.

    Examples
    --------
    >>> screen = measure(186 / 255, 8 / 255)
    >>> round(screen.gamma, 2), round(screen.stops, 1)
    (2.2, 5.4)
    """
    if not 0 < dark < gray < 1:
        raise InputError(f"expected 0 < dark < gray < 1, got dark={dark} and gray={gray}")
    if not 0 < threshold < np.inf:
        raise InputError(f"expected a threshold above 0, such as 0.02, got {threshold}")
    gamma = gamma_of_match(gray)
    return Screen(gamma, black_of_threshold(dark, gamma, threshold=threshold))


def stops_range(gray: float, dark: float) -> tuple[float, float]:
    """Return the fewest and the most stops from black to white, for the thresholds of most rooms.

    Examples
    --------
    >>> [round(stops, 1) for stops in stops_range(186 / 255, 8 / 255)]
    [4.4, 6.3]
    """
    low, high = THRESHOLD_RANGE
    fewest = measure(gray, dark, threshold=low).stops
    most = measure(gray, dark, threshold=high).stops
    return fewest, most


def setting_of_contrast(screen: Screen) -> float:
    """Return the contrast, white over black, to which an operator should compress a scene.

    The stops are rounded to a half, because the matches tell no more. Ward's histogram adjustment
    takes this number as its `white`, with its `black` of 1: it then shows nothing with more
    contrast than it has in the scene, and leaves nothing below the screen's own black.

    Examples
    --------
    >>> setting_of_contrast(Screen(gamma=2.2, black=0.015))
    64.0
    """
    steps = np.rint(SETTING_STEPS_PER_STOP * screen.stops)
    return float(2 ** np.clip(steps / SETTING_STEPS_PER_STOP, *SETTING_STOPS))


def encode(Ld: ArrayLike, gamma: float) -> Array:
    """Return the pixel values floor(255 Ld^(1 / gamma) + 0.5) with which a screen shows the light Ld.

    Parameters
    ----------
    Ld : light above the screen's black, 0 to 1; values outside are clipped
    gamma : exponent of the screen

    Returns
    -------
    uint8, shape of Ld

    Examples
    --------
    >>> encode([0, 0.25, 1], 2.0)
    array([  0, 128, 255], dtype=uint8)
    """
    if not 0 < gamma < np.inf:
        raise InputError(f"expected a gamma above 0, such as 2.2, got {gamma}")
    light = np.clip(np.asarray(Ld, np.float64), 0, 1)
    return np.floor(MAX_CODE * light ** (1 / gamma) + 0.5).astype(np.uint8)
