"""Scenes that move, with their truth: patches, video and the beam splitter beside a plain merge and `ghosts`.

E      radiance that a photograph saw, (H, W, 3): the truth of its moment
PSNR   of log2 E, dB: 20 log10 of the truth's range over the root mean square of the difference, both in
       stops; the darkest per cent of the truth counts as black, and the median difference, the
       unit, is taken off

The places are the embedded ones at 96 x 144 pixels. A visitor walks through them, and the camera of
the films pans by a pixel a frame. Photographs: film response, 8 bits, a well of 20 000 electrons,
noise of 5, seed 0. Times are seconds of a processor of this machine, per map made.
"""

from collections.abc import Callable, Mapping
from pathlib import Path
from time import process_time
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from benchmarks.experiments import Experiment, at_least, at_most
from hdrlab.beyond import patches, splitter, steady, video
from hdrlab.capture import camera, movers
from hdrlab.capture.hand_motion import views
from hdrlab.capture.responses import true_g
from hdrlab.core import colour
from hdrlab.fast import reinhard
from hdrlab.fast.merge import merge
from hdrlab.radiance.deghosting import ghosts
from hdrlab.scenes.places import PLACES, Layers, layers

Float = NDArray[np.float32]

SHAPE = (96, 144)
FRAMES = 7  # of a film, besides those at its ends, which have one neighbour
STEPS = {"slow": 4, "fast": 12}  # pixels that the visitor goes from photograph to photograph
WELL: dict[str, Any] = {"full_well": 20_000, "read_noise": 5}
G = true_g("film")


class Film(NamedTuple):
    """Frames (T, H, W, 3) uint8, the times of a turn, what each frame saw, and where no visitor ever was."""

    frames: NDArray[np.uint8]
    turn: NDArray[np.float64]
    truth: Float
    still: NDArray[np.bool_]


def psnr(E: ArrayLike, truth: Float) -> float:
    """Return the PSNR of log2 radiance, dB."""
    floor = np.quantile(truth, 0.01)
    a = np.log2(np.maximum(np.asarray(E), floor))
    b = np.log2(np.maximum(truth, floor))
    off = a - b - np.median(a - b)
    return float(20 * np.log10(np.ptp(b) / np.sqrt(np.mean(off**2))))


def figure(place: Layers) -> movers.Figure:
    """Return the visitor of a place."""
    return movers.Figure(place.mover, place.mask)


def sequences() -> list[tuple[str, int]]:
    """Return every place with every step."""
    return [(name, step) for name in PLACES for step in STEPS.values()]


def bracket(name: str, step: int) -> movers.Moving:
    """Return three photographs, three stops apart, between which the visitor walks."""
    place = layers(name, SHAPE)
    times = camera.times_around(place.radiance, 3, stops=3)
    at = movers.path(3, (0, step))
    return movers.shoot(place.radiance, figure(place), at, times, camera.Camera(**WELL), rng=0)


def film(name: str, step: int, *, pan: int = 1) -> Film:
    """Return a film whose exposures take turns, four stops apart, with a visitor who walks and a pan."""
    count = FRAMES + 2
    place = layers(name, (SHAPE[0], SHAPE[1] + count))
    offsets = np.stack([np.zeros(count, int), pan * np.arange(count)], axis=-1)
    turn = camera.times_around(place.radiance, 2, stops=4)
    rng = np.random.default_rng(0)
    frames = []
    truth = []
    hidden = []
    for j, at in enumerate(movers.path(count, (0, step))):
        radiance, mask = movers.compose_moment(place.radiance, figure(place), at)
        truth.append(views(radiance, offsets)[j])
        hidden.append(views(mask, offsets)[j] > 0)
        frames.append(
            camera.shoot(truth[-1], turn[[j % 2]], camera.Camera(**WELL), rng=rng).images[0]
        )
    return Film(np.stack(frames), turn, np.stack(truth), ~np.any(hidden, axis=0))


def compared(errors: Mapping[str, list[float]], seconds: float) -> dict[str, list[float]]:
    """Return the PSNR of each way in every sequence, ours less the others', and the time."""
    ours = np.array(errors["ours"])
    less = {
        f"ours less {other}, dB": (ours - errors[other]).tolist() for other in list(errors)[:-1]
    }
    return (
        {f"{way}, dB": values for way, values in errors.items()}
        | less
        | {"processor seconds each": [seconds]}
    )


def patch_based(_: Path) -> dict[str, list[float]]:
    """Return figures of the bracket's middle photograph, made three ways."""
    errors: dict[str, list[float]] = {"plain merge": [], "ghosts, same reference": [], "ours": []}
    seconds = 0.0
    for name, step in sequences():
        taken = bracket(name, step)
        Z = taken.bracket.images
        t = taken.bracket.times
        truth = taken.moments[1]
        start = process_time()
        H = patches.synthesise(Z, t, G)
        seconds += process_time() - start
        led = ghosts.remove_ghosts(Z, t, G, fixed=1).E
        for way, E in zip(errors, (merge(Z, t, G), led, H), strict=True):
            errors[way].append(psnr(E, truth))
    return compared(errors, seconds / len(sequences()))


def alternating(_: Path) -> dict[str, list[float]]:
    """Return figures of the films' inner frames: means over the frames of each film, and the worst frame."""
    errors: dict[str, list[float]] = {"plain merge": [], "ghosts, same reference": [], "ours": []}
    worst = []
    seconds = 0.0
    for name, step in sequences():
        shot = film(name, step)
        start = process_time()
        ours = video.merge(shot.frames, shot.turn, G)
        seconds += process_time() - start
        of_frames = [figures_of(shot, ours, i) for i in range(1, FRAMES + 1)]
        for way, values in zip(errors, np.mean(of_frames, axis=0), strict=True):
            errors[way].append(float(values))
        worst.append(float(np.min([values[2] - values[0] for values in of_frames])))
    least = {"ours less plain merge, worst frame, dB": worst}
    return compared(errors, seconds / len(sequences()) / (FRAMES + 2)) | least


def figures_of(shot: Film, ours: Float, i: int) -> list[float]:
    """Return the PSNR of frame i: of it and its neighbours merged, without ghosts, and by ours."""
    near = shot.frames[i - 1 : i + 2]
    times = shot.turn[np.arange(i - 1, i + 2) % 2]
    led = ghosts.remove_ghosts(near, times, G, fixed=1).E
    return [psnr(E, shot.truth[i]) for E in (merge(near, times, G), led, ours[i])]


def flickering(_: Path) -> dict[str, list[float]]:
    """Return the flicker of what stands still, in display levels: adapted frame by frame, and to three."""
    errors: dict[str, list[float]] = {"frame by frame, levels": [], "steady, levels": []}
    films = [film(name, STEPS["fast"], pan=0) for name in PLACES]
    merged = [
        (video.merge(steady_state.frames, steady_state.turn, G), steady_state.still)
        for steady_state in films
    ]
    for maps, still in [*merged, lamps()]:
        for way, span in zip(errors, (0, 1), strict=True):
            states = steady.tonemap_steps(maps, reinhard.tonemap, span=span)
            errors[way].append(steady.flicker((state.Ld for state in states), still))
    alone, together = errors.values()
    ratio = np.array(together) / np.array(alone)
    return errors | {"steady over frame by frame": ratio.tolist()}


def lamps() -> tuple[Float, NDArray[np.bool_]]:
    """Return a workshop in which a lamp comes and goes, twelve frames, and where the lamp is not."""
    room = layers("workshop", SHAPE).radiance
    lamp = movers.ball(SHAPE, (20, 30), 8, [20 * float(room.max())] * 3, stripes=0)
    lit, mask = movers.compose_moment(room, lamp, (0, 0))
    on = np.random.default_rng(0).random(12) < 0.5
    return np.stack([lit if is_on else room for is_on in on]), mask == 0


def split(_: Path) -> dict[str, list[float]]:
    """Return figures of one moment on three sensors, and of a bracket with the same shares of the light."""
    errors: dict[str, list[float]] = {"plain merge": [], "ours": []}
    e = splitter.shares()
    g = np.log(np.maximum(np.arange(65536), 0.5) / 32768)
    seconds = 0.0
    for name, step in sequences():
        place = layers(name, SHAPE)
        unit = 2 * float(np.median(place.radiance))
        room = colour.luminance(place.radiance) / unit
        walker = movers.Figure(colour.luminance(place.mover) / unit, place.mask)
        at = movers.path(3, (0, step))
        taken = movers.shoot(
            room, walker, at, e[::-1], camera.Camera(response="linear", bits=16, **WELL), rng=0
        )
        start = process_time()
        E = splitter.merge(splitter.shoot(taken.moments[1], e, bits=16, **WELL), e)
        seconds += process_time() - start
        for way, made in zip(
            errors, (merge(taken.bracket.images, taken.bracket.times, g), E), strict=True
        ):
            errors[way].append(psnr(made, taken.moments[1]))
    return compared(errors, seconds / len(sequences()))


def experiment(name: str, title: str, run: Callable[[Path], Any], *holds: Any) -> Experiment:
    """Return an Experiment of synthetic scenes: nothing of it was published."""
    return Experiment(name, title, run, holds)


EVERY = [1.0] * len(sequences())
IN_TURN = f"{', '.join(PLACES)}, each slow and fast"

ROWS = (
    experiment(
        "patches",
        f"three photographs, a walker; PSNR of log2 radiance: {IN_TURN}",
        patch_based,
        at_least("ours less plain merge, dB", *EVERY),
    ),
    experiment(
        "video",
        f"films of {FRAMES} frames in turns of two exposures, a walker and a pan: {IN_TURN}",
        alternating,
        at_least("ours less plain merge, dB", *EVERY),
        at_least("ours less plain merge, worst frame, dB", *EVERY),
    ),
    experiment(
        "flicker",
        f"tone-mapped films: {', '.join(PLACES)}, and a lamp that comes and goes",
        flickering,
        at_most("steady over frame by frame", *[0.6] * (len(PLACES) + 1)),
    ),
    experiment(
        "splitter",
        f"one moment on three sensors, beside three photographs: {IN_TURN}",
        split,
        at_least("ours less plain merge, dB", *EVERY),
    ),
)
