# %% [markdown]
# # Homework 5 · Methods since 2010
#
# Due {due}. {total} points. {late}
#
# Four answers that are younger than the slides: a radiance map that knows how sure it is, a base layer made
# of lines instead of neighbours, contrast lowered scale by scale with no base at all, and a code for displays
# that are brighter than paper. You write the heart of each.
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
each = {"photons alone": light / np.sqrt(variance(light, 0 * light, full, 0)), "all": light / np.sqrt(whole)}
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
t = 4.0 ** np.arange(6) / 2
taken = camera.shoot(green, t, camera.Camera(response="linear", bits=16, full_well=full, read_noise=R), rng=1)
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
    colour.to_8bit(colour.recolour(room, L, Ld)), alt="The room with its base compressed, details kept"
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
remapped = {f"alpha = {alpha}": remap(i, -4.0, sigma=1.0, alpha=alpha, beta=0.2)[0] for alpha in (0.5, 1, 2)}
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

# %% [markdown]
# ## The whole sheet

# %%
check("hw5")
