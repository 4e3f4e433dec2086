# %% [markdown]
# # Homework 3 · The radiance map and its files
#
# Due {due}. {total} points. {late}
#
# The response is known. Now the photographs become one map of the light in the scene, over more stops than
# any of them holds, and the map becomes a file that another program can open. Between the two stands an
# honest question: what do we say of a pixel that no photograph has measured?
#
# {choice} The map and two kinds of files, tasks 1 to 6, are enough. A file of more bits, where ghosts
# are, and how much longer a photograph was exposed may take the place of some, but not of the minimum.
#
# Under each task there is a cell `check("...")`: it says, promise by promise, what holds, and draws what
# differs. Inside a task use numpy, scipy and what this sheet gives; hdrlab cannot be imported when
# your work is graded.

# %%
import numpy as np

from hdrlab import scenes
from hdrlab.capture import camera, responses
from hdrlab.core import colour
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
print(
    f"RGBE keeps the channels within {np.median(apart):.2%} in the middle, and {apart.max():.0%} at worst"
)

# %% [markdown] about="decode_half"
# ## 7 · Half a float ({points})
#
# OpenEXR stores a value in 16 bits: the first is the sign $s$, then come five of the exponent $e$, then ten
# of the mantissa $m$, both whole numbers. They stand for
#
# $$(-1)^s\, 2^{e - 15} \Bigl(1 + \frac{m}{1024}\Bigr) \quad (0 < e < 31), \qquad
#   (-1)^s\, 2^{-14}\, \frac{m}{1024} \quad (e = 0),$$
#
# and where $e = 31$ for $\pm\infty$ if $m = 0$, and for NaN else. `bits` is an array of uint16, of any shape;
# return the values in the same shape, as float32 or float64. (Mind what $e - 15$ is in unsigned numbers.)

# %% task="decode_half"
# Return the values of half floats, given as bits (uint16) of any shape.

# %% about="decode_half"
for word in (0x3C00, 0xC100, 0x7BFF, 0x0001, 0x7C00):
    print(f"{word:016b} is {decode_half(np.array([word], np.uint16))[0]:.7g}")

# %% [markdown] about="weighted_variance"
# ## 8 · Who contradicts whom? ({points})
#
# What moved while the photographs were taken stands in the map several times, half transparent: a ghost. Each
# photograph answers with an $x = \ln E$ of its own, and where something moved the answers differ. How much
# they do is the weighted variance, over the photographs,
#
# $$v = \frac{\sum_j w_j\,(x_j - \bar x)^2}{\sum_j w_j}, \qquad
#   \bar x = \frac{\sum_j w_j\, x_j}{\sum_j w_j}.$$
#
# `x` and `w` are `(P, H, W)`; all $x$ are finite, also where $w = 0$, and no weight is negative. Return $v$
# `(H, W)`. Where all weights are 0, nobody contradicts: $v = 0$.

# %% task="weighted_variance"
# Return v (H, W), the weighted variance of x (P, H, W) over the photographs; 0 where no w is above 0.

# %% about="weighted_variance"
levels = bracket.images[..., 1].copy()
levels[2, 100:190, 60:95] = levels[
    2, 20:110, 200:235
]  # as if something had stood there for a while
z = np.arange(256)
x, w = g[levels] - np.log(bracket.times)[:, None, None], np.minimum(z, 255 - z)[levels] / 127
score = np.sqrt(weighted_variance(x, w)) / 0.2
pictures.picture(
    colour.to_8bit(np.clip(score / 3, 0, 1)),
    alt="The contradiction: an upright white block where something was put; gray noise but in the window",
)

# %% [markdown] about="find_seeds"
# ## 9 · The threshold of a ghost ({points})
#
# Over what noise explains, $\sqrt v$ is a `score` `(H, W)`: above 1 there is a contradiction. But noise has
# bright specks, and where the camera moved by a pixel each edge is a bright line. What really moved is
# wider. Mark all pixels of every square of 3 × 3 pixels, wholly in the picture, in which *all* scores are
# above 1, and no others. Return the mask `(H, W)`, of bool, or 0 and 1.

# %% task="find_seeds"
# Return where the score (H, W) exceeds 1 over at least 3 x 3 pixels.

# %% about="find_seeds weighted_variance"
pictures.picture(
    colour.to_8bit(0.5 * (score > 1) + 0.5 * find_seeds(score)),
    alt="White in the block; most of the specks are gray, above 1 and not marked",
)

# %% [markdown] about="dilate"
# ## 10 · A margin for ghosts ({points})
#
# Where something moved, a mask (H, W) marks pixels that the photographs contradict each other about.
# Movement is seen at outlines, so the mask is widened: to it belongs every pixel of which the middle is
# at most `margin` pixels from the middle of a pixel of the mask, by the straight line, and then all that
# the widened mask encloses, its holes. (A hole is what no walk from pixel to neighbour, above, below, left or
# right, leads out of the picture from.)
#
# (`mask` is an array of bool, `margin` a whole number above 0. An empty mask stays empty. The answer is
# of bool, or 0 and 1.)

# %% task="dilate"
# Return the mask (H, W), all within margin pixels of it, and what that encloses.

# %% about="dilate"
down, right = np.indices((180, 240)) - np.reshape((90, 120), (2, 1, 1))
outline = (abs(np.hypot(down, right) - 55) < 1) & (np.arctan2(down, right) % 0.5 > 0.15)
pictures.picture(
    colour.to_8bit(0.5 * outline + 0.5 * dilate(outline, 12)),
    alt="An outline with gaps, white, on a gray disc that it and its margin enclose",
)

# %% [markdown] about="label"
# ## 11 · Ghost by ghost ({points})
#
# Each region takes its pixels from one photograph, so regions are told apart: pixels of the mask belong
# to one region if a walk within the mask leads from one to the other, each step to one of eight
# neighbours, across corners too. Label the regions from 1 to their number, in whichever order, and with 0
# what is not in the mask.

# %% task="label"
# Return labels (H, W) of the connected regions of a mask of bool, 0 elsewhere.

# %% about="label"
squares = np.random.default_rng(3).uniform(size=(15, 20)) < 0.25
regions = label(np.kron(squares, np.ones((12, 12), bool)))
pictures.picture(
    colour.to_8bit(regions / regions.max()),
    alt="Squares on black, each group that touches, in a side or a corner, in a gray of its own",
)

# %% [markdown] about="ratio_steps"
# ## 12 · How much longer? The ratio of a linear camera ({points})
#
# A linear camera's level is its exposure. So if one photograph was exposed $k$ times as long as another, a
# level $x$ of the one belongs to $y = k\, x$ of the other, and pairs of such levels, each with a weight
# $v$, say what $k$ is (Cerman and Hlavac, 2006). Least squares make $\sum \bigl(v\,(y - k\,x)\bigr)^2$
# smallest, over the pairs in use. Some pairs are wrong, as of what moved; they are found in rounds:
#
# 1. At first all pairs are in use. Take $k$, and the mean $V$ of $\bigl(v\,(y - k\,x)\bigr)^2$ over them.
# 2. In a round those pairs are in use whose $\bigl(v\,(y - k\,x)\bigr)^2$ is at most `limit` times $V$,
#    with $k$ and $V$ of the last state. All pairs are asked, those that are out, too. Then $k$ and $V$
#    anew, of these.
# 3. End after the round in which $k$ changed by less than `tolerance`, or after so many `rounds`.
#
# `found` is a tuple of three arrays, $(x, y, v)$, each `(K,)`. Yield $(k, \text{used}, V)$ of the first
# state, and after each round; `used` is a mask `(K,)`. A list of states will do, too.

# %% task="ratio_steps"
# Yield (k, used, V) of all pairs, and after each round; found = (x, y, v).

# %% about="ratio_steps"
rng = np.random.default_rng(2)
darker = rng.uniform(5, 60, 300)
brighter = 4 * darker + rng.normal(0, 1, 300)
brighter[:60] *= 0.5
for k, used, V in ratio_steps((darker, brighter, np.ones(300))):
    print(f"k = {k:.4f} by {np.count_nonzero(used)} pairs, which miss by {np.sqrt(V):.2f}")

# %% [markdown]
# ## The whole sheet

# %%
check("hw3")
