"""Known mistakes in `label`, the task of hdrlab.radiance.deghosting.regions.label."""

import numpy as np
from scipy import ndimage

from hdrlab.course.checks.mistakes import mistake
from hdrlab.radiance.deghosting.regions import CONNECTED


@mistake(
    "label_corners_apart",
    says="Pixels that touch in a corner are two parts in your labels: a pixel has eight "
    "neighbours, not four.",
)
def corners_apart(mask):
    return ndimage.label(mask)[0].astype(np.int32)


@mistake(
    "label_from_0_on",
    says="Your outside has a label like a part: it is 0, and the parts are numbered from 1 on.",
)
def from_0_on(mask):
    return ndimage.label(mask, CONNECTED)[0].astype(np.int32) + 1
