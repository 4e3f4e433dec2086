"""Align the photos of a bracket, by a method of `align` or by your own function."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial

import numpy as np

from hdrlab.align.resample import cut, photographs
from hdrlab.align.shift import as_offsets, crop, shift
from hdrlab.core.arrays import F64, Array
from hdrlab.core.bracket import Bracket
from hdrlab.core.filters import warp
from hdrlab.diagnostics.registration import Validation
from hdrlab.diagnostics.warning_texts import warning_text
from hdrlab.errors import InputError
from hdrlab.pipeline import alignment, recovery
from hdrlab.pipeline.assembly import Assembly, Method

# What to do about photos that could not be aligned, depending on the method.
ADVICE_AFTER_MTB = "use --align auto, which also rotates photos, or leave one out"
ADVICE = "leave one out, or use --align none if it was the scene that moved"
ADVICE_ABOUT_GHOSTS = "use --ghosts regions, which shows each thing once, "
# rows of a photo that are shifted at a time
ROWS_PER_COPY = 32


@dataclass(frozen=True, kw_only=True)
class Alignment:
    """Offsets (P, 2) or homographies (P, 3, 3), the validation of each pair of photos, and notes."""

    transforms: Array
    pairs: tuple[Validation, ...] = ()
    notes: tuple[str, ...] = ()


def align_bracket(
    bracket: Bracket,
    align: Method,
    response: Method = "auto",
    in_place: bool = False,
    *,
    removes_ghosts: bool = False,
) -> Assembly:
    """Return the Assembly after alignment by a method's name, your own function or "none".

    `in_place` is the option of `apply_alignment`. Where ghosts will be removed, warnings do not
    recommend it.
    """
    # A homography needs the response, an offset does not. So it is found on demand, and once.
    get_response = cache(partial(find_provisional_response, bracket, response))
    found = estimate_alignment(bracket, align, get_response)
    g = get_response() if found.transforms.ndim == 3 else None
    if align == "mtb":
        advice = ADVICE_AFTER_MTB
    elif removes_ghosts:
        advice = ADVICE
    else:
        advice = ADVICE_ABOUT_GHOSTS + ADVICE
    warnings, notes = describe_pairs(found.pairs, bracket.names, advice)
    is_misaligned = any(pair.is_misaligned and not pair.is_borderline for pair in found.pairs)
    aligned = apply_alignment(bracket, found.transforms, g, in_place=in_place)
    homographies = warp.as_homographies(found.transforms)
    height, width = bracket.images.shape[1:3]
    center = (np.array([width, height]) - 1) / 2
    shifts = warp.apply(homographies, [center])[:, 0] - center
    return Assembly(
        stage="align",
        bracket=aligned,
        offsets=np.rint(shifts).astype(np.int64)[:, ::-1],
        homographies=homographies,
        details=found.notes + notes,
        warnings=warnings,
        is_misaligned=is_misaligned,
    )


def describe_pairs(
    pairs: Sequence[Validation], names: Sequence[str], advice: str
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return warnings and notes about pairs of photos: at most one sentence in total.

    A pair of which nothing is known is no reason for a warning: it stays as it is, and where its
    neighbors did not move either this is where it belongs.
    """
    doubtful = [pair for pair in pairs if pair.is_misaligned]
    if doubtful and all(pair.is_borderline for pair in doubtful):
        pair_names = _name_pairs(doubtful, names)
        return (warning_text("borderline", pair=pair_names, advice=advice),), ()
    misaligned = [pair for pair in pairs if pair.apart and not pair.is_borderline]
    if misaligned:
        warning = warning_text(
            "misaligned",
            pair=_name_pairs(misaligned, names),
            reason=misaligned[0].failure,
            advice=advice,
        )
        return (warning,), ()
    unconfirmed = [pair for pair in doubtful if not pair.is_borderline]
    if unconfirmed:
        names_of_pairs = _name_pairs(unconfirmed, names)
        return (warning_text("unconfirmed", pair=names_of_pairs, advice=advice),), ()
    unknown = [pair for pair in pairs if not pair.known]
    something_moved = any(np.any(pair.step != np.eye(3)) for pair in pairs)
    if unknown and something_moved:
        return (), (warning_text("not_aligned", pair=_name_pairs(unknown, names)),)
    return (), ()


def _name_pairs(pairs: Sequence[Validation], names: Sequence[str]) -> str:
    """Return the names of the first pair, and how many more there are."""
    first = pairs[0]
    text = f"{names[first.moving]} and {names[first.fixed]}"
    more = len(pairs) - 1
    if more == 1:
        return f"{text} (and 1 more pair)"
    if more > 1:
        return f"{text} (and {more} more pairs)"
    return text


def estimate_alignment(
    bracket: Bracket, align: Method, get_response: Callable[[], F64 | None]
) -> Alignment:
    """Return the Alignment of a bracket by a method's name, your own function or "none"."""
    images = bracket.images
    if align == "none":
        return Alignment(transforms=np.zeros((len(images), 2), np.int64))
    if callable(align):
        transforms = np.asarray(align(images))
        if transforms.ndim == 3:
            return Alignment(transforms=warp.as_homographies(transforms, len(images)))
        return Alignment(transforms=as_offsets(transforms, len(images)))
    found = alignment.register(images, align, times=bracket.times, g=get_response)
    if found.method in ("none", "mtb"):
        offsets = found.homographies[:, 1::-1, 2].astype(np.int64)
        return Alignment(transforms=offsets, pairs=found.pairs)
    notes: tuple[str, ...] = ()
    if align == "auto":
        notes = (
            f'aligned by "{found.method}", because no shift by whole pixels aligns the photos',
        )
    return Alignment(transforms=found.homographies, pairs=found.pairs, notes=notes)


def find_provisional_response(bracket: Bracket, response: Method) -> F64 | None:
    """Return a response from the histograms of photos that are not aligned [Cerman06 sec. 6].

    Your own function finds its own. The result is None if no pixel is well exposed in two photos:
    alignment works without a response, too.
    """
    if callable(response):
        method = response
    elif response == "linear" or (response == "auto" and bracket.linear):
        method = recovery.find_validated_method("linear")
    else:
        method = recovery.find_validated_method("debevec")
    if not callable(response):
        bracket = recovery.thin_photos(bracket)
    try:
        g = method(bracket.images, bracket.times, valid=bracket.valid)
    except InputError:
        return None
    return np.asarray(g, np.float64)


def apply_alignment(
    bracket: Bracket, transforms: Array, g: F64 | None = None, *, in_place: bool = False
) -> Bracket:
    """Return the bracket with aligned images and masks, cropped to the area that all photos show.

    Offsets (P, 2) shift the images without changing pixel values; with `in_place`, the result is in
    the memory of the images, which are lost. Homographies (P, 3, 3) resample the radiance of the
    images by the response g.
    """
    images = bracket.images
    valid = bracket.valid
    if transforms.ndim == 3:
        images, valid = photographs(images, transforms, g, valid=valid)
        return replace(bracket, images=images, valid=valid)
    if valid is not None:
        valid = shift(valid, transforms)
    images = shift_in_place(images, transforms) if in_place else shift(images, transforms)
    return replace(bracket, images=images, valid=valid)


def shift_in_place(images: Array, offsets: Array) -> Array:
    """Return `shift(images, offsets)` in the memory of the images, which are lost."""
    area = crop(offsets, images.shape[1:3])
    shape = images[:, *area].shape
    shifted_images = images.reshape(-1)[: np.prod(shape)].reshape(shape)
    for shifted, image, offset in zip(shifted_images, images, offsets.tolist(), strict=True):
        # No row moves beyond the place where it came from, so a few rows at a time are safe.
        for top in range(0, len(shifted), ROWS_PER_COPY):
            rows = slice(top, top + ROWS_PER_COPY)
            shifted[rows] = cut(image, offset, area)[rows]
    return shifted_images
