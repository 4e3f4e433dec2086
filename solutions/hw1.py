# %% [markdown]
# # Homework 1 · Capture and alignment
#
# Due {due}. {total} points. {late}
#
# A photograph that holds a whole scene begins before the camera clicks: which exposures, how many? And when
# they are taken from the hand, it goes on with laying them on each other. Here you write both.
#
# Under each task there is a cell `check("...")`. Run it as often as you like: it says, promise by promise,
# what holds, and draws what differs. Hints come in three steps, so open the second one only when the first
# has not helped. Inside a task use numpy, scipy and what this sheet gives; hdrlab itself is not there when
# your work is graded. Helpers of your own go into any cell.

# %%
import numpy as np

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.course.notebook import check, use_plan
from hdrlab.show import pictures, plots

use_plan("hw1")

# %% [markdown] about="ev"
# ## 1 · Exposure value ({points})
#
# A camera has three dials, and many settings give the same exposure. The exposure value counts them in
# stops, factors of two: with the f-number $F$, the time $T$ in seconds and the ISO speed $S$,
#
# $$\mathrm{EV} = 2\log_2 F - \log_2 T - \log_2\frac{S}{100}.$$
#
# Arguments are numbers or arrays of any shape; a setting that is not positive is a `ValueError`.

# %% task="ev"
# Return EV = 2 log2 F - log2 T - log2(S / 100).

# %% [markdown] about="equivalent_time"
# ## 2 · The same exposure with other settings ({points})
#
# You close the aperture to get more of the scene sharp. How long must the shutter stay open, so that the
# sensor gets as much as before? Light grows with $T$ and $S$, and with the aperture's area, which is
# $1/F^2$ but for a constant:
#
# $$T' = T \left(\frac{F'}{F}\right)^2 \frac{S}{S'}.$$

# %% task="equivalent_time"
# Return T' = T (F' / F)^2 S / S': the time that gives the same exposure with other settings.

# %% [markdown] about="count"
# ## 3 · How many photographs? ({points})
#
# A scene spans so many stops, one photograph holds $R$ of them (`usable`), and neighbours shall share $O$
# (`overlap`, less than $R$), so that the response can be found. The first photograph covers $R$, each further
# one adds $R - O$:
#
# $$n = 1 + \left\lceil \frac{\text{scene} - R}{R - O} \right\rceil, \qquad\text{and at least } 1.$$

# %% task="count"
# Return n = 1 + ceil((scene - R) / (R - O)), all in stops, and at least 1.

# %% [markdown]
# ## The photographs
#
# A room, photographed from the hand: five exposures, each shifted by some pixels. Levels cannot be compared
# between them, since each is exposed otherwise. But a pixel brighter than the median of the scene is
# brighter than the median in *every* photograph. Ward's method compares only this: one bit for each pixel,
# the median threshold bitmap (MTB).

# %%
room = scenes.room((240, 320))
moved = camera.shake(5, radius=9, rng=3)
bracket = camera.shoot(
    room,
    2.0 ** np.arange(-8, 2, 2),
    camera.Camera(sensitivity=1 / 16, full_well=2e4, read_noise=5),
    offsets=moved,
    rng=3,
)
grays = bracket.images[..., 1]
pictures.picture(
    plots.thumbnails(bracket), alt="Five photographs of a room, from dark to bright, each shifted"
)

# %% [markdown] about="threshold"
# ## 4 · The threshold ({points})
#
# The histogram `h` (256,) counts the pixels of each code. The threshold is the lowest code with a share of at
# least $q$ of the pixels at or below it: the median for $q = 1/2$; where that is clipped one takes another
# share. Several $q$ may be asked at once: for an array of shares return an array of codes.

# %% task="threshold"

# %% [markdown] about="exclusion"
# ## 5 · The exclusion bitmap ({points})
#
# Close to the threshold $t$ the noise decides whether a pixel is above it. Such pixels must not vote: the
# exclusion bitmap is True where $|Y - t| > 4$, and False where a pixel is *excluded*. $Y$ holds bytes; mind
# what bytes do below zero.

# %% task="exclusion"

# %% about="exclusion threshold"
Y = grays[2]
t = threshold(np.bincount(Y.ravel(), minlength=256), 0.5)
seen = np.where(exclusion(Y, t), 255 * (t < Y), 128).astype(np.uint8)
pictures.picture(
    seen,
    alt="The bitmap of the middle photograph: above the median white, below black, excluded gray",
)

# %% [markdown] about="shrink"
# ## 6 · A level of the pyramid ({points})
#
# A hand moves by dozens of pixels, and trying all offsets would take long. So one begins with small
# pictures: each level has half the size, and each of its pixels is the rounded mean of $2 \times 2$ pixels
# of the level below; a mean of a half may go up or down. An odd row or column at the end is left out.

# %% task="shrink"

# %% [markdown] about="shift"
# ## 7 · Moving photographs ({points})
#
# An offset $(dy, dx)$ says where an image must move, down and to the right. Move the images `(P, H, W[,
# 3])` by their offsets `(P, 2)`, and cut them to the rectangle that all of them cover: a pixel that comes
# from nowhere is no photograph. An image that stays where it is, $(0, 0)$, counts among them even if there
# is none, so one image that moves 3 rows down loses 3 rows.

# %% task="shift"

# %% [markdown] about="align"
# ## 8 · Alignment ({points})
#
# Now put it together. For a pair, from the coarsest level to the finest: bitmaps and exclusion bitmaps of
# both; for the nine offsets around twice the one found so far, XOR the bitmaps, AND with both exclusion
# bitmaps, count; the least count wins, and in a tie the centre does; between two others either may. Of the
# overlap alone, for the counts of nine overlaps differ in size: compare shares of its pixels. Both images of
# a pair have the same $q$; the median will do for all checks.
#
# Do this for each photograph and its neighbour in brightness, sum the offsets along the chain, and give
# them relative to the image in the middle of brightness, whose offset is $(0, 0)$; of an even number either
# of the two in the middle. `bits` is the number of levels, so `bits=6` finds offsets up to 63 pixels.

# %% task="align"
# Return the offsets that lay every image on the one in the middle of their brightness.

# %% about="align shift"
offsets = align(grays)
before, after = (stack.mean(axis=0).astype(np.uint8) for stack in (grays, shift(grays, offsets)))
print(f"found {offsets.tolist()}, true {moved.tolist()}")
pictures.picture(
    after, alt="The mean of the five photographs after they were moved: edges are single and sharp"
)

# %% [markdown]
# ## The whole sheet
#
# The last cell runs all checks, as grading does, with a bar that fills up. What counts is what the grader
# finds: it draws inputs of its own for you, so answers that only fit the examples do not carry far.

# %%
check("hw1")
