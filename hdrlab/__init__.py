"""hdrlab: high dynamic range imaging, from light to numbers to a picture.

lecture                                where
-------------------------------------  --------------------------------------------------------------------
Light to numbers                       capture.camera.shoot, scenes.chapel, scenes.room
What the sensor does, and its range    capture.sensor, capture.ranges, capture.photon_transfer.calibrate
Exposure, and planning a bracket       capture.exposure, capture.planning.plan
Metering, automatic exposure           capture.metering, capture.autoexposure.expose
Photographs in, with their exposure    io.photos.read_bracket
Median threshold bitmaps               align.mtb.align, align.shift.shift
From the hand: turned, tilted          align.cerman.align, align.homography.align
... moved through linear light         align.resample.photographs, capture.hand_motion.shake
The response by least squares          response.debevec.gsolve, response.debevec.recover
... by maximum likelihood              response.robertson.recover
... without exact times                response.mitsunaga.recover, response.marginal.calibrate
... from histograms, from a series     response.grossberg.recover, response.mann.recover
... in the space of measured curves    response.space.recover
... without a bracket                  calibration.display, calibration.motion_blur, calibration.chart
... of RAW: none to recover            response.linear.recover
Which pixels to use                    core.sampling, response.selection
The radiance map                       radiance.merge.merge, radiance.merge.bound
Does the map explain its photographs?  diagnostics.consistency, diagnostics.contradictions
Exposure ratios of a linear camera     radiance.ratios.ratio
What moved, and what the lens did      radiance.deghosting.ghosts.remove_ghosts, radiance.flare.remove_glare
... photographed with the truth        capture.movers.shoot, capture.lens_flare.add_flare
PFM, Radiance RGBE, OpenEXR            io.pfm, io.rgbe, io.exr; io.radiance.read_radiance
One curve for all pixels               tonemap.curves, tonemap.ward, tonemap.brush
Local scaling, and its halo            tonemap.chiu.tonemap
Base and detail                        tonemap.durand.tonemap, core.bilateral
Photographic tone reproduction         tonemap.reinhard.tonemap
Gradients                              tonemap.fattal.tonemap, core.poisson
Which picture is better?               tonemap.quality.tmqi, show.contact.contact_sheet
A picture without a radiance map       enhance.mertens.fuse
A badly exposed photograph, and skin   enhance.battiato.correct, enhance.relight, enhance.skin
Other cameras: pixels, shutters        beyond.assorted, beyond.flutter
Patch-based HDR                        beyond.patches.synthesise, beyond.patchmatch
HDR video                              beyond.video.merge, beyond.steady.tonemap_steps, io.sequence
One lens, three sensors                beyond.splitter.merge
All of it in a row                     pipeline.assemble, pipeline.develop
Steps, sliders, plots                  show.widgets.play, show.widgets.tune, show.plots

Chapters are loaded when they are first used: `import hdrlab` costs nothing, and `hdrlab.tonemap` works.
"""

import lazy_loader

__version__ = "0.1.0"

CHAPTERS = [
    "align",
    "beyond",
    "calibration",
    "capture",
    "core",
    "diagnostics",
    "enhance",
    "io",
    "pipeline",
    "radiance",
    "response",
    "scenes",
    "show",
    "tonemap",
]
__getattr__, __dir__, __all__ = lazy_loader.attach(__name__, submodules=CHAPTERS)
