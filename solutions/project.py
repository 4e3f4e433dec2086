# %% [markdown]
# # Project · Your own HDR photograph
#
# Due {due}. {total} points. {late}
#
# Find a place that no photograph holds: a church at noon, a street at night, your desk before the window.
# Photograph it, assemble its radiance, and make a picture that shows what you saw there. One part is
# checked here; the rest is looked at by people.
#
# You work in teams of two, and hand in once.
#
# What people look at:
#
# {hand}
#
# Hand in: this notebook, run from top to bottom; your photographs; the radiance map (`.hdr` or `.exr`); the
# picture, your *artifact* (`.jpg` or `.png`); a report of one or two pages.

# %%
from pathlib import Path

import numpy as np

from hdrlab import pipeline, scenes
from hdrlab.capture import camera
from hdrlab.core import colour
from hdrlab.course.notebook import check, use_plan
from hdrlab.io import photos
from hdrlab.show import pictures, plots

use_plan("project")

# %% [markdown] about="tonemap"
# ## 1 · The operator ({points})
#
# Write the photographic operator of Reinhard and his colleagues as one function; homework 4 has its parts.
# Log average, scale to the key $a$, and
#
# $$L_d = \frac{L_m\,(1 + L_m / L_{white}^2)}{1 + V}, \qquad L_m = \frac{a L}{\bar L},$$
#
# where $V$ is $L_m$ itself, or with `local=True` the mean of each pixel's own even neighbourhood: what
# `scale_steps` of homework 4 ends with, with `key`, `phi` and `threshold`, given $L_m$ blurred by Gaussians
# of $\sigma = s / 4$, $s = 1, 1.6, \ldots, 1.6^8$. $\delta$ is that of homework 4, $10^{-6}$. `white=None`
# takes the brightest $L_m$ but for 0.01 % of the pixels, by any rule of quantiles, and at least 1. The
# checks give finite luminance and knobs above 0; what to do with any other is yours to decide, and
# `key="auto"` is the library's alone.

# %% task="tonemap"

# %% [markdown]
# ## 2 · The photographs
#
# - A tripod, or a wall to lean on. The camera on manual: fixed aperture, ISO, focus and white balance;
#   only the shutter changes, by one or two stops from one photograph to the next.
# - The shortest shows no clipped pixel but the lamp or the sun itself; the longest shows the dark corner
#   at a middling level.
# - Nothing moves, if you can help it. If something does, say in the report what became of it.
#
# Put the folder's name between the quotes. As long as it is empty, a simulated room stands in.

# %%
FOLDER = ""
room = scenes.room((240, 320))
bracket = camera.shoot(
    room,
    2.0 ** np.arange(-9, 2, 2),
    camera.Camera(sensitivity=1 / 16, full_well=2e4, read_noise=5),
    rng=6,
)
if FOLDER:
    bracket = photos.read_bracket(Path(FOLDER))
pictures.picture(
    plots.thumbnails(bracket), alt="The photographs, from the shortest exposure to the longest"
)

# %% [markdown]
# ## 3 · The radiance map
#
# Take your own `align`, `recover` and `merge` from the homeworks, or the library's: `pipeline.assemble`
# takes a function where it takes a name. Read the doubts that it names, and say in the report what you did
# about them.

# %%
assembly = pipeline.assemble(bracket)
print("\n".join(assembly.doubts) or "no doubts")
pictures.radiance(assembly.E, alt="The radiance map in false colour")

# %% [markdown]
# ## 4 · The artifact
#
# Now the picture. Turn the knobs, try `local`, try the other operators (`hdrlab compare`), until it shows
# what you saw.

# %% about="tonemap"
L = colour.luminance(assembly.E)
Ld = tonemap(L, key=0.25, local=True)
artifact = colour.to_8bit(colour.recolour(assembly.E, L, Ld))
pictures.picture(artifact, alt="The artifact: the scene by your operator")

# %% [markdown]
# ## 5 · The report
#
# One or two pages: where you were and how you photographed; the response you found, and whether you trust
# it; what was clipped, what moved, and what you did about it; which operator and why; what went wrong. A
# plot and a radiance map in false colour say more than a paragraph.
#
# ## 6 · Bells and whistles
#
# Choose what tempts you: a second operator of your own; ghosts removed; handheld photographs aligned; a
# response recovered with Robertson's turns; a panorama; a scene relit. Show it beside the plain version,
# and say what it cost.

# %%
check("project")
