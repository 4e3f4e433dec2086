# %% [markdown]
# # Homework 3 · The radiance map and its files
#
# Due {due}. {total} points. {late}
#
# The response is known. Now the photographs become one map of the light in the scene, over more stops than
# any of them holds, and the map becomes a file that another program can open. Between the two stands an
# honest question: what do we say of a pixel that no photograph has measured?
#
# Under each task there is a cell `check("...")`: it says, promise by promise, what holds, and draws what
# differs. Inside a task use numpy, scipy and what this sheet gives; hdrlab cannot be imported when
# your work is graded.

# %%
import numpy as np

from hdrlab import scenes
from hdrlab.capture import camera, responses
from hdrlab.course.notebook import check, use_plan
from hdrlab.show import pictures, plots

use_plan("hw3")

# %% [markdown]
# ## The photographs
#
# Five photographs of a room, two stops apart. No single one shows both the window and the dark corner.

# %%
room = scenes.room((240, 320))
bracket = camera.shoot(
    room,
    2.0 ** np.arange(-9, 1, 2),
    camera.Camera(response="gamma", sensitivity=1 / 16, full_well=2e4, read_noise=5),
    rng=5,
)
g = responses.true_g("gamma")
pictures.picture(
    plots.thumbnails(bracket), alt="Five photographs of a room, from nearly black to nearly white"
)

# %% [markdown] about="merge"
# ## 1 · The radiance map ({points})
#
# Each photograph $j$ says of a pixel: $\ln E = g(Z_j) - \ln t_j$. They disagree a little, and some are
# clipped, so take the mean, weighted by the trust in their levels [Debevec97 eq. 6]:
#
# $$\ln E = \frac{\sum_j w(Z_j)\,[\,g(Z_j) - \ln t_j\,]}{\sum_j w(Z_j)}.$$
#
# `images` are `(P, H, W[, 3])` bytes, `times` `(P,)` seconds, `g` `(256,)` or one column for each channel,
# `w` `(256,)`, where none is given the hat of homework 2, which is 0 at both ends. Return $E$ `(H, W[,
# 3])`. Where all weights are zero the mean is undefined; the next task has an answer, and no check of this
# one looks there. (The library also drops a frame for all channels of a pixel where one is clipped. No
# check asks for that either.)

# %% task="merge"
# Return the radiance map E: the mean of the logarithms, weighted, over the photographs.

# %% about="merge"
E = merge(bracket.images, bracket.times, g)
pictures.radiance(E, alt="The radiance map of the room in false colour")

# %% [markdown] about="bound"
# ## 2 · Pixels that nobody measured ({points})
#
# The sun is clipped in all photographs, and a mean would have nothing to go by. But a clipped pixel is not
# unknown: its exposure was *at least* that of the first clipped level, `top`; and that of a dark one, level
# 0, at most that of level 1:
#
# $$\ln E \ge g(\mathrm{top}) - B_j \quad\text{(clipped in } j), \qquad
#   \ln E \le g(1) - B_j \quad\text{(dark in } j).$$
#
# The tightest bounds count. With one of them the map takes it; between two it takes the middle of their
# logarithms; without any, $E = 0$. `Z` is `(P, M)`: levels of $M$ such pixels; `B` `(P,)` ln times; `shown`
# `(P, M)` is False where a photograph does not show the pixel at all. Return $E$ `(M,)` and flags `(M,)`:
# the sum of 1 where it was clipped in some photograph that shows it and 2 where it was dark in one, and 8
# where there is no bound. A level between gives none.

# %% task="bound"
# Return E (M,) and flags (M,) of pixels that no frame measures, from the frames' tightest bounds.

# %% [markdown] about="to_bytes"
# ## 3 · Writing a portable float map ({points})
#
# PFM is the simplest file that holds radiance. Three lines of text: `PF` for colour or `Pf` for gray; width
# and height; and a number whose *sign* says the order of the bytes, negative for little endian; its size
# says nothing. Then the values, float32, pixel by pixel, and row by row **from the bottom up**.
#
# Return the file as `bytes`.

# %% task="to_bytes"
# Return the PFM file of radiance (H, W[, 3]), as bytes.

# %% [markdown] about="from_bytes"
# ## 4 · Reading it again ({points})
#
# The way back, and files of other programs have to be read, too: the parts of the header may be separated
# by any white space, the bytes may be in either order, and exactly one white space follows the number. The
# next byte belongs to the picture, even where it looks like a space.

# %% task="from_bytes"
# Return the values (H, W[, 3]) of a PFM file, given as bytes.

# %% about="from_bytes to_bytes merge"
data = to_bytes(E)
print(f"{len(data)} bytes for {E.size} values")
print(f"unchanged when read again: {np.array_equal(from_bytes(data), np.float32(E))}")

# %% [markdown] about="to_pixels"
# ## 5 · Three mantissas and one exponent ({points})
#
# Radiance RGBE stores a pixel in four bytes. The three channels share the exponent of the brightest:
#
# $$m = \lfloor 256\, E\, 2^{128 - e} \rfloor, \qquad
#   e \text{ such that the largest } m \text{ lies in } 128 \ldots 255.$$
#
# `E` is `(H, W, 3)`; return `(H, W, 4)` bytes, the exponent last. Black is four zeros. `np.frexp` is your
# friend.

# %% task="to_pixels"

# %% [markdown] about="to_radiance"
# ## 6 · And back ({points})
#
# $E = \frac{m}{256}\, 2^{e - 128}$, and 0 where $e = 0$. The exponent is a byte: mind what $100 - 128$ is
# there.

# %% task="to_radiance"

# %% about="to_radiance to_pixels merge"
apart = np.abs(to_radiance(to_pixels(E)) / np.maximum(E, 1e-12) - 1)[E > 1e-6]
print(f"RGBE keeps the channels within {np.median(apart):.2%} in the middle, and {apart.max():.0%} at worst")

# %% [markdown]
# ## The whole sheet

# %%
check("hw3")
