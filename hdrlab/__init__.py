"""hdrlab: high dynamic range imaging, from exposure to radiance map to tone-mapped image.

lecture                                where
-------------------------------------  --------------------------------------------------------------------
Exposure, and planning a bracket       capture.exposure, capture.planning.plan
Median threshold bitmaps               align.mtb.align, align.shift.shift
Hand-held photos: rotation, homography align.cerman.align, align.homography.align
The response by least squares          response.debevec.gsolve, response.debevec.recover
... by maximum likelihood              response.robertson.recover
... without exact times                response.mitsunaga.recover
... from histograms, from comparagrams response.grossberg.recover, response.mann.recover
The radiance map                       radiance.merge.merge
Its files: PFM, RGBE, OpenEXR, TIFF    io.maps.pfm, io.maps.rgbe, io.maps.exr, io.maps.tiff
One curve for all pixels               tonemap.ward.tonemap, tonemap.curves
Local scaling, and its halo            tonemap.chiu.tonemap
Base and detail                        tonemap.durand.tonemap, core.filters.bilateral
Photographic tone reproduction         tonemap.reinhard.tonemap
Gradients                              tonemap.fattal.tonemap, core.filters.poisson
Exposure fusion, without a map         enhance.mertens.fuse
Exposure correction and skin detection enhance.battiato.correct, enhance.relight, enhance.skin
-------------------------------------  --------------------------------------------------------------------
A camera, its sensor and its meter     capture.camera.shoot, capture.photon_transfer, capture.metering
A response from measured curves        response.space.recover, response.marginal.calibrate, response.linear
... without a bracket                  calibration.chart, calibration.display, calibration.motion_blur
Ghosts, veiling glare, exposure ratios radiance.deghosting.ghosts, radiance.flare, radiance.ratios
Local Laplacian filters                tonemap.local_laplacian.tonemap
Drago's logarithm, view transforms     tonemap.drago, tonemap.agx, tonemap.khronos
Transfer functions of screens: PQ, HLG tonemap.transfer
Bursts, other cameras, patches, video  beyond.burst, beyond.assorted, beyond.patches, beyond.video
Fast versions of the same functions    fast.debevec, fast.merge, fast.durand
Consistency checks of a radiance map   diagnostics.consistency, diagnostics.contradictions
The whole pipeline                     pipeline.assemble, pipeline.develop; io.photos.read_bracket
Step-by-step widgets, sliders, plots   show.widgets.play, show.widgets.tune, show.plots

`import hdrlab` imports none of these packages. Each is imported when it is first used, so
`hdrlab.tonemap` works without an import of its own.
"""

import importlib
from types import ModuleType

__version__ = "0.2.0"

CHAPTERS = (
    "align",
    "beyond",
    "calibration",
    "capture",
    "core",
    "diagnostics",
    "enhance",
    "fast",
    "io",
    "pipeline",
    "radiance",
    "response",
    "scenes",
    "show",
    "tonemap",
)


def __getattr__(name: str) -> ModuleType:
    if name in CHAPTERS:
        return importlib.import_module(f"hdrlab.{name}")
    raise AttributeError(f"module 'hdrlab' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*globals(), *CHAPTERS]
