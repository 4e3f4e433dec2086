"""hdrlab: high dynamic range imaging, from light to numbers to a picture.

lecture                              where
-----------------------------------  ------------------------------------------------------------
Light to numbers                     capture.camera.shoot, capture.scenes.room
Photographs in                       io.photos.read_bracket
Median threshold bitmaps             align.mtb.align, align.shift.shift
The response curve                   response.debevec.gsolve, response.debevec.recover
RAW: no response to recover          response.linear.recover, io.raw
The radiance map                     radiance.merge.merge, radiance.bounds
Does the map explain its frames?     radiance.consistency.spread
PFM, Radiance RGBE, OpenEXR          io.pfm, io.rgbe, io.exr; io.radiance.read_radiance
From radiance to a display           tonemap.curves.tonemap
Photographic tone reproduction       tonemap.reinhard.tonemap
All of it in a row                   pipeline.assemble, pipeline.develop
Pictures and sliders                 show.plots, show.widgets.play, show.widgets.tune

Chapters are loaded when they are first used: `import hdrlab` costs nothing, and `hdrlab.tonemap.reinhard` works.
"""

import lazy_loader

__version__ = "0.1.0"

CHAPTERS = ["align", "capture", "core", "io", "pipeline", "radiance", "response", "show", "tonemap"]
__getattr__, __dir__, __all__ = lazy_loader.attach(__name__, submodules=CHAPTERS)
