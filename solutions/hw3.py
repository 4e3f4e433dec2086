# %% [markdown]
# # Homework 3 · The radiance map and its files
#
# Due {due}. {total} points. {late}
#
# The response curve is known. Now merge the photos into one radiance map, which covers more stops
# than any single photo, and write the map to a file that other programs can open. On the way you
# meet a question of honesty: what should the map say about a pixel that no photo has measured?
#
# {choice} The map and two file formats, tasks 1 to 6, are enough. You can replace some of them, but
# not a required task, with a file format with more bits, ghost detection, or the exposure ratio of
# two photos.
#
# Under each task there is a cell `check("...")`. It shows which checks pass and draws what differs.
# Inside a task, use NumPy, SciPy and what this assignment gives you: hdrlab cannot be imported when
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
# ## The photos
#
# The photos show a room: five exposures, two stops apart. No single one shows both the window and
# the dark corner.

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
    plots.thumbnails(bracket), alt="Five photos of a room, from nearly black to nearly white"
)

# %% [markdown] about="merge"
# ## 1 · The radiance map ({points})
#
# Each photo $j$ gives an estimate for a pixel: $\ln E = g(Z_j) - \ln t_j$. The estimates differ a
# little, and some are clipped. So take the mean, in which the weight $w$ of a pixel value says how
# much you trust it [Debevec97 eq. 6]:
#
# $$\ln E = \frac{\sum_j w(Z_j)\,[\,g(Z_j) - \ln t_j\,]}{\sum_j w(Z_j)}.$$
#
# - `images` are `(P, H, W[, 3])` bytes, in any order, and `times` are their `(P,)` seconds.
# - `g` is `(256,)`, or has one column for each channel.
# - `w` is `(256,)`. If it is not given, use the hat of homework 2, which is 0 at both ends.
#
# Return $E$ `(H, W[, 3])`. If all weights of a pixel are zero, the mean is undefined. The next task
# deals with such pixels, and no check of this task looks at them. (The library also drops a frame
# for all channels of a pixel if one channel is clipped. No check asks for that.)

# %% task="merge"
# Return the radiance map E: the weighted mean of the logarithms over the photos.

# %% about="merge"
E = merge(bracket.images, bracket.times, g)
pictures.radiance(E, alt="The radiance map of the room in false color")

# %% [markdown] about="bound"
# ## 2 · Pixels that no photo measures ({points})
#
# The sun is clipped in all photos, so there is nothing to average. But a clipped pixel is not
# unknown: its exposure was *at least* that of the first clipped value, `top`. The exposure of a
# dark pixel, of value 0, was at most that of value 1. With the response $g$ and $B_j = \ln t_j$,
#
# $$\ln E \ge g(\mathrm{top}) - B_j \quad\text{(clipped in } j), \qquad
#   \ln E \le g(1) - B_j \quad\text{(dark in } j).$$
#
# Use the tightest bounds. If there is one bound, the map takes it. Between two bounds it takes the
# middle of their logarithms. Without any bound, $E = 0$.
#
# - `Z` is `(P, M)`: the values of $M$ such pixels. A value from 1 to `top` − 1 gives no bound.
# - `B` is `(P,)`: ln times.
# - `shown` `(P, M)` is False if a photo does not show the pixel at all.
#
# Return $E$ `(M,)` and flags `(M,)`. A flag is the sum of 1 if some photo that shows the pixel is
# clipped there, 2 if one is dark there, and 8 if there is no bound.

# %% task="bound"
# Return E (M,) and flags (M,) of pixels that no photo measures, from the tightest bounds.

# %% [markdown] about="to_bytes"
# ## 3 · Write a portable float map ({points})
#
# PFM is the simplest file format for radiance. It begins with three lines of text: `PF` for color
# or `Pf` for gray; width and height; and a number. The *sign* of the number gives the byte order,
# negative for little endian; its magnitude has no meaning. Then come the values as float32, pixel
# by pixel, and row by row **from the bottom up**.
#
# Return the file as `bytes`.

# %% task="to_bytes"
# Return the PFM file of radiance (H, W[, 3]), as bytes.

# %% [markdown] about="from_bytes"
# ## 4 · Read a portable float map ({points})
#
# Now read such a file, even if another program wrote it. Any white space may separate the parts of
# the header, the bytes may be in either order, and exactly one white-space character follows the
# number. The next byte belongs to the image, even if it looks like a space.

# %% task="from_bytes"
# Return the values (H, W[, 3]) of a PFM file, given as bytes.

# %% about="from_bytes to_bytes merge"
data = to_bytes(E)
print(f"{len(data)} bytes for {E.size} values")
print(f"unchanged when read again: {np.array_equal(from_bytes(data), np.float32(E))}")

# %% [markdown] about="to_pixels"
# ## 5 · Encode RGBE: three mantissas and one exponent ({points})
#
# Radiance RGBE stores a pixel in four bytes: a mantissa $m$ for the radiance $E$ of each channel,
# and one exponent $e$, which the three channels share. It is that of the brightest channel:
#
# $$m = \lfloor 256\, E\, 2^{128 - e} \rfloor, \qquad
#   e \text{ such that the largest } m \text{ lies in } 128 \ldots 255.$$
#
# `E` is `(H, W, 3)`. Return `(H, W, 4)` bytes, with the exponent last. Black is four zeros.
# `np.frexp` helps.

# %% task="to_pixels"

# %% [markdown] about="to_radiance"
# ## 6 · Decode RGBE ({points})
#
# $E = \frac{m}{256}\, 2^{e - 128}$, and 0 if $e = 0$. The exponent is a byte: think about what
# $100 - 128$ is in bytes.

# %% task="to_radiance"

# %% about="to_radiance to_pixels merge"
apart = np.abs(to_radiance(to_pixels(E)) / np.maximum(E, 1e-12) - 1)[E > 1e-6]
print(
    f"RGBE changes a channel by {np.median(apart):.2%} (median), and by {apart.max():.0%} at most"
)

# %% [markdown] about="decode_half"
# ## 7 · Decode half floats ({points})
#
# OpenEXR stores a value in 16 bits: first the sign $s$, then five bits of the exponent $e$, then
# ten bits of the mantissa $m$, both integers. They represent
#
# $$(-1)^s\, 2^{e - 15} \Bigl(1 + \frac{m}{1024}\Bigr) \quad (0 < e < 31), \qquad
#   (-1)^s\, 2^{-14}\, \frac{m}{1024} \quad (e = 0).$$
#
# $e = 31$ represents $\pm\infty$ if $m = 0$, and NaN otherwise. `bits` is an array of uint16, of
# any shape. Return the values in the same shape, as float32 or float64. (Think about what $e - 15$
# is in unsigned numbers.)

# %% task="decode_half"
# Return the values of half floats, given as bits (uint16) of any shape.

# %% about="decode_half"
for word in (0x3C00, 0xC100, 0x7BFF, 0x0001, 0x7C00):
    print(f"{word:016b} is {decode_half(np.array([word], np.uint16))[0]:.7g}")

# %% [markdown] about="weighted_variance"
# ## 8 · Where do the photos contradict each other? ({points})
#
# Something that moved between the photos appears in the map several times, semi-transparent: a
# *ghost*. Each photo gives its own estimate $x = \ln E$, and where something moved, the estimates
# differ. The weighted variance over the photos measures by how much:
#
# $$v = \frac{\sum_j w_j\,(x_j - \bar x)^2}{\sum_j w_j}, \qquad
#   \bar x = \frac{\sum_j w_j\, x_j}{\sum_j w_j}.$$
#
# `x` and `w` are `(P, H, W)`. All $x$ are finite, even where $w = 0$, and no weight is negative.
# Return $v$ `(H, W)`. Where all weights are 0, no photos contradict each other: $v = 0$.

# %% task="weighted_variance"
# Return v (H, W), the weighted variance of x (P, H, W) over the photos; 0 where all weights are 0.

# %% about="weighted_variance"
levels = bracket.images[..., 1].copy()
levels[2, 100:190, 60:95] = levels[
    2, 20:110, 200:235
]  # simulate an object that is in one photo only
z = np.arange(256)
x, w = g[levels] - np.log(bracket.times)[:, None, None], np.minimum(z, 255 - z)[levels] / 127
score = np.sqrt(weighted_variance(x, w)) / 0.2
pictures.picture(
    colour.to_8bit(np.clip(score / 3, 0, 1)),
    alt="The score: a white block where the object is, and gray noise elsewhere except in the window",
)

# %% [markdown] about="find_seeds"
# ## 9 · Find the seeds of a ghost ({points})
#
# $\sqrt v$ divided by the standard deviation that noise explains is a `score` `(H, W)`: above 1 the
# photos contradict each other. But noise has bright specks, and if the camera moved by a pixel,
# each edge is a bright line. Things that really moved are wider. Mark all pixels of every square of
# 3 × 3 pixels that lies completely in the image and in which *all* scores are above 1, and no other
# pixels. Return the mask `(H, W)`, of bool, or 0 and 1.

# %% task="find_seeds"
# Return where the score (H, W) exceeds 1 over at least 3 x 3 pixels.

# %% about="find_seeds weighted_variance"
pictures.picture(
    colour.to_8bit(0.5 * (score > 1) + 0.5 * find_seeds(score)),
    alt="The block is marked white; most specks are gray: above 1, but not marked",
)

# %% [markdown] about="dilate"
# ## 10 · Dilate the mask and fill its holes ({points})
#
# A mask (H, W) marks pixels where the photos contradict each other. Movement is often visible only
# at outlines, so the mask must grow in two steps:
#
# 1. Add every pixel whose center is at most `margin` pixels, in a straight line, from the center of
#    a pixel of the mask.
# 2. Add all holes, that is, everything that the grown mask encloses. A pixel lies in a hole if no
#    path of steps up, down, left or right, outside the grown mask, leads from it out of the image.
#
# (`mask` is an array of bool, and `margin` an integer above 0. An empty mask stays empty. The
# result is of bool, or 0 and 1.)

# %% task="dilate"
# Return the mask (H, W), widened by margin pixels, with its holes filled.

# %% about="dilate"
down, right = np.indices((180, 240)) - np.reshape((90, 120), (2, 1, 1))
outline = (abs(np.hypot(down, right) - 55) < 1) & (np.arctan2(down, right) % 0.5 > 0.15)
pictures.picture(
    colour.to_8bit(0.5 * outline + 0.5 * dilate(outline, 12)),
    alt="A white outline with gaps, and the gray disc that the dilated mask covers",
)

# %% [markdown] about="label"
# ## 11 · Label the regions ({points})
#
# Each ghost region takes its pixels from one photo, so you must separate the regions. Two pixels of
# the mask belong to one region if a path within the mask connects them; each step of the path goes
# to one of the eight neighbors, including diagonal ones. Label the regions from 1 to their number,
# in any order. Pixels outside the mask get 0.

# %% task="label"
# Return labels (H, W) of the connected regions of a mask, and 0 elsewhere.

# %% about="label"
squares = np.random.default_rng(3).uniform(size=(15, 20)) < 0.25
regions = label(np.kron(squares, np.ones((12, 12), bool)))
pictures.picture(
    colour.to_8bit(regions / regions.max()),
    alt="Squares on black; squares that touch at a side or a corner have the same gray",
)

# %% [markdown] about="ratio_steps"
# ## 12 · The exposure ratio of a linear camera ({points})
#
# A linear camera's pixel value is proportional to exposure. So if one photo got $k$ times the
# exposure of another, a value $x$ in the darker photo is $y = k\, x$ in the brighter one. Pairs of
# such values, each with a weight $v$, determine $k$ (Cerman and Hlavac, 2006). Least squares
# minimize $\sum \bigl(v\,(y - k\,x)\bigr)^2$ over the pairs in use. Some pairs are wrong, for
# example because something moved. Find them in rounds:
#
# 1. At first all pairs are in use. Compute $k$, and the mean $V$ of $\bigl(v\,(y - k\,x)\bigr)^2$
#    over them.
# 2. In each round, use the pairs whose $\bigl(v\,(y - k\,x)\bigr)^2$ is at most `limit` times $V$,
#    with $k$ and $V$ of the last state. Test all pairs, including those that are not in use. Then
#    compute $k$ and $V$ again from the pairs in use.
# 3. Stop after the round in which $k$ changed by less than `tolerance`, or after the given number
#    of `rounds`.
#
# `found` is a tuple of three arrays, $(x, y, v)$, each `(K,)`. Yield $(k, \text{used}, V)$ of the
# first state and after each round; `used` is a mask `(K,)`. You may also return a list of states.

# %% task="ratio_steps"
# Yield (k, used, V) for all pairs and after each round; found = (x, y, v).

# %% about="ratio_steps"
rng = np.random.default_rng(2)
darker = rng.uniform(5, 60, 300)
brighter = 4 * darker + rng.normal(0, 1, 300)
brighter[:60] *= 0.5
for k, used, V in ratio_steps((darker, brighter, np.ones(300))):
    print(f"k = {k:.4f} from {np.count_nonzero(used)} pairs, with an error of {np.sqrt(V):.2f}")

# %% [markdown]
# ## All checks

# %%
check("hw3")
