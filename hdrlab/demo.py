"""The main job on an embedded scene: photograph a chapel whose radiance is known, assemble, compare.

The camera keeps its response to itself, the hand shakes, the sensor is noisy and has a few stuck
pixels: all that a real bracket has, and the truth besides. `real_steps` does it with a real
bracket, without the truth.
"""

from collections.abc import Generator, Iterator
from pathlib import Path

import numpy as np

from hdrlab import pipeline, scenes
from hdrlab.align.shift import crop
from hdrlab.capture import camera, responses
from hdrlab.capture.hand_motion import views
from hdrlab.core.bracket import Bracket
from hdrlab.core.metrics import Truth
from hdrlab.io import photos, radiance
from hdrlab.pipeline.pictures import Developed
from hdrlab.show.pages.report import write_report

STEPS = 10
CAMERA = camera.Camera(response="film", full_well=60_000.0, read_noise=6.0, hot=2e-5)


def demo_steps(out: Path, *, seed: int = 1) -> Iterator[str]:
    """Write the demo's files into `out`, and yield a line about each step when it is done."""
    rng, scene = np.random.default_rng(seed), scenes.chapel()
    yield f"scene      a chapel with stained glass, {scenes.decades(scene):.1f} decades"
    times = camera.times_around(scene)
    shaken = camera.shake(len(times), rng=rng)
    bracket = camera.shoot(scene, times, CAMERA, offsets=shaken, rng=rng)
    yield f"bracket    {len(times)} photographs, {times[0]:.2g} s to {times[-1]:.2g} s, hand-held"
    assembly, (picture, settings) = yield from _assemble_steps(out, bracket)
    light = views(scene, shaken)[len(times) // 2][crop(assembly.offsets, bracket.images.shape[1:3])]
    truth = Truth(light, responses.true_g(CAMERA.response), shaken)
    noise = {name: getattr(CAMERA, name) for name in ("full_well", "read_noise", "hot")}
    recipe = {"tonemap": settings, "seed": seed, "camera": CAMERA.response, **noise}
    yield f"report     {write_report(out, assembly, picture, recipe=recipe, truth=truth)}"


def real_steps(out: Path) -> Iterator[str]:
    """Do the same with real photographs, whose radiance nobody knows."""
    bracket = scenes.photographs((720, 540))
    yield "scene      a small tripod before a window, seen by a telephone"
    yield f"bracket    {len(bracket.times)} photographs, hand-held"
    assembly, (picture, settings) = yield from _assemble_steps(out, bracket)
    yield f"report     {write_report(out, assembly, picture, recipe={'tonemap': settings})}"


def _assemble_steps(
    out: Path, bracket: Bracket
) -> Generator[str, None, tuple[pipeline.Assembly, Developed]]:
    """Write the maps and the picture of a bracket, yield a line about each step, return what was found."""
    out.mkdir(parents=True, exist_ok=True)
    for assembly in pipeline.assemble_steps(bracket):
        yield f"{assembly.stage:<10} {_summarise(assembly)}"
    made = pipeline.develop_and_describe(assembly.E)
    yield f"picture    {made.settings}"
    for suffix in (".hdr", ".exr", ".pfm"):
        radiance.write_radiance(out / f"radiance{suffix}", assembly.E)
    photos.write_picture(out / "picture.png", made.picture)
    yield f"files      radiance.hdr, .exr, .pfm and picture.png in {out}"
    return assembly, made


def _summarise(assembly: pipeline.Assembly) -> str:
    """Return what a stage of the pipeline has to say."""
    match assembly.stage:
        case "align":
            return (
                "moved by " + ", ".join(f"({dy}, {dx})" for dy, dx in assembly.offsets) + " pixels"
            )
        case "times":
            times = assembly.bracket.times
            return f"the longest is {times[-1] / times[0]:.4g} times the shortest"
        case "response":
            darkest, brightest = assembly.g.reshape(256, -1)[[10, 250]].mean(axis=1)
            return f"levels 10 and 250 lie {(brightest - darkest) / np.log(2):.1f} stops apart"
        case "merge":
            return f"{np.mean(assembly.quality == 0):.2%} of the pixels measured"
        case _:
            return f"the frames agree to {assembly.spread:.3f} stops"
