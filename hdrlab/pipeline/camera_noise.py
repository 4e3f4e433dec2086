"""Measure the noise of a camera from a folder of darks and a folder of flats.

`diagnostics.camera_noise` does the arithmetic. Here, files become arrays: the photos are checked,
sorted into pairs, and the planes of each color are cut out of the mosaic. `camera_noise_file` writes
the result, and `measure_deviation` merges a bracket of the same camera with it.
"""

import math
import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from hdrlab.core.arrays import F64, Array, Indices
from hdrlab.core.threads import map_in_threads
from hdrlab.diagnostics import camera_noise
from hdrlab.diagnostics.camera_noise import (
    ChannelNoise,
    ChannelPhotos,
    Interval,
    NoiseWarning,
)
from hdrlab.diagnostics.noise import Noise
from hdrlab.errors import InputError
from hdrlab.io import album, raw
from hdrlab.io.decode import PhotoHeader, decode_photo, read_header

# kinds of photos in a file of noise
RAW = "RAW"
LINEAR = "linear"

# pixels of a plane on a side, at most: more hardly narrow the intervals
MAX_PLANE_SIDE = 1000
# pixels of a plane without which the intervals are wide
MIN_PLANE_PIXELS = 200
# the middle of the frame, as a fraction of each side: vignetting is small there
MIDDLE_FRACTION = 0.5
# blocks of a side of the frame in which the level of darks is compared
BLOCKS_PER_SIDE = 8
# standard deviations beyond which a level counts as an outlier of its block
OUTLIER_DEVIATIONS = 6.0
# LibRaw's range of developed levels, and the level of exposure 1 in a response
LARGEST_LEVEL = 65535
UNIT_LEVEL = 32768
# kinds of warnings with which a merge would be wrong
SPOILING_WARNING_KINDS = (camera_noise.TONE_CURVE, camera_noise.DENOISED_FLATS)

CHANNEL_NAMES = ("red", "green", "blue")
QUANTITIES = {
    "gain": "electrons per level",
    "read_noise": "electrons",
    "full_well": "electrons",
    "black": "level",
}
DIGITS = re.compile(r"(\d+)")


@dataclass(frozen=True, kw_only=True, eq=False)
class CameraNoise:
    """The noise of a camera at one ISO speed; print it for a table.

    Attributes
    ----------
    camera : make and model, "" if the photos do not state them
    iso : ISO speed, None if the photos do not state it
    kind : "RAW", or "linear" for 16-bit TIFF and PNG files
    channels : the noise of each channel
    warnings : what is wrong with the photos
    notes : what else users should know, as sentences
    """

    camera: str
    iso: float | None
    kind: str
    channels: tuple[ChannelNoise, ...]
    warnings: tuple[NoiseWarning, ...] = ()
    notes: tuple[str, ...] = ()

    def __str__(self) -> str:
        """Return the table of all figures with their 95 % intervals."""
        columns = [["", *QUANTITIES], ["", *(f"({unit})" for unit in QUANTITIES.values())]]
        columns = [[text.replace("_", " ") for text in line] for line in columns]
        for channel in self.channels:
            figures = [_describe(getattr(channel, quantity)) for quantity in QUANTITIES]
            columns.append([channel.name, *figures])
        widths = [max(len(line[k]) for line in columns) for k in range(len(columns[0]))]
        lines = [
            "  ".join(text.ljust(width) for text, width in zip(line, widths, strict=True)).rstrip()
            for line in columns
        ]
        return "\n".join(lines)


def measure_camera_noise(dark: str | Path, flat: str | Path) -> CameraNoise:
    """Measure gain, read noise, full well and black level of a camera by photon transfer.

    Parameters
    ----------
    dark : folder of at least two darks: photos with the lens cap on
    flat : folder of pairs of flats: photos of an evenly lit surface out of focus, two of each
        exposure, at least three exposures from dark to clipped. Photos of the same time and f-number
        are paired in the order of their names

    Returns
    -------
    CameraNoise
        Check its `warnings` before you use its figures.

    Raises
    ------
    InputError
        For folders without enough photos, for photos of different cameras, ISO speeds or sizes, and
        for JPEG and other photos whose values are not proportional to light.
    CalibrationError
        If too few pairs saw the same light twice, or the noise does not grow with the light.

    References
    ----------
    Janesick, Photon Transfer: DN -> lambda, SPIE Press 2007.

    Examples
    --------
    >>> noise = measure_camera_noise("dark/", "flat/")  # doctest: +SKIP
    >>> print(noise)  # doctest: +SKIP
    """
    notes: list[str] = []
    dark_headers = _list_photos(Path(dark), notes)
    flat_headers = _list_photos(Path(flat), notes)
    _require_one_camera([*dark_headers, *flat_headers])
    pairs = _pair_flats(flat_headers, notes)
    if len(pairs) < camera_noise.MIN_FLAT_PAIRS:
        raise InputError(
            f"{flat}: expected at least {camera_noise.MIN_FLAT_PAIRS} pairs of flats, got {len(pairs)}; "
            "take two photos of each exposure, and at least three exposures from dark to clipped"
        )
    darks = _choose_darks(dark_headers, pairs, Path(dark), notes)
    first = flat_headers[0]
    if first.exposure.iso is None:
        notes.append("the photos state no ISO speed: use the figures only for photos of this one")
    photos, step, offset = _read_channels(darks, pairs)
    seconds = [pair[0].exposure.seconds for pair in pairs]
    times = [time for time in seconds if time is not None]
    has_one_aperture = len({pair[0].exposure.f_number for pair in pairs}) == 1
    has_times = has_one_aperture and len(times) == len(pairs)
    measured = camera_noise.measure_noise(
        photos,
        [(one.path.name, other.path.name) for one, other in pairs],
        times if has_times else None,
    )
    channels = tuple(_in_file_levels(channel, step, offset) for channel in measured.channels)
    notes += _describe_limits(channels)
    return CameraNoise(
        camera=first.camera,
        iso=first.exposure.iso,
        kind=RAW if first.kind == "RAW" else LINEAR,
        channels=channels,
        warnings=measured.warnings,
        notes=tuple(notes),
    )


# Photos


def _list_photos(folder: Path, notes: list[str]) -> list[PhotoHeader]:
    """Return the headers of the photos of a folder in the order of their names, numbers by value."""
    if not folder.is_dir():
        if not folder.exists():
            raise InputError(f"{folder} does not exist; pass a folder of photos")
        raise InputError(f"{folder} is a file; pass a folder of photos")
    paths = sorted(album.list_folder(folder), key=_natural_order)
    raw_stems = {path.stem for path in paths if path.suffix.lower() in raw.SUFFIXES}
    kept = [
        path for path in paths if path.suffix.lower() in raw.SUFFIXES or path.stem not in raw_stems
    ]
    if len(kept) < len(paths):
        count = len(paths) - len(kept)
        notes.append(f"{folder}: skipped {count} files that are other formats of the RAW photos")
    headers = list(map_in_threads(read_header, kept))
    for header in headers:
        _require_linear(header)
    if len(headers) < 2:
        raise InputError(
            f"{folder}: expected at least two photos, got {headers[0].path.name} alone"
        )
    return headers


def _natural_order(path: Path) -> list[str | int]:
    """Return a sort key with which IMG_10 comes after IMG_9."""
    parts = DIGITS.split(path.name)
    return [int(part) if k % 2 else part for k, part in enumerate(parts)]


def _require_linear(header: PhotoHeader) -> None:
    """Raise an InputError for a photo whose values cannot be proportional to light."""
    advice = "take RAW photos"
    if header.kind in ("JPEG", "HEIF", "AVIF", "WEBP", "JXL"):
        raise InputError(
            f"{header.path}: the camera has denoised, tone-mapped and compressed this {header.kind} "
            f"photo, so neither electrons per level nor read noise nor full well follow from it; {advice}"
        )
    if header.dtype != np.uint16:
        raise InputError(
            f"{header.path}: this photo has 8 bits, which hide the noise, and probably a tone curve; "
            f"{advice} or linear files of 16 bits"
        )
    if header.icc:
        raise InputError(
            f"{header.path}: this photo has a color profile, so its values are made for a screen; "
            f"{advice}, or linear files without a profile"
        )


def _require_one_camera(headers: Sequence[PhotoHeader]) -> None:
    """Raise an InputError that names two photos of different cameras, ISO speeds or sizes."""
    first = headers[0]
    for other in headers[1:]:
        for what, mine, others in (
            ("kind", first.kind, other.kind),
            ("camera", first.camera, other.camera),
            ("ISO speed", _name_iso(first.exposure.iso), _name_iso(other.exposure.iso)),
            ("size", _name_size(first), _name_size(other)),
        ):
            if mine != others:
                raise InputError(
                    f"expected photos of one {what}: {first.path} has {mine or 'none'}, "
                    f"{other.path} has {others or 'none'}"
                )


def _name_iso(iso: float | None) -> str:
    return "" if iso is None else f"{iso:g}"


def _name_size(header: PhotoHeader) -> str:
    height, width = header.shape[:2]
    if header.kind == "RAW":
        # the levels of a mosaic are not rotated
        height, width = sorted((height, width))
    channels = "" if len(header.shape) == 3 else ", gray"
    return f"{width} x {height} pixels{channels}"


Pair = tuple[PhotoHeader, PhotoHeader]


def _pair_flats(headers: Sequence[PhotoHeader], notes: list[str]) -> list[Pair]:
    """Return pairs of flats: photos with the same time and f-number, in the order of their names."""
    groups: dict[tuple[float | None, float | None], list[PhotoHeader]] = defaultdict(list)
    for header in headers:
        groups[header.exposure.seconds, header.exposure.f_number].append(header)
    pairs = []
    for group in groups.values():
        pairs += list(zip(group[::2], group[1::2], strict=False))
        if len(group) % 2:
            notes.append(
                f"{group[-1].path.name}: skipped, because it has no partner with the same exposure"
            )
    return pairs


def _choose_darks(
    headers: Sequence[PhotoHeader], pairs: Sequence[Pair], folder: Path, notes: list[str]
) -> Pair:
    """Return two darks of one time, that which is closest to the times of the flats."""
    groups: dict[float | None, list[PhotoHeader]] = defaultdict(list)
    for header in headers:
        groups[header.exposure.seconds].append(header)
    candidates = {seconds: group for seconds, group in groups.items() if len(group) > 1}
    if not candidates:
        raise InputError(f"{folder}: expected two darks with the same exposure time, got none")
    times = [pair[0].exposure.seconds for pair in pairs if pair[0].exposure.seconds]
    chosen = next(iter(candidates))
    known = [seconds for seconds in candidates if seconds]
    if times and known:
        middle = float(np.median(np.log(times)))
        chosen = min(known, key=lambda seconds: abs(math.log(seconds) - middle))
    first, second = candidates[chosen][:2]
    if len(headers) > 2:
        notes.append(f"of {len(headers)} darks, {first.path.name} and {second.path.name} are used")
    return first, second


# Levels


@dataclass(frozen=True, kw_only=True, eq=False)
class _Frame:
    """The planes of each channel of a photo, and what its file states.

    The means of blocks of the whole frame are those of darks only.
    """

    planes: dict[str, Array]
    block_means: dict[str, F64]
    block_pixels: int
    black: dict[str, float]
    white: float | None


def _read_channels(darks: Pair, pairs: Sequence[Pair]) -> tuple[list[ChannelPhotos], int, int]:
    """Return the darks and flats of each channel, and the step and offset of the levels.

    Some programs multiply the levels, so that only each 16th occurs, say. The levels that are
    returned are (Z - offset) / step.
    """
    dark_frames = list(map_in_threads(partial(_read_frame, is_dark=True), darks))
    flat_headers = [header for pair in pairs for header in pair]
    frames = [*dark_frames, *map_in_threads(partial(_read_frame, is_dark=False), flat_headers)]
    first = frames[0]
    samples = [plane for frame in frames[:4] for plane in frame.planes.values()]
    step, offset = _find_step(samples)
    channels = []
    for name in first.planes:
        levels = np.stack([frame.planes[name] for frame in frames])
        if step > 1:
            levels = (levels - levels.dtype.type(offset)) // levels.dtype.type(step)
        stated_black = first.black.get(name)
        pixels = levels.reshape(-1, 2, *levels.shape[1:])
        channels.append(
            ChannelPhotos(
                name=name,
                dark=pixels[0],
                flats=pixels[1:],
                block_means=np.stack([frame.block_means[name] for frame in frames[:2]]) / step,
                block_pixels=first.block_pixels,
                stated_black=None if stated_black is None else (stated_black - offset) / step,
                white=None if first.white is None else (first.white - offset) / step,
            )
        )
    return channels, step, offset


def _find_step(samples: Sequence[Array]) -> tuple[int, int]:
    """Return the distance of levels that occur, and the remainder that they leave."""
    occurring = np.unique(np.concatenate([np.unique(sample) for sample in samples])).astype(
        np.int64
    )
    step = int(np.gcd.reduce(np.diff(occurring))) if len(occurring) > 1 else 1
    return step, int(occurring[0]) % step


def _read_frame(header: PhotoHeader, *, is_dark: bool) -> _Frame:
    """Read one photo, and cut the middle out of the planes of each channel."""
    places: dict[str, list[Array]] = defaultdict(list)
    blacks: dict[str, list[float]] = defaultdict(list)
    white = None
    if header.kind == "RAW":
        mosaic = raw.read_mosaic(header.path)
        white = mosaic.white
        black = np.broadcast_to(np.asarray(mosaic.black), mosaic.levels.shape)
        for y, x, channel in _iterate_pattern(mosaic.pattern):
            places[CHANNEL_NAMES[channel]].append(mosaic.levels[y::2, x::2])
            blacks[CHANNEL_NAMES[channel]].append(float(black[y, x]))
    else:
        image = np.empty(header.shape, header.dtype)
        decode_photo(header, image)
        if image.ndim == 2:
            places["gray"].append(image)
        else:
            for channel, name in enumerate(CHANNEL_NAMES):
                places[name].append(image[..., channel])
    planes = {}
    block_means = {}
    block_pixels = 1
    for name in sorted(places, key=[*CHANNEL_NAMES, "gray"].index):
        height = min(plane.shape[0] for plane in places[name])
        width = min(plane.shape[1] for plane in places[name])
        stack = np.stack([plane[:height, :width] for plane in places[name]])
        planes[name] = _cut_middle(header.path, stack)
        if is_dark:
            block_means[name] = _average_blocks(stack)
            block_pixels = (height // BLOCKS_PER_SIDE) * (width // BLOCKS_PER_SIDE)
    return _Frame(
        planes=planes,
        block_means=block_means,
        block_pixels=block_pixels,
        black={name: float(np.mean(levels)) for name, levels in blacks.items()},
        white=white,
    )


def _iterate_pattern(pattern: Indices) -> Iterator[tuple[int, int, int]]:
    """Yield row, column and channel of each filter of a pattern."""
    for y in range(2):
        for x in range(2):
            yield y, x, int(pattern[y, x])


def _cut_middle(path: Path, planes: Array) -> Array:
    """Return a copy of the middle of planes (K, H, W), where vignetting is small."""
    height, width = planes.shape[1:]
    rows = min(int(height * MIDDLE_FRACTION), MAX_PLANE_SIDE)
    columns = min(int(width * MIDDLE_FRACTION), MAX_PLANE_SIDE)
    if rows * columns < MIN_PLANE_PIXELS or min(rows, columns) < BLOCKS_PER_SIDE:
        raise InputError(
            f"{path}: expected a larger photo, its channels have {width} x {height} pixels"
        )
    top = (height - rows) // 2
    left = (width - columns) // 2
    return planes[:, top : top + rows, left : left + columns].copy()


def _average_blocks(planes: Array) -> F64:
    """Return the means (K, B, B) of blocks of planes (K, H, W), without hot pixels."""
    rows = planes.shape[1] // BLOCKS_PER_SIDE
    columns = planes.shape[2] // BLOCKS_PER_SIDE
    middle = np.median(planes)
    deviation = camera_noise.DEVIATION_PER_MAD * np.median(np.abs(planes - middle))
    reach = OUTLIER_DEVIATIONS * max(deviation, 1)
    blocks = planes[:, : rows * BLOCKS_PER_SIDE, : columns * BLOCKS_PER_SIDE].reshape(
        -1, BLOCKS_PER_SIDE, rows, BLOCKS_PER_SIDE, columns
    )
    lowest = np.median(blocks, axis=(2, 4), keepdims=True) - reach
    highest = lowest + 2 * reach
    means: F64 = np.clip(blocks, lowest, highest).mean(axis=(2, 4))
    return means


def _in_file_levels(noise: ChannelNoise, step: int, offset: int) -> ChannelNoise:
    """Return noise in the levels of the file, from that in steps."""
    return replace(
        noise,
        gain=Interval(*(value / step for value in noise.gain)),
        black=Interval(*(value * step + offset for value in noise.black)),
        full_level=noise.full_level * step + offset,
        S=noise.S * step,
        V=noise.V * step**2,
    )


# Words


def _describe_limits(channels: Sequence[ChannelNoise]) -> list[str]:
    """Return notes on figures that the photos only bound."""
    notes = []
    hidden = [channel for channel in channels if math.isnan(channel.read_noise.value)]
    if hidden:
        names = ", ".join(channel.name for channel in hidden)
        notes.append(
            f"rounding to whole levels hides the read noise ({names}), so there is an upper limit only; "
            "use a higher ISO speed to measure it"
        )
    open_wells = [channel.name for channel in channels if math.isinf(channel.full_well.high)]
    if open_wells:
        notes.append(
            f"no flat is full ({', '.join(open_wells)}), so the full well has a lower limit only; add "
            "a pair with a longer exposure"
        )
    return notes


def _describe(interval: Interval) -> str:
    """Return a figure with its 95 % interval, with as many digits as the interval allows."""
    value, low, high = interval
    if math.isnan(value):
        return f"below {high:#.2g}"
    if math.isinf(high):
        return f"at least {_round_to(low, low / 100)}"
    width = max(high - low, abs(value) * 1e-4)
    return " ".join(
        [
            _round_to(value, width),
            f"({_round_to(low, width)} to {_round_to(high, width)})",
        ]
    )


def _round_to(value: float, width: float) -> str:
    """Return a number with two digits of its uncertainty."""
    # a width of 0.9999 counts as 1
    decimals = 1 - math.floor(math.log10(width * 1.001))
    return f"{value:.{max(decimals, 0)}f}"


# The merge


def safe_read_noise(channel: ChannelNoise) -> float:
    """Return the read noise in electrons, or its upper limit where rounding hides it."""
    R = channel.read_noise
    return R.high if math.isnan(R.value) else R.value


def require_useful(noise: CameraNoise) -> None:
    """Raise an InputError if the photos of the measurement make its figures wrong."""
    spoiled = [warning.text for warning in noise.warnings if warning.kind in SPOILING_WARNING_KINDS]
    if spoiled:
        raise InputError(f"the measured noise is of no use: {spoiled[0]}")


def require_same_camera(noise: CameraNoise, headers: Sequence[PhotoHeader]) -> None:
    """Raise an InputError unless all photos of a bracket are RAW, of this camera and ISO speed."""
    require_useful(noise)
    if noise.kind != RAW:
        raise InputError("the noise was measured on linear files; measure it on RAW photos")
    names = [channel.name for channel in noise.channels]
    if sorted(names) != sorted(CHANNEL_NAMES):
        raise InputError(
            f"expected the noise of {', '.join(CHANNEL_NAMES)}, got that of {', '.join(names)}; "
            "measure it on photos of a color camera"
        )
    for header in headers:
        if header.kind != "RAW":
            raise InputError(
                f"{header.path.name}: the measured noise is that of RAW photos, and this is a "
                f"{header.kind} file; leave the noise out, and hdrlab estimates it from the photos"
            )
        if noise.camera and header.camera and header.camera != noise.camera:
            raise InputError(
                f"{header.path.name}: taken with {header.camera}, but the noise is that of "
                f"{noise.camera}; measure the noise of this camera"
            )
        iso = header.exposure.iso
        if noise.iso is not None and iso is not None and iso != noise.iso:
            raise InputError(
                f"{header.path.name}: taken at ISO {iso:g}, but the noise was measured at ISO "
                f"{noise.iso:g}; measure the noise at ISO {iso:g}"
            )


def noise_of_developed(noise: CameraNoise, path: str | Path) -> Noise:
    """Return the noise of a RAW photo after its development to linear sRGB, for neutral light.

    N and R are those of `radiance.uncertainty`, and rho is 0. White balance multiplies a channel of
    the camera, the color matrix M mixes the three: with the electrons N_k of a channel k at exposure
    1, and its read noise R_k,

        1 / N_c = sum_k M_ck^2 / N_k        (R_c / N_c)^2 = sum_k M_ck^2 (R_k / N_k)^2.

    This is the noise of pixels whose own filter measured a color. Demosaicing averages pixels where
    the scene is smooth, so the noise is smaller there, by 20 to 35 %. At edges it adds an error of
    its own, which no noise describes.

    Parameters
    ----------
    noise : the noise of the camera
    path : the photo whose white balance all photos of the bracket get, the shortest one
    """
    mosaic = raw.read_mosaic(path)
    black = float(np.asarray(mosaic.black, np.float64).mean())
    by_name = {channel.name: channel for channel in noise.channels}
    channels = [by_name[name] for name in CHANNEL_NAMES]
    K = np.array([channel.gain.value for channel in channels])
    R = np.array([safe_read_noise(channel) for channel in channels])
    # LibRaw multiplies the levels by this, so that the channel with the smallest gain just clips
    scale = LARGEST_LEVEL / (mosaic.white - black) * mosaic.gains / mosaic.gains.min()
    N = K * UNIT_LEVEL / scale
    squares = mosaic.conversion**2
    N_developed = 1 / (squares @ (1 / N))
    R_developed = N_developed * np.sqrt(squares @ (R / N) ** 2)
    return Noise(N_developed, R_developed, np.zeros(3))
