"""The demo: simulate a bracket of a scene with known radiance, assemble it, and compare.

The simulated camera has an unknown response, camera shake, noise and a few hot pixels, as a real
one has, and the true radiance is known. `real_steps` runs the same steps on real photos, whose
true radiance is unknown.
"""

from collections.abc import Generator, Iterator
from dataclasses import dataclass
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

# lines that demo_steps and real_steps yield
STEP_COUNT = 10

CAMERA = camera.Camera(response="film", full_well=60_000.0, read_noise=6.0, hot=2e-5)

# pixel values between which the summary measures the response
DARK_LEVEL = 10
BRIGHT_LEVEL = 250


@dataclass(frozen=True)
class DemoResult:
    """The assembled bracket and its tone-mapped image."""

    assembly: pipeline.Assembly
    developed: Developed


def demo_steps(out: Path, *, seed: int = 1) -> Iterator[str]:
    """Write the demo's files into `out`, and yield a line about each step when it is done."""
    rng = np.random.default_rng(seed)
    scene = scenes.chapel()
    yield f"scene      a chapel with stained glass, {scenes.decades(scene):.1f} decades"
    times = camera.times_around(scene)
    offsets = camera.shake(len(times), rng=rng)
    bracket = camera.shoot(scene, times, CAMERA, offsets=offsets, rng=rng)
    yield f"bracket    {len(times)} photos, {times[0]:.2g} s to {times[-1]:.2g} s, hand-held"
    result = yield from _assemble_steps(out, bracket)
    middle_view = views(scene, offsets)[len(times) // 2]
    common_area = crop(result.assembly.offsets, bracket.images.shape[1:3])
    truth = Truth(middle_view[common_area], responses.true_g(CAMERA.response), offsets)
    recipe = {
        "tonemap": result.developed.settings,
        "seed": seed,
        "camera": CAMERA.response,
        "full_well": CAMERA.full_well,
        "read_noise": CAMERA.read_noise,
        "hot": CAMERA.hot,
    }
    page = write_report(out, result.assembly, result.developed.picture, recipe=recipe, truth=truth)
    yield f"report     {page}"


def real_steps(out: Path) -> Iterator[str]:
    """Run the demo on real photos, whose true radiance is unknown."""
    bracket = scenes.window()
    yield "scene      a dark room with a window, by Axel Jacobs (CC BY-SA 2.0)"
    yield f"bracket    {len(bracket.times)} photos, from a tripod, one stop apart"
    result = yield from _assemble_steps(out, bracket)
    recipe = {"tonemap": result.developed.settings}
    page = write_report(out, result.assembly, result.developed.picture, recipe=recipe)
    yield f"report     {page}"


def _assemble_steps(out: Path, bracket: Bracket) -> Generator[str, None, DemoResult]:
    """Assemble a bracket, write its maps and its image, and yield a line about each step."""
    out.mkdir(parents=True, exist_ok=True)
    for assembly in pipeline.assemble_steps(bracket):
        yield f"{assembly.stage:<10} {_summarize(assembly)}"
    developed = pipeline.develop_and_describe(assembly.E)
    yield f"picture    {developed.settings}"
    for suffix in (".hdr", ".exr", ".pfm"):
        radiance.write_radiance(out / f"radiance{suffix}", assembly.E)
    photos.write_picture(out / "picture.png", developed.picture, is_result=True)
    yield f"files      radiance.hdr, .exr, .pfm and picture.png in {out}"
    return DemoResult(assembly, developed)


def _summarize(assembly: pipeline.Assembly) -> str:
    """Return the result of the pipeline's last stage in words."""
    match assembly.stage:
        case "align":
            offsets = ", ".join(f"({dy}, {dx})" for dy, dx in assembly.offsets)
            return f"moved by {offsets} pixels"
        case "times":
            times = assembly.bracket.times
            return f"the longest is {times[-1] / times[0]:.4g} times the shortest"
        case "response":
            g = assembly.g.reshape(256, -1).mean(axis=1)
            stops = (g[BRIGHT_LEVEL] - g[DARK_LEVEL]) / np.log(2)
            return f"pixel values {DARK_LEVEL} and {BRIGHT_LEVEL} are {stops:.1f} stops apart"
        case "merge":
            return f"{np.mean(assembly.quality == 0):.2%} of the pixels measured"
        case _:
            return f"the frames agree to {assembly.spread:.3f} stops"
