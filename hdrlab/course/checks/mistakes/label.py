"""Known mistakes in `label`, the task of hdrlab.radiance.deghosting.regions.label."""

import numpy as np
from scipy import ndimage

from hdrlab.course.checks.mistakes import mistake
from hdrlab.radiance.deghosting.regions import CONNECTED


@mistake(
    "label_corners_apart",
    says="You give different labels to pixels that touch at a corner. A pixel has eight "
    "neighbors, not four.",
)
def corners_apart(mask):
    return ndimage.label(mask)[0].astype(np.int32)


@mistake(
    "label_from_0_on",
    says="You give the pixels outside the mask a label like a region. They get 0, and the regions"
    " are numbered from 1.",
)
def from_0_on(mask):
    return ndimage.label(mask, CONNECTED)[0].astype(np.int32) + 1
