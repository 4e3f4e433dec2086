"""Radiance maps of simulated brackets, by hdrlab and by other programs.

    python -m benchmarks brackets [--rows brackets-street,brackets-room] [--seed N]

Each program gets the same JPEG files with their times in EXIF and makes a radiance map with its
defaults: the four embedded scenes, three responses and two levels of noise, 24 brackets in all. The
camera stands on a tripod, because not every program aligns photos. In half of the brackets, the
camera has a color matrix, see `color_camera`: the name of such a bracket ends with `-matrix`.

Errors are those of the pixels that some photo shows between LOWEST_LEVEL and HIGHEST_LEVEL in every
channel, after one factor for each channel was removed. A pixel without a positive value counts as
MISSING_STOPS.

EV         size of the error of log2 E, stops: median, and 95th percentile
dark       median size of the error in the darkest twentieth of these pixels, stops
color      95th percentile of the size of the error of log2 R/G and log2 B/G, stops
tint       the same of the means over 8 x 8 pixels, in which noise averages out and a wrong color stays
CPU        processor time of the whole command, s
memory     peak memory of the largest process of the command, MB

Each line is printed as soon as a program is done with a bracket. In the summary, the first row of a
program has the medians over the brackets, the second row the worst bracket. Ctrl-C prints the summary
of the brackets that every program has done. The rows of one scene run only where `--rows` names them.
"""

import itertools
import shlex
import sys
from collections.abc import Callable, Mapping
from dataclasses import astuple, dataclass
from fractions import Fraction
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import ExifTags, Image
from PIL.TiffImagePlugin import IFDRational

from benchmarks import color_camera, peer_maps, peers
from benchmarks.experiments import Experiment, at_most, listed, one_thread
from benchmarks.measure import ROOT, process
from benchmarks.rows import OURS, Usage
from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.core.bracket import Bracket
from hdrlab.core.colour import luminance
from hdrlab.io import radiance

SHAPE = (384, 640)
SCENES = (*scenes.PLACES, "room")
RESPONSES = ("film", "srgb", "gamma")
# Full well and read noise in electrons: a large sensor, and a small one at a high ISO.
SENSORS = ((20_000.0, 5.0), (3_000.0, 12.0))
BRACKETS = tuple(itertools.product(SCENES, RESPONSES, SENSORS))
# Brackets with an odd sum of the places of scene, response and sensor are taken with this matrix, so
# that each scene, response and sensor occurs with and without it.
COLOR_MATRIX = color_camera.CANON_5D_MARK_3
FRAME_COUNT = 5
STEP_STOPS = 2.0
JPEG_QUALITY = 95
FULL_CHROMA = 0  # no subsampling, whose color fringes are the same for every program
F_NUMBER = 8
ISO = 100
LOWEST_LEVEL = 5
HIGHEST_LEVEL = 250
DARK_FRACTION = 0.05
MISSING_STOPS = 10.0
LUMINANCE_HDR = "Luminance HDR"
AGAINST_BEST = "hdrlab / best of the others"
FIGURES = "EV median, EV 95 %, dark, color, tint, CPU s, memory MB"
# side of the blocks of pixels over which the tint is averaged
TINT_BLOCK_SIDE = 8
Float = NDArray[np.float64]
Command = Callable[[list[Path], Path], list[str]]
Figures = tuple[float, ...]


@dataclass(frozen=True)
class SimulatedBracket:
    """Photos as files, and the radiance that they show."""

    name: str
    files: list[Path]
    times: Float
    images: NDArray[np.uint8]
    E: NDArray[np.float32]


@dataclass(frozen=True)
class MapErrors:
    """Errors of a radiance map, stops."""

    median: float
    p95: float
    dark: float
    color: float
    tint: float


@dataclass(frozen=True)
class Program:
    """A program that makes a radiance map: its command, and the ending of the map's file."""

    command: Command
    suffix: str


def compare(
    folder: Path, *, seed: int = 0, places: tuple[str, ...] = SCENES
) -> Mapping[str, ArrayLike]:
    """Return errors, CPU time and memory of each program: medians over the brackets, and worst.

    Each line is printed as soon as it is measured.
    """
    programs, missing = find_programs(folder)
    for name, reason in missing.items():
        print(f"  {name}: missing, {reason}", flush=True)
    rows: list[dict[str, Figures]] = []
    try:
        for number, (scene, response, sensor) in enumerate(BRACKETS):
            if scene not in places:
                continue
            rng = np.random.default_rng((seed, number))
            simulated = simulate(folder, scene, response, sensor, rng)
            print(f"{simulated.name}: {FIGURES}", flush=True)
            rows.append(measure_programs(programs, simulated, folder))
    except KeyboardInterrupt:
        print(f"Stopped. Complete brackets: {len(rows)}. {FIGURES}")
        for what, values in summarize(rows).items():
            print_line(what, values)
        raise
    return summarize(rows)


def measure_programs(
    programs: Mapping[str, Program], simulated: SimulatedBracket, folder: Path
) -> dict[str, Figures]:
    """Return the figures of each program on a bracket, and print them as they come."""
    figures: dict[str, Figures] = {}
    for name, program in programs.items():
        usage, errors = run_program(name, program, simulated, folder)
        figures[name] = (*astuple(errors), usage.cpu_seconds, usage.megabytes)
        print_line(name, figures[name])
    return figures


def print_line(what: str, values: Figures) -> None:
    """Print the figures of a program."""
    print(f"  {what:<30} {listed(values)}", flush=True)


def summarize(rows: list[dict[str, Figures]]) -> dict[str, Figures]:
    """Return the medians and the worst of each program, and how hdrlab compares with the best peer."""
    summary: dict[str, Figures] = {}
    if not rows:
        return summary
    medians = {}
    for name in rows[0]:
        figures = np.array([row[name] for row in rows])
        medians[name] = np.nanmedian(figures, axis=0)
        summary[name] = tuple(medians[name].tolist())
        summary[f"{name}, worst"] = tuple(np.nanmax(figures, axis=0).tolist())
    peer_medians = [medians[name] for name in medians if name != OURS]
    if peer_medians:
        ratios = medians[OURS] / np.min(peer_medians, axis=0)
        summary[AGAINST_BEST] = tuple(ratios.tolist())
    return summary


def simulate(
    folder: Path,
    scene: str,
    response: str,
    sensor: tuple[float, float],
    rng: np.random.Generator,
) -> SimulatedBracket:
    """Take photos of a scene and write them as JPEG with exposure times."""
    full_well, read_noise = sensor
    E = getattr(scenes, scene)(SHAPE)
    times = camera.times_around(
        E, FRAME_COUNT, stops=STEP_STOPS, middle=0.1 * 2 ** rng.uniform(-0.5, 0.5)
    )
    model = camera.Camera(response=response, full_well=full_well, read_noise=read_noise)
    name = f"{scene}-{response}-{full_well:g}"
    if has_color_matrix(scene, response, sensor):
        taken = color_camera.shoot(E, times, model, COLOR_MATRIX, rng=rng)
        name += "-matrix"
    else:
        taken = camera.shoot(E, times, model, rng=rng)
    photos = folder / name
    photos.mkdir(exist_ok=True)
    files = write_photos(photos, taken)
    decoded = np.stack([np.asarray(Image.open(file)) for file in files])
    return SimulatedBracket(name, files, taken.times, decoded, E)


def has_color_matrix(scene: str, response: str, sensor: tuple[float, float]) -> bool:
    """Return whether the camera of a bracket has a color matrix."""
    places = SCENES.index(scene) + RESPONSES.index(response) + SENSORS.index(sensor)
    return places % 2 == 1


def write_photos(folder: Path, taken: Bracket) -> list[Path]:
    """Write JPEG files with time, f-number and ISO in EXIF."""
    files = []
    for number, (image, time) in enumerate(zip(taken.images, taken.times, strict=True)):
        exif = Image.Exif()
        fraction = Fraction(float(time)).limit_denominator(10**6)
        tags = exif.get_ifd(ExifTags.IFD.Exif)
        tags[ExifTags.Base.ExposureTime] = IFDRational(fraction.numerator, fraction.denominator)
        tags[ExifTags.Base.FNumber] = IFDRational(F_NUMBER, 1)
        tags[ExifTags.Base.ISOSpeedRatings] = ISO
        file = folder / f"photo-{number}.jpg"
        Image.fromarray(image).save(file, quality=JPEG_QUALITY, subsampling=FULL_CHROMA, exif=exif)
        files.append(file)
    return files


def find_programs(folder: Path) -> tuple[dict[str, Program], dict[str, str]]:
    """Return the installed programs, and the reasons why others are missing."""
    programs = {OURS: Program(hdrlab_command, ".pfm")}
    makers = {
        "OpenCV Debevec": lambda: python_peer(peers.opencv(True), peer_maps.OPENCV_DEBEVEC),
        "OpenCV Robertson": lambda: python_peer(peers.opencv(True), peer_maps.OPENCV_ROBERTSON),
        peers.COLOUR: lambda: python_peer(peers.colour_hdri(), peer_maps.COLOUR_HDRI),
        peers.PFS: lambda: pfstools(folder),
        LUMINANCE_HDR: luminance_hdr,
    }
    missing = {}
    for name, make in makers.items():
        try:
            programs[name] = make()
        except peers.Missing as reason:
            missing[name] = str(reason)
    return programs, missing


def hdrlab_command(photos: list[Path], target: Path) -> list[str]:
    """Return `hdrlab assemble` with its defaults."""
    return [sys.executable, "-m", "hdrlab", "assemble", *map(str, photos), "-o", str(target)]


def python_peer(module: object, peer: str) -> Program:
    """Return a Python package in a process of its own."""
    script = str(ROOT / "benchmarks" / "peer_maps.py")

    def command(photos: list[Path], target: Path) -> list[str]:
        return [sys.executable, script, peer, str(target), *map(str, photos)]

    return Program(command, ".npy")


def pfstools(folder: Path) -> Program:
    """Return pfshdrcalibrate, which estimates the response and merges by Robertson's method."""
    read = peers.pfstools("pfsinhdrgen")
    merge = peers.pfstools("pfshdrcalibrate")
    write = peers.pfstools("pfsoutpfm")

    def command(photos: list[Path], target: Path) -> list[str]:
        listing = folder / "photos.hdrgen"
        lines = []
        for photo in photos:
            time = peer_maps.read_time(str(photo))
            lines.append(f"{photo} {1 / time:.9g} {F_NUMBER} {ISO} 0\n")
        listing.write_text("".join(lines), encoding="utf8")
        pipeline = (
            f"{read} {shlex.quote(str(listing))} | {merge} | {write} {shlex.quote(str(target))}"
        )
        return ["sh", "-c", pipeline]

    return Program(command, ".pfm")


def luminance_hdr() -> Program:
    """Return Luminance HDR with Robertson's method; its default takes the photos for linear."""
    program = peers.program("luminance-hdr-cli", "apt install luminance-hdr")

    def command(photos: list[Path], target: Path) -> list[str]:
        environment = ["env", "QT_QPA_PLATFORM=offscreen"]
        model = ["--hdrModel", "robertsonauto"]
        return [*environment, program, *model, "--save", str(target), *map(str, photos)]

    return Program(command, ".hdr")


def run_program(
    name: str, program: Program, simulated: SimulatedBracket, folder: Path
) -> tuple[Usage, MapErrors]:
    """Run a program on a bracket, and return what it took and the errors of its map."""
    target = folder / f"map{program.suffix}"
    target.unlink(missing_ok=True)
    try:
        with one_thread():
            usage = process(program.command(simulated.files, target), one_thread=False)
        return usage, measure_errors(read_map(target), simulated)
    except (RuntimeError, OSError, ValueError) as error:
        print(f"  {name}, {simulated.name}: no map, {str(error)[-300:]}", flush=True)
        return Usage(np.nan, np.nan, np.nan), MapErrors(*[MISSING_STOPS] * 5)


def read_map(path: Path) -> Float:
    """Return a radiance map, float64."""
    E = np.load(path) if path.suffix == ".npy" else radiance.read_radiance(path)
    return np.asarray(E, np.float64)


def measure_errors(E: Float, simulated: SimulatedBracket) -> MapErrors:
    """Return the errors of a map."""
    if E.shape != simulated.E.shape:
        raise ValueError(f"the map has the shape {E.shape}, not {simulated.E.shape}")
    levels = simulated.images
    is_exposed = (levels >= LOWEST_LEVEL) & (levels <= HIGHEST_LEVEL)
    is_measured = is_exposed.all(axis=-1).any(axis=0)
    truth = simulated.E[is_measured].astype(np.float64)
    measured = E[is_measured]
    is_positive = np.isfinite(measured) & (measured > 0)
    errors = np.full(measured.shape, np.nan)
    errors[is_positive] = np.log2(measured[is_positive] / truth[is_positive])
    errors -= np.nanmedian(errors, axis=0)
    sizes = np.nan_to_num(np.abs(errors), nan=MISSING_STOPS)
    color_sizes = np.nan_to_num(np.abs(errors[:, [0, 2]] - errors[:, [1]]), nan=MISSING_STOPS)
    light = luminance(truth)
    is_dark = light <= np.quantile(light, DARK_FRACTION)
    return MapErrors(
        median=float(np.median(sizes)),
        p95=float(np.quantile(sizes, 0.95)),
        dark=float(np.median(sizes[is_dark])),
        color=float(np.quantile(color_sizes, 0.95)),
        tint=measure_tint(errors, np.asarray(is_measured)),
    )


def measure_tint(errors: Float, is_measured: NDArray[np.bool_]) -> float:
    """Return the 95th percentile of the color errors of blocks of pixels, stops.

    errors : (N, 3), log2 of the map over the truth at the N measured pixels; NaN where it is missing
    is_measured : (H, W)
    """
    height, width = (n // TINT_BLOCK_SIDE * TINT_BLOCK_SIDE for n in is_measured.shape)
    shape = (height // TINT_BLOCK_SIDE, TINT_BLOCK_SIDE, width // TINT_BLOCK_SIDE, TINT_BLOCK_SIDE)
    differences = np.zeros((*is_measured.shape, 2))
    counts = np.zeros(is_measured.shape)
    color_errors = errors[:, [0, 2]] - errors[:, [1]]
    is_known = np.asarray(np.isfinite(color_errors).all(axis=1))
    differences[is_measured] = np.where(is_known[:, None], color_errors, 0)
    counts[is_measured] = is_known
    sums = differences[:height, :width].reshape(*shape, 2).sum(axis=(1, 3))
    block_counts = counts[:height, :width].reshape(shape).sum(axis=(1, 3))
    large = np.nonzero(block_counts >= TINT_BLOCK_SIDE**2 / 2)
    if not len(large[0]):
        return MISSING_STOPS
    means = np.abs(sums[large] / block_counts[large][:, None])
    return float(np.quantile(means, 0.95))


HOLD = at_most(AGAINST_BEST, 1, 1, 1, 1, 1, np.inf, np.inf)
ROWS = (
    Experiment(
        "brackets-peers",
        f"maps of {len(BRACKETS)} simulated brackets; {FIGURES}",
        compare,
        (HOLD,),
        has_seed=True,
    ),
    *(
        Experiment(
            f"brackets-{scene}",
            f"maps of the {len(BRACKETS) // len(SCENES)} brackets of one scene; {FIGURES}",
            partial(compare, places=(scene,)),
            (HOLD,),
            has_seed=True,
            only_by_name=True,
        )
        for scene in SCENES
    ),
)
