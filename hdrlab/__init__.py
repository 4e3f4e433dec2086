"""hdrlab: high dynamic range imaging, from light to numbers to a picture.

lecture                                where
-------------------------------------  --------------------------------------------------------------------
Exposure, and planning a bracket       capture.exposure, capture.planning.plan
Median threshold bitmaps               align.mtb.align, align.shift.shift
From the hand: turned, tilted          align.cerman.align, align.homography.align
The response by least squares          response.debevec.gsolve, response.debevec.recover
... by maximum likelihood              response.robertson.recover
... without exact times                response.mitsunaga.recover
... from histograms, from a series     response.grossberg.recover, response.mann.recover
The radiance map                       radiance.merge.merge
Its files: PFM, RGBE, OpenEXR, TIFF    io.maps.pfm, io.maps.rgbe, io.maps.exr, io.maps.tiff
One curve for all pixels               tonemap.ward.tonemap, tonemap.curves
Local scaling, and its halo            tonemap.chiu.tonemap
Base and detail                        tonemap.durand.tonemap, core.filters.bilateral
Photographic tone reproduction         tonemap.reinhard.tonemap
Gradients                              tonemap.fattal.tonemap, core.filters.poisson
A picture without a radiance map       enhance.mertens.fuse
A badly exposed photograph, and skin   enhance.battiato.correct, enhance.relight, enhance.skin
-------------------------------------  --------------------------------------------------------------------
A camera, its sensor and its meter     capture.camera.shoot, capture.photon_transfer, capture.metering
A response from measured curves        response.space.recover, response.marginal.calibrate, response.linear
... without a bracket                  calibration.chart, calibration.display, calibration.motion_blur
What moved, and what the lens did      radiance.deghosting.ghosts, radiance.flare, radiance.ratios
Edges made smaller at each scale       tonemap.local_laplacian.tonemap
The codes of HDR screens: PQ, HLG      tonemap.transfer
Other cameras, patches, video          beyond.assorted, beyond.flutter, beyond.patches, beyond.video
The same functions, fast               fast.debevec, fast.merge, fast.durand
May I trust it?                        diagnostics.consistency, diagnostics.contradictions
All of it in a row                     pipeline.assemble, pipeline.develop; io.photos.read_bracket
Steps, sliders, plots                  show.widgets.play, show.widgets.tune, show.plots

Chapters are loaded when they are first used: `import hdrlab` costs nothing, and `hdrlab.tonemap`
works.
"""

import importlib
from typing import Any

__version__ = "0.2.0"

CHAPTERS = (
    *("align", "beyond", "calibration", "capture", "core", "diagnostics", "enhance", "fast", "io"),
    *("pipeline", "radiance", "response", "scenes", "show", "tonemap"),
)


def __getattr__(name: str) -> Any:
    if name in CHAPTERS:
        return importlib.import_module(f"hdrlab.{name}")
    raise AttributeError(f"module 'hdrlab' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*globals(), *CHAPTERS]
