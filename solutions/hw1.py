# %% [markdown]
# # Homework 1 · Capture and alignment
#
# Due {due}. {total} points. {late}
#
# Before you can photograph a scene with a high dynamic range, you must decide which exposures you
# need, and how many. If you take them by hand, you must also align the photos afterwards. In this
# homework you write both parts.
#
# Under each task there is a cell `check("...")`. Run it as often as you like. It shows which checks
# pass and draws what differs. Each check has three hints; open the next one only if the last did
# not help. Inside a task, use NumPy, SciPy and what this assignment gives you: hdrlab cannot be
# imported when your work is graded. You can put helper functions into any cell.

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
# A camera has three controls, and many combinations give the same exposure. The exposure value (EV)
# combines them into one number, in stops (factors of two), so that one more is half as bright a
# photo. For the f-number $F$, the time $T$ in seconds and the ISO speed $S$ (at ISO 100, this is
# the EV of notebook 02),
#
# $$\mathrm{EV} = 2\log_2 F - \log_2 T - \log_2\frac{S}{100}.$$
#
# The arguments are numbers or arrays of any shape, all above 0.

# %% task="ev"
# Return EV = 2 log2 F - log2 T - log2(S / 100).

# %% [markdown] about="equivalent_time"
# ## 2 · The same exposure with other settings ({points})
#
# You close the aperture to get more of the scene in focus. How long must the shutter now stay open
# to give the same exposure as before? The pixel values of a photo depend on the product of $T$,
# $S$ and the area of the aperture, which is proportional to $1/F^2$. With $F'$ and $S'$ for the
# new settings, and $T'$ for the new time,
#
# $$T' = T \left(\frac{F'}{F}\right)^2 \frac{S}{S'}.$$

# %% task="equivalent_time"
# Return T' = T (F' / F)^2 S / S': the time that gives the same exposure with other settings.

# %% [markdown] about="count"
# ## 3 · How many photos? ({points})
#
# A scene has $D$ stops (`scene`), and one photo covers $U$ stops (`usable`). Neighboring photos
# must share $O$ stops (`overlap`, less than $U$), so that the response curve can be estimated. The
# first photo covers $U$ stops of the scene, and each further photo adds $U - O$. So the number $n$
# of photos is
#
# $$n = 1 + \left\lceil \frac{D - U}{U - O} \right\rceil, \qquad\text{and at least } 1.$$

# %% task="count"
# Return n = 1 + ceil((D - U) / (U - O)), all in stops, and at least 1.

# %% [markdown]
# ## The photos
#
# The photos show a room: five hand-held exposures, each shifted by some pixels. You cannot compare
# their pixel values directly, since each has a different exposure. But a pixel that is brighter
# than the median of the scene is brighter than the median in every photo, unless the photo shows
# both the pixel and the median as black, or both as white. Ward's method compares only that: one
# bit per pixel, the *median threshold bitmap* (MTB).

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
    plots.thumbnails(bracket), alt="Five photos of a room, from dark to bright, each shifted"
)

# %% [markdown] about="threshold"
# ## 4 · The threshold ({points})
#
# The histogram `h` (256,) counts the pixels of each pixel value. The threshold is the lowest value
# for which at least a fraction $q$ of all pixels lie at or below it. For $q = 1/2$ that is the
# median; if the median is clipped, an aligner chooses another fraction. $q$ may be an array: then
# return an array of thresholds.

# %% task="threshold"

# %% [markdown] about="exclusion"
# ## 5 · The exclusion bitmap ({points})
#
# Close to the threshold $t$, noise decides whether a pixel is above it. Such pixels must not vote.
# The exclusion bitmap is True where $|Y - t| > 4$, and False where a pixel is *excluded*. $Y$
# contains bytes, and bytes have no negative values: a difference below zero wraps around.

# %% task="exclusion"

# %% about="exclusion threshold"
Y = grays[2]
t = threshold(np.bincount(Y.ravel(), minlength=256), 0.5)
seen = np.where(exclusion(Y, t), 255 * (t < Y), 128).astype(np.uint8)
pictures.picture(
    seen,
    alt="The bitmap of the middle photo: white above the median, black below it, gray where excluded",
)

# %% [markdown] about="shrink"
# ## 6 · A level of the pyramid ({points})
#
# A hand moves by dozens of pixels, and testing all offsets would take long. So the search starts
# with small images. Each level of the *image pyramid* has half the size of the level below, and
# each of its pixels is the rounded mean of $2 \times 2$ pixels. If the mean ends in one half, you
# may round up or down. Drop an odd row or column at the end.

# %% task="shrink"

# %% [markdown] about="shift"
# ## 7 · Moving photos ({points})
#
# An offset $(dy, dx)$ says where an image must move, down and to the right. Move the images
# `(P, H, W[, 3])` by their offsets `(P, 2)`, and crop them to the rectangle that all of them cover,
# so that every pixel comes from a photo. The rectangle must also lie inside the original frame, as
# if one more image had the offset $(0, 0)$: a single image that moves 3 rows down loses 3 rows.

# %% task="shift"
# Return the images moved by `offsets`, and cropped to the rectangle that all of them cover.

# %% [markdown] about="align"
# ## 8 · Alignment ({points})
#
# Now put everything together. For each pair of images, go from the coarsest level to the finest:
#
# - Compute the bitmaps and exclusion bitmaps of both images. Use the same $q$ for both; the median
#   is enough for all checks.
# - Test the nine offsets around twice the offset found so far. For each, XOR the bitmaps, AND the
#   result with both exclusion bitmaps, and count. Use only the overlap of the images. The nine
#   overlaps differ in size, so compare counts as fractions of the overlap. (Ward compares the
#   counts themselves. The checks accept that, too.)
# - Take the offset with the smallest fraction. In a tie, the center wins; between two others,
#   either may win.
#
# Do this for each photo and its neighbor in brightness, and sum the offsets along the chain. Return
# them relative to the image in the middle of the brightness order, whose offset is $(0, 0)$. If the
# number of images is even, use either of the two in the middle. `bits` is the number of levels, so
# `bits=6` finds offsets up to 63 pixels.

# %% task="align"
# Return the offsets that align every image with the image of middle brightness.

# %% about="align shift"
offsets = align(grays)
before, after = (stack.mean(axis=0).astype(np.uint8) for stack in (grays, shift(grays, offsets)))
print(f"found {offsets.tolist()}, true {moved.tolist()}")
pictures.picture(
    after, alt="The mean of the five photos after the alignment: edges are single and sharp"
)

# %% [markdown]
# ## All checks
#
# The last cell runs all checks with a progress bar, just like grading. Only the grader's result
# counts. It generates its own random inputs for you, so a solution that only works for the examples
# here does not pass.

# %%
check("hw1")
