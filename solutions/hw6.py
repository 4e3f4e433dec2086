# %% [markdown]
# # Homework 6 · More methods of the lecture's papers
#
# Due {due}. {total} points. {late}
#
# The tasks cover methods that no other homework contains: the scales of the color channels, a
# power-law response from repeated comparison, registration by correlation and simplex, adding light
# along a simulated response, veiling glare, assorted pixels, coded exposure, several sensors behind
# one lens, video, the space of response curves, joining blends of light, finding a chart, the Detail
# Brush, curves and operators, contrast, focus and skin as measures of what matters in a photo, the
# circle without vignetting, a logarithm whose base changes, and the merge of a burst. You write the
# core of each.
#
# {choice}
#
# | symbol | meaning | shape |
# |---|---|---|
# | $I$, $M$; $k$ | radiance and pixel values of the same pixels; channel scales | (N, 3); (3,) |
# | $T$ | pixel value in the dark photo for each one in the bright photo | (n,) |
# | $R$, $\gamma$ | exposure ratio of two photos, below 1; exponent of a power-law response | |
# | $X$, $c$ | two photos on one scale; their correlation | (2, h, w); (2h - 1, 2w - 1) |
# | $d_y$, $d_x$, $r\varphi$ | motion of a photo down, right, and by turning, in pixels | (3,) |
# | $q$, $\Delta$ | light, and light to add, in stops | |
# | $F$, $G$, $E$; $s$ | radiance with glare, scattered light, clean radiance; share of glare | (H, W) |
# | $Z$, $e$, $w$ | pixel values, transparency of the filter of each pixel, weight | (H, W) |
# | $B$, $D$; $u$, $P$ | radiance from two sensors; fraction of full pixels, prediction | (H, W) |
# | $x$, $h$, $y$ | object, shutter, photo of the moving object | (n,), (m,), (n + m - 1,) |
# | $H$, $\mathrm{sd}$ | principal components of response curves, and the spread along each | (K, n), (K,) |
# | $L$, $L_{wa}$, $L_d$; $b$ | luminance, its log average, display luminance; bias | any shape |
# | $F_z$, $D_z$; $A_z$ | Fourier transform of tile z, difference from the reference; shrinkage | (n, n) |
# | $V$, $Q$ | powers of the brightness; quadratic form of the error | (l, d + 1), (d + 1, d + 1) |
#
# Under each task there is a cell `check("...")`. It shows which checks pass and draws what
# differs. Inside a task, use NumPy, SciPy and what this assignment gives you: hdrlab cannot be
# imported when your work is graded. All numbers are float unless the text says otherwise, and you
# may return float32 or float64. Papers reuse letters: if a task explains a symbol of its own, this
# meaning holds in that task.

# %%
import numpy as np

from hdrlab import scenes
from hdrlab.beyond import assorted, flutter
from hdrlab.core import colour
from hdrlab.core.filters.mosaic import tile
from hdrlab.course.notebook import check, use_plan
from hdrlab.show import pictures
from hdrlab.show.plots import curves

use_plan("hw6")

# %% [markdown]
# ## The scene

# %%
room = scenes.room((120, 160))
L = colour.luminance(room)
pictures.radiance(room, alt="The radiance of the room in false color")

# %% [markdown] about="fit_channel_scales"
# ## 1 · One tint for the whole map: channel scales ({points})
#
# A response is known up to a factor, in each channel separately. So a radiance map that was
# recovered channel by channel has an unknown factor in each channel, and may have a tint.
# [Mitsunaga and Nayar (1999, section 6.4)](https://doi.org/10.1109/CVPR.1999.786966) assume that
# the camera keeps the chromaticity: the direction of a pixel's vector (R, G, B).
#
# `I` (N, 3) is the recovered radiance of $N$ pixels, and `M` (N, 3) are their pixel values in a
# photo, from 0 to 1. All numbers are above 0. The corrected radiance of pixel $n$ is $k I_n = (k_R
# I_{nR},\; k_G I_{nG},\; k_B I_{nB})$. Only ratios are determined, so $k_G = 1$. Find the $k$
# above 0 that minimizes
#
# $$\sum_n \Bigl\lVert \frac{k I_n}{\lVert k I_n \rVert} - \frac{M_n}{\lVert M_n \rVert} \Bigr\rVert^2,
#   \qquad \lVert x \rVert = \sqrt{x_R^2 + x_G^2 + x_B^2}.$$
#
# There is no formula for this minimum. Search for the two numbers, for example with
# `scipy.optimize`. The checks accept an error of half a percent.
#
# *Example*: one pixel has $I = (0.1, 0.8, 0.2)$ and $M = (0.2, 0.4, 0.4)$. $k = (4, 1, 4)$ gives
# $k I = (0.4, 0.8, 0.8)$, which has the direction of $M$.
#
# (Return $k$ (3,), in the order R, G, B, with `k[1]` = 1.)

# %% task="fit_channel_scales"
# Return the channel scales k (3,) with k[1] = 1 for which k I is nearest to the direction of M.

# %% about="fit_channel_scales"
tinted = room * [2.2, 1.0, 0.5]
pixels = (room / room.max()).reshape(-1, 3)[::7]
k = fit_channel_scales(tinted.reshape(-1, 3)[::7], pixels)
print("k =", np.round(k, 3))
pictures.picture(
    colour.to_8bit(np.clip(np.hstack([tinted, tinted * k]) / np.quantile(L, 0.95), 0, 1)),
    alt="The room with a red tint, and without it after the channel scales",
)

# %% [markdown] about="descend"
# ## 2 · A series by repeated comparison ({points})
#
# Mann and Picard (1995) take two photos of a scene. The dark one has $R$ times the exposure of the
# bright one, $R < 1$. A pixel of exposure $I$ has the value $M(I)$ in the bright photo, and $M(R
# I)$ in the dark one. Now look for another pixel that has the value $M(R I)$ in the *bright*
# photo. In the dark photo it has $M(R^2 I)$, and so on: a series $M(I), M(R I), M(R^2 I) \ldots$,
# whatever the scene shows.
#
# `T` (n,) contains, for each value of the bright photo, the value in the dark one: $T(M(I)) = M(R
# I)$. It is known between a first and a last pixel value, and NaN below the first and above the
# last. Between two pixel values, interpolate along a straight line.
#
# Return the series `start`, $T(\text{start})$, $T(T(\text{start})) \ldots$ It ends with its last
# value $m$ if one of these holds:
#
# - $m$ is below the first or above the last pixel value with a known $T$;
# - the next value, $T(m)$, would be below `low`;
# - the next value would be above $m - \frac{1}{2}$: such a step is only rounding.
#
# *Example*: $T(z) = z / 2$ for all $z$, `start` = 200 and `low` = 20 give 200, 100, 50, 25.
#
# (`start` and `low` are numbers; `start` need not be whole. Return (K,), $K \ge 1$: `start` is
# always the first value.)

# %% task="descend"
# Return the series start, T(start), T(T(start)) ... (K,), down to `low` or to where T is unknown.

# %% about="descend"
bright = np.arange(256.0)
half_exposure = np.where(bright > 250, np.nan, bright * 0.5**0.45)
print("a camera with M = 255 I^0.45, half of the exposure:")
print(descend(half_exposure, 240.0).round(1))

# %% [markdown] about="fit_exponent"
# ## 3 · The exponent of a power law ({points})
#
# Mann and Picard describe the response by $M = \alpha + \beta I^\gamma$, where $\alpha$ is the
# pixel value of a photo with the lens covered. Then
#
# $$\ln(M - \alpha) = \ln \beta + \gamma \ln I.$$
#
# Along a series, $\ln I$ changes by $\ln R$ at each step: with $x_k = k \ln R$, $k = 0, 1, 2
# \ldots$ and $y_k = \ln(M_k - \alpha)$, a series is a straight line of slope $\gamma$. Several
# series have the same slope, but each has an intercept of its own, because it starts at another
# exposure. By least squares over all series together,
#
# $$\gamma = \frac{\sum_\text{series} \sum_k (x_k - \bar x)(y_k - \bar y)}
#   {\sum_\text{series} \sum_k (x_k - \bar x)^2},$$
#
# where $\bar x$ and $\bar y$ are the means of one series.
#
# *Example*: the series 200, 100, 50 with $R = 1/4$ and $\alpha = 0$ has the steps $\ln
# \frac{1}{2}$ in $y$ and $\ln \frac{1}{4}$ in $x$, so $\gamma = \frac{1}{2}$.
#
# (`ladders` is a list of pairs (`series`, `R`): an array (K,) with $K \ge 2$, and a number. All
# values of a series are above `alpha`. Return the number $\gamma$.)

# %% task="fit_exponent"
# Return gamma, the slope of ln(M - alpha) over k ln R that all ladders (series, R) share.

# %% about="descend fit_exponent"
quarter = np.where(bright > 250, np.nan, bright * 0.25**0.45)
print(
    "gamma =", fit_exponent([(descend(half_exposure, 240.0), 0.5), (descend(quarter, 230.0), 0.25)])
)

# %% [markdown] about="correlation"
# ## 4 · Registration: correlation by Fourier transform ({points})
#
# How far did the camera move between two photos? Cerman and Hlavac (2006, section 6.1) bring both
# to the same scale and correlate them. `X` (2, h, w) contains the fixed photo `X[0]` and the
# moving one `X[1]`. A pixel that is too dark or too bright is discarded: it is NaN in `X`.
#
# - From each photo, subtract the *local mean* around each pixel. Otherwise light that falls off
#   slowly across the scene would decide. With $x_0$, the photo with 0 in place of NaN, and $v$,
#   which is 1 where the photo is not NaN and 0 elsewhere, the local mean is $\text{blur}(x_0) /
#   \text{blur}(v)$. Blur with `scipy.ndimage.gaussian_filter(..., 4)` and its default settings.
# - Then set the discarded pixels to 0. This gives $a$ from `X[0]` and $b$ from `X[1]`.
# - For every shift $s = (d_y, d_x)$ for which the photos overlap, compute the sum over the
#   pixels $p$ of the overlap,
#
# $$c(s) = \sum_p a(p + s)\; b(p).$$
#
# In the result $c$ (2h - 1, 2w - 1), the element $[i, j]$ belongs to the shift $d_y = i - (h -
# 1)$, $d_x = j - (w - 1)$. A Fourier transform is fast: $c = \mathcal{F}^{-1}(\mathcal{F}(a)\,
# \overline{\mathcal{F}(b)})$ (equation 5 of the paper). It makes photos periodic, so pad them with
# zeros first. Any other way to compute the sums is fine, too.
#
# *Example* for the sums: $a = (0, 0, 1)$ and $b = (1, 0, 0)$, with one row, give $c = (0, 0, 0, 0,
# 1)$: $b$ must move by $d_x = +2$.
#
# (`X` is float32.)

# %% task="correlation"
# Return c (2 h - 1, 2 w - 1), the correlation of X[0] and X[1] at every shift.

# %% about="correlation"
shot = np.log(L).astype(np.float32)
X = np.stack([shot[10:90, 10:110], shot[14:94, 4:104]])
c = correlation(X)
pictures.picture(
    colour.to_8bit(np.clip(c / c.max(), 0, 1)),
    alt="The correlation: a bright cross slightly below and to the left of the middle",
)

# %% [markdown] about="peaks"
# ## 5 · The peaks of a correlation ({points})
#
# The highest value of $c$ is not always the right shift: a row of windows fits in several places.
# So the search begins from several peaks. A *peak* is a value above 0 that is the largest of the 5
# × 5 values around it, itself included. At the edge of $c$, fewer than 25 values are compared.
#
# Return the shifts $(d_y, d_x)$ of the `count` highest peaks, the highest first. If there are
# fewer than `count` peaks, return all of them. As above, the element $[i, j]$ of `c` (2h - 1, 2w -
# 1) belongs to the shift $(i - (h - 1),\; j - (w - 1))$; the middle of `c` is the shift (0, 0).
#
# *Example*: `c` is (3, 5), and its only value above 0 is `c[0, 4]`. Then $h = 2$ and $w = 3$, and
# the only peak is at the shift (-1, 2).
#
# (The result is (P, 2), P ≤ `count`. In the checks, no two values are equal.)

# %% task="peaks"
# Return the shifts (P, 2) of the `count` highest peaks of c, the highest first.

# %% about="correlation peaks"
print("shifts (down, right) of the three highest peaks:", np.asarray(peaks(c, 3)).tolist())

# %% [markdown] about="refine"
# ## 6 · From a peak to the motion: the simplex ({points})
#
# A peak of the correlation is a whole number of pixels, and the camera also turned. So Cerman and
# Hlavac (section 6.2) search on from the peak. The search moves a simplex: a triangle in two
# dimensions, and four points in three.
#
# The motion of the moving photo is $(d_y, d_x, r\varphi)$, three numbers in pixels. The photo is
# turned by the angle $\varphi$ about its middle, $x_m = \frac{w - 1}{2}$ and $y_m = \frac{h -
# 1}{2}$, clockwise as seen, and then shifted. Its pixel $(x, y)$ gets to the place
#
# $$x' = x_m + (x - x_m) \cos\varphi - (y - y_m) \sin\varphi + d_x, \qquad
#   y' = y_m + (x - x_m) \sin\varphi + (y - y_m) \cos\varphi + d_y$$
#
# of the fixed photo; $r = \frac{1}{2}\sqrt{h^2 + w^2}$ is half of the diagonal. For a pixel of the
# fixed photo, $a$ is its value there, and $b$ is the value of the moving photo at the place that
# gets to this pixel, by linear interpolation. The error of a motion is the mean, over all pixels
# that have an $a$ and a $b$, of
#
# $$d^2 = \Bigl( \frac{a - b}{(a + b) / 2} \Bigr)^2.$$
#
# A pixel has no $a$ or $b$ if it is discarded (NaN), or if the place lies outside of the moving
# photo. Return the motion for which the error has its minimum near `start`.
#
# Nelder and Mead's method needs no derivatives: `scipy.optimize.minimize(..., method="Nelder-Mead",
# options={"initial_simplex": ...})`. Begin with the points `start`, and `start` with `reach` added
# to one of its three numbers; scipy's own first simplex would be too small. Other methods of search
# are fine, too. The checks accept an error of 0.1 pixels, and `start` is at most two pixels from the
# minimum.
#
# *Example*: the photos are equal, except that the content of the moving one lies three pixels
# farther left. Then the motion is (0, 3, 0).
#
# (`X` (2, h, w) contains the fixed photo `X[0]` and the moving one `X[1]`, float32, with values
# above 0 or NaN. `start` is (3,). Return (3,).)

# %% task="refine"
# Return the motion (dy, dx, r phi) of X[1] that fits X[0] best, near `start`.

# %% about="refine"
shot_light = L.astype(np.float32)
two_shots = np.stack([shot_light[10:90, 10:110], shot_light[14:94, 4:104]])
print(
    "the motion, found from two pixels away:",
    np.round(refine(two_shots, np.array([3.0, -4, 0])), 2),
)

# %% [markdown] about="offset"
# ## 7 · How much light is missing? ({points})
#
# Battiato and others (2008, section 1.3.3) correct a photo that is too dark or too bright. They
# simulate the response of a camera by a curve. A pixel that receives the light $q$, in stops, gets
# the value (equation 1.9)
#
# $$f(q) = \frac{255}{(1 + e^{-A q})^C}.$$
#
# The average of the important parts of the photo should become `target`. The light to add is
# (equation 1.10)
#
# $$\Delta = f^{-1}(\text{target}) - f^{-1}(\text{average}),$$
#
# but at most 8 stops, up or down: if $\Delta$ is above 8, return 8, and if it is below -8, return
# -8. Derive $f^{-1}$ yourself. `average` is from 0 to 255, `target` lies between 0 and 255.
# $f^{-1}(0) = -\infty$ and $f^{-1}(255) = \infty$, so an average of 0 gives 8, and an average of
# 255 gives -8.
#
# *Example*: with $A = 1$ and $C = 1$, $f(0) = 127.5$, and $f(\ln 3) = 191.25$. So $\Delta = \ln 3
# \approx 1.0986$ stops for the average 127.5 and the target 191.25.
#
# ($A$ is `a`, and $C$ is `c`. All arguments are numbers, and so is the result.)

# %% task="offset"
# Return the light to add, in stops, so that the average value becomes the target; from -8 to 8.

# %% [markdown] about="table"
# ## 8 · A look-up table that adds light ({points})
#
# To add $\Delta$ = `delta` stops of light, every pixel moves along the same curve $f$ (equation
# 1.11 of the same paper):
#
# $$Y' = f\bigl(f^{-1}(Y) + \Delta\bigr).$$
#
# There are only 256 pixel values, so the result is a table: `table(delta)[Y]` is the new value of
# $Y$, for $Y = 0, 1 \ldots 255$. Round to whole numbers (a half either way). Black stays 0, and
# white stays 255.
#
# *Example*: with $A = C = 1$ and $\Delta = \ln 3$, the value 85 has the light $-\ln 2$. It gets
# the light $\ln 1.5$, and so the value $255 / (1 + 2/3) = 153$.
#
# ($A$ is `a`, and $C$ is `c`. Return (256,), of any type of numbers.)

# %% task="table"
# Return the new pixel values (256,) of Y = 0 ... 255 with delta stops more light, rounded.

# %% about="offset table"
photo = np.rint(255 * np.clip(0.2 * L / np.quantile(L, 0.95), 0, 1) ** (1 / 2.2)).astype(int)
delta = float(offset(photo.mean()))
brighter = np.asarray(table(delta))[photo]
print(f"the photo needs {delta:.2f} stops")
pictures.picture(
    np.hstack([photo, brighter]).astype(np.uint8),
    alt="The dark photo of the room, and the photo with the missing light added",
)

# %% [markdown] about="lowest_ratio"
# ## 9 · How much light does the lens scatter? ({points})
#
# A lens scatters a share $s$ of the light all over the image: *veiling glare*. If $E$ is the
# radiance, and $G$ is the light that arrives at a pixel if all light of the scene is scattered, a
# photo shows
#
# $$F = (1 - s)\, E + s\, G.$$
#
# $E$ is not negative, so the ratio $F / G$ is at least $s$. If the scene has dark places, the
# lowest ratios are near $s$. A single pixel may be defective, so use quantiles. Let $q_1$, $q_2$
# and $q_3$ be the quantiles of 0.0002, 0.001 and 0.01 of all ratios $F / G$ with $G > 0$, as
# `numpy.quantile` computes them. Dark places are not perfectly black, so extrapolate to even lower
# ratios:
#
# $$s = \max(2 q_1 - q_2,\; 0), \qquad \text{agreement} = \frac{q_3}{q_1}.$$
#
# An agreement near 1 means that many places have the same lowest ratio, as with glare. If fewer
# than 5000 pixels have $G > 0$, return a share of 0 and an agreement of `inf`.
#
# *Example*: $q_1 = 0.05$, $q_2 = 0.06$ and $q_3 = 0.08$ give $s = 0.04$ and an agreement of 1.6.
#
# (`F` and `G` are (H, W); all values of `F` are above 0, those of `G` at least 0. Return the pair
# (share, agreement).)

# %% task="lowest_ratio"
# Return the share of glare from the lowest ratios F / G, and the agreement q3 / q1.

# %% [markdown] about="subtract_glare"
# ## 10 · Subtract the glare ({points})
#
# Now solve $F = (1 - s)\, E + s\, G$ for $E$, with $s$ = `share`, a number from 0 to less than 1.
# Noise can make $F - s\, G$ smaller than it is, or even negative. Light is not negative, and 0
# would have no logarithm. So use $F / 1000$ in place of $F - s\, G$ where the latter is smaller.
#
# *Example*: $s = 0.2$. $F = 1$ and $G = 2$ give $E = 0.6 / 0.8 = 0.75$. $F = 1$ and $G = 6$ give
# $E = 0.001 / 0.8 = 0.00125$.
#
# (`F` and `G` have the same shape, (H, W) or (H, W, 3), and all values are above 0. $E$ has the
# same shape.)

# %% task="subtract_glare"
# Return E, the radiance map F without the scattered light share G.

# %% about="lowest_ratio subtract_glare"
y, x = np.indices(L.shape)
falloff = 1 / (1 + np.hypot(y - 60, x - 80)) ** 2
spectrum = np.fft.fft2(L) * np.fft.fft2(np.fft.ifftshift(falloff / falloff.sum()))
scattered = np.maximum(np.fft.ifft2(spectrum).real, 1e-6)
veiled = 0.9 * L + 0.1 * scattered
share, agreement = lowest_ratio(veiled, scattered)
print(f"share {share:.3f} (true: 0.100), agreement {agreement:.2f}")
clear = subtract_glare(veiled, scattered, share)
pictures.radiance(np.hstack([veiled, clear]), alt="The room with and without veiling glare")

# %% [markdown] about="reconstruct"
# ## 11 · Assorted pixels: a bracket in one photo ({points})
#
# In front of each pixel of the sensor is a filter of transparency $e$, from 1 down to 1/64 ([Nayar
# and Mitsunaga, 2000](https://doi.org/10.1109/CVPR.2000.855857)). Neighbors have different
# filters, so one photo contains a bracket. `Z` (H, W) is the photo, linear, uint8. $X = Z / 255$
# is the exposure of a pixel, and $X / e$ is its estimate of the radiance.
#
# - A pixel with $X \ge 0.995$ may be full: its weight $w$ is 0.
# - All others have the inverse of the variance of $X / e$ as weight,
#
# $$w = \frac{e^2}{\dfrac{X}{N} + \Bigl(\dfrac{R}{N}\Bigr)^2 + \dfrac{1}{12 \cdot 255^2}},$$
#
#   with $N$ = `full_well` and $R$ = `read_noise`, both in electrons. $N$ may be infinite (its
#   default); then the first two terms of the sum are 0.
# - The radiance is a weighted mean of the pixels nearby,
#   $E = \dfrac{\text{blur}(w X / e)}{\text{blur}(w)}$, with
#   `scipy.ndimage.gaussian_filter(..., sigma)` and its default settings.
#
# If `c` (H, W) is given, a pixel also has a color: `c` is 0, 1 or 2 for red, green or blue. Then
# compute one map for each color, in which the weights of all pixels of other colors are 0, and
# return (H, W, 3).
#
# *Example*: a clear pixel ($e = 1$) is full. Its only neighbor, $e = 1/4$, has $X = 0.5$. Then $E
# = 2$ at both places.
#
# (`e` is (H, W). In the checks, there are pixels that measure, of each color, near every pixel.)

# %% task="reconstruct"
# Return the radiance E (H, W) of a photo Z through filters e; (H, W, 3) if colors c are given.

# %% about="reconstruct"
mosaic = tile(assorted.FOUR_EXPOSURES, L.shape)
Z = assorted.shoot(60 * L / L.max(), mosaic, full_well=20_000, read_noise=5)
E = reconstruct(Z, mosaic, full_well=20_000, read_noise=5)
pictures.radiance(
    E, alt="The radiance recovered from one photo; the cabinet is too dark to be measured"
)

# %% [markdown] about="smear"
# ## 12 · Coded exposure: what the sensor sees ({points})
#
# An object moves while the shutter is open. [Raskar, Agrawal and Tumblin
# (2006)](https://doi.org/10.1145/1179352.1141957) let the shutter flutter: it opens and closes in
# a code `h` (m,) of 0 (closed) and 1 (open). The exposure has $m$ equal parts, the *chops*, and in
# each chop the object moves one pixel down the first axis. So the photo of the object `x` (n,), of
# $n$ pixels, is
#
# $$y_i = \frac{1}{m} \sum_{k = 0}^{m - 1} h_k\, x_{i - k}, \qquad i = 0 \ldots n + m - 2,$$
#
# where $x$ is 0 outside of the object.
#
# *Example*: $x = (4, 8)$ and $h = (1, 0, 1, 1)$ give $y = (1, 2, 1, 3, 2)$.
#
# (`x` is (n,), or (n, 3) in color, where each channel moves in the same way. $y$ is (n + m - 1,)
# or (n + m - 1, 3).)

# %% task="smear"
# Return the photo y (n + m - 1, ...) of an object x that moves while the shutter h flutters.

# %% [markdown] about="sharpen"
# ## 13 · Make it sharp again ({points})
#
# The equation above is linear: $y = A x$, where the matrix $A$ (n + m - 1, n) has $h / m$ in each
# column, one row lower than in the column before. It has more rows than columns, so with noise
# there is no exact solution. Return the object $x$ that minimizes $\lVert A x - y \rVert^2$,
# without any further term. The code keeps all spatial frequencies, so in the checks $A$ has full
# rank.
#
# *Example*: $y = (1, 2, 1, 3, 2)$ and $h = (1, 0, 1, 1)$ give $x = (4, 8)$.
#
# (`y` is (n + m - 1,), or (n + m - 1, 3) in color: each column has its own $x$, with the same $A$.
# The result is (n,) or (n, 3).)

# %% task="sharpen"
# Return the object x (n, ...) that fits the photo y best, by least squares.

# %% about="smear sharpen"
row = L[60, :100] / L[60, :100].max()
flutter_photo = smear(row, flutter.RASKAR_CODE)
noisy = flutter_photo + np.random.default_rng(1).normal(0, 0.002, flutter_photo.shape)
pictures.picture(
    curves.lines(
        np.arange(len(row)),
        {"object": row, "photo": noisy[26:126], "sharpened": sharpen(noisy, flutter.RASKAR_CODE)},
        across="pixel",
        up="light",
    ),
    alt="The object, its smooth photo, and the sharpened photo, which follows the object closely",
)

# %% [markdown] about="join_sensors"
# ## 14 · One lens, several sensors ({points})
#
# Behind one lens, beam splitters send most of the light to one sensor, and little to another
# ([Tocci and others, 2011](https://doi.org/10.1145/2010324.1964936), section 5). `B` and `D` (H, W)
# are the radiance from the brighter and the darker sensor. `full` (H, W) is True where a pixel of
# the brighter sensor is full; its `B` is too low. The darker sensor is never full, but noisier. So
# use it only where the other one fails, and without a visible seam.
#
# The *window* of a pixel is the 5 × 5 pixels around it, itself included. Beyond the border of the
# image, the nearest pixel of the image stands in. $u$ is the fraction of the pixels in the window
# that are full. A full pixel is predicted by
#
# $$P = D\, \frac{\sum B}{\sum D},$$
#
# where both sums are over the pixels of the window that are not full. There are four cases:
#
# | case | the pixel | its window | $E$ |
# |---|---|---|---|
# | 1 | is not full | no pixel is full | $B$ |
# | 2 | is not full | some pixels are full | $(1 - u)\, B + u\, D$ |
# | 3 | is full | some pixels are not full | $(1 - u)\, P + u\, D$ |
# | 4 | is full | all pixels are full | $D$ |
#
# Filters such as `scipy.ndimage.uniform_filter` make small rounding errors: do not compare $u$ with
# exactly 0 or 1.
#
# *Example*: all pixels have $B = 10$ and $D = 9$, except for one, which is full and has $D = 18$. It
# has $u = 1/25$ and $P = 18 \cdot 10 / 9 = 20$, so $E = 0.96 \cdot 20 + 0.04 \cdot 18 = 19.92$. Its
# neighbors have $E = 0.96 \cdot 10 + 0.04 \cdot 9 = 9.96$.
#
# (`B` and `D` are above 0, `full` is bool. Return the pair $E$ (H, W) and the cases (H, W), 1 to 4,
# of any type of numbers.)

# %% task="join_sensors"
# Return the radiance E (H, W) from two sensors, and the case (H, W), 1 to 4, of each pixel.

# %% about="join_sensors"
bright_sensor = np.minimum(L / np.quantile(L, 0.95), 1)
sensor_noise = np.random.default_rng(2).normal(0, 0.02, L.shape)
dark_sensor = np.maximum(L / np.quantile(L, 0.95) + sensor_noise, 1e-3)
E, cases = join_sensors(bright_sensor, dark_sensor, bright_sensor == 1)
print("pixels of the cases 1 to 4:", np.bincount(np.asarray(cases, int).ravel(), minlength=5)[1:])
pictures.radiance(E, alt="The radiance of the room from two sensors")

# %% [markdown] about="consistency"
# ## 15 · Does a neighboring frame agree? ({points})
#
# A video alternates between short and long exposures ([Kang and others,
# 2003](https://doi.org/10.1145/882262.882270)). A frame borrows radiance from its neighbors, which
# are first moved along the estimated motion. Where this motion is wrong, the neighbor contradicts
# the frame, and must get no weight. $v$ and $v'$, the arguments `v` and `v_` (H, W, C), are the
# values of the frame and of its neighbor at the same exposure, from 0 to 1, in $C$ channels. Let
#
# $$d = \min\Bigl( \frac{\max_C |v - v'|}{16/255},\; 1 \Bigr), \qquad f = 2 d^3 - 3 d^2 + 1,$$
#
# where the maximum is over the channels.
#
# *Example*: the channels of a pixel differ by 8/255, 4/255 and 0. Then $d = \frac{1}{2}$ and $f =
# \frac{1}{2}$.
#
# ($C$ is 1 or 3. Return $f$ (H, W, 1).)

# %% task="consistency"
# Return f (H, W, 1), the weight of a neighboring frame v_ of the frame v: 1 where both agree.

# %% about="consistency"
one_frame = np.full((1, 5, 3), 0.5)
next_frame = one_frame + np.array([0, 4, 8, 12, 20])[:, None] / 255
print(
    "weights for differences of 0, 4, 8, 12 and 20 levels:",
    np.ravel(consistency(one_frame, next_frame)),
)

# %% [markdown] about="fit_space"
# ## 16 · The space of response curves ({points})
#
# The responses of real cameras are alike. [Grossberg and Nayar
# (2003)](https://doi.org/10.1109/CVPR.2003.1211522) describe them by a few numbers. `curves` (C,
# n) contains $C$ measured responses at $n$ places each. The singular value decomposition of their
# deviations from the mean into $U$, $S$ and $V$,
#
# $$\text{curves} - \text{mean} = U\, S\, V^\top,$$
#
# gives the directions along which curves differ most: $H$ (K, n) is the first $K$ = `count` rows
# of $V^\top$, the one with the largest singular value first. Its rows have length 1 and are
# orthogonal. The spread of the curves along each of them is $\mathrm{sd} = S / \sqrt C$ (K,). Then
# a response is $\text{mean} + c\, H$ with coefficients $c$ (K,).
#
# *Example*: the curves (0, 1) and (0, 3) have the mean (0, 2). $H = (0, 1)$, and $\mathrm{sd} =
# \sqrt 2 / \sqrt 2 = 1$.
#
# (Return three arrays: mean (n,), $H$ (K, n) and $\mathrm{sd}$ (K,). A tuple or a `Space` are both
# fine, and each row of $H$ may have either sign. In the checks, $K < C$, and no two singular
# values are nearly equal.)

# %% task="fit_space"
# Return mean (n,), the principal components H (count, n), and the spread sd (count,) along each.

# %% about="fit_space"
places = np.linspace(0, 1, 101)
cameras = np.array([places**gamma for gamma in np.arange(0.25, 1.0, 0.05)])
mean, H, sd = fit_space(cameras, 3)
print("sd:", np.round(sd, 3))
pictures.picture(
    curves.lines(
        places,
        {"mean": mean, **{f"component {k + 1}": H[k] for k in range(3)}},
        across="exposure",
        up="brightness",
    ),
    alt="The mean of the responses, and three components with one, two and three bumps",
)

# %% [markdown] about="solve_map"
# ## 17 · A curve from a few samples: the prior ({points})
#
# A few samples of a response give equations $A c = b$ for its coefficients, often fewer than there
# are unknowns. But not all coefficients are equally plausible: over many cameras, $c_k$ has the
# mean 0 and the standard deviation $\mathrm{sd}_k$. If the errors of the equations have the
# standard deviation 1, the most probable coefficients (maximum a posteriori) minimize
#
# $$\lVert A c - b \rVert^2 + \sum_k \Bigl(\frac{c_k}{\mathrm{sd}_k}\Bigr)^2.$$
#
# *Example*: one equation, $c = 3$, and $\mathrm{sd} = 1$: the minimum of $(c - 3)^2 + c^2$ is at
# $c = 1.5$.
#
# (`A` is (m, K), `b` is (m,), `sd` is (K,) and above 0. $m$ may be smaller than $K$. Return $c$
# (K,).)

# %% task="solve_map"
# Return the c (K,) that minimizes |A c - b|^2 + |c / sd|^2.

# %% about="fit_space solve_map"
seen = [20, 70]
noise = 0.002
found = solve_map(H[:, seen].T / noise, (places**0.42 - mean)[seen] / noise, sd)
pictures.picture(
    curves.lines(
        places,
        {"true": places**0.42, "from two samples": mean + found @ H},
        across="exposure",
        up="brightness",
    ),
    alt="A response from two samples and the prior: it covers the true one almost everywhere",
)

# %% [markdown] about="quadratic_form"
# ## 18 · Join blends of light ({points})
#
# A *blend* is a series of samples of the response: while the exposure rises evenly, in known
# relative steps $I_{ij}$, the camera measures the brightnesses $M_{ij}$ (Wilburn, Xu and
# Matsushita, 2008). The exposure itself is $s_j I_{ij} + r_j$, with an unknown scale and offset
# for each blend $j$. The inverse response is a polynomial, $g(M) = \sum_{k = 0}^{d} a_k M^k$. The
# error is (equation 5 of the paper, with the index of $s$ corrected)
#
# $$E = \sum_j \sum_i \bigl(s_j I_{ij} + r_j - g(M_{ij})\bigr)^2.$$
#
# For given $a$, the best $s_j$ and $r_j$ are those of the least-squares straight line through the
# points $(I_{ij},\, g(M_{ij}))$ of blend $j$. So $E$ depends on $a$ only, and it is a quadratic
# form: $E = a^\top Q\, a$. Return the symmetric matrix $Q$.
#
# One way: the columns of $V$ (l, d + 1) are $M^0, M^1 \ldots M^d$ of a blend of $l$ samples.
# Replace each column by its deviation from its own least-squares line in $I$; call the result
# $R_j$. Then $Q = \sum_j R_j^\top R_j$.
#
# *Example*: one blend has $I = (0, 1, 2)$ and $M = (0, 1, 4)/4$, and $d = 1$. The powers $M^0$ lie
# on a line; the deviations of $M^1$ from its line are $(1, -2, 1)/12$. So $Q$ is $1/24$ at $[1,
# 1]$ and 0 elsewhere.
#
# (`blends` is a list of pairs ($I$, $M$), arrays (l,) with $l \ge 3$; $l$ may differ from blend to
# blend. `degree` is $d \ge 1$. $Q$ is (d + 1, d + 1).)

# %% task="quadratic_form"
# Return Q (d + 1, d + 1), for which E = a^T Q a is the error at the best scales and offsets.

# %% about="quadratic_form"
ramp = np.linspace(0, 1, 16)
two_blends = [(ramp, np.sqrt(0.9 * ramp + 0.05)), (ramp, np.sqrt(0.3 * ramp + 0.01))]
Q = quadratic_form(two_blends, 3)
for name, a in {"M": [0, 1, 0, 0], "M^2": [0, 0, 1, 0], "M^3": [0, 0, 0, 1]}.items():
    print(f"g = {name}: E = {np.array(a) @ Q @ np.array(a):.6f}")

# %% [markdown] about="homography"
# ## 19 · Where are the patches of the chart? ({points})
#
# A chart with known colors calibrates a camera. In a photo, its four corners form any convex
# quadrilateral, and a homography says where every point of the chart lies: a matrix $H$ with
#
# $$\begin{pmatrix} x\, s \\ y\, s \\ s \end{pmatrix} =
#   H \begin{pmatrix} u \\ v \\ 1 \end{pmatrix}$$
#
# for a point $(u, v)$ of the chart, the place $(x, y)$ in the photo, and some number $s$, which may
# be another one for each point. Return the $H$ that takes the four points `source` to the four
# points `target`, in their order. $H$ is unknown up to a factor, so let the last element be 1,
# $H_{33} = 1$. The other eight numbers follow from a linear system with two equations for each
# point.
#
# *Example*: the corners (0, 0), (1, 0), (1, 1), (0, 1) go to (5, 5), (7, 5), (7, 7), (5, 7). $H$ has
# the rows (2, 0, 5), (0, 2, 5) and (0, 0, 1).
#
# (`source` and `target` are (4, 2), with $(x, y)$ in each row: the column first. In the checks, both
# are the corners of a convex quadrilateral, and the factor can be chosen. Return (3, 3).)

# %% task="homography"
# Return H (3, 3), with H[2, 2] = 1, that takes the four points source (4, 2) to target (4, 2).

# %% about="homography"
H_chart = np.asarray(
    homography([[0, 0], [6, 0], [6, 4], [0, 4]], [[20, 30], [95, 22], [90, 80], [25, 70]])
)
middle_of_a_patch = H_chart @ [2.5, 1.5, 1]
print(
    "the middle of the third patch of row 2 lies at", middle_of_a_patch[:2] / middle_of_a_patch[2]
)

# %% [markdown] about="clip_histogram"
# ## 20 · A clipped histogram for the Detail Brush ({points})
#
# The Detail Brush ([Mitsunaga and Nayar, 1999](https://doi.org/10.1109/CVPR.1999.786966), section
# 7) equalizes the histogram of a small window, so that it shows detail. On a flat wall, full
# equalization shows only noise: one high bin gets all the display values. So limit the bins, as
# adaptive equalization does. `h` (bins,) contains the fraction of the pixels in each bin; it sums
# to 1. No bin may be above $t = \text{limit} / \text{bins}$: `limit`, at least 1, counts in means
# of a bin.
#
# - Cut each bin: $\min(h, t)$. What was cut off everywhere is the excess, $1 - \sum \min(h, t)$.
# - Distribute the excess over the bins in proportion to the room of each, $t - \min(h, t)$.
#
# The result sums to 1, and no bin is above $t$.
#
# *Example*: `h` = (0.7, 0.3, 0, 0) and `limit` = 2: $t = 0.5$, the excess is 0.2, and the room is
# (0, 0.2, 0.5, 0.5). The result is (0.5, 0.3 + 0.2/6, 0.5/6, 0.5/6).
#
# (The result is (bins,). In the checks, $t \le 1$.)

# %% task="clip_histogram"
# Return the histogram h (bins,) with no bin above limit / bins; the excess goes where there is room.

# %% about="clip_histogram"
counts = np.histogram(np.log(L), bins=40)[0] / L.size
pictures.picture(
    curves.lines(
        np.arange(40),
        {"h": counts, "clipped at 2 means": clip_histogram(counts, limit=2.0)},
        across="bin of ln L",
        up="fraction of the pixels",
    ),
    alt="A histogram with high bins, and the clipped one, whose low bins are raised",
)

# %% [markdown] about="equalise"
# ## 21 · Equalize a window ({points})
#
# Now put the Detail Brush together. `L` (H, W) is the luminance of a window of at most 10,000
# pixels, above 0, in any linear unit. Return its display luminance (H, W), from 0 to 1:
#
# - Sort the values of all pixels. `low` is the second one and `high` the second last one, because
#   one pixel may be defective. If `high` < 2 `low`, the window is flat. Then divide `low` and
#   multiply `high` by the same factor, so that `high` becomes 2 `low`.
# - Divide $\ln L$ from $\ln$ `low` to $\ln$ `high` into `bins` bins of equal width. The histogram is
#   the fraction of the pixels in each bin. A pixel beyond an end belongs to the bin at that end.
# - Clip the histogram at `limit`, as in the task above.
# - $P$ at an edge of the bins is the sum of all bins below it: 0 at $\ln$ `low`, and 1 at $\ln$
#   `high`. For a pixel between two edges, interpolate.
# - $P$ is the code of a display. Its display luminance is that of sRGB: $P / 12.92$ if $P \le
#   0.04045$, and $((P + 0.055) / 1.055)^{2.4}$ otherwise.
#
# The checks accept an error of 0.025, so it does not matter how a pixel at the edge of a bin or
# beyond an end counts, and $P^{2.2}$ is near enough.
#
# *Example*: half of the pixels have the luminance 1, the others 100, and `bins` = 2, `limit` = 2.
# Both bins are 0.5, which is below $t = 1$. At the edge between them, $P = 0.5$ and the display
# luminance is 0.214.
#
# (You may call your `clip_histogram`. In the checks, $\text{limit} / \text{bins} \le 1$.)

# %% task="equalise"
# Return the display luminance (H, W) of a window by equalizing its clipped histogram of ln L.

# %% about="clip_histogram equalise"
brush_window = L[30:80, 90:150]
equalised = [equalise(brush_window, bins=256, limit=limit) for limit in (1.0, 4.0, 60.0)]
pictures.picture(
    colour.to_8bit(np.hstack(equalised)),
    alt="A window of the room, with more and more contrast from left to right",
)

# %% [markdown] about="spread"
# ## 22 · A curve or an operator? ({points})
#
# A tone-mapping curve gives equal luminances equal display values. An operator that looks at the
# neighborhood does not. To see how much, plot the display luminance over the luminance: a curve
# draws a line, an operator a band.
#
# Sort the pixels by their luminance $L$. Divide them into `bins` classes of equally many pixels, the
# darkest first. For each class, return three numbers: a luminance of the class, the smallest and the
# largest display luminance $L_d$ of its pixels. The luminance may be that of any of its pixels, such
# as the one in the middle, or a mean.
#
# *Example*: $L = (4, 1, 3, 2)$, $L_d = (0.9, 0.1, 0.5, 0.2)$ and 2 classes. The first class has the
# luminances 1 and 2, and $L_d$ from 0.1 to 0.2. The second one has 3 and 4, and $L_d$ from 0.5 to
# 0.9.
#
# (`L` and `Ld` are (H, W); in the checks, all luminances differ, and `bins` divides the number of
# pixels. Return three arrays (`bins`,): luminance, minimum, maximum.)

# %% task="spread"
# Return luminance, smallest Ld and largest Ld (bins,) of classes of equally many pixels.

# %% about="spread"
curve_Ld = L / (1 + L)
drawn_band = spread(L, curve_Ld * (1 + 0.2 * np.sin(np.indices(L.shape)[0] / 9)), bins=48)
pictures.picture(
    curves.lines(
        np.log10(drawn_band[0]),
        {"smallest": drawn_band[1], "largest": drawn_band[2]},
        across="log10 of the luminance",
        up="display luminance",
    ),
    alt="A band: the smallest and the largest display luminance of each class of luminance",
)

# %% [markdown] about="contrast"
# ## 23 · The contrast of a block ({points})
#
# Which parts of a photo matter for its exposure? Battiato and others (2008, section 1.3.1) divide
# it into blocks, and measure contrast and focus of each. For the contrast, $I[i]$ is the number of
# pixels with the value $i$ in the block, for $i = 0 \ldots 255$. Single peaks are irrelevant, so
# the histogram is smoothed (equation 1.3):
#
# $$\tilde I[i] = \frac{I[i - 2] + I[i - 1] + I[i] + I[i + 1] + I[i + 2]}{5}, \qquad i = 0 \ldots 255,$$
#
# where $I$ is 0 below 0 and above 255. The contrast is the mean distance from the mean (equations
# 1.4 and 1.5):
#
# $$M = \frac{\sum_i i\; \tilde I[i]}{\sum_i \tilde I[i]}, \qquad
#   D = \frac{\sum_i |i - M|\; \tilde I[i]}{\sum_i \tilde I[i]}.$$
#
# *Example*: all pixels of a block are 100. $\tilde I$ is the same at 98, 99, 100, 101 and 102, so
# $M = 100$ and $D = (2 + 1 + 0 + 1 + 2)/5 = 1.2$.
#
# (`block` is (h, w), of type float, and contains whole numbers from 0 to 255. Return the number
# $D$.)

# %% task="contrast"
# Return D, the mean distance of the smoothed histogram of a block from its mean.

# %% [markdown] about="focus"
# ## 24 · The focus of a block ({points})
#
# The Laplacian of a pixel is the sum of its four neighbors (above, below, left, right), minus four
# times the pixel. At the edge of the block, the pixel itself stands in for a neighbor that is
# missing. The focus (equation 1.6 of the same paper) is the mean of the absolute Laplacian over
# all pixels of the block, where absolute values of at most `noise` count as 0: they may be noise.
#
# *Example*: a block of 5 × 5 pixels is 0, except for the middle pixel, which is 100. The absolute
# Laplacian is 400 there, and 100 at its four neighbors. With `noise` = 20, the focus is 800/25 =
# 32; with `noise` = 150, it is 400/25 = 16.
#
# (`block` is (h, w), of type float, from 0 to 255; `noise` is a number of at least 0. Return a
# number.)

# %% task="focus"
# Return F, the mean of the absolute Laplacian of a block, where values of at most `noise` count as 0.

# %% about="contrast focus"
gray = np.rint(255 * np.clip(L / np.quantile(L, 0.95), 0, 1) ** (1 / 2.2))
blocks = [np.hsplit(row, 8) for row in np.vsplit(gray, 6)]
measured = {"contrast": contrast, "focus": focus}
for name, measure in measured.items():
    print(f"{name} of 6 x 8 blocks:")
    print(np.array([[measure(block) for block in row] for row in blocks]).round().astype(int))

# %% [markdown] about="find_by_locus"
# ## 25 · Skin by its color ({points})
#
# If there are faces in a photo, they decide its exposure. From a candle to the sky, skin has
# colors in a narrow region, the *skin locus* (Soriano and others, 2003). With
#
# $$r = \frac{R}{R + G + B}, \qquad g = \frac{G}{R + G + B},$$
#
# which do not depend on brightness, a pixel is skin if all of these hold:
#
# - $g < -1.3767\, r^2 + 1.0743\, r + 0.1452$,
# - $g > -0.776\, r^2 + 0.5601\, r + 0.1766$,
# - $(r - \frac{1}{3})^2 + (g - \frac{1}{3})^2 > 0.0004$, so it is not white or gray,
# - $r > g$.
#
# A black pixel, $R + G + B = 0$, is not skin.
#
# *Example*: (224, 172, 105) has $r = 0.447$ and $g = 0.343$; the limits for $g$ are 0.272 and
# 0.350, and all conditions hold. (60, 90, 200) has $r < g$: no skin.
#
# (`Z` contains pixel values from 0 to 255, of type float, (N, 3) or (H, W, 3). Return a mask (N,)
# or (H, W), of bool, or 0 and 1. No check tests a color that lies on a limit.)

# %% task="find_by_locus"
# Return a mask of the pixels between the two parabolas of the skin locus, except for white.

# %% about="find_by_locus"
colors = np.array(
    [[224.0, 172, 105], [115, 82, 68], [194, 150, 130], [60, 90, 200], [120, 120, 120]]
)
print(
    "light skin, dark skin, skin of a color chart, blue, gray:",
    np.asarray(find_by_locus(colors)).tolist(),
)

# %% [markdown] about="distance"
# ## 26 · Skin by its distance from skin ({points})
#
# The skin locus says yes or no. A Gaussian says how far a color is from the colors of skin (Battiato
# and others, 2008, equation 1.8). The brightness $Y$ of a pixel is
#
# $$Y = 0.299\, R + 0.587\, G + 0.114\, B.$$
#
# Skin in the shade is skin, too. So bring each pixel to the brightness 128 first, and then compute
# its chrominance $x = (C_b, C_r)$:
#
# $$C_b = \frac{128}{\max(Y, 1)} (-0.168736\, R - 0.331264\, G + 0.5\, B), \qquad
#   C_r = \frac{128}{\max(Y, 1)} (0.5\, R - 0.418688\, G - 0.081312\, B).$$
#
# The skin of a training set has the mean $\mu$ (2,) and the covariance $S$ (2, 2) of $(C_b, C_r)$.
# Return the Mahalanobis distance of each pixel,
#
# $$d = \sqrt{(x - \mu)^\top S^{-1} (x - \mu)}.$$
#
# *Example*: $(128, 128, 128)$ has $x = (0, 0)$. For $\mu = (-6, 0)$ and $S$ with 9 and 16 on its
# diagonal and 0 beside it, $d = 6/3 = 2$.
#
# (`Z` contains pixel values from 0 to 255, of type float, (N, 3) or (H, W, 3). `skin` is the pair
# ($\mu$, $S$); the checks always pass it. Return (N,) or (H, W).)

# %% task="distance"
# Return the Mahalanobis distance d of each pixel from skin, which is the pair (mu, S).

# %% about="distance"
skin_gaussian = (np.array([-17.0, 24.0]), np.array([[20.0, -25], [-25, 49]]))
swatches = np.array([[224.0, 172, 105], [115, 82, 68], [194, 150, 130], [60, 90, 200]])
print(
    "light skin, dark skin, skin of a color chart, blue:",
    np.round(distance(swatches, skin_gaussian), 1).tolist(),
)

# %% [markdown] about="circle"
# ## 27 · The circle without vignetting ({points})
#
# A lens darkens the corners of an image, more so at a wide aperture. If two photos have different
# apertures, their corners differ by more than the exposure. [Mitsunaga and Nayar (1999, section
# 6.2)](https://doi.org/10.1109/CVPR.1999.786966) use only pixels inside the circle in which the
# exposure is the only difference. `A` and `B` (H, W) are two aligned photos, uint8. The middle of
# the image is at row $(H - 1)/2$ and column $(W - 1)/2$, and $r$ is the distance of a pixel from
# it. The farthest pixel has the distance $r_\text{max}$.
#
# - Use only pixels with values from 5 to 249 in both photos.
# - From the pixels with $r < r_\text{max} / 4$, learn which value of $B$ belongs to each value of
#   $A$: the mean of $B$ over all of them that have this value in $A$. Interpolate for values that
#   do not occur. Leave out all pixels whose $A$ is below the smallest or above the largest value
#   there.
# - Divide the image from $r_\text{max} / 4$ to $r_\text{max}$ into `rings` rings of equal width. A
#   ring *differs* if the median of $B$ minus the predicted value over its pixels is above
#   `tolerance`, or below $-$`tolerance`. A ring without usable pixels does not differ.
# - The circle ends at the inner radius of the first ring that differs together with the next one.
#   A single ring may be an object that moved. If there are no such rings, return $r_\text{max}$.
#
# The checks accept an error of two rings.
#
# *Example*: $r_\text{max} = 100$ and `rings` = 3: the rings begin at 25, 50 and 75. If the first
# one does not differ and the other two do, the result is 50.
#
# (Return a number, in pixels.)

# %% task="circle"
# Return the radius, in pixels, of the circle in which the photos A and B have no vignetting.

# %% about="circle"
y, x = np.indices(L.shape)
from_middle = np.hypot(y - 59.5, x - 79.5)
darkening = np.clip(1.2 - from_middle / 250, 0, 1)
steady = np.clip(0.3 * L / np.quantile(L, 0.8), 0.01, 0.6)
small = np.rint(255 * steady ** (1 / 2.2)).astype(np.uint8)
wide = np.rint(255 * (1.5 * steady * darkening) ** (1 / 2.2)).astype(np.uint8)
print(f"the lens darkens beyond 50 pixels; the photos agree up to {circle(small, wide):.0f} pixels")

# %% [markdown] about="adaptive_log"
# ## 28 · A logarithm whose base changes ({points})
#
# A logarithm compresses luminance as the eye does. With base 2, dark places keep their contrast, but
# lamps are far too bright. With base 10, the lamps fit, and the rest is dark. The curve of [Drago,
# Myszkowski, Annen and Chiba (2003)](https://doi.org/10.1111/1467-8659.00689) changes the base from
# pixel to pixel.
#
# The eye is adapted to the log average $L_{wa}$ of the scene. So divide luminance by it, and the
# largest luminance $L_{max}$ of the scene as well:
#
# $$L_w = L / L_{wa}, \qquad L_{wmax} = L_{max} / L_{wa}.$$
#
# The base is 2 for black, and 10 for the largest luminance. The bias $b$ = `bias` shapes it in
# between:
#
# $$B = 2 + 8 \Bigl(\frac{L_w}{L_{wmax}}\Bigr)^{\ln b / \ln 0.5}.$$
#
# The display luminance is a logarithm to this base. It is 0 for black, and 1 for the largest
# luminance:
#
# $$L_d = \frac{\log_B (L_w + 1)}{\log_{10} (L_{wmax} + 1)}, \qquad \log_B x = \frac{\ln x}{\ln B}.$$
#
# *Example*: $b = 0.85$, $L_{wa} = 1$ and $L_{max} = 100$. Half of $L_{max}$ has the base $2 + 8 \cdot
# 0.85 = 8.8$, and $L_d = (\ln 51 / \ln 8.8) / \log_{10} 101 = 0.902$.
#
# (`L` has values from 0 to `Lmax`; `Lwa` and `Lmax` are numbers above 0, and $0 < b \le 1$. Return an
# array with the shape of `L`.)

# %% task="adaptive_log"
# Return the display luminance of L, with the log average Lwa and the largest luminance Lmax.

# %% about="adaptive_log"
average = float(np.exp(np.log(L).mean()))
mapped = [
    adaptive_log(np.minimum(L, 60 * average), average, 60 * average, bias=b) for b in (1, 0.75)
]
pictures.picture(
    colour.to_8bit(np.hstack(mapped)),
    alt="The room twice: with base 10, and with a bias of 0.75, where the middle tones are brighter",
)

# %% [markdown] about="merge_tile"
# ## 29 · Merge a burst, frequency by frequency ({points})
#
# A phone takes a *burst*: $N$ equal, short photos, one right after the other. Each tile of $n \times n$
# pixels is aligned with the first photo, the *reference frame*. The mean of the $N$ tiles has less noise,
# but ghosts where something moved. [Hasinoff and others
# (2016)](https://doi.org/10.1145/2980179.2980254) decide it for each spatial frequency of the tile.
#
# Let $F_z$ be the Fourier transform of tile $z$, with $z = 0$ for the reference. Its difference from the
# reference is
#
# $$D_z = F_0 - F_z.$$
#
# If nothing moved, $D_z$ is only noise. A coefficient of the transform is a sum over $n^2$ pixels, and
# two tiles contribute. So with the noise variance $\sigma^2$ = `variance` of a pixel, the mean of
# $|D_z|^2$ is
#
# $$S = 2 n^2 \sigma^2.$$
#
# The *shrinkage* is a number from 0 to 1 for each frequency, near 0 for noise and near 1 for motion. With
# the tuning constant $c$ = `tuning` it is
#
# $$A_z = \frac{|D_z|^2}{|D_z|^2 + c\,S}.$$
#
# The merged tile has the Fourier transform
#
# $$F = \frac1N \sum_{z=0}^{N-1} \bigl(F_z + A_z D_z\bigr).$$
#
# *Example*: $N = 2$ tiles of a single pixel, 3 and 1, with $\sigma^2 = 1$ and $c = 1$. Then $D_1 = 2$,
# $S = 2$ and $A_1 = 4 / 6$. The merged pixel is $(3 + 1 + 2 \cdot 4 / 6) / 2 = 2.667$.
#
# (`T` contains the tiles, shape (N, n, n), the reference first; `variance` and `tuning` are numbers above
# 0. Return the merged tile itself, shape (n, n), as real numbers.)

# %% task="merge_tile"
# Return the tile merged from the aligned tiles T of a burst, with the noise variance of a pixel.

# %% about="merge_tile"
rng = np.random.default_rng(0)
still = 0.4 + 0.2 * np.sin(np.arange(16) / 2) * np.ones((16, 1))
burst = still + 0.05 * rng.standard_normal((8, 16, 16))
burst[4:, 4:12, 4:12] += 0.5  # something comes into the picture
versions = {"reference": burst[0], "mean": burst.mean(axis=0)}
versions["merged"] = merge_tile(burst, 0.05**2, tuning=12.0)
for name, version in versions.items():
    print(f"{name:9} error {np.sqrt(np.mean((version - still) ** 2)):.3f}")

# %% about="merge_tile"
row = np.clip(np.hstack(list(versions.values())), 0, 1)
pictures.picture(
    colour.to_8bit(row).repeat(12, axis=0).repeat(12, axis=1),
    alt="The tile three times: with noise, with a ghost, and merged with less noise and no ghost",
)

# %% [markdown]
# ## All checks

# %%
check("hw6")
