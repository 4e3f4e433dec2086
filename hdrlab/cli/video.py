"""The command that makes an HDR film: `video`."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hdrlab.cli import brackets, common
from hdrlab.errors import InputError

if TYPE_CHECKING:
    from hdrlab.core.arrays import F32, F64, Array


@click.command(cls=common.Command)
@click.argument("frames", type=common.INPUT_PATH)
@click.option(
    "-o",
    "--out",
    required=True,
    type=common.OUTPUT_PATH,
    help="Video to write, .gif or .mp4, or a folder for radiance maps.",
)
@click.option(
    "--times",
    required=True,
    metavar="SECONDS,...",
    help="Alternating exposure times of the frames, such as 1/1000,1/60.",
)
@click.option(
    "--response",
    type=brackets.ResponseType(),
    default="auto",
    help="Method that estimates the response curve, or a file with a saved curve.",
)
@click.option("--rate", type=float, default=25.0, help="Frames per second of the video.")
@click.option(
    "--key",
    type=float,
    default=0.18,
    help="Brightness that the log average of the frames gets in the video.",
)
@click.option(
    "--span",
    type=click.IntRange(0),
    default=1,
    help="Number of frames before and after each frame over which to smooth the brightness.",
)
def video(
    *,
    frames: Path,
    out: Path,
    times: str,
    response: str | Path,
    rate: float,
    key: float,
    span: int,
) -> None:
    """Make an HDR video from FRAMES with alternating exposure times.

    FRAMES is a folder of photos, sorted by name, or a video. Reading or writing a video needs the
    extra `video`. The exposure times of the frames repeat in the order of --times. With
    --times 1/1000,1/60, frame 1 has 1/1000 s, frame 2 has 1/60 s, frame 3 has 1/1000 s, and so on.

    In each frame, hdrlab replaces clipped and dark pixels with those of the neighboring frames,
    after motion compensation. If --out ends in .gif or .mp4, hdrlab writes a tone-mapped video. If it has no
    suffix, hdrlab writes a folder of radiance maps: 0001.exr and so on.

    hdrlab estimates the response from the first frame of each exposure time. These frames should
    show nearly the same scene. --response auto estimates the curve with a model of measured camera
    responses. A curve that you have saved with `hdrlab calibrate` is more accurate.
    """
    from hdrlab.beyond import video as merging
    from hdrlab.io import sequence

    exposure_times = parse_times(times)
    # a bad output is reported before the work starts
    if out.suffix:
        sequence.require_writable(out)
    else:
        sequence.require_new(out)
    count = sequence.count(frames)
    film = sequence.read(frames)
    first_frames = list(islice(film, len(exposure_times)))
    g = recover_response(response, first_frames, exposure_times)
    steps = merging.merge_steps(chain(first_frames, film), exposure_times, g)
    maps = (state.E for state in common.progress(steps, "merging", count))
    if out.suffix:
        written = sequence.write(out, tone_map(maps, key=key, span=span), rate=rate)
    else:
        written = sequence.write_maps(out, maps)
    height, width = first_frames[0].shape[:2]
    click.echo(f"{out}: {written} frames, {width} x {height}")


def parse_times(text: str) -> list[float]:
    """Return the seconds of exposure times that are separated by commas, such as 1/1000,1/60."""
    from hdrlab.capture import exposure

    try:
        times = [exposure.seconds(part) for part in text.split(",")]
    except InputError:
        raise InputError(f"--times: expected seconds such as 1/1000,1/60, got {text!r}") from None
    if len(set(times)) < 2:
        raise InputError(f"--times: expected at least two different times, got {text!r}")
    return times


def recover_response(
    response: str | Path, frames: "Sequence[Array]", times: Sequence[float]
) -> "F64":
    """Return the response curve of a file, or the one that the first frames have in common."""
    import numpy as np

    from hdrlab.core.bracket import bracket
    from hdrlab.io.response_files import read_curve
    from hdrlab.pipeline import recovery

    if isinstance(response, Path):
        return read_curve(response)
    if len(frames) < len(times):
        raise InputError(
            f"expected at least one frame for each of the {len(times)} times, got {len(frames)}"
        )
    first = bracket(np.stack(frames), times)
    recover = recovery.find_validated_method("space" if response == "auto" else response)
    return recover(first.images, first.times)


def tone_map(maps: "Iterable[F32]", *, key: float, span: int) -> "Iterator[Array]":
    """Yield the tone-mapped frames of a film. Their brightness changes slowly."""
    from hdrlab.beyond import steady
    from hdrlab.core import colour
    from hdrlab.fast import reinhard

    for state in steady.tonemap_steps(maps, reinhard.tonemap, key=key, span=span):
        yield colour.render(state.E, colour.luminance(state.E), state.Ld)
