"""The main job on an embedded scene: photograph a chapel whose radiance is known, assemble, compare.

The camera keeps its response to itself, the hand shakes, the sensor is noisy and has a few stuck pixels: all
that a real bracket has, and the truth besides.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from hdrlab import pipeline, scenes
from hdrlab.align.shift import crop
from hdrlab.capture import camera, responses
from hdrlab.core.metrics import Truth
from hdrlab.io.photos import write_picture
from hdrlab.io.radiance import write_radiance
from hdrlab.show.pages.report import write_report

STEPS = 10
CAMERA = camera.Camera(response="film", full_well=60_000.0, read_noise=6.0, hot=2e-5)


def demo_steps(out: Path, *, seed: int = 1) -> Iterator[str]:
    """Write the demo's files into `out`, and yield a line about each step when it is done."""
    rng = np.random.default_rng(seed)
    out.mkdir(parents=True, exist_ok=True)
    scene = scenes.chapel()
    yield f"scene      a chapel with stained glass, {scenes.decades(scene):.1f} decades"
    times = camera.times_around(scene)
    shaken = camera.shake(len(times), rng=rng)
    bracket = camera.shoot(scene, times, CAMERA, offsets=shaken, rng=rng)
    yield f"bracket    {len(times)} photographs, {times[0]:.2g} s to {times[-1]:.2g} s, hand-held"
    for assembly in pipeline.assemble_steps(bracket):
        yield f"{assembly.stage:<10} {_summarise(assembly)}"
    picture, settings = pipeline.develop_and_describe(assembly.E)
    yield f"picture    {settings}"
    for suffix in (".hdr", ".exr", ".pfm"):
        write_radiance(out / f"radiance{suffix}", assembly.E)
    write_picture(out / "picture.png", picture)
    yield f"files      radiance.hdr, .exr, .pfm and picture.png in {out}"
    light = camera.views(scene, shaken)[len(times) // 2][crop(assembly.offsets, bracket.images.shape[1:3])]
    truth = Truth(light, responses.true_g(CAMERA.response), shaken)
    noise = {name: getattr(CAMERA, name) for name in ("full_well", "read_noise", "hot")}
    recipe = {"tonemap": settings, "seed": seed, "camera": CAMERA.response, **noise}
    page = write_report(out, assembly, picture, recipe=recipe, truth=truth)
    yield f"report     {page}"


def _summarise(assembly: pipeline.Assembly) -> str:
    """Return what a stage of the pipeline has to say."""
    match assembly.stage:
        case "align":
            return "moved by " + ", ".join(f"({dy}, {dx})" for dy, dx in assembly.offsets) + " pixels"
        case "times":
            return "from " + " to ".join(f"{time:.4g} s" for time in assembly.bracket.times[[0, -1]])
        case "response":
            darkest, brightest = assembly.g.reshape(256, -1)[[10, 250]].mean(axis=1)
            return f"levels 10 and 250 lie {(brightest - darkest) / np.log(2):.1f} stops apart"
        case "merge":
            return f"{np.mean(assembly.quality == 0):.2%} of the pixels measured"
        case _:
            return f"the frames agree to {assembly.spread:.3f} stops"
