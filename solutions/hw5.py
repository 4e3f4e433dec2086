# %% [markdown]
# # Homework 5 · Methods since 2010, and more of the lecture
#
# Due {due}. {total} points. {late}
#
# The first tasks are about methods that are newer than the lecture: a radiance map with a standard
# deviation for each pixel, a base layer from local linear fits (the guided filter), contrast
# compression at each scale without a base layer (the local Laplacian filter), and PQ coding and
# gain maps for HDR screens. The others are parts of the lecture that no other homework covers: the
# gain of a sensor, the brightness transfer between two histograms, the signal-to-noise ratio of a
# pixel value, the weights of exposure fusion, metering, flat patches, least squares by the singular
# value decomposition, and the colors of a RAW photo. You write the core of each.
#
# {choice}
#
# | symbol | meaning | shape |
# |---|---|---|
# | $X$, $D$ | exposure, and the width of the exposures of one pixel value | (P, H, W) |
# | $N$, $R$ | electrons of a pixel at exposure 1, and read noise in electrons | |
# | $t$ | exposure times, s | (P,) |
# | $E$, $s$ | radiance, and its standard deviation | (H, W) |
# | $l$ | $\ln$ luminance, `lL` | (H, W) |
# | $I$, $p$, $q$ | guide, image, and smoothed image | (H, W) |
# | $F_D$ | luminance that a display shows, cd/m² | any |
# | $G$ | gain in stops | (H, W, 3) |
# | $h_A$, $h_B$; $T$ | histograms of two photos; the value in $B$ for each value of $A$ | (n,) |
#
# A task may use other letters, or one of these for something else, and then it says so.
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
from hdrlab.show import pictures
from hdrlab.show.plots import curves

use_plan("hw5")

# %% [markdown]
# ## The scene

# %%
room = scenes.room((240, 320))
L = colour.luminance(room)
pictures.radiance(room, alt="The radiance of the room in false color")

# %% [markdown] about="variance"
# ## 1 · The noise of one photo ({points})
#
# A sensor counts photons, which arrive at random: the variance of a count equals the count itself
# (*shot noise*). At exposure $X$ the count is $X N$ electrons. Reading it out adds *read noise*:
# $R$ electrons of standard deviation, independent of the light. Finally, the result is rounded to a
# pixel value. All exposures in an interval of width $D$ are rounded to the same value, and the true
# one lies anywhere in the interval, with equal probability.
#
# What is the variance $V$ of the exposure $X$? Think about the units: two of the three terms are
# given in electrons, and $N$ electrons are an exposure of 1. The three are independent. `X` and `D`
# are arrays of one shape; `N` and `R` are numbers, or arrays of that shape. Return $V$ in the shape
# of `X`.

# %% task="variance"
# Return the variance V of the exposure X: photon noise, read noise and rounding.

# %% about="variance"
light = np.logspace(-4, 0, 201)
full, R = 20_000, 5
whole = variance(light, 0 * light + 1 / 4095, full, R)
each = {
    "photons alone": light / np.sqrt(variance(light, 0 * light, full, 0)),
    "all": light / np.sqrt(whole),
}
pictures.picture(
    curves.lines(
        np.log2(light),
        {name: np.log2(snr) for name, snr in each.items()},
        across="exposure, stops below saturation",
        up="signal-to-noise ratio, stops",
        legend="upper left",
    ),
    alt="The signal-to-noise ratio rises by half a stop per stop of light under photon noise, by one below",
)

# %% [markdown] about="inverse_variance_merge"
# ## 2 · The inverse-variance mean ({points})
#
# Each photo gives an estimate of the radiance, $x = X / t$, with the variance
# $V = \operatorname{variance}(X, D, N, R) / t^2$. The mean with the smallest error weights each
# estimate by the inverse of its variance ([Granados and others,
# 2010](https://doi.org/10.1109/CVPR.2010.5540208)). It also gives its own standard deviation:
#
# $$E = \frac{\sum x / V}{\sum 1 / V}, \qquad s = \frac 1 {\sqrt{\sum 1 / V}}.$$
#
# The sums are over the photos that measure the pixel: `measured` is False where a photo is clipped,
# and `X` and `D` have no meaning there. One problem is left. A photo that caught too few photons by
# chance has too small an $X$, so too small a $V$, and would get too much weight. The variance
# should be that of the true light, $E\,t$. But $E$ is unknown. So begin with the variance of $X$
# and compute the mean $E$. Then do the following twice: compute $V$ from the exposures $E\,t$, and
# with this $V$ a new mean. The checks do not notice more iterations.
#
# `X`, `D` and `measured` are `(P, H, W)`. Return $E$ and $s$, both `(H, W)`. You may call your
# `variance`. In the checks, at least one photo measures each pixel.

# %% task="inverse_variance_merge"
# Return E and s: the inverse-variance weighted mean of X / t, and its standard deviation.

# %% about="inverse_variance_merge"
green = room[..., 1] / room[..., 1].max()
t, full, R = 4.0 ** np.arange(6) / 2, 20_000, 5
taken = camera.shoot(
    green, t, camera.Camera(response="linear", bits=16, full_well=full, read_noise=R), rng=1
)
g = responses.true_g("linear", 2**16)
X = np.exp(g - g[-1])[taken.images]
E, s = inverse_variance_merge(X, np.full(X.shape, 1 / 65535), X < 0.98, t, full, R)
covered = np.abs(E - green) < 1.96 * s
print(f"{np.mean(covered[s < np.inf]):.1%} of the measured pixels lie within E ± 1.96 s")
pictures.radiance(s / E, alt="s / E in false color: it is largest in the shadows")

# %% [markdown] about="guided"
# ## 3 · A line in each window: the guided filter ({points})
#
# [He, Sun and Tang (2010, 2013)](https://doi.org/10.1109/TPAMI.2012.213) smooth an image $p$ and
# keep the edges of a guide $I$, which is often the same image. In each square window with sides of
# $2 \cdot$ `radius` $+\, 1$ pixels, $p$ is approximated by a linear function of $I$, $a I + b$,
# with a penalty on its slope $a$:
#
# $$a = \frac{\operatorname{cov}(I, p)}{\operatorname{var}(I) + \epsilon}, \qquad
#   b = \operatorname{mean}(p) - a \operatorname{mean}(I).$$
#
# Mean, variance and covariance are over the pixels of the window (divide by their number).
# $\epsilon$ (`epsilon`, above 0) is the variance above which something counts as an edge. Each
# pixel lies in many windows, as many as a window has pixels. It takes the mean of their lines:
#
# $$q = \operatorname{mean}(a)\, I + \operatorname{mean}(b).$$
#
# If `p` is not given, $p = I$. How you extend the image beyond its edge is up to you: the checks
# only look at pixels further than $2 \cdot$ `radius` from it.

# %% task="guided"
# Return q = mean(a) I + mean(b), with means over all windows that contain the pixel.

# %% about="guided"
l = np.log(L)
base = guided(l, radius=8, epsilon=0.8)
detail = l - base
high = np.quantile(base, 0.99)
Ld = np.clip(np.exp(0.45 * (base - high) + detail), 0, 1)
pictures.picture(
    colour.to_8bit(colour.recolour(room, L, Ld)),
    alt="The room with a compressed base and unchanged details",
)

# %% [markdown] about="remap"
# ## 4 · Detail or edge? The local Laplacian filter ({points})
#
# [Paris, Hasinoff and Kautz (2011)](https://doi.org/10.1145/1964921.1964963) need no base layer.
# For each coefficient of a Laplacian pyramid, they take the luminance $g$ at its position and
# classify the image around it: whatever differs from $g$ by less than $\sigma$ is detail, and the
# rest is an edge. With $d = |l - g|$, the image is remapped to $r$,
#
# $$r = \begin{cases} g \pm \sigma\, f(d / \sigma) & d \le \sigma \\
#   g \pm \bigl(\sigma + \beta\, (d - \sigma)\bigr) & d > \sigma \end{cases}$$
#
# with + where $l$ is above $g$ and - where it is below. $\beta$ is the fraction that remains of
# an edge's contrast beyond $\sigma$. For $\alpha \ge 1$, $f(x) = x^\alpha$: the larger $\alpha$,
# the weaker the details, and 1 leaves them as they are. For $\alpha < 1$, this power amplifies
# details, but its slope at 0 is infinite, so it would amplify noise most of all. Therefore
# differences up to 0.01, a contrast of 1 %, stay as they are, and a smooth step $\tau$ leads to
# the power at 0.02:
#
# $$f(x) = \tau\, x^\alpha + (1 - \tau)\, x, \qquad \tau = y^2 (2 - y)^2, \qquad
#   y = \min\Bigl(\max\Bigl(\frac{d}{0.01} - 1,\, 0\Bigr),\, 1\Bigr).$$
#
# ($l$ and the number $g$ are natural logarithms, so $d$ is in nats. $\sigma$ is `sigma` and
# $\alpha$ is `alpha`, both above 0; $\beta$ is `beta`.)

# %% task="remap"
# Return the remapped r of log luminance lL (H, W), for the reference value g.

# %% about="remap"
i = np.linspace(-8, 0, 201)[None]
remapped = {
    f"alpha = {alpha}": remap(i, -4.0, sigma=1.0, alpha=alpha, beta=0.2)[0] for alpha in (0.5, 1, 2)
}
pictures.picture(
    curves.lines(i[0], remapped, across="l, ln luminance", up="r, nats"),
    alt="r over l: steep, straight or flat at g = -4, and a gentle slope beyond sigma on both sides",
)

# %% [markdown] about="pq"
# ## 5 · PQ: a code for brighter screens ({points})
#
# Gamma coding was made for displays of 100 cd/m². The *perceptual quantizer* (PQ) of SMPTE ST 2084
# ([ITU-R BT.2100](https://www.itu.int/rec/R-REC-BT.2100)) has a code for every luminance $F_D$ up
# to 10,000 cd/m². With 12 bits, each of its steps is just too small for the eye to see. With $Y$ for
# the fraction of 10,000 cd/m², and five constants $m_1$, $m_2$, $c_1$, $c_2$ and $c_3$,
#
# $$v = \Bigl(\frac{c_1 + c_2\, Y^{m_1}}{1 + c_3\, Y^{m_1}}\Bigr)^{m_2}, \qquad Y = \frac{F_D}{10{,}000},$$
#
# $$m_1 = \frac{2610}{16384}, \quad m_2 = 128 \cdot \frac{2523}{4096}, \quad c_1 = \frac{3424}{4096}, \quad
#   c_2 = 32 \cdot \frac{2413}{4096}, \quad c_3 = 32 \cdot \frac{2392}{4096}.$$
#
# $F_D$ is an array of any shape, from 0 to 10,000. $v$ has the same shape, from 0 to 1.

# %% task="pq"
# Return the signal v from 0 to 1 of the luminance FD from 0 to 10,000 cd/m2.

# %% about="pq"
light = np.logspace(-2, 4, 201)
signals = {"PQ": pq(light), "gamma 2.4": (light / 10_000) ** (1 / 2.4)}
pictures.picture(
    curves.lines(np.log10(light), signals, across="log10 of the luminance, cd/m²", up="v"),
    alt="The signal over log luminance: PQ is nearly a line; gamma gives dark luminance almost no codes",
)

# %% [markdown] about="gain_map"
# ## 6 · One image for every screen: the gain map ({points})
#
# A file cannot know on which screen it will be shown. So ISO 21496-1 (2025) stores two images:
# `sdr`, which an operator made for any screen, and a map of how much brighter the scene, `hdr`,
# should be. Both are linear light, and 1 is the white of the screen; `hdr` goes beyond it. The gain
# is in stops:
#
# $$G = \log_2 \frac{\text{hdr} + k_\text{hdr}}{\text{sdr} + k_\text{sdr}}.$$
#
# The small offsets `k` $= (k_\text{sdr}, k_\text{hdr})$ make the gain of black finite. The map
# stores where a gain lies between the smallest and the largest gain that it can represent, `low`
# and `high`:
#
# $$g = \Bigl(\frac{G - \text{low}}{\text{high} - \text{low}}\Bigr)^\gamma.$$
#
# The quotient is clipped to 0 ... 1 before it is raised to $\gamma$ = `gamma`, which is above 0.
#
# (`sdr`, `hdr` and $g$ have the same shape, (H, W, 3) or another. `low` and `high` are numbers, or
# one for each channel, (3,). If an offset is 0, no check tests black.)

# %% task="gain_map"
# Return the gain map g from 0 to 1 for the image sdr and the scene hdr.

# %% about="gain_map"
sdr = np.clip(0.18 * room / np.exp(np.mean(np.log(L))), 0, None)
hdr, sdr = np.minimum(sdr, 8), sdr / (1 + sdr)
g = gain_map(sdr, hdr, 0.0, 3.2)
pictures.picture(
    colour.to_8bit(g), alt="The gain map: bright in the window, at the lamp and in sunlight"
)

# %% [markdown] about="apply_gain"
# ## 7 · Apply the gain map ({points})
#
# A program that reads the map reverses these steps. From $g$ it computes the gain,
#
# $$G = \text{low} + (\text{high} - \text{low})\, g^{1 / \gamma}.$$
#
# If a screen reaches as far above white as the map does, it applies the whole gain. Any other
# screen multiplies the gain, in stops, by a fraction $W$ from 0 to 1, and shows
#
# $$(\text{sdr} + k_\text{sdr})\; 2^{W G} - k_\text{hdr}.$$
#
# ($W$ is a number. `low`, `high` and $\gamma$ = `gamma` are numbers, or one for each channel,
# (3,). The result has the shape of `sdr`.)

# %% task="apply_gain"
# Return the light (1 = white) of a screen that applies the fraction W of the gain.

# %% about="gain_map apply_gain"
shown = [
    apply_gain(sdr, np.rint(255 * g) / 255, 0.0, 3.2, W=W) / 8**W for W in (0, 1 / 3, 2 / 3, 1)
]
pictures.picture(
    colour.to_8bit(np.clip(np.hstack(shown), 0, 1)),
    alt="The room on screens of 1, 2, 4 and 8 times white: brighter screens show more in the window",
)

# %% [markdown] about="line"
# ## 8 · Photon transfer: a sensor's gain from its noise ({points})
#
# Somebody took pairs of photos of an evenly lit wall, with more light from pair to pair. The first
# pair is dark, with the lens cap on. $S$ is the signal of each pair, in pixel values above the dark
# pair ($S_0 = 0$), and $V$ is the variance of its noise, in squared pixel values. Photons arrive at
# random: the variance of $N$ electrons is $N$. With $K$ electrons per pixel value,
#
# $$V - V_0 = \frac{S}{K}.$$
#
# This is a straight line through the dark pair, which is taken as exact. The error of a variance
# measured in many pixels is proportional to the variance, so each pair gets the weight
# $w = 1 / V^2$. The slope that minimizes $\sum w\,(V - V_0 - S / K)^2$ is
#
# $$\frac{1}{K} = \frac{\sum w\, S\, (V - V_0)}{\sum w\, S^2}.$$
#
# ($S$ and $V$ are arrays (M,), with $V$ above 0. Return the number $1 / K$.)

# %% task="line"
# Return the slope 1 / K of V - V[0] = S / K, by least squares with the weights 1 / V^2.

# %% about="line"
signal = np.array([0, 200, 400, 800, 1200, 1600, 2400, 3000.0])
noise = np.array([4.0, 104, 210, 398, 612, 801, 1230, 1690])
fitted = noise[0] + line(signal, noise) * signal
pictures.picture(
    curves.lines(
        signal, {"measured": noise, "line": fitted}, across="S, pixel values", up="V, squared"
    ),
    alt="Variance over signal: the line starts at the dark pair and passes below the brightest pair",
)

# %% [markdown] about="brightness_transfer"
# ## 9 · Brightness transfer from two histograms ({points})
#
# If the photos $A$ and $B$ show the same scene, the $k$-th darkest pixel of $A$ is also the $k$-th
# darkest of $B$, whatever the camera's response [(Grossberg and Nayar,
# 2003)](https://doi.org/10.1109/TPAMI.2003.1240119). So the histograms alone determine which value
# $T(m)$ of $B$ corresponds to the value $m$ of $A$, and the photos need not be aligned.
#
# A pixel value is an interval: the value $z$ reaches from $z - \frac{1}{2}$ to $z + \frac{1}{2}$,
# and its pixels are spread evenly over it. Let $H(z)$ be the fraction of pixels below the value
# $z$, with $H(0) = 0$ and $H(n) = 1$; it belongs to the edge at $z - \frac{1}{2}$. The middle of
# the value $m$ of $A$ has the rank $\frac{1}{2}\bigl(H_A(m) + H_A(m + 1)\bigr)$. $T(m)$ is the
# position where $H_B$, with straight lines between the edges, reaches that rank.
#
# The lowest value of $B$ contains everything darker, and the highest everything brighter. So $T(m)$
# is NaN where it falls on one of them: below $\frac{1}{2}$ or above $n - \frac{3}{2}$.
#
# (`h_A` and `h_B` (n,) are counts of pixels; their sums may differ. Do not round $T$ (n,). If $B$
# has empty values, $H_B$ may have the same rank along an interval. Any position in it is right, and
# no check tests it.)

# %% task="brightness_transfer"
# Return T (n,): the value in B for each value m in A, NaN at the end values of B.

# %% about="brightness_transfer"
exposures = [t * L / np.quantile(L, 0.95) for t in (0.25, 1.0)]
taken = [np.round(255 * np.clip(X, 0, 1) ** (1 / 2.2)).astype(int) for X in exposures]
T = brightness_transfer(*(np.bincount(Z.ravel(), minlength=256) for Z in taken))
inside = np.flatnonzero(np.isfinite(T))
pictures.picture(
    curves.lines(inside, {"T": T[inside], "m": inside}, across="m, value in A", up="value in B"),
    alt="T over m: above the diagonal, reaching the top of B a bit above the middle of the values of A",
)

# %% [markdown] about="snr"
# ## 10 · The signal-to-noise ratio of a pixel value ({points})
#
# Assume that the noise of the pixel values is equally large everywhere. The slope $f'$ of the
# response $f = e^{g}$ converts it into noise of the exposure, so the signal-to-noise ratio
# [(Mitsunaga and Nayar, 1999)](https://doi.org/10.1109/CVPR.1999.786966) is
#
# $$w(z) = \frac{f(z)}{f'(z)}.$$
#
# - $f'(z)$ is the slope between the values $z - s$ and $z + s$ with $s$ = `span`. If one of them is
#   beyond an end of the range, use the end instead.
# - Where the curve is flat, the quotient would be unbounded: replace a slope by `least` times the
#   mean slope, $\bigl(f(n - 1) - f(0)\bigr) / (n - 1)$, if it is smaller than that.
# - The lowest and the highest value are only bounds: $w = 0$ there.
#
# (`g` (n,) increases, and $n$ is even. $w$ (n,) may have any scale.)

# %% task="snr"
# Return w = f / f' (n,) with f = exp g, and 0 at both ends.

# %% about="snr"
levels = np.arange(256)
sure = {f"gamma {gamma}": snr(gamma * np.log((levels + 0.5) / 256)) for gamma in (1.0, 1.8, 2.6)}
pictures.picture(
    curves.lines(levels, sure, across="z, pixel value", up="w"),
    alt="w over the pixel value: nearly a line for each gamma, steeper for smaller gamma, 0 at both ends",
)

# %% [markdown] about="weight"
# ## 11 · What a good pixel is: the weights of exposure fusion ({points})
#
# [Mertens, Kautz and Van Reeth (2007)](https://doi.org/10.1109/PG.2007.17) do not make a radiance map.
# They blend the photos themselves. Three measures decide the weight of a pixel. $F$ is a photo from
# 0 to 1, with its channels R, G and B as planes:
#
# - **contrast** $C = |Y_\text{up} + Y_\text{down} + Y_\text{left} + Y_\text{right} - 4\, Y|$, with the
#   gray image $Y = 0.299 R + 0.587 G + 0.114 B$;
# - **saturation** $S$, the standard deviation of R, G and B (divide the sum of squares by 3);
# - **exposedness** $E = \prod_{R, G, B} \exp\bigl(-(F - 0.5)^2 / (2 \cdot 0.2^2)\bigr)$.
#
# The weight is their product, so that a pixel needs all three: $W = C^{a}\, S^{b}\, E^{c}$ with
# `powers` $= (a, b, c)$. No power is negative, and $x^0 = 1$.
#
# ($F$ is (3, H, W), and $W$ is (H, W). How you extend the image beyond its edge is up to you: the
# checks only look at pixels that do not touch the edge. You may add up to 1e-9 to all weights.)

# %% task="weight"
# Return W = C^a S^b E^c (H, W) of a photo F (3, H, W) from 0 to 1.

# %% about="weight"
F = np.moveaxis(np.clip(room / np.quantile(L, 0.9), 0, 1) ** (1 / 2.2), -1, 0).astype(np.float32)
W = weight(F)
pictures.picture(
    colour.to_8bit(np.clip(W / np.quantile(W, 0.99), 0, 1)),
    alt="The weight of a photo of the room: bright at edges of colored objects, black where it is clipped",
)

# %% [markdown] about="optimum"
# ## 12 · The exposure that a meter recommends ({points})
#
# An image taken at the exposure value $\mathrm{EV}_\text{pre}$ has the reading $B_\text{pre}$, a
# brightness above 0 and at most 1. It should be $B_\text{opt}$, by default 0.18. The exposure value
# that achieves this, in stops (one more stop halves the light), is (Battiato and others, 2008,
# equation 1.2)
#
# $$\mathrm{EV}_\text{opt} = \mathrm{EV}_\text{pre} + \log_2 B_\text{pre} - \log_2 B_\text{opt}.$$

# %% task="optimum"
# Return EV_opt for the numbers EV_pre, B_pre and B_opt.

# %% [markdown] about="spot"
# ## 13 · Where does a spot meter look? ({points})
#
# A spot meter gives equal weight to the pixels of a disc, and none to all others. All weights add
# up to 1.
#
# - The center of the disc is `at`, how far down and how far right as fractions of the image (H, W):
#   at row `at[0]` $H$ and column `at[1]` $W$. The pixel $(y, x)$ has its center at
#   $(y + \frac{1}{2}, x + \frac{1}{2})$.
# - The disc consists of the `share` $\cdot H W$ pixels whose centers are nearest to that point,
#   measured in pixels. Round this number (a half either way), but use at least one pixel.
#
# A share of 0.12 makes it a partial meter. A share of 1 makes it an average meter, which weights
# all pixels equally.
#
# (`shape` is (H, W), and the result $w$ is (H, W). In the checks, no two pixels are equally near.)

# %% task="spot"
# Return the weights w (H, W) of the nearest pixels, a disc; they sum to 1.

# %% about="spot"
pictures.picture(
    colour.to_8bit(
        np.clip(L / np.quantile(L, 0.95), 0, 1) * (0.3 + 0.7 * (spot(L.shape, at=(0.6, 0.5)) > 0))
    ),
    alt="The room, dark except for a disc at the lower half of the window",
)

# %% [markdown] about="centre"
# ## 14 · A center-weighted meter ({points})
#
# A center-weighted meter has no sharp boundary. The weight of a pixel is a Gaussian,
# $\exp\bigl(-d^2 / (2 \sigma^2)\bigr)$, of its distance $d$ from the point `at`. The distance is
# measured in fractions of the image: heights down and widths to the right,
# $d^2 = (\Delta y / H)^2 + (\Delta x / W)^2$. All weights add up to 1. Choose $\sigma$ so that the
# fraction `inside` of all weight lies on the pixels that a spot meter with this `share` and `at`
# uses.
#
# (`shape` is (H, W), and `inside` is larger than `share`. You may call your `spot`.)

# %% task="centre"
# Return w (H, W), a Gaussian around `at` that sums to 1, the fraction `inside` of it in the spot.

# %% about="centre"
pictures.picture(
    colour.to_8bit(
        np.clip(L / np.quantile(L, 0.95), 0, 1) * centre(L.shape) / centre(L.shape).max()
    ),
    alt="The room, gradually darker from the center to the edges of the image",
)

# %% [markdown] about="flat"
# ## 15 · Is a patch flat? A chi-square test ({points})
#
# For calibration, use pixels on evenly lit surfaces ([Mitsunaga and Nayar,
# 1999](https://doi.org/10.1109/CVPR.1999.786966)). `A` (t, H, W) are $t$ frames of one exposure,
# where 1 is full scale. Average the frames. In the average, take the patch of $s$ = `size`$^2$
# pixels around each pixel (`size` is odd). On an even surface, its variance $\sigma_s^2$ (the sum
# of the squared deviations, divided by $s$) comes from noise alone.
#
# - For **one frame**, the noise $\sigma$ = `sigma` is known. Then $s\,\sigma_s^2 / \sigma^2$ has a
#   chi-square distribution with $s - 1$ degrees of freedom. The patch is flat if this is at most
#   $\chi^2_{s-1}(\psi)$, which noise exceeds by chance in a fraction $\psi$ = `psi` of all flat
#   patches: `scipy.stats.chi2.isf(psi, s - 1)`.
# - For **several frames**, estimate the noise from the frames and ignore `sigma`. The sum of a
#   pixel's squared deviations over the frames, divided by $t - 1$, estimates the noise variance of
#   one frame; the mean of these estimates over the patch is $\sigma_t^2$. The average of $t$ frames
#   has $\sigma_t^2 / t$. This estimate has $s\,(t - 1)$ degrees of freedom, so the limit is a
#   different one. The patch is flat if
#
# $$\frac{s\,\sigma_s^2}{\sigma_t^2 / t} \le (s - 1)\, F_{s-1,\; s(t-1)}(\psi),$$
#
#   which is `scipy.stats.f.isf(psi, s - 1, s * (t - 1))`.
#
# A pixel within `size // 2` pixels of the edge of the image never counts as flat, because the edge
# cuts its patch. Return a mask (H, W), of bool, or 0 and 1.

# %% task="flat"
# Return a mask (H, W) of the pixels with a flat patch around them, for frames A (t, H, W).

# %% about="flat"
frames = np.clip(L / np.quantile(L, 0.95), 0, 1) + np.random.default_rng(8).normal(
    0, 0.01, (4, *L.shape)
)
pictures.picture(
    colour.to_8bit(flat(frames).astype(float)),
    alt="White on most of the walls; black along edges, on most of the floor, and at the image borders",
)

# %% [markdown] about="solve_by_svd"
# ## 16 · Least squares by the SVD ({points})
#
# Debevec and Malik's system $A x = b$ has more rows than unknowns. If you leave out the row
# $g(n/2) = 0$, it has many solutions, because adding one number to all $g$ and all $\ln E$ changes
# no other row. The singular value decomposition (SVD) $A = U \Sigma V^\top$ finds the shortest $x$
# among all that minimize $\sum (A x - b)^2$:
#
# $$x = \sum_{\sigma_i > \text{rtol}\, \sigma_1} \frac{u_i^\top b}{\sigma_i}\, v_i,$$
#
# where $u_i$ and $v_i$ are the columns of $U$ and $V$, and $\sigma_1$ is the largest singular
# value. Singular values of at most `rtol` $\sigma_1$ count as 0, and their terms are left out. (`A`
# is (m, k) with $m \ge k$, `b` is (m,) and `x` is (k,).)

# %% task="solve_by_svd"
# Return the shortest x (k,) that minimizes |A x - b|, with the SVD of A.

# %% about="solve_by_svd"
chain = np.array([[1.0, -1, 0], [0, 1, -1], [1, 0, -1]])  # the differences of three numbers
print(
    solve_by_svd(chain, np.array([1.0, 1, 2])),
    "has the differences 1, 1 and 2, and the mean 0",
)

# %% [markdown] about="balance_white"
# ## 17 · White balance on a RAW mosaic ({points})
#
# A RAW file holds one number for each pixel: `X`, the exposure behind one color filter, where 1 is a
# full pixel. `c` is the channel of its filter: 0 red, 1 green, 2 blue. A white card has a different
# exposure behind each filter. The gains $g$ = `gains` correct this: multiply each pixel by the
# gain of its filter.
#
# Only the ratios of the gains count, so first divide all three by the smallest. What exceeds 1 after
# the multiplication becomes 1: a pixel that is full behind all filters is white. Noise around no
# light is negative half of the time; leave values below 0 as they are.
#
# (`X` and `c` have the shape (H, W), and `gains` are three positive numbers. The filters of `c` can
# be in any order. Return the balanced mosaic, (H, W).)

# %% task="balance_white"
# Return the mosaic X (H, W), each pixel multiplied by the gain of its filter c, and at most 1.

# %% about="balance_white"
filters = np.tile([[0, 1], [1, 2]], (120, 160))
seen = np.take_along_axis(room * [0.44, 1, 0.7], filters[..., None], axis=-1)[..., 0]
mosaic = np.minimum(0.3 * seen / np.quantile(seen, 0.7), 1)
balanced = balance_white(mosaic, filters, np.array([2.25, 1, 1.42]))
pictures.picture(
    colour.to_8bit(np.hstack([mosaic, balanced])[60:120].repeat(2, axis=0).repeat(2, axis=1)),
    alt="The mosaic of the room: a checkerboard, and nearly without it after white balance",
)

# %% [markdown] about="screen_from_camera"
# ## 18 · From the colors of a camera to those of a screen ({points})
#
# The matrix $M$ takes XYZ to the channels of a camera, and $P$ takes linear RGB of a screen to XYZ.
# Together they take RGB to the camera:
#
# $$A = M P.$$
#
# White, (1, 1, 1), becomes the sums of $A$'s rows. White balance has divided each channel by just
# that, so divide each row of $A$ by its sum. The inverse of the result takes balanced
# channels back to the screen:
#
# $$C = \Bigl(\frac{A}{\text{row sums}}\Bigr)^{-1}.$$
#
# ($M$, $P$ and $C$ are (3, 3). The row sums are positive, and $A$ has an inverse.)

# %% task="screen_from_camera"
# Return C (3, 3), from the balanced channels of a camera to linear RGB of a screen.

# %% about="screen_from_camera"
canon = np.array([[0.6722, -0.0635, -0.0963], [-0.4287, 1.2460, 0.2028], [-0.0908, 0.2162, 0.5668]])
srgb = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
print(screen_from_camera(canon, srgb).round(3), "takes the colors of a camera to sRGB")

# %% [markdown]
# ## All checks

# %%
check("hw5")
