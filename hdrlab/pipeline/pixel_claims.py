"""What each photo of a bracket claims about some pixels of the map, and what became of it.

Z        pixel values      (P, M, C), of P photos at M pixels with C channels
W        weights           (P, M, C), those of the merge, relative to the largest one
shares   of the mean       (P, M, C): the sum over the photos is 1 where a photo measures the pixel
claims   exp(g(Z)) / t     (P, M, C), radiance; a bound where a value is clipped or 0
E        radiance          (M, C), the map's

Weights, bounds and means come from `radiance.merge` and `fast.merge`, and each later change from the
function that changed the map. Applied to these pixels alone, they give the map's values again.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from hdrlab.core import colour
from hdrlab.core.arrays import F32, F64, Array, Flags, Indices, Mask
from hdrlab.diagnostics.frame_choice import choose_spread_frames
from hdrlab.diagnostics.noise import Noise
from hdrlab.errors import InputError
from hdrlab.fast.merge import FACTORS, merge_with_quality
from hdrlab.pipeline import dark_pixels
from hdrlab.pipeline.assembly import Assembly
from hdrlab.pipeline.certainty import merge_pixels_with_deviation
from hdrlab.pipeline.deghosting import MAX_COMPARED_PHOTOS, fill_pixels
from hdrlab.pipeline.merging import NOISE_DEVIATIONS, MergeRecord, merge_photos
from hdrlab.radiance.deghosting import regions
from hdrlab.radiance.merge import CLIPPING_LEVEL, METHODS, Quality, as_tables, weigh
from hdrlab.radiance.stuck import neighbours_median

# stops by which a claim may miss the map's radiance, in addition to the noise of its pixel value
CONTRADICTION_STOPS = 0.25
# Only values below this fraction of the range can be those of a black floor.
MAX_FLOOR_FRACTION = 1 / 8
# On a floor, the exposure grows by at least this factor, and the pixel value only by noise.
MIN_FLOOR_EXPOSURE_FACTOR = 8.0
# pixel values of 8-bit photos by which noise may lift the floor
FLOOR_NOISE_LEVELS = NOISE_DEVIATIONS * dark_pixels.MAX_NOISE_LEVELS


class Role(IntEnum):
    """What a photo can measure of a pixel."""

    MEASURED = 0
    # as dark as shorter photos, so that the value is that of the scanner or of noise
    FLOOR = 1
    # 0 in all channels: an upper bound
    BLACK = 2
    # a channel is clipped: a lower bound
    CLIPPED = 3
    # left out, because something moved
    MOVED = 4
    # masked, or outside of the photo
    MASKED = 5


class ChangeKind(IntEnum):
    """Why the map's value is not the mean of the claims."""

    LIMITED = 0
    STUCK = 1
    WHITE = 2
    BLENDED = 3
    FADED = 4
    REWEIGHTED = 5
    DEGLARED = 6


@dataclass(frozen=True, kw_only=True, eq=False)
class Change:
    """A change of some of the pixels after the mean of the claims.

    Attributes
    ----------
    kind : ChangeKind
    is_changed : (M,) bool
    radiance : (M, C) float32, after the change
    """

    kind: ChangeKind
    is_changed: Mask
    radiance: F32


@dataclass(frozen=True, kw_only=True, eq=False)
class PixelClaims:
    """The claims of all photos about M pixels, and how the map's values came from them.

    Attributes
    ----------
    y, x : (M,) int, rows and columns in the map
    levels : (P, M, C) uint8 or uint16, pixel values Z
    weights : (P, M, C), W; 0 where a photo does not count
    shares : (P, M, C), weight times the exposure time's factor, over the sum; 0 if nothing is measured
    claims : (P, M, C), radiance in the unit of the map
    roles : (P, M) uint8, a Role
    contradicts : (P, M) bool, whether a claim contradicts the map's radiance
    mean : (M, C) float32, the mean of the claims; the bounds' if no photo measures a pixel
    changes : what happened after the mean, in this order
    E : (M, C) float32, the map
    s : (M, C) float32, standard deviation, infinite where unknown
    quality : (M,) uint8, flags of `radiance.merge.Quality`
    alternatives : (M, C) float32 for each method of the merge
    """

    y: Indices
    x: Indices
    levels: Array
    weights: F64
    shares: F64
    claims: F64
    roles: Flags
    contradicts: Mask
    mean: F32
    changes: tuple[Change, ...]
    E: F32
    s: F32
    quality: Flags
    alternatives: dict[str, F32]


def luminance(E: Array) -> Array:
    """Return the luminance (...) of radiance (..., C), or radiance itself if C is 1."""
    if E.shape[-1] == 1:
        return np.asarray(E[..., 0])
    return np.asarray(E @ colour.LUMINANCE.astype(E.dtype))


def collect_claims(state: Assembly, y: Indices, x: Indices, noise: Noise | None) -> PixelClaims:
    """Return what all photos claim about the pixels E[y, x] of a map.

    Parameters
    ----------
    state : Assembly
        With a map and its photos.
    y, x : (M,) int
    noise : Noise or None
        Noise of the camera, see `Assembly.sensor_noise`; without it, s is infinite.

    Raises
    ------
    InputError
        If the photos, or the record of the merge, are missing.
    """
    record = require_record(state)
    row = _read_row(state, record, y, x)
    _, t, w, curves, top = as_tables(
        row.photos, row.times, state.g, record.pixel_weights, record.method, CLIPPING_LEVEL
    )
    Z = row.photos.reshape(len(t), 1, len(y), -1)
    weights = weigh(Z, w, top, row.used[..., None])[:, 0]
    totals = np.array([FACTORS[record.method](float(time)).total for time in t])
    shares = weights * totals[:, None, None]
    sums = shares.sum(axis=0)
    shares = np.divide(shares, sums, out=np.zeros_like(shares), where=sums > 0)

    levels = Z[:, 0]
    E = state.E[y, x].reshape(len(y), -1)
    claimed = np.clip(levels, 1, top)
    claims = _expose(claimed, curves) / t[:, None, None] * record.unit_factor
    delta = max(1, round(NOISE_DEVIATIONS * record.noise))
    roles = _find_roles(levels, t, row.shown[:, 0], row.used[:, 0], top)
    trace = _trace_changes(row, noise)
    return PixelClaims(
        y=y,
        x=x,
        levels=levels,
        weights=weights / w.max(),
        shares=shares,
        claims=claims,
        roles=roles,
        contradicts=_find_contradictions(state, levels, curves, t, E, roles, top, delta),
        mean=trace.mean,
        changes=tuple(trace.changes),
        E=E,
        s=trace.s,
        quality=state.quality[y, x],
        alternatives=trace.alternatives,
    )


def require_record(state: Assembly) -> MergeRecord:
    """Return the record of a merge, or raise an InputError if its photos are not there."""
    if state.record is None or len(state.bracket.images) != len(state.bracket.times):
        raise InputError(
            "the photos of this map are not kept, so its pixels cannot be explained; "
            "assemble it again without `release`, and up to the stage merge"
        )
    return state.record


def _expose(levels: Array, curves: F64) -> F64:
    """Return the exposure (P, M, C) of pixel values."""
    return np.asarray(np.exp(curves[levels, np.arange(levels.shape[-1])]))


def _find_roles(levels: Array, t: F64, shown: Mask, used: Mask, top: int) -> Flags:
    """Return the Role (P, M) of each photo."""
    is_clipped = (levels >= top).any(axis=-1)
    is_black = (levels == 0).all(axis=-1)
    is_floor = _find_floor(levels, t, shown & ~is_clipped)
    roles = np.full(shown.shape, Role.MEASURED, np.uint8)
    roles[is_floor] = Role.FLOOR
    roles[is_black] = Role.BLACK
    roles[is_clipped] = Role.CLIPPED
    roles[~used] = Role.MOVED
    roles[~shown] = Role.MASKED
    return roles


def _find_floor(levels: Array, t: F64, is_open: Mask) -> Mask:
    """Return where photos (P, M) show only a black floor.

    From the shortest photo on, their values stay near the lowest one, while the exposure grows by
    MIN_FLOOR_EXPOSURE_FACTOR or more. So these values do not depend on the light.
    """
    highest = np.iinfo(levels.dtype).max
    cap = MAX_FLOOR_FRACTION * (highest + 1)
    tolerance = FLOOR_NOISE_LEVELS if levels.dtype == np.uint8 else 257 * FLOOR_NOISE_LEVELS
    pixels = is_open.shape[1]
    lowest = np.full(levels.shape[1:], highest, np.int64)
    goes_on = np.ones(pixels, bool)
    is_low = np.zeros(is_open.shape, bool)
    first = np.full(pixels, np.inf)
    last = np.zeros(pixels)
    for j in np.argsort(t, kind="stable"):
        is_near = (levels[j] <= lowest + tolerance).all(axis=-1) & (levels[j] < cap).all(axis=-1)
        goes_on &= is_near | ~is_open[j]
        is_low[j] = goes_on & is_open[j]
        lowest[is_low[j]] = np.minimum(lowest, levels[j])[is_low[j]]
        first = np.where(is_low[j], np.minimum(first, t[j]), first)
        last = np.where(is_low[j], t[j], last)
    return np.asarray(is_low & (last >= MIN_FLOOR_EXPOSURE_FACTOR * first))


def _find_contradictions(
    state: Assembly,
    levels: Array,
    curves: F64,
    t: F64,
    E: F32,
    roles: Flags,
    top: int,
    delta: int,
) -> Mask:
    """Return whether each photo's claim (P, M) contradicts the map, beyond noise."""
    factor = require_record(state).unit_factor / t[:, None, None]
    values = levels.astype(np.int64)
    low_levels = np.clip(values - delta, 1, top - 1)
    high_levels = np.clip(values + delta, 1, top - 1)
    low = luminance(_expose(low_levels, curves) * factor)
    high = luminance(_expose(high_levels, curves) * factor)
    bound = luminance(_expose(np.clip(values, 1, top), curves) * factor)
    is_clipped = (levels >= top).any(axis=-1)
    is_black = (levels == 0).all(axis=-1)
    low = np.where(is_clipped, bound, low)
    low[is_black] = 0
    high[is_clipped] = np.inf
    tolerance = 2**CONTRADICTION_STOPS
    L = luminance(E.astype(np.float64))
    contradicts = (low > tolerance * L) | (high * tolerance < L)
    return np.asarray(contradicts & (roles != Role.MASKED))


@dataclass(kw_only=True, eq=False)
class _Trace:
    """How the radiance of one row of pixels changes; `values` (1, M[, 3]) is the present one."""

    values: F32
    mean: F32
    changes: list[Change]
    s: F32
    alternatives: dict[str, F32]

    def change(self, kind: ChangeKind, values: F32, is_open: Mask) -> None:
        """Replace the values where `is_open` (M,), and note where they differ."""
        flat_old = self.values.reshape(len(is_open), -1)
        flat_new = values.reshape(len(is_open), -1)
        is_changed = is_open & (flat_old != flat_new).any(axis=-1)
        if not is_changed.any():
            return
        radiance = np.where(is_changed[:, None], flat_new, flat_old).astype(np.float32)
        self.values = radiance.reshape(self.values.shape)
        self.changes.append(Change(kind=kind, is_changed=is_changed, radiance=radiance))


@dataclass(frozen=True, kw_only=True, eq=False)
class _PixelRow:
    """The M pixels as an image of one row, which the functions of the merge take.

    Attributes
    ----------
    state, record : the Assembly, and the record of its merge
    y, x : (M,) int, rows and columns in the map
    photos : (P, 1, M[, 3]) uint8 or uint16
    shown : (P, 1, M) bool, the photos that show each pixel
    used : (P, 1, M) bool, those of them that removal of ghosts left
    compared : (Q,) int, the photos that removal of ghosts looked at
    """

    state: Assembly
    record: MergeRecord
    y: Indices
    x: Indices
    photos: Array
    shown: Mask
    used: Mask
    compared: Indices

    @property
    def times(self) -> F64:
        """Exposure times (P,) in seconds."""
        return self.state.bracket.times

    @property
    def is_mixed(self) -> Mask:
        """Whether only some of the photos that show a pixel make it (M,)."""
        return np.asarray((self.used != self.shown).any(axis=0)[0])

    def merge(self, method: str, *, limited: bool) -> F32:
        """Return the merge (1, M[, 3]) of the photos that make each pixel.

        If `limited`, the longest photo limits what is dark, see `merge_photos`.
        """
        is_mixed = self.is_mixed
        E = self._merge_photos(np.arange(len(self.photos)), self.shown, method, limited=limited)
        if is_mixed.any():
            still = self._merge_photos(self.compared, self.used, method, limited=limited)
            E[:, is_mixed] = still[:, is_mixed]
        return E

    def merge_shown(self) -> F32:
        """Return the merge of all photos that show a pixel, also of those that were left out."""
        everything = np.arange(len(self.photos))
        return self._merge_photos(everything, self.shown, self.record.method, limited=True)

    def _merge_photos(self, chosen: Indices, valid: Mask, method: str, *, limited: bool) -> F32:
        """Merge some photos by the functions of the pipeline. Stuck pixels stay as they are."""
        photos = self.photos[chosen]
        times = self.times[chosen]
        g = self.state.g
        weights = self.record.pixel_weights
        if not limited:
            return merge_with_quality(
                photos, times, g, weights, method=method, valid=valid[chosen], repair=False
            ).E
        return merge_photos(
            photos,
            times,
            g,
            weights,
            method=method,
            noise=self.record.noise,
            valid=valid[chosen],
            repair=False,
        ).E


def _read_row(state: Assembly, record: MergeRecord, y: Indices, x: Indices) -> _PixelRow:
    """Return the pixels E[y, x] of all photos as a row."""
    photos = state.bracket.images[:, y, x][:, None]
    shown = np.ones(photos.shape[:3], bool)
    if state.bracket.valid is not None:
        shown = state.bracket.valid[:, y, x][:, None]
    used = shown if record.used is None else record.used[:, y, x][:, None]
    return _PixelRow(
        state=state,
        record=record,
        y=y,
        x=x,
        photos=photos,
        shown=shown,
        used=used,
        compared=choose_spread_frames(state.bracket.times, MAX_COMPARED_PHOTOS),
    )


def _trace_changes(row: _PixelRow, noise: Noise | None) -> _Trace:
    """Repeat the merge of a row of pixels, and each step after it."""
    state = row.state
    record = row.record
    count = len(row.y)
    factor = np.float32(record.unit_factor)
    mean = row.merge(record.method, limited=False)
    alternatives = {}
    for method in METHODS:
        limited = row.merge(method, limited=True)
        alternatives[method] = (limited * factor).reshape(count, -1)
    trace = _Trace(
        values=mean,
        mean=(mean * factor).reshape(count, -1),
        changes=[],
        s=np.full((count, row.photos[0, 0, 0].size), np.inf, np.float32),
        alternatives=alternatives,
    )
    is_stuck = state.quality[row.y, row.x] == Quality.STUCK
    trace.change(ChangeKind.LIMITED, row.merge(record.method, limited=True), ~is_stuck)
    if is_stuck.any():
        trace.change(ChangeKind.STUCK, _repair_stuck(row, trace.values, is_stuck), is_stuck)
    if row.is_mixed.any():
        _blend_regions(row, trace)
    elif record.certainty is not None:
        faded = _fade(trace.values, record, record.certainty[row.y, row.x])
        trace.change(ChangeKind.FADED, faded, np.ones(count, bool))
    if noise is not None:
        _measure_deviation(row, trace, noise)
    if state.glare is not None:
        from_map = state.E[row.y, row.x][None] / factor
        trace.change(ChangeKind.DEGLARED, from_map, state.glare[row.y, row.x])
    trace.s *= factor
    # Every radiance is stated in the unit of the map, so that the unit is no change.
    trace.changes = [
        Change(kind=change.kind, is_changed=change.is_changed, radiance=change.radiance * factor)
        for change in trace.changes
    ]
    return trace


def _repair_stuck(row: _PixelRow, values: F32, is_stuck: Mask) -> F32:
    """Return a row of pixels in which the stuck ones are the median of their neighbors."""
    repaired = values.copy()
    for i in np.flatnonzero(is_stuck):
        mixed = bool(row.is_mixed[i])
        repaired[0, i] = _repair(row.state, row.record, int(row.y[i]), int(row.x[i]), mixed=mixed)
    return repaired


def _fade(E: F32, record: MergeRecord, certainty: F32) -> F32:
    """Return one row of pixels whose color fades where it is uncertain."""
    return dark_pixels.fade_to_neutral(E, certainty[None], neutral=record.neutral)


def _repair(state: Assembly, record: MergeRecord, y: int, x: int, *, mixed: bool) -> F32:
    """Return the median of the neighbors of a stuck pixel, as `radiance.stuck` computes it."""
    rows = slice(max(y - 1, 0), y + 2)
    columns = slice(max(x - 1, 0), x + 2)
    masks = record.used if mixed else state.bracket.valid
    window = merge_with_quality(
        state.bracket.images[:, rows, columns],
        state.bracket.times,
        state.g,
        record.pixel_weights,
        method=record.method,
        valid=None if masks is None else masks[:, rows, columns],
        repair=False,
    ).E
    is_center = np.zeros(window.shape[:2], bool)
    is_center[y - rows.start, x - columns.start] = True
    planes = window.reshape(*window.shape[:2], -1)
    return np.asarray(neighbours_median(planes, is_center)[0].reshape(window.shape[2:]), np.float32)


def _blend_regions(row: _PixelRow, trace: _Trace) -> None:
    """Repeat what `deghosting.remove_ghosts` does after the merge of the photos that it uses."""
    state = row.state
    record = row.record
    if record.alpha is None or record.references is None or state.moving is None:
        raise InputError("the record of the merge has no regions; assemble the photos again")
    is_mixed = row.is_mixed
    compared = row.compared
    numbers = np.searchsorted(compared, record.references)
    reference = np.concatenate([[-1], numbers])[state.moving[row.y, row.x]].astype(np.int32)
    tables = as_tables(row.photos, row.times, state.g, None, record.method, CLIPPING_LEVEL)
    top = tables[4]
    white = fill_pixels(
        row.photos[compared],
        row.times[compared],
        state.g,
        row.used[compared],
        row.shown[compared],
        reference[None],
        top,
    ).white
    whitened = np.where(white > 0, white, trace.values)
    trace.change(ChangeKind.WHITE, whitened, is_mixed)

    alpha = np.where(is_mixed, record.alpha[row.y, row.x], 0)
    certainty = np.ones(len(row.y), np.float32)
    if record.certainty is not None:
        certainty = record.certainty[row.y, row.x]
    plain = row.merge_shown()
    faded_plain = np.where(
        _column(is_mixed, plain), _fade(plain, record, certainty), trace.values
    ).astype(np.float32)
    blended = regions.blend(faded_plain, trace.values, alpha[None].astype(np.float32))
    trace.change(ChangeKind.BLENDED, blended, is_mixed & (alpha < 1))
    # Where the region changed nothing, the map around it is as it was, and has already faded.
    is_same = (faded_plain == trace.values).reshape(len(row.y), -1).all(axis=-1)
    is_old = is_mixed & is_same
    faded = _fade(trace.values, record, np.where(is_old, np.float32(1), certainty))
    trace.change(ChangeKind.FADED, faded, np.ones(len(row.y), bool))


def _column(mask: Mask, like: Array) -> Mask:
    """Return a mask (M,) that can be broadcast to one row of pixels (1, M[, 3])."""
    return mask[None] if like.ndim == 2 else mask[None, :, None]


def _measure_deviation(row: _PixelRow, trace: _Trace, noise: Noise) -> None:
    """Compute s, and repeat the merge by inverse variance if the map was made by it."""
    state = row.state
    is_unknown = state.quality[row.y, row.x] != Quality.MEASURED
    for layer in (state.moving, state.glare):
        if layer is not None:
            is_unknown |= layer[row.y, row.x] > 0
    sure = merge_pixels_with_deviation(row.photos, row.shown, row.times, state.g, noise)
    s = sure.s.reshape(len(row.y), -1)
    s[is_unknown] = np.inf
    trace.s = s
    if state.s is not None:
        is_finite = np.isfinite(s).reshape(trace.values.shape)
        values = np.where(is_finite, sure.E, trace.values)
        trace.change(ChangeKind.REWEIGHTED, values, np.ones(len(row.y), bool))
