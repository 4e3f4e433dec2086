"""Array types and input checks of the whole library; each public function checks its input once.

images  (P, H, W) gray or (P, H, W, 3) RGB, uint8 or uint16: a stack of photographs
times   (P,) seconds of equivalent exposure, positive
E       (H, W) or (H, W, 3) float32, radiance: finite and not negative, any linear unit
L       (H, W) float32, luminance: the same, one channel
valid   (P, H, W) bool, False where a photograph holds no picture
n       256 or 65536, the number of levels a pixel value can take
"""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike as ArrayLike, NDArray as NDArray

from hdrlab.errors import InputError

Array = NDArray[Any]
F32 = NDArray[np.float32]
F64 = NDArray[np.float64]
Mask = NDArray[np.bool_]
Flags = NDArray[np.uint8]
Labels = NDArray[np.int32]
Indices = NDArray[np.intp]
Image = NDArray[np.uint8] | NDArray[np.uint16]

# exposure times, also relative ones, with which radiance stays within float32
MIN_SECONDS = 1e-30
MAX_SECONDS = 1e30
# e^80 is close to the largest float32, the type of radiance maps
MAX_LN_EXPOSURE = 80
# the bits of infinity in float32; NaN and negative numbers have larger ones
_INFINITY_BITS = 0x7F800000


def hidden(array: object) -> str:
    """Return why the values are no pixel levels: a Pillow picture's palette, or a mask; else ""."""
    if getattr(array, "mode", "") == "P":
        return "a palette"
    return "some of it masked" if np.ma.is_masked(array) else ""


def describe(array: ArrayLike) -> str:
    """Describe an array for an error message: shape, dtype, and range or that it is masked."""
    is_masked = np.ma.is_masked(array)
    array = np.asarray(array)
    text = f"shape {array.shape}, dtype {array.dtype}"
    if is_masked:
        return f"{text}, some of it masked"
    if array.size == 0 or array.dtype.kind not in "biuf":
        return text
    return f"{text}, values {array.min():.6g} to {array.max():.6g}"


def as_stack(images: ArrayLike | Sequence[ArrayLike]) -> Array:
    """Return `images` as one array (P, H, W[, 3]) of uint8 or uint16, or raise a ValueError."""
    if hasattr(images, "__array__"):
        images = np.asanyarray(images)
    else:
        images = _stack(list(images) if isinstance(images, Iterable) else [images])
    is_stack = images.ndim == 3 or (images.ndim == 4 and images.shape[-1] == 3)
    if not is_stack or 0 in images.shape:
        raise InputError(
            f"expected a stack of images (P, H, W) or (P, H, W, 3), got {describe(images)}"
        )
    native = images.dtype.newbyteorder("=")
    if native not in (np.uint8, np.uint16) or np.ma.is_masked(images):
        raise InputError(f"expected images of uint8 or uint16, got {describe(images)}")
    return np.asarray(images) if images.dtype.isnative else np.asarray(images.astype(native))


def _stack(images: Sequence[ArrayLike]) -> Array:
    """Return frames of one size and type as one array.

    np.stack alone would convert 8 bits to 16 bits, which makes them nearly black, and would drop
    masks.
    """
    frames = [np.asanyarray(image) for image in images]
    kinds = {f"{frame.shape} {frame.dtype}" for frame in frames}
    kinds |= {hidden(image) for image in images if hidden(image)}
    if len(kinds) > 1:
        got = ", ".join(sorted(kinds))
        raise InputError(f"expected frames of one size and type, no mask and no palette, got {got}")
    return np.stack(frames) if frames else np.empty(0)


def as_times(times: ArrayLike, count: int, *, distinct: int = 1) -> NDArray[np.float64]:
    """Return `times` as float64 (count,), positive, at least `distinct` of them different.

    Anything else is a ValueError.

    Examples
    --------
    >>> as_times([0.5, 1], 2).tolist()
    [0.5, 1.0]
    """
    is_numeric = np.asarray(times).dtype.kind in "biufO" and not np.ma.is_masked(times)
    if np.shape(times) != (count,) or not is_numeric:
        raise InputError(f"expected {count} exposure times, one per image, got {describe(times)}")
    checked = np.asarray(times, dtype=np.float64)
    if not np.all(np.isfinite(checked) & (checked > 0)):
        raise InputError(f"expected positive exposure times in seconds, got {checked.tolist()}")
    if checked.min() < MIN_SECONDS or checked.max() > MAX_SECONDS:
        raise InputError(
            f"expected exposure times from {MIN_SECONDS:g} to {MAX_SECONDS:g} seconds, beyond which "
            f"radiance does not fit into float32, got {checked.tolist()}"
        )
    if len(np.unique(checked)) < distinct:
        raise InputError(
            f"expected at least {distinct} different exposure times, got {checked.tolist()} s"
        )
    return checked


def as_mask(valid: ArrayLike | None, images: Array) -> NDArray[np.bool_] | None:
    """Return `valid` as bool (P, H, W), one mask per image, or None where every pixel is valid."""
    if valid is None:
        return None
    checked = np.asarray(valid, dtype=bool)
    if checked.shape != images.shape[:3] or np.ma.is_masked(valid):
        raise InputError(f"expected a mask of shape {images.shape[:3]}, got {describe(valid)}")
    return checked


def as_radiance(E: ArrayLike) -> NDArray[np.float32]:
    """Return `E` as float32 (H, W) or (H, W, 3), finite and not negative, or raise a ValueError."""
    array = np.asanyarray(E)
    is_map = array.ndim == 2 or (array.ndim == 3 and array.shape[-1] == 3)
    if not is_map or 0 in array.shape:
        raise InputError(f"expected radiance (H, W) or (H, W, 3), got {describe(array)}")
    return _finite(array, "radiance")


def as_luminance(L: ArrayLike) -> NDArray[np.float32]:
    """Return `L` as float32 (H, W), finite and not negative, or raise a ValueError."""
    array = np.asanyarray(L)
    if array.ndim != 2 or 0 in array.shape:
        raise InputError(f"expected luminance (H, W), got {describe(array)}")
    return _finite(array, "luminance")


def as_picture(picture: ArrayLike) -> Array:
    """Return `picture` as uint8 (H, W) or (H, W, 3), or raise a ValueError."""
    Z = np.asarray(picture)
    why = hidden(picture)
    is_picture = Z.ndim >= 2 and Z.shape[2:] in ((), (3,)) and Z.size > 0
    if why or not is_picture or Z.dtype != np.uint8:
        raise InputError(
            f"expected a picture (H, W) or (H, W, 3) of uint8, got {why or describe(picture)}"
        )
    return Z


def _finite(array: Array, what: str) -> NDArray[np.float32]:
    """Return `array` as float32, or raise an InputError that counts invalid values."""
    if array.dtype.kind not in "iuf" or np.ma.is_masked(array):
        raise InputError(f"expected {what} as numbers, got {describe(array)}")
    with np.errstate(over="ignore"):  # a float64 beyond float32 becomes inf, and is counted as such
        # in C order, because even the last bit of a sum depends on the order of its terms
        array = np.asarray(array).astype(np.float32, order="C", copy=False)
    # One pass over the bits is enough for nearly all arrays; -0.0 needs the second comparison.
    is_suspect = array.view(np.uint32).max() >= _INFINITY_BITS
    if is_suspect and not (array.min() >= 0 and array.max() < np.inf):
        nans = np.count_nonzero(np.isnan(array))
        infinities = np.count_nonzero(np.isinf(array))
        negatives = np.count_nonzero(array < 0)
        counts = f"{nans} NaN, {infinities} infinite and {negatives} negative values"
        raise InputError(
            f"expected finite {what} that is not negative, got {counts} in shape {array.shape}"
        )
    return array


def levels(images: Array) -> int:
    """Return n, the number of levels of the images' dtype: 256 or 65536."""
    return 1 << (8 * images.dtype.itemsize)


def to_256(images: Array) -> NDArray[np.uint8]:
    """Return the images at 256 levels: 16-bit level z becomes round(z / 257)."""
    if images.dtype == np.uint8:
        return images
    return ((images.astype(np.uint32) + 128) // 257).astype(np.uint8)


def as_response(g: ArrayLike, n: int, channels: int) -> NDArray[np.float64]:
    """Return a response as a table (n, channels); one curve serves all channels."""
    table = as_table(g, n).reshape(n, -1)
    if table.shape[1] not in (1, channels):
        wanted = "(n,) for gray" if channels == 1 else "(n,) or (n, 3)"
        raise InputError(f"expected a response {wanted}, got shape {table.shape}")
    if len(np.asarray(g)) not in (n, 256, 65536):
        raise InputError(f"expected a response of {n} levels, or of 256, got {describe(g)}")
    if not np.all(table[-1] > table[0]) or np.abs(table).max() > MAX_LN_EXPOSURE:
        limit = MAX_LN_EXPOSURE
        raise InputError(
            f"expected ln exposures that rise, from -{limit} to {limit}, got {describe(table)}"
        )
    return np.broadcast_to(table, (n, channels))


def as_table(table: ArrayLike, n: int) -> NDArray[np.float64]:
    """Return a table over pixel levels, (n,) or (n, C), interpolated to n rows where it has others.

    So a response of 256 levels serves 16-bit photographs: level z of 65536 is level z / 257 of 256.
    """
    if np.asanyarray(table).dtype.kind not in "biuf" or np.ma.is_masked(table):
        raise InputError(f"expected a table of numbers, all of them known, got {describe(table)}")
    array = np.asarray(table, dtype=np.float64)
    if array.ndim not in (1, 2) or len(array) < 2 or not np.all(np.isfinite(array)):
        raise InputError(
            f"expected a finite table over pixel levels, (n,) or (n, 3), got {describe(array)}"
        )
    if len(array) == n:
        return array
    at = np.linspace(0, 1, n)
    own = np.linspace(0, 1, len(array))
    columns = [np.interp(at, own, column) for column in array.reshape(len(array), -1).T]
    return np.stack(columns, axis=-1).reshape(n, *array.shape[1:])
