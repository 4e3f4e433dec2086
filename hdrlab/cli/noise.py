"""The command `noise`: gain, read noise and full well of one's own camera."""

from pathlib import Path

import click

from hdrlab.cli import common


@click.command(cls=common.Command)
@click.argument("dark", type=common.INPUT_PATH)
@click.argument("flat", type=common.INPUT_PATH)
@click.option(
    "-o",
    "--out",
    type=common.OUTPUT_FILE,
    help="File for all figures, for assemble --noise: .json.",
)
def noise(dark: Path, flat: Path, out: Path | None) -> None:
    """Measure the noise of a camera from the folders DARK and FLAT.

    DARK holds at least two RAW photos with the lens cap on. FLAT holds RAW photos of an evenly lit
    wall, out of focus: two of each exposure, and at least three exposures, from nearly dark to
    clipped. Use one ISO speed for all photos. 16-bit TIFF or PNG files are read as well if they are
    linear.

    For each channel, hdrlab prints four figures with their 95 % intervals: the gain, in electrons
    per level, the read noise and the full well, in electrons, and the level of black. It warns if
    the photos are not what they seem: if the camera applied a tone curve or noise reduction, if
    pixels clip below the white level that the file states, if the lamp flickered, or if light
    reached the darks.

    hdrlab assemble --noise FILE --uncertainty MAP uses the figures to merge a bracket of the same
    camera, and hdrlab plan --camera FILE to plan one.
    """
    from hdrlab.io.files import require_suffix
    from hdrlab.pipeline import camera_noise, camera_noise_file

    # a bad option is reported before the work starts
    if out:
        require_suffix(out, [".json"], "a file for the noise")
    measured = camera_noise.measure_camera_noise(dark, flat)
    common.echo_notes(measured.notes)
    common.echo_warnings(warning.text for warning in measured.warnings)
    click.echo(_describe_photos(measured.camera, measured.iso))
    click.echo(measured)
    if out:
        camera_noise_file.write_camera_noise(out, measured)
        click.echo(out)


def _describe_photos(camera: str, iso: float | None) -> str:
    """Return the line above the table."""
    name = camera or "unknown camera"
    speed = "unknown ISO speed" if iso is None else f"ISO {iso:g}"
    return f"{name}, {speed}, with 95 % intervals:"
