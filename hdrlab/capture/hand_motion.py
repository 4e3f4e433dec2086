"""A hand that holds the camera: what each photograph sees of the scene when it shifts, turns and tilts.

E        radiance (H, W[, 3]) float32, any linear unit
offsets  (P, 2), (dy, dx) pixels: how far frame j must move, down and right, to lie on the reference
H        (P, 3, 3) homographies: where pixel (x, y, 1) of frame j lies in the reference, see `filters.warp`

What `align` should answer is the same whichever way it is written. Offsets of whole pixels cut
views out of the scene; all others resample its light, before the sensor: a camera that moved sees
the scene between the pixels, not the photograph.
"""

import numpy as np

from hdrlab.core.arrays import F64, Array, ArrayLike, describe
from hdrlab.core.filters import warp
from hdrlab.errors import InputError

Seed = int | np.random.Generator | None


def views(E: Array, offsets: ArrayLike) -> list[Array]:
    """Return what each frame of a moved camera sees: P arrays (h, w[, 3]), views of E.

    Frame j sees E from (top + dy, left + dx) on, so that moved by (dy, dx) it lies on a frame of
    (0, 0). It is smaller than the scene by the span of the offsets, h = H - (max dy - min dy) and w
    likewise: it holds real content everywhere, and nothing wraps around.

    With homographies, or fractions of pixels, frame j sees E at H_j (x, y, 1), and all of them the
    largest rectangle within which every one finds content. `frame_homographies` gives these in
    pixels of the frames.
    """
    moves = np.asarray(offsets)
    is_pairs = moves.ndim == 2 and moves.shape[1] == 2 and len(moves) > 0
    if moves.ndim == 3 or (is_pairs and moves.dtype.kind == "f"):
        rows, columns = _shown(moves, E.shape)
        size = (rows.stop - rows.start, columns.stop - columns.start)
        first = _from((rows, columns))
        return [warp.sample(E, H @ first, size) for H in warp.as_homographies(moves)]
    if not is_pairs or moves.dtype.kind not in "iu":
        raise InputError(
            f"expected offsets (P, 2) or homographies (P, 3, 3), got {describe(moves)}"
        )
    corners = moves - moves.min(axis=0)
    h, w = E.shape[:2] - corners.max(axis=0)
    if h < 1 or w < 1:
        raise InputError(
            f"expected offsets that span less than {E.shape[:2]}, got {moves.tolist()}"
        )
    return [E[y : y + h, x : x + w] for y, x in corners]


def frame_homographies(homographies: ArrayLike, shape: tuple[int, ...]) -> F64:
    """Return homographies (P, 3, 3) of a scene of `shape` in pixels of the frames that `views` returns.

    These begin at pixel (left, top) of the scene, so H becomes T^-1 H T with the shift T by that
    much. A shift stays what it is.

    Examples
    --------
    >>> turned = warp.turn((100, 160), 2)  # about the middle of the scene, and of the frames
    >>> h, w = views(np.ones((100, 160)), [turned, np.eye(3)])[0].shape
    >>> np.allclose(frame_homographies([turned, np.eye(3)], (100, 160))[0], warp.turn((h, w), 2), atol=0.2)
    True
    """
    first = _from(_shown(homographies, shape))
    return np.asarray(np.linalg.inv(first) @ warp.as_homographies(homographies) @ first)


def shake(
    count: int,
    shape: tuple[int, ...],
    *,
    radius: float = 8.0,
    degrees: float = 1.0,
    zoom: float = 0.0,
    tilt: float = 0.0,
    rng: Seed = 0,
) -> F64:
    """Return homographies (P, 3, 3) of a shaking hand in front of a scene (H, W); frame P // 2 stays.

    Parameters
    ----------
    count : frames
    shape : (H, W) of the scene, about whose middle the camera turns
    radius : pixels, at most so far up, down and to either side, in fractions
    degrees : at most so far clockwise, or the other way
    zoom : share by which the picture grows or shrinks at most, as by a step ahead
    tilt : share by which one side of the picture, left or right, top or bottom, grows at most over
        its middle
    rng : seed, or a generator, which is advanced

    Examples
    --------
    >>> shake(3, (100, 150), radius=2, degrees=0, rng=1)[:, :2, 2].round(2).tolist()  # dx, dy
    [[1.8, 0.05], [0.0, 0.0], [1.15, -0.68]]
    """
    rng = np.random.default_rng(rng)
    knobs = np.array([radius, degrees, zoom, tilt], float)
    if count < 1 or not np.all(np.isfinite(knobs) & (knobs >= 0)) or zoom >= 0.5 or tilt >= 0.5:
        got = f"{count} frames, radius {radius}, degrees {degrees}, zoom {zoom}, tilt {tilt}"
        raise InputError(
            f"expected at least one frame, motion of at least 0, zoom and tilt < 0.5, got {got}"
        )
    homographies = []
    for dy, dx, phi, grown, across, down in rng.uniform(-1, 1, (count, 6)):
        about = warp.turn(shape, degrees * phi, (radius * dy, radius * dx), scale=1 + zoom * grown)
        homographies.append(about @ _tilted(shape, tilt * across, tilt * down))
    homographies[count // 2] = np.eye(3)
    return np.array(homographies)


def _tilted(shape: tuple[int, ...], across: float, down: float) -> F64:
    """Return the H that grows the right side by a share `across`, the bottom by `down`, not the middle."""
    y, x = (np.array(shape[:2]) - 1) / 2
    middle = np.array([[1, 0, -x], [0, 1, -y], [0, 0, 1]])
    lean = np.array([[1, 0, 0], [0, 1, 0], [-across / max(x, 1), -down / max(y, 1), 1]])
    return np.asarray(np.linalg.inv(middle) @ lean @ middle)


def _shown(homographies: ArrayLike, shape: tuple[int, ...]) -> tuple[slice, slice]:
    """Return the rectangle of pixels that all of them see within the scene: H p inside, so p inside H^-1."""
    return warp.common_rectangle(np.linalg.inv(warp.as_homographies(homographies)), shape)


def _from(shown: tuple[slice, slice]) -> F64:
    """Return the shift T from a frame to the scene."""
    return warp.as_homographies([[shown[0].start, shown[1].start]])[0]
