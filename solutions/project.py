# %% [markdown]
# # Project · Your own HDR photo
#
# Due {due}. {total} points. {late}
#
# Find a scene that does not fit into a single photo: a church at noon, a street at night, your desk
# in front of the window. Photograph it, make its radiance map, and tone-map it into an image that
# shows what you saw there. One part is checked here; people grade the rest.
#
# You work in teams of two, and submit once.
#
# What people grade:
#
# {hand}
#
# Submit: this notebook, run from top to bottom; your photos; the radiance map (`.hdr` or `.exr`);
# the tone-mapped image, your *artifact* (`.jpg` or `.png`); and a report of one or two pages.

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
# Write the photographic operator of Reinhard and his colleagues as one function. Homework 4 has its
# parts: the log average, the scaling to the key $a$, and the curve. Use them in this form:
#
# $$L_d = \frac{L_m\,(1 + L_m / L_{white}^2)}{1 + V}, \qquad L_m = \frac{a L}{\bar L}.$$
#
# - $V$ is $L_m$ itself. With `local=True`, it is the mean of each pixel's own even neighborhood:
#   the last adaptation of `scale_steps` of homework 4, with `key`, `phi` and `threshold`. Its input
#   is $L_m$ blurred by Gaussians of $\sigma = s / 4$, $s = 1, 1.6, \ldots, 1.6^8$.
# - $\delta$ is that of homework 4, $10^{-6}$.
# - `white=None` takes the brightest $L_m$ except for 0.01 % of the pixels, by any quantile rule,
#   and at least 1.
# - $L_d$ is clipped at 1. It is finite for any scene, even if all of it is black, and the same for
#   the same scene.
#
# The checks use finite luminance and parameters above 0. For anything else, the behavior is up to
# you. `key="auto"` exists only in the library.

# %% task="tonemap"

# %% [markdown]
# ## 2 · The photos
#
# - Use a tripod, or a wall to lean on. Set the camera to manual, with fixed aperture, ISO, focus
#   and white balance. Change only the shutter time, by one or two stops from one photo to the next.
# - In the shortest exposure nothing is clipped except the lamp or the sun itself. In the longest,
#   the dark corner has medium pixel values.
# - Nothing should move. If something does, say in the report how you dealt with it.
#
# Put the folder's name between the quotes. While it is empty, the notebook uses a simulated room.

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
    plots.thumbnails(bracket), alt="The photos, from the shortest exposure to the longest"
)

# %% [markdown]
# ## 3 · The radiance map
#
# Use your own `align`, `recover` and `merge` from the homework, or the library's:
# `pipeline.assemble` accepts a function wherever it accepts a name. Read the warnings that it
# prints, and say in the report what you did about them.

# %%
assembly = pipeline.assemble(bracket)
print("\n".join(assembly.warnings) or "no warnings")
pictures.radiance(assembly.E, alt="The radiance map in false color")

# %% [markdown]
# ## 4 · The tone-mapped image
#
# Now make the image. Change the parameters, try `local`, and try the other operators
# (`hdrlab compare`), until the image shows what you saw.

# %% about="tonemap"
L = colour.luminance(assembly.E)
Ld = tonemap(L, key=0.25, local=True)
artifact = colour.to_8bit(colour.recolour(assembly.E, L, Ld))
pictures.picture(artifact, alt="The artifact: the scene, tone-mapped with your operator")

# %% [markdown]
# ## 5 · The report
#
# Write one or two pages: where you were and how you took the photos; the response curve, and
# whether you trust it; what was clipped, what moved, and what you did about it; which operator you
# chose and why; and what went wrong. A plot and a radiance map in false color say more than a
# paragraph.
#
# ## 6 · Bells and whistles
#
# Choose what interests you: a second operator of your own, deghosting, alignment of hand-held
# photos, a response curve from Robertson's iterations, a panorama, or a relit scene. Show it beside
# the plain version, and say what it cost.

# %%
check("project")
