"""The command that takes the photographs."""

from pathlib import Path

import click

from hdrlab.cli import common, photographs


@common.command()
@click.option("-o", "--out", required=True, type=common.OUT, help="Folder for the photographs, new or empty.")
@click.option("--frames", type=click.IntRange(2), default=7, help="How many photographs.")
@click.option("--stops", type=click.FloatRange(0, min_open=True), default=2.0, help="From one to the next.")
@click.option("--assemble", "map_", type=common.OUT, help="Radiance map to make of them: .hdr, .exr, ...")
def shoot(out: Path, frames: int, stops: float, map_: Path | None) -> None:
    """Take a bracket with the camera on the USB cable.

    Focus, ISO and white balance are fixed, and put back at the end; the aperture stays. The middle time is
    what the camera then shows: in A (Av) what its meter says, in M what you have set. The others are those of
    its times that lie nearest. Each photograph is in the folder as soon as it is taken, with its time in
    exposures.csv. This wants the extra `camera`, which is for Linux and macOS.
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
