"""Something moves while the bracket is taken: photographs that contradict each other, and the truth of each.

E      radiance of the still scene       (H, W[, 3]) float32, any linear unit
light  radiance of the figure            (H, W[, 3]), the same unit, already multiplied by the mask
mask   share of a pixel that it hides    (H, W), 0 to 1
at     where the figure stands           (P, 2) int, (dy, dx) pixels down and right of its place in its layer
E_j    radiance that frame j saw         light_j + (1 - mask_j) E

The embedded places bring a visitor: `Figure(place.mover, place.mask)` of `scenes.layers`.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hdrlab.capture import camera
from hdrlab.capture.hand_motion import views
from hdrlab.capture.sensor import Seed
from hdrlab.core.arrays import F32, Array, ArrayLike, Mask, NDArray, as_radiance, as_times, describe
from hdrlab.core.bracket import Bracket, bracket, short_to_long
from hdrlab.errors import InputError

# (y, x, z), where a ball is lit from: above, left and the camera's side
SUN_DIRECTION = np.array([-0.5, -0.5, 0.7])


class Figure(NamedTuple):
    """What moves: its light (H, W[, 3]), multiplied by its mask (H, W)."""

    light: F32
    mask: F32


@dataclass(frozen=True, kw_only=True, eq=False)
class Moving:
    """A bracket of a scene in which a figure moves, and the truth.

    Attributes
    ----------
    bracket : the photographs, from short to long
    still : (h, w[, 3]), radiance of the scene without the figure, as a frame of offset (0, 0) would
        see it
    moments : (P, h, w[, 3]), radiance that each photograph saw
    hidden : (P, h, w) bool, where the figure changed what a photograph saw
    """

    bracket: Bracket
    still: F32
    moments: F32
    hidden: Mask

    @property
    def region(self) -> Mask:
        """Where the figure stands in any of the photographs, (h, w): of a camera that stood still."""
        return np.any(self.hidden, axis=0)


def ball(
    shape: tuple[int, int],
    centre: ArrayLike,
    radius: float,
    radiance: ArrayLike = 1.0,
    *,
    stripes: int = 4,
) -> Figure:
    """Return a striped ball lit from above, whose brightest point has this radiance.

    Its edge is a pixel wide, and the share of a pixel that it hides is exact to a few per cent.

    Parameters
    ----------
    shape : (H, W), pixels, of the layer
    centre : (y, x), pixels, and `radius` likewise
    radiance : one number for (H, W), three for (H, W, 3)
    stripes : how many dark bands it has; 0 is a plain ball

    Raises
    ------
    ValueError
        For a radius that is not positive, or radiance that is not one or three positive numbers.

    Examples
    --------
    >>> thrown = ball((40, 60), (20, 10), 6, [4.0, 1.0, 0.5])
    >>> thrown.light.shape, float(thrown.mask.max())
    ((40, 60, 3), 1.0)
    """
    colour = np.asarray(radiance, np.float32)
    middle = np.asarray(centre, float)
    if colour.shape not in ((), (3,)) or not np.all((colour > 0) & (colour < np.inf)):
        raise InputError(f"expected one positive radiance or three, got {describe(colour)}")
    if not (0 < radius < np.inf) or middle.shape != (2,) or stripes < 0:
        raise InputError(
            f"expected a centre (y, x) and a positive radius, got {centre!r} and {radius}"
        )
    y, x = np.indices(shape) - middle[:, None, None]
    mask = np.clip(radius + 0.5 - np.hypot(y, x), 0, 1)
    z = np.sqrt(np.maximum(radius**2 - y**2 - x**2, 0))
    sun = SUN_DIRECTION / np.linalg.norm(SUN_DIRECTION)
    facing = np.maximum((sun[0] * y + sun[1] * x + sun[2] * z) / radius, 0)
    bands = 0.7 + 0.3 * np.cos(np.pi * stripes * (x + y) / (2**0.5 * radius))
    shade = (mask * (0.15 + 0.85 * facing) * (bands if stripes else 1)).astype(np.float32)
    light = shade if colour.ndim == 0 else shade[..., None]
    return Figure(light * colour, mask.astype(np.float32))


def path(count: int, step: ArrayLike) -> NDArray[np.int64]:
    """Return at (P, 2): a straight way in equal steps (dy, dx), at (0, 0) in the middle of the bracket.

    Examples
    --------
    >>> path(3, (0, 12)).tolist()
    [[0, -12], [0, 0], [0, 12]]
    """
    stride = np.asarray(step, float)
    if count < 1 or stride.shape != (2,) or not np.all(np.isfinite(stride)):
        raise InputError(
            f"expected at least one frame and a step (dy, dx), got {count} and {step!r}"
        )
    return np.rint(np.arange(count)[:, None] * stride - (count - 1) / 2 * stride).astype(np.int64)


def shift_layer(layer: Array, at: ArrayLike) -> Array:
    """Return a layer moved by (dy, dx) whole pixels: cut off at the frame, and 0 where it left."""
    h, w = layer.shape[:2]
    dy, dx = np.asarray(at).tolist()
    out = np.zeros_like(layer)
    there = layer[max(-dy, 0) : max(h - dy, 0), max(-dx, 0) : max(w - dx, 0)]
    out[max(dy, 0) : max(h + dy, 0), max(dx, 0) : max(w + dx, 0)] = there
    return out


def compose_moment(E: F32, figure: Figure, at: ArrayLike) -> tuple[F32, F32]:
    """Return E_j = light + (1 - mask) E with the figure at (dy, dx), and its mask there [Porter84 sec. 4]."""
    light = shift_layer(figure.light, at)
    mask = shift_layer(figure.mask, at)
    return light + (1 - (mask if E.ndim == 2 else mask[..., None])) * E, mask


def shoot(
    E: ArrayLike,
    figure: Figure,
    at: ArrayLike,
    times: ArrayLike,
    model: camera.Camera = camera.Camera(),  # noqa: B008  it is frozen
    *,
    offsets: ArrayLike | None = None,
    rng: Seed = 0,
) -> Moving:
    """Photograph a scene once per exposure time, with a figure that stands elsewhere each time.

    Parameters
    ----------
    E : (H, W) or (H, W, 3), radiance of the still scene
    figure : Figure of the same size
    at : (P, 2) int, where the figure stands in each photograph: `path` has straight ways
    times : (P,) seconds, in any order: photographs, moments and masks come sorted from short to
        long
    model : Camera, without hot pixels: each photograph is a shot of its own
    offsets : (P, 2) int, where the camera stands: see `camera.shoot`
    rng : seed, or a generator, which is advanced

    Returns
    -------
    Moving

    Raises
    ------
    ValueError
        For layers that are no figure of this scene, and numbers of places that do not fit the
        times.

    References
    ----------
    Porter and Duff, Compositing digital images, SIGGRAPH 1984.

    Examples
    --------
    >>> wall = np.full((40, 60), 0.5, np.float32)
    >>> taken = shoot(wall, ball((40, 60), (20, 30), 6, 2.0), path(3, (0, 14)), [0.25, 0.5, 1.0])
    >>> taken.bracket.images.shape, int(taken.hidden.any(axis=(1, 2)).sum())
    ((3, 40, 60), 3)
    """
    E = as_radiance(E)
    figure = as_figure(figure, E)
    places = np.asarray(at)
    seconds = as_times(np.atleast_1d(times), max(np.size(times), 1))
    moves = np.zeros((len(seconds), 2), int) if offsets is None else np.asarray(offsets)
    _require_whole_pixels("places", places, len(seconds))
    _require_whole_pixels("offsets", moves, len(seconds))
    if not np.any(np.all(moves == 0, axis=1)):
        raise InputError(f"expected offsets relative to a photo at (0, 0), got {moves.tolist()}")
    if model.hot:
        raise InputError("expected no hot pixels, because they would differ in each photo")
    rng = np.random.default_rng(rng)
    still = views(E, moves)[int(np.argmin(np.abs(moves).sum(axis=1)))]
    moments = []
    masks = []
    shots = []
    for j in np.argsort(seconds, kind="stable"):
        E_all, mask_all = compose_moment(E, figure, places[j])
        E_j = views(E_all, moves)[j]
        mask = views(mask_all, moves)[j]
        shots.append(camera.shoot(E_j, seconds[j], model, rng=rng))
        moments.append(E_j)
        masks.append(mask)
    images = np.concatenate([shot.images for shot in shots])
    shot_times = np.concatenate([shot.times for shot in shots])
    order = short_to_long(images, shot_times)
    return Moving(
        bracket=bracket(images, shot_times, linear=shots[0].linear),
        still=still,
        moments=np.stack(moments)[order],
        hidden=np.stack(masks)[order] > 0,
    )


def _require_whole_pixels(name: str, pairs: Array, count: int) -> None:
    if pairs.shape != (count, 2) or pairs.dtype.kind not in "iu":
        raise InputError(f"expected {name} ({count}, 2) of whole pixels, got {describe(pairs)}")


def as_figure(figure: Figure, E: F32) -> Figure:
    """Return the layers of a figure as float32, or raise a ValueError where they do not fit the scene."""
    light = np.asarray(figure.light)
    mask = np.asarray(figure.mask)
    if light.shape != E.shape or mask.shape != E.shape[:2]:
        raise InputError(
            f"expected light {E.shape} and a mask of it, got {light.shape} and {mask.shape}"
        )
    if not (mask.min() >= 0 and mask.max() <= 1):
        raise InputError(f"expected a mask from 0 to 1, got {describe(mask)}")
    return Figure(as_radiance(light), mask.astype(np.float32))
