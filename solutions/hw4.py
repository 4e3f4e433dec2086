# %% [markdown]
# # Homework 4 · Tone mapping
#
# Due {due}. {total} points. {late}
#
# The radiance map of a room covers a factor of some 400,000, but a screen only shows a factor of a
# few hundred. Five papers give five answers: one curve for all pixels, a base layer that holds the
# illumination, a histogram with limited contrast, a scale that varies slowly, and attenuated
# gradients.
#
# {choice} Everybody begins with Reinhard's curve. Then choose from the other four papers, for
# example those whose images you like best. Durand with Ward is enough, so is Chiu with Fattal, and
# so are any three. You also get the points of single tasks of a paper.
#
# | symbol | meaning | shape |
# |---|---|---|
# | $L$ | luminance, in any linear unit | (H, W) |
# | $L_m$ | luminance scaled to the key | (H, W) |
# | $L_d$ | display luminance, 1 is white | (H, W) |
#
# Under each task there is a cell `check("...")`. It shows which checks pass and draws what differs.
# Inside a task, use NumPy, SciPy and what this assignment gives you: hdrlab cannot be imported when
# your work is graded. If a task says *yield*, you may also return a list, and a state may be a
# plain tuple.

# %%
import numpy as np

from hdrlab import scenes
from hdrlab.core import colour
from hdrlab.course.notebook import check, use_plan
from hdrlab.show import pictures

use_plan("hw4")

# %% [markdown]
# ## The scene

# %%
room = scenes.room((240, 320))
L = colour.luminance(room)
pictures.radiance(room, alt="The radiance of the room in false color")

# %% [markdown] about="log_average"
# ## 1 · Reinhard: how bright is the scene? ({points})
#
# The arithmetic mean would be dominated by the window. A photographer thinks in stops, so take the
# mean of the logarithms (the *log-average luminance*):
#
# $$\bar L = \exp\Bigl(\frac 1 N \sum \ln(\delta + L)\Bigr).$$
#
# The sum is over all $N$ pixels. A small $\delta$ keeps the logarithm of black pixels finite.
# `delta` is given in medians of $L$, so that the unit of $L$ cancels: $\delta$ is `delta` times
# the median of all pixels that are not black. Return a number.

# %% task="log_average"
# Return Lav = exp(mean(log(delta + L))), delta in medians of L.

# %% [markdown] about="display"
# ## 2 · Reinhard: the curve ({points})
#
# With $L_m = a L / \bar L$, each pixel is divided by 1 plus the luminance that the eye has adapted
# to:
#
# $$L_d = \frac{L_m\,(1 + L_m / L_{white}^2)}{1 + \text{adaptation}}, \qquad\text{at most } 1.$$
#
# If the adaptation is $L_m$ itself, this is the global operator, and everything brighter than
# $L_{white}$ (`white`) becomes white. In a brighter neighborhood, it may stay below 1. `white` may
# be infinite; then the bracket equals 1.

# %% task="display"
# Return Ld = Lm (1 + Lm / white^2) / (1 + adaptation), clipped at 1.

# %% about="display log_average"
Lm = 0.18 * L / log_average(L)
Ld = display(Lm, Lm, 20.0)
pictures.picture(
    colour.to_8bit(colour.recolour(room, L, Ld)),
    alt="The room, tone-mapped with the global operator: both inside and outside are visible",
)

# %% [markdown] about="scale_steps"
# ## 3 · Reinhard: dodging and burning ({points})
#
# In the darkroom, a photographer exposes each region of the print according to its surroundings.
# Here these are the largest neighborhood that is still even. `blurred` contains $V_1(s)$, which is
# $L_m$ blurred at the widths $s = 1, 1.6, 1.6^2, \ldots$ At each width $s$, the image blurred at
# the next width is the surround $V_2$:
#
# $$V(s) = \frac{V_1(s) - V_2(s)}{2^\phi a / s^2 + V_1(s)}, \qquad V_2(s) = V_1(1.6\, s).$$
#
# A neighborhood is even while $|V| < \varepsilon$ (`threshold`) at this width *and at all smaller
# ones*. The adaptation of a pixel is $V_1$ at the largest width that is still even, or at the
# smallest width if none is. $a$ is `key`, and $\phi$ is `phi`. Nine blurred images give eight
# states. Yield for each width: the width $s$, $V_1$, $V$, the mask of neighborhoods that are
# still even, and the adaptation so far. (Some programs use the index of the loop instead of $s$.
# That is wrong.)

# %% task="scale_steps"
# Yield (s, V1, V, even, adaptation) for each width, from small to large, given V1 at every width.

# %% [markdown] about="layers"
# ## 4 · Durand and Dorsey: base and detail ({points})
#
# Illumination varies over decades, but slowly. The reflectance of surfaces varies little, but
# quickly. A *bilateral filter* of $\log_{10} L$ smooths the image but keeps the edges of the
# illumination: that is the `base` layer. The rest is the `detail` layer, $\log_{10} L - $ `base`.
# (Battiato and others, 2008, print the opposite sign.) With pixels $p$ and $q$, and a Gaussian $G$
# of their distance and one of the difference of their $l$, whose standard deviations are
# $\sigma_s$ pixels and $\sigma_r$ decades,
#
# $$\text{base}(p) = \frac{\sum_q G_{\sigma_s}(p - q)\; G_{\sigma_r}\bigl(l(p) - l(q)\bigr)\; l(q)}
#   {\sum_q G_{\sigma_s}(p - q)\; G_{\sigma_r}\bigl(l(p) - l(q)\bigr)}, \qquad l = \log_{10} L.$$
#
# You may compute the sums directly: loop over the offsets within $2\sigma_s$ or $3\sigma_s$, in a
# square or a disc, and process all pixels at once. Beyond the edge there are either no pixels or
# mirrored ones.

# %% task="layers"
# Return base = bil(lL) and detail = lL - base.

# %% [markdown] about="compress"
# ## 5 · Durand and Dorsey: compress the base ({points})
#
# The base spans from `low` to `high` decades. On the screen it must span `contrast`, and its bright
# end must become white, 0 decades: $m\,(\text{base} - \text{high})$ with
# $m = \log_{10}(\text{contrast}) / (\text{high} - \text{low})$. Never stretch a scene: $m \le 1$.

# %% task="compress"
# Return m (base - high), m = c / (high - low), c = log10(contrast), m at most 1.

# %% about="compress layers"
lL = np.log10(L).astype(np.float32)
base, detail = layers(lL, sigma_s=6.0)
low, high = np.quantile(base, [0.01, 0.99])
Ld = np.clip(10 ** (compress(base, low, high) + detail), 0, 1)
pictures.picture(
    colour.to_8bit(colour.recolour(room, L, Ld)),
    alt="The room with a compressed base and unchanged details",
)

# %% [markdown] about="fix_uncertain"
# ## 6 · Durand and Dorsey: uncertain pixels ({points})
#
# The sum in the denominator, $k(p)$, says how many pixels contribute to the mean at $p$. A pixel
# that differs from all its neighbors only has itself: it is its own base and keeps no detail. The
# paper uses another base for such pixels. We use `mean`, the base from the filter, blurred by a
# Gaussian of $\sigma = 2$ pixels. The certainty $u$ of a base increases with the logarithm of $k$,
# from 0 at $k = 1$ to 1 where $k$ reaches the square root of the effective number of pixels, $2 \pi
# \sigma_s^2$:
#
# $$u = \frac{\ln k}{\ln \sqrt{2 \pi \sigma_s^2}}, \text{ at least 0 and at most 1}, \qquad
#   \text{base} = u\, \text{mean} + (1 - u)\, \mathrm{blur}(\text{mean}).$$
#
# (`mean` and `k` are (H, W), $k$ is above 0, and $\sigma_s$ is at least 1. How you extend the image
# beyond its edge is up to you: the checks only look at pixels that are ten or more pixels away from
# it.)

# %% task="fix_uncertain"
# Return u mean + (1 - u) blur(mean), (H, W), where the certainty u increases with ln k.

# %% [markdown] about="adjust_steps"
# ## 7 · Ward: a histogram with limited contrast ({points})
#
# Equalizing the histogram $h$ of ln luminance gives each luminance a fraction of the display range
# that is proportional to its number of pixels. That exaggerates the contrast of areas that fill the
# image. A ceiling keeps every slope at or below 1. With $T = \sum h$, bins of width $\Delta b$
# (`db`) and a display of range $D$, both in nats,
#
# $$h(b) \le \frac{T\, \Delta b}{D}.$$
#
# Cut $h$ at the ceiling. That lowers $T$, and with it the next ceiling, so repeat. Stop when a trim
# cuts off less than the fraction `tolerance` of $T$ (taken before that trim), or when at most the
# fraction `tolerance` of the first $T$ is left. Discard what was cut off. Yield $h$, the ceiling,
# the $T$ from which the ceiling was computed, and the trimmed amount: for the original histogram,
# and after every trim. At first, the ceiling and the trimmed amount are infinite.

# %% task="adjust_steps"
# Yield (h, ceiling, T, trimmings): the original histogram, and the histogram after every trim.

# %% [markdown] about="scale"
# ## 8 · Chiu: a scale that varies slowly ({points})
#
# The eye hardly notices a scale that varies slowly: $s = 1 / (k\, \mathrm{blur}(L))$ with a
# Gaussian blur. A pixel $k$ times as bright as its neighborhood becomes white ($k$ is `headroom`).
# Battiato and others (2008) print another factor $L$, which is a misprint. `sigma` is in pixels,
# and the checks always pass it. How you extend the image beyond its edge is up to you.

# %% task="scale"
# Return s = 1 / (k blur(L)).

# %% about="scale"
Ld = np.clip(scale(L, sigma=20.0) * L, 0, 1)
pictures.picture(
    colour.to_8bit(colour.recolour(room, L, Ld)),
    alt="The room, tone-mapped with a slowly varying scale: dark halos around the window",
)

# %% [markdown] about="attenuation_steps"
# ## 9 · Fattal: attenuate steep gradients ({points})
#
# A large contrast has steep gradients at some level of the pyramid of $l = \ln L$. Level $k$ has
# half the size of level $k - 1$ (blur, then take every second pixel; round sides up), as long as
# neither side falls below 32. Gradients are central differences over $2^{k+1}$ pixels of the image,
# with mirrored edges. (A factor that all gradients of a level share cancels. The checks accept any.)
# A gradient of $\alpha$ times the mean gradient of its level stays unchanged, a larger one is
# reduced, and a smaller one is amplified, the more so the smaller $\beta$ is:
#
# $$\varphi_k = \Bigl(\frac{|\nabla l_k|}{\alpha\, \overline{|\nabla l_k|}}\Bigr)^{\beta - 1}, \qquad
#   \Phi_d = \varphi_d, \qquad \Phi_k = \mathrm{enlarged}(\Phi_{k+1})\, \varphi_k.$$
#
# Treat a gradient below `noise` times the mean as that value. Enlarge by linear interpolation.
# Which blur you use, and where the fine pixels lie between the coarse ones, is up to you. Yield
# from the coarsest level to the full image: $k$, $l_k$, $|\nabla l_k|$, $\varphi_k$, $\Phi_k$.

# %% task="attenuation_steps"
# Yield (k, lL, slope, phi, Phi) for k = d ... 0: Phi_d = phi_d, Phi_k = enlarged(Phi_(k+1)) phi_k.

# %% [markdown] about="divergence"
# ## 10 · Fattal: the divergence ({points})
#
# A gradient field $G = (G_y, G_x)$, `(2, H, W)`, contains forward differences: $G_y(y, x)$ is the
# step from row $y$ to row $y + 1$. The divergence takes *backward* differences, so that both
# together give the Laplacian:
#
# $$\operatorname{div} G(y, x) = G_y(y, x) - G_y(y - 1, x) + G_x(y, x) - G_x(y, x - 1).$$
#
# Nothing flows through the edges: steps across them are 0, whatever the last row of $G_y$ and the
# last column of $G_x$ contain.

# %% task="divergence"

# %% [markdown] about="solve"
# ## 11 · Fattal: the image with these gradients ({points})
#
# In general, no image has exactly the attenuated gradients. The closest one solves the *Poisson
# equation* $\nabla^2 u = \operatorname{div} G$, with nothing flowing through the edges. In the cosine
# transform, the Laplacian is a multiplication: compute `scipy.fft.dctn(divG, type=2)`, divide the
# coefficient $(i, j)$ of an image with $H$ rows and $W$ columns by
#
# $$2\cos\frac{\pi i}{H} - 2 + 2\cos\frac{\pi j}{W} - 2,$$
#
# and transform back with `idctn`. The coefficient $(0, 0)$ is the mean: set it to 0. (The checks
# accept any other mean.) You may use a sparse solver instead.

# %% task="solve"
# Return the image u with mean 0 whose Laplacian is div G.

# %% about="solve divergence attenuation_steps"
l = np.log(L).astype(np.float32)
Phi = list(attenuation_steps(l))[-1][-1]
G = np.zeros((2, *l.shape), np.float32)
G[0, :-1], G[1, :, :-1] = (np.diff(l, axis=k) for k in (0, 1))
u = solve(divergence(G * Phi))
low, high = np.quantile(np.exp(u), [0.01, 0.995])
Ld = np.clip((np.exp(u) - low) / (high - low), 0, 1)
shown = colour.to_8bit(colour.recolour(room, L, Ld, saturation=0.6))
pictures.picture(
    shown,
    alt="The room with attenuated gradients: the window, the walls and the dark corner are visible",
)

# %% [markdown]
# ## All checks

# %%
check("hw4")
