"""You use the hat whatever w is given; look the weights up in w, and take the hat where it is None."""

from hdrlab.radiance import merge as merging


def merge(images, times, g, w=None):
    return merging.merge(images, times, g)
