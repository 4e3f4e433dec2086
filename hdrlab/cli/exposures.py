"""Commands about exposure: which photographs to take, to take them, and what a meter would have said."""

import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from hdrlab.cli import common, photographs
from hdrlab.errors import InputError

MODES = ("spot", "partial", "centre", "average", "matrix")


@common.command()
@click.argument("low", type=float, required=False)
@click.argument("high", type=float, required=False)
@click.option("--low", "low_", type=float, help="LOW, as an option.")
@click.option("--high", "high_", type=float, help="HIGH, as an option.")
@click.option(
    "--map", "source", type=common.FILE, help="A radiance map in cd/m^2 instead of LOW and HIGH."
)
@click.option("--aperture", default=8.0, help="f-number, the same for all.")
@click.option("--iso", default=100.0, help="ISO speed, the same for all.")
@click.option("--usable", default=7.0, help="Stops that one photograph holds.")
@click.option("--overlap", default=3.0, help="Stops that two neighbours both hold.")
@click.option("--thirds", is_flag=True, help="The dial has thirds of a stop.")
@click.option(
    "--snr", type=click.FloatRange(0, min_open=True), help="As quick as may be at this SNR, too."
)
@click.option("--camera", "model", type=common.FILE, help="For --snr: the camera's noise, a .toml.")
def plan(asked: Any) -> None:
    """Plan the photographs for a scene whose luminances go from LOW to HIGH, cd/m^2.

    Moonlight is about 0.1 cd/m^2, a living room in the evening 10, a white page in the sun 30 000.
    Of a map, one pixel in a thousand may be left out at either end.

    With --snr 20, too: those photographs that take the least time, if in their mean by inverse
    variance noise is at most a 20th of the light, from LOW to HIGH. The file of --camera may say
    full_well = 20000, read_noise = 5 (electrons), gain = 5 (electrons per level), converter_noise =
    0 (levels), pause = 0.2 (seconds after each photograph) and speeds = [100, 400] (ISO; well and
    gain are those of the lowest).
    """
    import numpy as np

    from hdrlab.capture import planning
    from hdrlab.core.colour import luminance
    from hdrlab.show.pages.templates import render_page

    low, high = asked.low_ or asked.low, asked.high_ or asked.high
    camera = {name: getattr(asked, name) for name in ("aperture", "iso", "usable", "overlap")}
    if asked.source is not None and low is None:
        L = luminance(common.read_map(asked.source, clean=False))
        low, high = np.quantile(L[L > 0], [0.001, 0.999]) if (L > 0).any() else (0.0, 0.0)
    elif asked.source is not None or low is None or high is None:
        raise InputError("expected LOW and HIGH in cd/m^2, or --map FILE")
    made = planning.plan(low, high, per_stop=3 if asked.thirds else 1, **camera)
    usual = planning.Model(speeds=(camera["iso"],), aperture=camera["aperture"])
    maker = usual._replace(**_camera(asked.model, usual._fields)) if asked.model else usual
    ways = []
    if asked.snr:
        quick = planning.plan_by_noise(low, high, asked.snr, maker)
        stops = made.names, made.times, np.full(len(made.times), camera["iso"])
        for way, (names, times, speeds) in (("by stops", stops), ("by noise", quick)):
            worst = planning.worst_snr(low, high, times, speeds, maker)
            ways.append((way, (names, times, speeds), worst))
    words = {"low": low, "high": high, "scene": np.log2(high / low), "camera": camera, "made": made}
    text = render_page(Path(__file__).parent, "plan.plain", ways=ways, pause=maker.pause, **words)
    click.echo(text.rstrip())


@common.command()
@click.argument("photo", type=common.FILE)
@common.choice("--mode", MODES, "centre", help="Whom the meter asks.")
@click.option(
    "--at", metavar="DOWN,RIGHT", default="0.5,0.5", help="The spot, in parts of the picture."
)
def meter(photo: Path, mode: str, at: str) -> None:
    """Read PHOTO as a camera's meter would, and say how it should have been exposed.

    The photograph is taken to be in sRGB. Full pixels say only "at least so bright", so of an
    overexposed photograph the advice is a first step: take it, and meter again.
    """
    import numpy as np

    from hdrlab.capture import exposure, metering
    from hdrlab.core.colour import decode_srgb, luminance
    from hdrlab.io import decode, photos

    place, image = _place(at), photos.read_photo(photo)
    B = np.minimum(luminance(decode_srgb(image / np.float32(np.iinfo(image.dtype).max))), 1)
    w = metering.weights(B, mode, at=place)
    read, stops = metering.reading(B, w), metering.correction(B, w)
    asked, full = (w > w.max() / 100).mean(), float((w * (B >= 1)).sum())
    click.echo(
        f"{mode}: asks {asked:.0%} of the pixels; {full:.0%} of what it hears is full pixels"
    )
    wanted, way = metering.MIDDLE_GRAY, "too dark" if stops > 0 else "too bright"
    click.echo(
        f"reading {read:.3f} of full, where {wanted} is wanted: {abs(stops):.1f} stops {way}"
    )
    said = decode.look(photo).exposure
    if said.seconds:
        right = exposure.true_time(exposure.true_time(said.seconds) * 2.0**stops)
        dial = exposure.shutter_series(3)
        name = dial.names[int(np.argmin(abs(dial.values - right)))]
        time = f"{said.seconds:g}" if said.seconds >= 0.4 else f"1/{1 / said.seconds:.0f}"
        click.echo(f"taken with {time} s; with {name} s it would be right")


@common.command()
@click.argument("photo", type=common.FILE)
@click.option(
    "-o", "--out", required=True, type=common.OUT, help="Picture to write: .png, .jpg or .tif."
)
@common.choice("--by", ["auto", "skin", "blocks"], help="What matters, see above.")
@common.choice("--way", ["chrominance", "locus"], help="How skin is found.")
@click.option("--target", default=128.0, help="Mean level of what matters, 1 to 254.")
def correct(photo: Path, out: Path, by: str, way: str, target: float) -> None:
    """Correct the exposure of PHOTO by what matters in it, and write it to OUT.

    What matters is skin, where it covers a hundredth of the picture, or else the blocks of most
    contrast and focus. A photograph that lacks less than a third of a stop is written as it is. 16
    bits become 8.
    """
    from hdrlab.core.arrays import to_256
    from hdrlab.enhance import battiato, skin
    from hdrlab.io import photos

    Z = to_256(photos.read_photo(photo))
    found = battiato.correct(Z, by=by, find_skin=skin.FINDERS[way], target=target)
    photos.write_picture(out, found.picture)
    part = f"{found.relevant.mean():.0%} of the picture"
    click.echo(f"what matters: {found.by}, {part}, mean level {found.before:.0f}")
    decision = (
        f"{found.delta:+.1f} stops: mean level {found.after:.0f}"
        if found.delta
        else "left as it is"
    )
    click.echo(f"{out}: {decision}")


@common.command()
@click.option(
    "-o", "--out", required=True, type=common.OUT, help="Folder for the photographs, new or empty."
)
@click.option("--frames", type=click.IntRange(2), default=7, help="How many photographs.")
@click.option(
    "--stops", type=click.FloatRange(0, min_open=True), default=2.0, help="From one to the next."
)
@click.option(
    "--assemble", "map_", type=common.OUT, help="Radiance map to make of them: .hdr, .exr, ..."
)
def shoot(out: Path, frames: int, stops: float, map_: Path | None) -> None:
    """Take a bracket with the camera on the USB cable.

    Focus, ISO and white balance are fixed, and put back at the end; the aperture stays. The middle
    time is what the camera then shows: in A (Av) what its meter says, in M what you have set. The
    others are those of its times that lie nearest. Each photograph is in the folder as soon as it
    is taken, with its time in exposures.csv. This wants the extra `camera`, which is for Linux and
    macOS.
    """
    from hdrlab.capture import exposure, planning
    from hdrlab.io import files, radiance, sequence, tethered

    common.require("camera", ["gphoto2"])
    sequence.require_new(out)
    if map_:
        radiance.format_of(map_)  # an unknown suffix is better known before the work than after it
    with tethered.connected() as camera:
        common.say("note", camera.fix("light"))
        metered, names = camera.shutter()
        dial = exposure.read_dial(names)
        chosen = planning.around(exposure.seconds(metered), dial.values, frames, stops)
        common.say("note", camera.fix("mode"))
        out.mkdir(exist_ok=True)
        lines = ["file,exposure_time_s"]
        for j in common.progress(chosen, "taking", frames):
            taken = camera.photograph(dial.names[j], out / f"{len(lines):02d}")
            lines.append(f"{taken[0].name},{dial.values[j]:.6g}")
            files.write(out / "exposures.csv", "\n".join(lines) + "\n")
            click.echo(f"{taken[0]}: {dial.names[j]}")
    if map_:
        words = ["-o", str(map_), "--times", str(out / "exposures.csv"), "--", str(out)]
        photographs.assemble.main(words, standalone_mode=False)


def _camera(file: Path, known: Sequence[str]) -> dict[str, Any]:
    """Return what a file says of a camera's noise."""
    said = tomllib.loads(file.read_text(encoding="utf8"))
    try:
        found = {
            key: tuple(map(float, one)) if key == "speeds" else float(one)
            for key, one in said.items()
        }
    except (TypeError, ValueError, OverflowError):
        found = {"": ()}
    if not set(found) <= set(known) or found.get("speeds") == ():
        raise InputError(
            f"{file}: expected numbers {', '.join(known)}, of speeds a list, got {said}"
        )
    return found


def _place(text: str) -> tuple[float, float]:
    try:
        down, right = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(
            f"--at: expected two parts of the picture, such as 0.5,0.5, got {text!r}"
        ) from None
    return down, right
