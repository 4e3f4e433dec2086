# %% [markdown]
# # Homework 5 · Tone mapping since 2010
#
# Due {due}. {total} points. {late}
#
# Three answers that are younger than the slides: a base layer made of lines instead of neighbours, contrast
# lowered scale by scale with no base at all, and a code for displays that are brighter than paper. You
# write the heart of each.
#
# | letter | what it is | shape |
# |---|---|---|
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

# %% [markdown] about="guided"
# ## 1 · A line in each window: the guided filter ({points})
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
# ## 2 · Detail or edge? The local Laplacian's question ({points})
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
# ## 3 · A code for a brighter screen: PQ ({points})
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
