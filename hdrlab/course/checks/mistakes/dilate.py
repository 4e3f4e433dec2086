"""Known mistakes in `dilate`, the task of hdrlab.radiance.deghosting.regions.dilate."""

from scipy import ndimage

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "dilate_holes_left",
    says="The inside of the figure is missing in your mask: fill the holes that the outline "
    "encloses.",
)
def holes_left(mask, margin):
    if not mask.any():
        return mask
    return ndimage.distance_transform_edt(~mask) <= margin


@mistake(
    "dilate_filled_first",
    says="You fill the holes before the mask is widened: the margin closes gaps of an outline, "
    "so its inside is filled at last.",
)
def filled_first(mask, margin):
    if not mask.any():
        return mask
    return ndimage.distance_transform_edt(~ndimage.binary_fill_holes(mask)) <= margin


@mistake(
    "dilate_square",
    says="Your margin is a square: its corners lie further than `margin` from the mask. "
    "Measure by the straight line.",
)
def square(mask, margin):
    if not mask.any():
        return mask
    return ndimage.binary_fill_holes(ndimage.distance_transform_cdt(~mask) <= margin)


@mistake(
    "dilate_one_too_few",
    says="A pixel that is just `margin` away belongs to the mask: compare with <=, not <.",
)
def one_too_few(mask, margin):
    if not mask.any():
        return mask
    return ndimage.binary_fill_holes(ndimage.distance_transform_edt(~mask) < margin)
