"""The commands about exposure: plan a bracket, take it, meter a photo, correct a photo."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from hdrlab.cli import common, photos as photo_commands
from hdrlab.errors import FileFormatError, InputError

if TYPE_CHECKING:
    from hdrlab.capture import planning

# those of hdrlab.capture.metering, which takes long to import
METERING_MODES = ("spot", "partial", "centre", "average", "matrix")

# the fractions of a map's pixels between which its scene's range lies
SCENE_QUANTILES = (0.001, 0.999)

# exposure times from here on are written as decimals, shorter ones as fractions
SHORTEST_DECIMAL_SECONDS = 0.4


@click.command(cls=common.Command)
@click.argument("low", type=float, required=False)
@click.argument("high", type=float, required=False)
@click.option("--low", "low_option", type=float, help="The same as the argument LOW.")
@click.option("--high", "high_option", type=float, help="The same as the argument HIGH.")
@click.option(
    "--map",
    "source",
    type=common.INPUT_PATH,
    help="Radiance map in cd/m^2 that determines LOW and HIGH.",
)
@click.option(
    "--aperture", type=click.FloatRange(0.1, 1000), default=8.0, help="f-number of all photos."
)
@click.option(
    "--iso", type=click.FloatRange(1, 10_000_000), default=100.0, help="ISO speed of all photos."
)
@click.option("--usable", default=7.0, help="Dynamic range of one photo, in stops.")
@click.option("--overlap", default=3.0, help="Overlap of two neighboring photos, in stops.")
@click.option("--thirds", is_flag=True, help="Use shutter times in thirds of a stop.")
@click.option(
    "--snr",
    type=click.FloatRange(0, 1e6, min_open=True),
    help="Also plan the fastest bracket with at least this signal-to-noise ratio.",
)
@click.option(
    "--camera",
    "camera_file",
    type=common.INPUT_PATH,
    help="Noise of the camera for --snr: a .toml file, or a .json file of hdrlab noise.",
)
@click.pass_context
def plan(
    ctx: click.Context,
    *,
    low: float | None,
    high: float | None,
    low_option: float | None,
    high_option: float | None,
    source: Path | None,
    aperture: float,
    iso: float,
    usable: float,
    overlap: float,
    thirds: bool,
    snr: float | None,
    camera_file: Path | None,
) -> None:
    """Plan the exposures for a scene.

    LOW and HIGH are the scene's smallest and largest luminance, in cd/m^2. Typical luminances are
    0.1 cd/m^2 in moonlight, 10 cd/m^2 in a living room in the evening, and 30,000 cd/m^2 for a
    white page in the sun. With --map, hdrlab ignores the darkest and the brightest thousandth of
    the pixels.

    With --snr 20, hdrlab also plans a second bracket: the fastest one with a signal-to-noise ratio
    of at least 20 from LOW to HIGH. It assumes that the photos are merged with inverse-variance
    weights. The --camera file describes the noise of the camera. It may contain these lines,
    whose defaults are shown:

    \b
      full_well = 20000      electrons
      read_noise = 5         electrons
      gain = 5               electrons per pixel value
      converter_noise = 0    pixel values
      pause = 0.2            seconds after each photo
      aperture = 8           f-number
      speeds = [100]         ISO speeds to choose from, such as [100, 400]

    full_well and gain apply to the lowest ISO speed. A file that hdrlab noise wrote has full_well,
    read_noise, gain and the ISO speed; hdrlab uses those of the green channel.
    """  # noqa: D301  # click needs the backspace itself
    from hdrlab.capture import planning

    low = _either(low, low_option, "LOW")
    high = _either(high, high_option, "HIGH")
    if camera_file is not None and snr is None:
        raise InputError("--camera is used only with --snr; add --snr or leave --camera out")
    if source is not None:
        if low is not None or high is not None:
            raise InputError("--map and LOW or HIGH exclude each other; pass one of them")
        low, high = _scene_range(source)
    if low is None or high is None:
        raise InputError("pass LOW and HIGH in cd/m^2, or --map FILE")
    bracket = planning.plan(
        low,
        high,
        aperture=aperture,
        iso=iso,
        usable=usable,
        overlap=overlap,
        per_stop=3 if thirds else 1,
    )
    camera = planning.Model(speeds=(iso,), aperture=aperture)
    if camera_file is not None:
        values = _read_camera(camera_file, camera._fields)
        for name, option in (("aperture", "aperture"), ("speeds", "iso")):
            is_given = ctx.get_parameter_source(option) is ParameterSource.COMMANDLINE
            if is_given and name in values:
                raise InputError(
                    f"--{option} and {name} in {camera_file} exclude each other; leave one out"
                )
        camera = camera._replace(**values)
    for line in _bracket_lines(bracket, low, high, aperture=aperture, iso=iso, usable=usable):
        click.echo(line)
    if snr is not None:
        for line in _noise_lines(bracket, low, high, iso=iso, snr=snr, camera=camera):
            click.echo(line)


def _either(argument: float | None, option: float | None, name: str) -> float | None:
    """Return the value of an argument that is also an option; both together are an error."""
    if argument is not None and option is not None:
        raise InputError(f"{name} and --{name.lower()} are the same; pass one of them")
    return option if argument is None else argument


def _scene_range(source: Path) -> tuple[float, float]:
    """Return the darkest and the brightest luminance of a radiance map, without outliers."""
    import numpy as np

    from hdrlab.core.colour import luminance

    L = luminance(common.read_map(source, clean=False))
    if not (L > 0).any():
        raise InputError(f"{source}: all pixels are black; pass a map with positive radiance")
    darkest, brightest = np.quantile(L[L > 0], SCENE_QUANTILES)
    return float(darkest), float(brightest)


def _read_camera(file: Path, known: tuple[str, ...]) -> dict[str, Any]:
    """Return the values of a camera's noise model in a TOML file, by name."""
    import tomllib

    if file.suffix.lower() == ".json":
        return _read_measured_camera(file)
    expected = f"{file}: expected a list of speeds and numbers for the rest of {', '.join(known)}"
    try:
        table = tomllib.loads(file.read_text(encoding="utf8"))
        values = {
            name: tuple(map(float, value)) if name == "speeds" else float(value)
            for name, value in table.items()
        }
    except (TypeError, ValueError, OverflowError) as error:
        raise FileFormatError(f"{expected}; {error}") from None
    unknown = sorted(set(values) - set(known))
    if unknown or values.get("speeds") == ():
        got = ", ".join(unknown) or "no speeds"
        raise FileFormatError(f"{expected}; got {got}")
    return values


def _read_measured_camera(file: Path) -> dict[str, Any]:
    """Return the values of the noise model that `hdrlab noise` measured of the green channel."""
    from hdrlab.pipeline import camera_noise, camera_noise_file

    noise = camera_noise_file.read_camera_noise(file)
    camera_noise.require_useful(noise)
    channels = {channel.name: channel for channel in noise.channels}
    channel = channels.get("green", noise.channels[0])
    values: dict[str, Any] = {
        "gain": channel.gain.value,
        "read_noise": camera_noise.safe_read_noise(channel),
        "full_well": channel.full_well.value,
    }
    if noise.iso is not None:
        values["speeds"] = (noise.iso,)
    return values


def _bracket_lines(
    bracket: "planning.Plan",
    low: float,
    high: float,
    *,
    aperture: float,
    iso: float,
    usable: float,
) -> Iterator[str]:
    """Yield the lines that describe a scene and the bracket for it."""
    import numpy as np

    stops = np.log2(high / low)
    yield f"scene: {low:.3g} to {high:.3g} cd/m^2, {stops:.1f} stops; one photo holds {usable:g}"
    count = len(bracket.times)
    photos = "1 photo" if count == 1 else f"{count} photos, {bracket.step:.3g} stops apart"
    yield f"{photos}, f/{aperture:g}, ISO {iso:g}:"
    for name, seconds, (dark, bright) in zip(
        bracket.names, bracket.times, bracket.holds, strict=True
    ):
        holds = f"{dark:.3g} to {bright:.3g} cd/m^2"
        yield f"  {name:>7} s  (exactly {seconds:.6g} s) holds {holds}"


def _noise_lines(
    bracket: "planning.Plan",
    low: float,
    high: float,
    *,
    iso: float,
    snr: float,
    camera: "planning.Model",
) -> Iterator[str]:
    """Yield the lines that compare a bracket by stops with the fastest one for an SNR."""
    import numpy as np

    from hdrlab.capture import planning

    by_stops = planning.Shots(bracket.names, bracket.times, np.full(len(bracket.times), iso))
    by_noise = planning.plan_by_noise(low, high, snr, camera)
    for title, shots in (("by stops", by_stops), ("by noise", by_noise)):
        worst = planning.worst_snr(low, high, shots.times, shots.speeds, camera)
        count = len(shots.names)
        duration = f"{shots.times.sum():.4g} s and {count} pauses of {camera.pause:g} s"
        yield f"{title}: {count} photos in {duration}; lowest signal-to-noise ratio {worst:.3g}"
    for name, seconds, speed in zip(by_noise.names, by_noise.times, by_noise.speeds, strict=True):
        yield f"  {name:>7} s  (exactly {seconds:.6g} s) at ISO {speed:g}"


@click.command(cls=common.Command)
@click.argument("photo", type=common.INPUT_PATH)
@common.choice_option("--mode", METERING_MODES, "centre", help="Metering mode.")
@click.option(
    "--at",
    metavar="DOWN,RIGHT",
    default="0.5,0.5",
    help="Position of the spot, as fractions of the height and the width.",
)
def meter(photo: Path, mode: str, at: str) -> None:
    """Meter PHOTO like a camera, and report the correct exposure.

    hdrlab assumes an sRGB photo. The true brightness of clipped pixels is unknown. So if many are
    clipped, take another photo with the reported time, and meter that one.
    """
    import numpy as np

    from hdrlab.capture import metering
    from hdrlab.core.colour import decode_srgb, luminance
    from hdrlab.io import decode, photos

    place = _parse_place(at)
    image = photos.read_photo(photo)
    largest = np.float32(np.iinfo(image.dtype).max)
    brightness = np.minimum(luminance(decode_srgb(image / largest)), 1)
    weights = metering.weights(brightness, mode, at=place)
    reading = metering.reading(brightness, weights)
    stops = metering.correction(brightness, weights)
    metered_fraction = (weights > weights.max() / 100).mean()
    clipped_fraction = float((weights * (brightness >= 1)).sum())
    click.echo(
        f"{mode}: meters {metered_fraction:.0%} of the pixels; "
        f"{clipped_fraction:.0%} of their weight is on clipped pixels"
    )
    direction = "too dark" if stops > 0 else "too bright"
    click.echo(
        f"reading {reading:.3f} of full scale, the target is {metering.MIDDLE_GRAY}: "
        f"{abs(stops):.1f} stops {direction}"
    )
    seconds = decode.read_header(photo).exposure.seconds
    if seconds:
        click.echo(_corrected_time(seconds, stops))


def _corrected_time(seconds: float, stops: float) -> str:
    """Return the time of a photo, and the time on the dial that corrects it by `stops`."""
    import numpy as np

    from hdrlab.capture import exposure

    corrected = exposure.true_time(exposure.true_time(seconds) * 2.0**stops)
    dial = exposure.shutter_series(3)
    name = dial.names[int(np.argmin(abs(dial.values - corrected)))]
    taken = f"{seconds:g}" if seconds >= SHORTEST_DECIMAL_SECONDS else f"1/{1 / seconds:.0f}"
    return f"taken with {taken} s; the right time is {name} s"


def _parse_place(text: str) -> tuple[float, float]:
    """Return the two fractions of --at."""
    try:
        down, right = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(
            f"--at: expected two fractions of the image, such as 0.5,0.5, got {text!r}"
        ) from None
    return down, right


@click.command(cls=common.Command)
@click.argument("photo", type=common.INPUT_PATH)
@click.option(
    "-o",
    "--out",
    required=True,
    type=common.OUTPUT_PICTURE,
    help="Photo to write: .png, .jpg or .tif.",
)
@common.choice_option(
    "--by", ["auto", "skin", "blocks"], help="Region to expose correctly, see above."
)
@common.choice_option("--skin", ["chrominance", "locus"], help="Method that finds skin.")
@click.option(
    "--target",
    default=128.0,
    help="Mean pixel value of that region after the correction, 1 to 254.",
)
def correct(photo: Path, out: Path, by: str, skin: str, target: float) -> None:
    """Correct the exposure of PHOTO.

    hdrlab changes the brightness so that the important region is well exposed. --by skin selects
    skin, and --by blocks selects the blocks with the most contrast and the sharpest focus. --by
    auto uses skin if it covers at least a hundredth of the photo, and otherwise blocks.

    If the exposure is wrong by less than a third of a stop, hdrlab does not change it. The output
    always has 8 bits per channel.
    """
    from hdrlab.core.arrays import to_256
    from hdrlab.enhance import battiato
    from hdrlab.enhance.skin import FINDERS
    from hdrlab.io import photos

    Z = to_256(photos.read_photo(photo))
    correction = battiato.correct(Z, by=by, find_skin=FINDERS[skin], target=target)
    photos.write_picture(out, correction.picture, is_result=True)
    fraction = correction.relevant.mean()
    click.echo(
        f"important region: {correction.by}, {fraction:.0%} of the photo, "
        f"mean pixel value {correction.before:.0f}"
    )
    if correction.delta:
        change = f"{correction.delta:+.1f} stops: mean pixel value {correction.after:.0f}"
    else:
        change = "unchanged"
    click.echo(f"{out}: {change}")


@click.command(cls=common.Command)
@click.option(
    "-o",
    "--out",
    required=True,
    type=common.OUTPUT_PATH,
    help="Folder for the photos, new or empty.",
)
@click.option("--frames", type=click.IntRange(2), default=7, help="Number of photos.")
@click.option(
    "--stops",
    type=click.FloatRange(0, min_open=True),
    default=2.0,
    help="Stops between one photo and the next.",
)
@click.option(
    "--assemble",
    "map_file",
    type=common.OUTPUT_MAP,
    help=f"Radiance map to assemble from the photos: {common.MAP_SUFFIXES}.",
)
def shoot(out: Path, frames: int, stops: float, map_file: Path | None) -> None:
    """Take a bracket with a camera on a USB cable.

    hdrlab fixes focus, ISO and white balance, and restores them at the end. It does not change the
    aperture. The middle photo gets the time that the camera shows: in mode A (Av) the metered time,
    in mode M the time that you set. For the others, hdrlab uses the nearest times that the camera
    has.

    hdrlab saves each photo as soon as it is taken, and adds its time to exposures.csv. This command
    needs the extra `camera` and runs on Linux and macOS.
    """
    from hdrlab.capture import exposure, planning
    from hdrlab.io import files, sequence, tethered

    # bad options are reported before the first photo
    common.require_modules("camera", ["gphoto2"])
    sequence.require_new(out)
    with tethered.connected() as camera:
        common.echo_notes(camera.fix("light"))
        metered, names = camera.shutter()
        dial = exposure.read_dial(names)
        chosen = planning.around(exposure.seconds(metered), dial.values, frames, stops)
        common.echo_notes(camera.fix("mode"))
        out.mkdir(exist_ok=True)
        lines = ["file,exposure_time_s"]
        for index in common.progress(chosen, "taking", frames):
            paths = camera.photograph(dial.names[index], out / f"{len(lines):02d}")
            lines.append(f"{paths[0].name},{dial.values[index]:.6g}")
            files.write(out / "exposures.csv", "\n".join(lines) + "\n")
            click.echo(f"{paths[0]}: {dial.names[index]}")
    if map_file:
        times = str(out / "exposures.csv")
        words = ["-o", str(map_file), "--times", times, "--", str(out)]
        photo_commands.assemble.main(words, standalone_mode=False)
