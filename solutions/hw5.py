# %% [markdown]
# # Homework 5 · Methods since 2010, and more of the lecture
#
# Due {due}. {total} points. {late}
#
# Four answers that are younger than the slides: a radiance map that knows how sure it is, a base layer
# made of lines instead of neighbours, contrast lowered scale by scale with no base at all, and for displays
# that are brighter than paper a code and a map of gains. Then questions of the lecture that no other sheet
# asks: a sensor's gain, levels that two histograms bring together, how sure a level is, what a good pixel is,
# what a meter asks for and of whom, and where a surface is even. You write the heart of each.
#
# {choice}
#
# | letter | what it is | shape |
# |---|---|---|
# | $X$, $D$ | exposure, and the step of exposures that are rounded to one level | (P, H, W) |
# | $N$, $R$ | electrons of a pixel at the exposure 1, and read noise in electrons | |
# | $t$ | exposure times, s | (P,) |
# | $E$, $s$ | radiance, and its standard deviation | (H, W) |
# | $l$ | $\ln$ luminance, `lL` | (H, W) |
# | $I$, $p$, $q$ | guide, picture, and the picture smoothed | (H, W) |
# | $F_D$ | luminance that a display shows, cd/m² | any |
# | $G$ | gain, stops; of a map of gains, $g$ | (H, W, 3) |
# | $S$, $V$ | signal in levels, and variance in levels², of pairs of photographs | (M,) |
# | $h_A$, $h_B$; $T$ | histograms of two photographs; the level in $B$ of each level of $A$ | (n,) |
# | $g$, $w$ | logarithm of each level's exposure, and its weight | (n,) |
# | $F$, $W$ | a photograph from 0 to 1, its channels as planes; its weight | (3, H, W); (H, W) |
#
# Under each task there is a cell `check("...")`: it says, promise by promise, what holds, and draws what
# differs. Inside a task use numpy, scipy and what this sheet gives; hdrlab itself is not there when your
# work is graded.

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
pictures.radiance(room, alt="The room's radiance in false colour")

# %% [markdown] about="variance"
# ## 1 · The noise of one photograph ({points})
#
# A sensor counts photons, which come by chance: of a count the variance is the count itself. At the exposure
# $X$ that is $X N$ electrons. Reading it out adds noise of its own, $R$ electrons whatever the light is, a
# standard deviation. At last the value is rounded to a level: all exposures of a step, $D$ wide, come out as
# one, and the true one lies anywhere in it, with equal chance.
#
# What is the variance $V$ of the exposure $X$? Mind the units: two of the three are given in electrons, and
# $N$ electrons are an exposure of 1. The three know nothing of one another. `X` and `D` are arrays of one
# shape, `N` and `R` numbers, or arrays of that shape; return $V$ in the shape of `X`.

# %% task="variance"
# Return the variance V of the exposure X: of photons, of the amplifier, and of rounding.

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
        across="exposure, stops below full",
        up="signal over noise, stops",
        legend="upper left",
    ),
    alt="Signal over noise: half a stop for each of light where photons are the noise, a whole one below",
)

# %% [markdown] about="inverse_variance_merge"
# ## 2 · The surest mean ({points})
#
# Each photograph answers with a radiance, $x = X / t$, whose variance is
# $V = \operatorname{variance}(X, D, N, R) / t^2$. Of all means, the one in which each answer counts by the
# inverse of its variance errs least ([Granados and others, 2010](https://doi.org/10.1109/CVPR.2010.5540208)),
# and it comes with its own standard deviation:
#
# $$E = \frac{\sum x / V}{\sum 1 / V}, \qquad s = \frac 1 {\sqrt{\sum 1 / V}}.$$
#
# The sums are over the photographs that measure the pixel: `measured` is False where one is clipped, and
# what stands there in `X` and `D` says nothing. One thing is left. A photograph that by chance caught too
# few photons has too small an $X$, so too small a $V$, and would count for too much. The variance ought to
# be that of the light which is there, $E\,t$. But $E$ is what we look for: begin with $X$ in its place, and
# then take $V$ from $E\,t$ and the mean again, twice. More rounds change nothing that a check looks at.
#
# `X`, `D` and `measured` are `(P, H, W)`; return $E$ and $s$, both `(H, W)`. You may call your `variance`.
# The checks give each pixel a photograph that measures it.

# %% task="inverse_variance_merge"
# Return E and s: the mean of X / t, each counted by the inverse of its variance, and its standard deviation.

# %% about="inverse_variance_merge"
green = room[..., 1] / room[..., 1].max()
t, full, R = 4.0 ** np.arange(6) / 2, 20_000, 5
taken = camera.shoot(
    green, t, camera.Camera(response="linear", bits=16, full_well=full, read_noise=R), rng=1
)
g = responses.true_g("linear", 2**16)
X = np.exp(g - g[-1])[taken.images]
E, s = inverse_variance_merge(X, np.full(X.shape, 1 / 65535), X < 0.98, t, full, R)
within = np.abs(E - green) < 1.96 * s
print(f"{np.mean(within[s < np.inf]):.1%} of the pixels that were measured lie within E ± 1.96 s")
pictures.radiance(s / E, alt="s over E in false colour: the shadows are the least sure")

# %% [markdown] about="guided"
# ## 3 · A line in each window: the guided filter ({points})
#
# [He, Sun and Tang (2010, 2013)](https://doi.org/10.1109/TPAMI.2012.213) smooth a picture $p$ and keep the
# edges of a guide $I$, often the same picture. In each square window of $2 \cdot$ `radius` $+\, 1$ pixels a
# side let $p$ be a line of $I$, as near as it can be while the slope stays small:
#
# $$a = \frac{\operatorname{cov}(I, p)}{\operatorname{var}(I) + \epsilon}, \qquad
#   b = \operatorname{mean}(p) - a \operatorname{mean}(I),$$
#
# with mean, variance and covariance over the pixels of the window (divided by their number), and $\epsilon$
# (`epsilon`, above 0) the variance from which on something is an edge. Each pixel lies in as many windows as
# a window has pixels; it takes the mean of their lines:
#
# $$q = \operatorname{mean}(a)\, I + \operatorname{mean}(b).$$
#
# Where no `p` is given, $p = I$. What stands past the edge of the picture is yours to choose, and the checks
# look at pixels further than $2 \cdot$ `radius` from it.

# %% task="guided"
# Return q = mean(a) I + mean(b), means over all windows that hold the pixel.

# %% about="guided"
l = np.log(L)
base = guided(l, radius=8, epsilon=0.8)
detail = l - base
high = np.quantile(base, 0.99)
Ld = np.clip(np.exp(0.45 * (base - high) + detail), 0, 1)
pictures.picture(
    colour.to_8bit(colour.recolour(room, L, Ld)),
    alt="The room with its base compressed, details kept",
)

# %% [markdown] about="remap"
# ## 4 · Detail or edge? The local Laplacian's question ({points})
#
# [Paris, Hasinoff and Kautz (2011)](https://doi.org/10.1145/1964921.1964963) have no base. For each
# coefficient of a Laplacian pyramid they look at the brightness $g$ of its place, and ask of the picture
# around it: what differs from $g$ by less than $\sigma$ is detail, the rest is an edge. With
# $d = |l - g|$ the picture is remapped,
#
# $$r = \begin{cases} g \pm \sigma\, (d / \sigma)^\alpha & d \le \sigma \\
#   g \pm \bigl(\sigma + \beta\, (d - \sigma)\bigr) & d > \sigma \end{cases}$$
#
# with + where $l$ is above $g$, and - where it is below. $\alpha$ below 1 makes details grow; $\beta$ is
# what is left of edges. ($l$ and the number $g$ are nats; $\sigma$ is `sigma` and $\alpha$ `alpha`, both
# above 0; $\beta$ is `beta`.)

# %% task="remap"
# Return r, for log luminance lL (H, W) about the brightness g.

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
# ## 5 · A code for a brighter screen: PQ ({points})
#
# A gamma was made for displays of 100 cd/m². The perceptual quantiser of SMPTE ST 2084
# ([ITU-R BT.2100](https://www.itu.int/rec/R-REC-BT.2100)) has a code for every luminance $F_D$ up to
# 10,000 cd/m², in steps about as large as an eye just does not see:
#
# $$v = \Bigl(\frac{c_1 + c_2\, Y^{m_1}}{1 + c_3\, Y^{m_1}}\Bigr)^{m_2}, \qquad Y = \frac{F_D}{10{,}000},$$
#
# $$m_1 = \frac{2610}{16384}, \quad m_2 = 128 \cdot \frac{2523}{4096}, \quad c_1 = \frac{3424}{4096}, \quad
#   c_2 = 32 \cdot \frac{2413}{4096}, \quad c_3 = 32 \cdot \frac{2392}{4096}.$$
#
# $F_D$ is an array of any shape, 0 to 10,000; $v$ has the same shape, 0 to 1.

# %% task="pq"
# Return the signal v, 0 to 1, of luminance FD, 0 to 10,000 cd/m2.

# %% about="pq"
light = np.logspace(-2, 4, 201)
signals = {"PQ": pq(light), "gamma 2.4": (light / 10_000) ** (1 / 2.4)}
pictures.picture(
    curves.lines(np.log10(light), signals, across="log10 of the luminance, cd/m²", up="v"),
    alt="The signal over the logarithm of luminance: PQ is nearly a line, gamma leaves the dark no codes",
)

# %% [markdown] about="gain_map"
# ## 6 · One picture for every screen: the gain map ({points})
#
# A photograph does not know its screen. So ISO 21496-1 (2025) keeps two: a picture for any screen, `sdr`,
# which an operator made, and a map of how much brighter the scene, `hdr`, ought to be. Both are light, and
# 1 is the screen's white; `hdr` goes on beyond it. The gain is counted in stops,
#
# $$G = \log_2 \frac{\text{hdr} + k_\text{hdr}}{\text{sdr} + k_\text{sdr}},$$
#
# with small offsets `k` $= (k_\text{sdr}, k_\text{hdr})$, so that black has a gain. The map says where a gain
# lies between the least and the largest that it can tell, `low` and `high`:
#
# $$g = \Bigl(\frac{G - \text{low}}{\text{high} - \text{low}}\Bigr)^\gamma,$$
#
# the quotient clipped to 0 ... 1 before it is raised to $\gamma$ = `gamma`, which is above 0.
#
# (`sdr`, `hdr` and $g$ have one shape, (H, W, 3) or another. `low` and `high` are numbers, or one for each
# channel, (3,). Where an offset is 0, no check asks for black.)

# %% task="gain_map"
# Return g, 0 to 1, for the picture sdr and the scene hdr.

# %% about="gain_map"
sdr = np.clip(0.18 * room / np.exp(np.mean(np.log(L))), 0, None)
hdr, sdr = np.minimum(sdr, 8), sdr / (1 + sdr)
g = gain_map(sdr, hdr, 0.0, 3.2)
pictures.picture(
    colour.to_8bit(g), alt="The gain map: bright in the window, the lamp and where sun falls"
)

# %% [markdown] about="apply_gain"
# ## 7 · What a brighter screen shows ({points})
#
# Who reads the map goes the way back. From $g$ comes the gain,
#
# $$G = \text{low} + (\text{high} - \text{low})\, g^{1 / \gamma}.$$
#
# A screen whose brightest light is as far above white as the map reaches takes all of it; another takes the
# part $W$ of its stops, 0 to 1, and shows
#
# $$(\text{sdr} + k_\text{sdr})\; 2^{W G} - k_\text{hdr}.$$
#
# ($W$ is a number. `low`, `high` and `gamma` are numbers, or one for each channel, (3,); what is shown has
# the shape of `sdr`.)

# %% task="apply_gain"
# Return the light, 1 = white, that a screen shows which takes the part W of the gain.

# %% about="gain_map apply_gain"
shown = [
    apply_gain(sdr, np.rint(255 * g) / 255, 0.0, 3.2, W=W) / 8**W for W in (0, 1 / 3, 2 / 3, 1)
]
pictures.picture(
    colour.to_8bit(np.clip(np.hstack(shown), 0, 1)),
    alt="The room on screens of 1, 2, 4 and 8 times white: the larger, the more is to be seen in the window",
)

# %% [markdown] about="line"
# ## 8 · Photon transfer: a sensor's gain out of its noise ({points})
#
# Of an even wall pairs of photographs were taken, with more light from pair to pair; the first pair is
# dark, with the lens cap on. $S$ is each pair's signal, in levels above the dark ($S_0 = 0$), and $V$ the
# variance of its noise, in levels². Photons come by chance: of $N$ electrons the variance is $N$. With
# $K$ electrons a level,
#
# $$V - V_0 = \frac{S}{K},$$
#
# a straight line through the dark pair, which is taken for exact. Measured in so many pixels, a variance
# errs in proportion to itself, so each pair counts by $w = 1 / V^2$. The slope that makes $\sum w\,(V -
# V_0 - S / K)^2$ smallest is
#
# $$\frac{1}{K} = \frac{\sum w\, S\, (V - V_0)}{\sum w\, S^2}.$$
#
# ($S$ and $V$ are arrays (M,), with $V$ above 0. The answer is a number, $1 / K$.)

# %% task="line"
# Return the slope 1 / K of V - V[0] = S / K, by least squares with the weights 1 / V^2.

# %% about="line"
signal = np.array([0, 200, 400, 800, 1200, 1600, 2400, 3000.0])
noise = np.array([4.0, 104, 210, 398, 612, 801, 1230, 1690])
fitted = noise[0] + line(signal, noise) * signal
pictures.picture(
    curves.lines(signal, {"measured": noise, "line": fitted}, across="S, levels", up="V, levels²"),
    alt="Variance over signal: the line from the dark pair on passes below the brightest, which errs most",
)

# %% [markdown] about="brightness_transfer"
# ## 9 · Two histograms instead of two aligned photographs ({points})
#
# The $k$-th darkest pixel of a photograph $A$ is the $k$-th darkest of $B$, whatever the camera's
# response, if both show the same scene [(Grossberg and Nayar,
# 2003)](https://doi.org/10.1109/TPAMI.2003.1240119). So histograms alone say which level $T(m)$ of $B$
# belongs to level $m$ of $A$, and nothing has to be aligned.
#
# A level is a step: level $z$ reaches from $z - \frac{1}{2}$ to $z + \frac{1}{2}$, and its pixels are
# spread evenly over it. Let $H(z)$ be the share of the pixels below level $z$, with $H(0) = 0$ and $H(n)
# = 1$: it belongs to the edge at $z - \frac{1}{2}$. The middle of $A$'s level $m$ has the rank
# $\frac{1}{2}\bigl(H_A(m) + H_A(m + 1)\bigr)$, and $T(m)$ is the place where $H_B$, on straight lines
# between the edges, reaches that rank.
#
# The lowest level of $B$ holds all that is darker, and the highest all that is brighter. So $T(m)$ is NaN
# where it falls on one of them: below $\frac{1}{2}$ or above $n - \frac{3}{2}$.
#
# (`h_A` and `h_B` (n,) are counts of pixels; their sums may differ. $T$ (n,) is not rounded. Where $B$ has
# empty levels, $H_B$ may have one rank along a stretch; any place of it will do, and no check asks.)

# %% task="brightness_transfer"
# Return T (n,), the level in B of what has level m in A, NaN where B's outer levels hold it.

# %% about="brightness_transfer"
exposures = [t * L / np.quantile(L, 0.95) for t in (0.25, 1.0)]
taken = [np.round(255 * np.clip(X, 0, 1) ** (1 / 2.2)).astype(int) for X in exposures]
T = brightness_transfer(*(np.bincount(Z.ravel(), minlength=256) for Z in taken))
inside = np.flatnonzero(np.isfinite(T))
pictures.picture(
    curves.lines(inside, {"T": T[inside], "m": inside}, across="m, level in A", up="level in B"),
    alt="T over m: above the diagonal, rising to the top of B at a bit more than half of A's levels",
)

# %% [markdown] about="snr"
# ## 10 · How sure is a level? The signal over its noise ({points})
#
# Let the noise in a photograph's levels have one size everywhere. Through the response $f = e^{g}$ it
# enters the exposure by the slope $f'$, so the signal over the noise [(Mitsunaga and Nayar,
# 1999)](https://doi.org/10.1109/CVPR.1999.786966) is
#
# $$w(z) = \frac{f(z)}{f'(z)}.$$
#
# - $f'(z)$ is the slope between the levels $z - s$ and $z + s$ with $s$ = `span`; where one of them is
#   past an end of the range, the end takes its place.
# - Where the curve is level the quotient would have no bound: a slope counts at least `least` times the
#   mean slope, $\bigl(f(n - 1) - f(0)\bigr) / (n - 1)$.
# - The lowest and the highest level are bounds: $w = 0$ there.
#
# (`g` (n,) rises, $n$ is even. The scale of $w$ (n,) is free.)

# %% task="snr"
# Return w = f / f' (n,), f = exp g, and 0 at both ends.

# %% about="snr"
levels = np.arange(256)
sure = {f"gamma {gamma}": snr(gamma * np.log((levels + 0.5) / 256)) for gamma in (1.0, 1.8, 2.6)}
pictures.picture(
    curves.lines(levels, sure, across="z, level", up="w"),
    alt="w over the level: for each gamma nearly a line, the steeper the smaller gamma, 0 at both ends",
)

# %% [markdown] about="weight"
# ## 11 · What a good pixel is: the weights of exposure fusion ({points})
#
# [Mertens, Kautz and Van Reeth (2007)](https://doi.org/10.1109/PG.2007.17) make no radiance map. They
# blend the photographs themselves, by three measures of each pixel; $F$ is a photograph from 0 to 1, its
# channels R, G and B as planes:
#
# - **contrast** $C = |Y_\text{up} + Y_\text{down} + Y_\text{left} + Y_\text{right} - 4\, Y|$, with the
#   gray picture $Y = 0.299 R + 0.587 G + 0.114 B$;
# - **saturation** $S$, the standard deviation of R, G and B, the mean of the squares being their sum over 3;
# - **exposedness** $E = \prod_{R, G, B} \exp\bigl(-(F - 0.5)^2 / (2 \cdot 0.2^2)\bigr)$.
#
# A pixel is to be good in all three: $W = C^{a}\, S^{b}\, E^{c}$, with `powers` $= (a, b, c)$, of which
# none is negative, and $x^0 = 1$.
#
# ($F$ is (3, H, W), $W$ is (H, W). What stands past the edge of the picture is yours to choose, and so is
# a trace of weight in all pixels, up to 1e-9; the checks look at pixels that do not touch the edge.)

# %% task="weight"
# Return W = C^a S^b E^c (H, W) of a photograph F (3, H, W) from 0 to 1.

# %% about="weight"
F = np.moveaxis(np.clip(room / np.quantile(L, 0.9), 0, 1) ** (1 / 2.2), -1, 0).astype(np.float32)
W = weight(F)
pictures.picture(
    colour.to_8bit(np.clip(W / np.quantile(W, 0.99), 0, 1)),
    alt="The weight of the room's photograph: bright at edges of coloured things, black where it is clipped",
)

# %% [markdown] about="optimum"
# ## 12 · What a meter asks for ({points})
#
# A picture taken at the exposure value $\mathrm{EV}_\text{pre}$ has the reading $B_\text{pre}$, a
# brightness above 0, up to 1; it should be $B_\text{opt}$, by default 0.18. The exposure value that brings it
# there, in stops, of which one more halves the light, is (Battiato and others, 2008, equation 1.2)
#
# $$\mathrm{EV}_\text{opt} = \mathrm{EV}_\text{pre} + \log_2 B_\text{pre} - \log_2 B_\text{opt}.$$

# %% task="optimum"
# Return EV_opt of numbers EV_pre, B_pre and B_opt.

# %% [markdown] about="spot"
# ## 13 · Whom does a spot meter ask? ({points})
#
# It weights the pixels of a disc alike, and no others; all weights add up to 1. The middle of the disc is
# `at`, how far down and how far right in parts of the picture (H, W): at row `at[0]` $H$ and column
# `at[1]` $W$, where the pixel $(y, x)$ has its middle at $(y + \frac{1}{2}, x + \frac{1}{2})$. The disc
# is made of the `share` $\cdot H W$ pixels, rounded (a half either way), and at least one, whose middles
# are nearest to it, measured in pixels. A share of 0.12 makes a partial meter of it, and 1 an average
# one, which asks all alike.
#
# (`shape` is (H, W), and the answer $w$ (H, W). The checks ask for no two pixels that are equally near.)

# %% task="spot"
# Return the weights w (H, W) of a disc of the nearest pixels, whose sum is 1.

# %% about="spot"
pictures.picture(
    colour.to_8bit(
        np.clip(L / np.quantile(L, 0.95), 0, 1) * (0.3 + 0.7 * (spot(L.shape, at=(0.6, 0.5)) > 0))
    ),
    alt="The room, dark but for a disc at the lower half of the window",
)

# %% [markdown] about="centre"
# ## 14 · A meter that asks all, and the middle most ({points})
#
# A centre-weighted meter has no rim. A pixel's weight is a Gaussian, $\exp\bigl(-d^2 / (2 \sigma^2)\bigr)$,
# of its distance $d$ from the middle `at`, measured in parts of the picture: in heights down, in widths to
# the right, $d^2 = (\Delta y / H)^2 + (\Delta x / W)^2$. All weights add up to 1. And $\sigma$ is the one
# with which the part `inside` of all the weight lies on the pixels that a spot meter of this `share` and
# `at` asks.
#
# (`shape` is (H, W), and `inside` is larger than `share`. You may call your `spot`.)

# %% task="centre"
# Return w (H, W), a Gaussian about `at` whose sum is 1: `inside` of it lies on the pixels of a spot.

# %% about="centre"
pictures.picture(
    colour.to_8bit(
        np.clip(L / np.quantile(L, 0.95), 0, 1) * centre(L.shape) / centre(L.shape).max()
    ),
    alt="The room, which becomes darker and darker from the middle to the edges of the picture",
)

# %% [markdown] about="flat"
# ## 15 · Is that patch flat? Ask chi-square ({points})
#
# Whoever calibrates with pixels takes those on even surfaces ([Mitsunaga and Nayar,
# 1999](https://doi.org/10.1109/CVPR.1999.786966)). `A` (t, H, W) are $t$ frames of one exposure, where 1 is
# full. Take the average of the frames, and in it the patch of $s$ = `size`$^2$ pixels around each pixel
# (`size` is odd). On an even surface its variance $\sigma_s^2$ (the mean of the squares, divided by $s$) is
# that of noise alone.
#
# - Of **one frame** the noise is known, $\sigma$ = `sigma`. Then $s\,\sigma_s^2 / \sigma^2$ is chi-square
#   with $s - 1$ degrees of freedom: the patch is flat if it is at most $\chi^2_{s-1}(\psi)$, which noise
#   exceeds by chance in the part $\psi$ = `psi` of all flat patches: `scipy.stats.chi2.isf(psi, s - 1)`.
# - Of **more frames** the noise is seen, and `sigma` has no say. A pixel's variance over the frames,
#   divided by $t - 1$, is that of one frame; its mean over the patch is $\sigma_t^2$. The average of $t$
#   frames has $\sigma_t^2 / t$. And as that is an estimate of $s\,(t - 1)$ degrees of freedom, the limit is
#   another: flat is where
#
# $$\frac{s\,\sigma_s^2}{\sigma_t^2 / t} \le (s - 1)\, F_{s-1,\; s(t-1)}(\psi),$$
#
#   `scipy.stats.f.isf(psi, s - 1, s * (t - 1))`.
#
# Where a patch is cut by the edge of the picture, within `size // 2` pixels of it, nothing is flat. Return
# a mask (H, W), of bool, or 0 and 1.

# %% task="flat"
# Return where the patch around a pixel is flat, (H, W), of frames A (t, H, W).

# %% about="flat"
frames = np.clip(L / np.quantile(L, 0.95), 0, 1) + np.random.default_rng(8).normal(
    0, 0.01, (4, *L.shape)
)
pictures.picture(
    colour.to_8bit(flat(frames).astype(float)),
    alt="White on most of the walls; black along edges, on most of the floor, and at the picture's rim",
)

# %% [markdown] about="solve_by_svd"
# ## 16 · Least squares by the SVD ({points})
#
# Debevec and Malik's system $A x = b$ has more rows than unknowns; and if the row $g(n/2) = 0$ is left out,
# not one answer but many, for a number that is added to all $g$ and all $\ln E$ changes no other row. The
# singular value decomposition $A = U \Sigma V^\top$ finds among all $x$ of the smallest $\sum (A x - b)^2$
# the shortest one:
#
# $$x = \sum_{\sigma_i > \text{rtol}\, \sigma_1} \frac{u_i^\top b}{\sigma_i}\, v_i,$$
#
# with the columns $u_i$ of $U$ and $v_i$ of $V$, and $\sigma_1$ the largest singular value. What is at most
# `rtol` times as large is taken for 0, and its term left out. (`A` is (m, k), with $m \ge k$, `b` (m,) and
# `x` (k,).)

# %% task="solve_by_svd"
# Return the shortest x (k,) that minimises |A x - b|, by the SVD of A.

# %% about="solve_by_svd"
chain = np.array(
    [[1.0, -1, 0], [0, 1, -1], [1, 0, -1]]
)  # differences of three numbers, and no number
print(
    solve_by_svd(chain, np.array([1.0, 1, 2])),
    "as the differences say: 1, 1 and 2; their mean is 0",
)

# %% [markdown]
# ## The whole sheet

# %%
check("hw5")
