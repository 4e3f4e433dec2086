# %% [markdown]
# # Homework 4 · Tone mapping
#
# Due {due}. {total} points. {late}
#
# The map holds the light of the scene, over a factor of a million; the screen shows a factor of a few
# hundred. Five papers, five answers: a curve for all pixels, a layer for the light, a histogram that may
# not exaggerate, a scale that varies slowly, and gradients that are flattened.
#
# {choice} Reinhard's curve is where everybody begins. Of the four papers after it, take those whose pictures
# you like: Durand with Ward is enough, Chiu with Fattal is, and so are three. A half of one counts, too.
#
# | letter | what it is | shape |
# |---|---|---|
# | $L$ | luminance, any linear unit | (H, W) |
# | $L_m$ | luminance scaled to the key | (H, W) |
# | $L_d$ | display luminance, 1 is white | (H, W) |
#
# Under each task there is a cell `check("...")`: it says, promise by promise, what holds, and draws what
# differs. Inside a task use numpy, scipy and what this sheet gives; hdrlab itself is not there when your
# work is graded. Where a sheet says yield, a list will do, and a plain tuple for a state.

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
pictures.radiance(room, alt="The room's radiance in false colour")

# %% [markdown] about="log_average"
# ## 1 · Reinhard: how bright is the scene? ({points})
#
# The mean would be that of the window alone. A photographer thinks in stops, so the mean is taken of
# logarithms:
#
# $$\bar L = \exp\Bigl(\frac 1 N \sum \ln(\delta + L)\Bigr).$$
#
# A small $\delta$ stands for black pixels. So that the unit of $L$ cancels, `delta` is given in medians of
# $L$: $\delta$ is `delta` times the median of what is not black. Return a number.

# %% task="log_average"
# Return Lav = exp(mean(log(delta + L))), delta in medians of L.

# %% [markdown] about="display"
# ## 2 · Reinhard: the curve ({points})
#
# With $L_m = a L / \bar L$, each pixel is held back by what the eye has adapted to, and what is brighter
# than `white` becomes white:
#
# $$L_d = \frac{L_m\,(1 + L_m / L_{white}^2)}{1 + \text{adaptation}}, \qquad\text{at most } 1.$$
#
# With $L_m$ itself as the adaptation this is the global operator. An infinite `white` is allowed, and
# leaves the bracket at 1.

# %% task="display"
# Return Ld = Lm (1 + Lm / white^2) / (1 + adaptation), clipped at 1.

# %% about="display log_average"
Lm = 0.18 * L / log_average(L)
Ld = display(Lm, Lm, 20.0)
pictures.picture(
    colour.to_8bit(colour.recolour(room, L, Ld)),
    alt="The room by the global operator: inside and outside",
)

# %% [markdown] about="scale_steps"
# ## 3 · Reinhard: dodge and burn ({points})
#
# A photographer holds back a region by its own surroundings, the largest that is still even. `blurred`
# gives $V_1(s)$, $L_m$ blurred at widths $s = 1, 1.6, 1.6^2, \ldots$ At each width, with the next one as
# the surround $V_2$,
#
# $$V(s) = \frac{V_1(s) - V_2(s)}{2^\phi a / s^2 + V_1(s)}, \qquad V_2(s) = V_1(1.6\, s).$$
#
# A pixel is even as long as $|V| < \varepsilon$ (`threshold`) at this width *and at all smaller ones*; its
# adaptation is $V_1$ at the largest width that is still even, at the smallest where none is. $a$ is `key`.
# From nine blurred pictures come eight states. Yield for each width: the width $s$, $V_1$, $V$, the mask of
# what is still even, and the adaptation so far. (Some programs use the loop's index where $s$ belongs.
# Do not.)

# %% task="scale_steps"
# Yield (s, V1, V, even, adaptation) of each width, from small to large, given V1 at every width.

# %% [markdown] about="layers"
# ## 4 · Durand and Dorsey: light and paint ({points})
#
# Light varies over decades and slowly; what things are painted with varies little and fast. A bilateral
# filter of $\log_{10} L$ keeps the edges of the light: `base`. What is left is `detail` $= \log_{10} L - $
# `base`; Battiato and others (2008) print this sign reversed.
#
# $$\text{base}(p) = \frac{\sum_q G_{\sigma_s}(p - q)\; G_{\sigma_r}\bigl(l(p) - l(q)\bigr)\; l(q)}
#   {\sum_q G_{\sigma_s}(p - q)\; G_{\sigma_r}\bigl(l(p) - l(q)\bigr)}, \qquad l = \log_{10} L.$$
#
# Sums written out are exact and good enough: a loop over the offsets within $2\sigma_s$ or $3\sigma_s$, in a
# square or a disc, all pixels at once. Past the edge there are no pixels, or mirrored ones.

# %% task="layers"
# Return base = bil(lL) and detail = lL - base.

# %% [markdown] about="compress"
# ## 5 · Durand and Dorsey: compress the light ({points})
#
# The base spans from `low` to `high` decades. It shall span `contrast` on the screen, and its bright end
# shall stay where it is: $m\,(\text{base} - \text{high})$ with $m = \log_{10}(\text{contrast}) /
# (\text{high} - \text{low})$. No scene is stretched: $m \le 1$.

# %% task="compress"
# Return m (base - high), m = c / (high - low), c = log10(contrast), m at most 1.

# %% about="compress layers"
lL = np.log10(L).astype(np.float32)
base, detail = layers(lL, sigma_s=6.0)
low, high = np.quantile(base, [0.01, 0.99])
Ld = np.clip(10 ** (compress(base, low, high) + detail), 0, 1)
pictures.picture(
    colour.to_8bit(colour.recolour(room, L, Ld)),
    alt="The room with its light compressed, details kept",
)

# %% [markdown] about="fix_uncertain"
# ## 6 · Durand and Dorsey: uncertain pixels ({points})
#
# The sum below the fraction, $k(p)$, says how many pixels the mean at $p$ rests on. A pixel unlike all
# around it rests on itself alone, is its own base, and keeps no detail. There the paper takes another base,
# and this is ours: the mean, blurred by a Gaussian of $\sigma = 2$ pixels. How certain a base is rises with
# the logarithm of $k$, from 0 at one pixel to 1 at the root of all,
#
# $$u = \frac{\ln k}{\ln \sqrt{2 \pi \sigma_s^2}}, \text{ at least 0 and at most 1}, \qquad
#   \text{base} = u\, \text{mean} + (1 - u)\, \mathrm{blur}(\text{mean}).$$
#
# (`mean` and `k` are (H, W), $k$ is above 0, and $\sigma_s$ at least 1. What the blur meets past the edge
# is yours to choose: the checks look at pixels ten or more from it.)

# %% task="fix_uncertain"
# Return u mean + (1 - u) blur(mean), (H, W): the certainty u rises with ln k.

# %% [markdown] about="adjust_steps"
# ## 7 · Ward: a histogram that may not exaggerate ({points})
#
# Equalising the histogram $h$ of ln luminance gives each brightness its share of the display, and
# exaggerates the contrast of those that fill the picture. A ceiling keeps every slope at or below 1: with
# $T = \sum h$, bins $\Delta b$ wide (`db`) and a display of range $D$,
#
# $$h(b) \le \frac{T\, \Delta b}{D}.$$
#
# Cut $h$ there. That lowers $T$, and so the next ceiling: again, until what was trimmed is less than
# `tolerance` of the $T$ before the trim, or no more than `tolerance` of the first $T$ is left. The
# trimmings go nowhere. Yield the histogram as it is, and after every trim: $h$, the ceiling, that $T$, and
# the trimmings (infinite ceiling and trimmings at first).

# %% task="adjust_steps"
# Yield (h, ceiling, T, trimmings): the histogram as it is, and after every trim.

# %% [markdown] about="scale"
# ## 8 · Chiu: a scale that varies slowly ({points})
#
# The eye does not mind a scale that varies slowly: $s = 1 / (k\, \mathrm{blur}(L))$ with a Gaussian blur,
# so that a pixel $k$ times as bright as its neighbourhood becomes white ($k$ is `headroom`). Where a
# further factor $L$ is printed, as in Battiato and others (2008), it is a misprint. `sigma` is in pixels; the
# checks always give it. What stands past the edge is yours to choose.

# %% task="scale"
# Return s = 1 / (k blur(L)).

# %% about="scale"
Ld = np.clip(scale(L, sigma=20.0) * L, 0, 1)
pictures.picture(
    colour.to_8bit(colour.recolour(room, L, Ld)),
    alt="The room by a slow scale: dark clouds around the window",
)

# %% [markdown] about="attenuation_steps"
# ## 9 · Fattal: flatten what is steep ({points})
#
# Large contrasts have steep slopes somewhere in the pyramid of $l = \ln L$. Level $k$ has half the size of
# level $k - 1$ (blur, then every second pixel; sides rounded up), as long as neither side falls below 32.
# Slopes are central differences over $2^{k+1}$ pixels of the picture, edges mirrored; where the slope is
# $\alpha$ times the level's mean slope it stays:
#
# $$\varphi_k = \Bigl(\frac{|\nabla l_k|}{\alpha\, \overline{|\nabla l_k|}}\Bigr)^{\beta - 1}, \qquad
#   \Phi_d = \varphi_d, \qquad \Phi_k = \mathrm{enlarged}(\Phi_{k+1})\, \varphi_k.$$
#
# A slope below `noise` times the mean counts as that much. Enlarge by linear interpolation. Which blur, and
# where between the coarse pixels the fine ones lie, is yours to choose. Yield from the
# coarsest level to the picture: $k$, $l_k$, $|\nabla l_k|$, $\varphi_k$, $\Phi_k$.

# %% task="attenuation_steps"
# Yield (k, lL, slope, phi, Phi) of the levels k = d ... 0: Phi_d = phi_d, Phi_k = enlarged(Phi_(k+1)) phi_k.

# %% [markdown] about="divergence"
# ## 10 · Fattal: the divergence ({points})
#
# A gradient field $G = (G_y, G_x)$, `(2, H, W)`, holds forward differences: $G_y(y, x)$ is the step from
# row $y$ to row $y + 1$. Its divergence takes *backward* differences, so that the two together are the
# Laplacian:
#
# $$\operatorname{div} G(y, x) = G_y(y, x) - G_y(y - 1, x) + G_x(y, x) - G_x(y, x - 1).$$
#
# Nothing flows through the edges: steps across them are 0, whatever the last row of $G_y$ and the last
# column of $G_x$ hold.

# %% task="divergence"

# %% [markdown] about="solve"
# ## 11 · Fattal: the picture with these gradients ({points})
#
# No picture has exactly the gradients that were asked for. The nearest one solves
# $\nabla^2 u = \operatorname{div} G$, with nothing flowing through the edges. In cosines the Laplacian is a
# factor: `scipy.fft.dctn(divG, type=2)`, divide the coefficient $(i, j)$ by
#
# $$2\cos\frac{\pi i}{H} - 2 + 2\cos\frac{\pi j}{W} - 2,$$
#
# and back with `idctn`. The coefficient $(0, 0)$ is the mean: set it to 0. A sparse solver will do as well.

# %% task="solve"
# Return the u of mean 0 whose Laplacian is div G.

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
    shown, alt="The room with its steep gradients flattened: window, walls and dark corner at once"
)

# %% [markdown]
# ## The whole sheet

# %%
check("hw4")
