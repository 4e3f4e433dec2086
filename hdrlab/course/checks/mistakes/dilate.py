"""Known mistakes in `dilate`, the task of hdrlab.radiance.deghosting.regions.dilate."""

from scipy import ndimage

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "dilate_holes_left",
    says="Your mask has holes. Fill the holes that the widened mask encloses.",
)
def holes_left(mask, margin):
    if not mask.any():
        return mask
    return ndimage.distance_transform_edt(~mask) <= margin


@mistake(
    "dilate_filled_first",
    says="You fill the holes before you widen the mask. Widening closes gaps in an outline, so "
    "fill the holes last.",
)
def filled_first(mask, margin):
    if not mask.any():
        return mask
    return ndimage.distance_transform_edt(~ndimage.binary_fill_holes(mask)) <= margin


@mistake(
    "dilate_square",
    says="Your margin is a square, whose corners are farther than `margin` from the mask. Use "
    "the Euclidean distance.",
)
def square(mask, margin):
    if not mask.any():
        return mask
    return ndimage.binary_fill_holes(ndimage.distance_transform_cdt(~mask) <= margin)


@mistake(
    "dilate_one_too_few",
    says="A pixel at a distance of exactly `margin` belongs to the mask: compare with <=, not <.",
)
def one_too_few(mask, margin):
    if not mask.any():
        return mask
    return ndimage.binary_fill_holes(ndimage.distance_transform_edt(~mask) < margin)
