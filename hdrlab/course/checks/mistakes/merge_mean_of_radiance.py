"""A wrong merge: mean of radiance."""

from hdrlab.radiance import merge as merging

TASK = "merge"
MISCONCEPTION = (
    "You average the radiances; asked is the mean of their logarithms, which one bright outlier moves less."
)


def merge(images, times, g, w=None):
    return merging.merge_with_quality(images, times, g, w, method="mean", repair=False).E
