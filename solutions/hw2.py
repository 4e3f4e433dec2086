# %% [markdown]
# # Homework 2 · The response curve
#
# Due {due}. {total} points. {late}
#
# A photograph does not hold light. It holds pixel levels, which the camera made from light in a way its
# maker keeps to himself. Three papers give that way back from a few photographs; you write the heart of
# each.
#
# | letter | what it is | shape |
# |---|---|---|
# | $Z_{ij}$ | pixel level, 0 to 255, of sample $i$ in photograph $j$ | (N, P) |
# | $t_j$, $B_j = \ln t_j$ | exposure time in seconds, and its logarithm | (P,) |
# | $E_i$ | irradiance of sample $i$; `lE` $= \ln E_i$ | (N,) |
# | $f$ | the camera's response: $Z = f(E\,t)$ | |
# | $f^{-1}$, `f_inv` | its inverse, the exposure of each level | (256,) |
# | $g = \ln f^{-1}$ | its logarithm | (256,) |
# | $w$ | how far to trust a level | (256,) |
#
# Under each task there is a cell `check("...")`: it says, promise by promise, what holds, and draws what
# differs. Inside a task use numpy, scipy and what this sheet gives; hdrlab itself is not there when your
# work is graded.

# %%
import numpy as np

from hdrlab import scenes
from hdrlab.capture import camera, responses
from hdrlab.core import sampling
from hdrlab.course.notebook import check, use_plan
from hdrlab.show import pictures, plots

use_plan("hw2")

# %% [markdown]
# ## The photographs
#
# Seven photographs of a room, two stops apart, on film; sixty pixels of them are enough to begin with. As
# long as nobody knows the $E_i$, each pixel's levels over $\ln t$ stand for themselves, as if every $E_i$
# were 1.

# %%
room = scenes.room((240, 320))
bracket = camera.shoot(
    room,
    2.0 ** np.arange(-10, 3, 2),
    camera.Camera(sensitivity=1 / 16, full_well=20_000, read_noise=5),
    rng=4,
)
grays = bracket.images[..., 1]
Z, B = sampling.by_grid(grays, 60), np.log(bracket.times)
pictures.picture(
    plots.samples(Z, np.zeros(60), B),
    alt="Levels of sixty pixels over ln time: seven columns of dots",
)

# %% [markdown] about="hat"
# ## 1 · The hat ({points})
#
# Near 0 rounding is as large as the signal, near the top the sensor is full. The hat trusts a level by how
# far it is from both ends: over $n$ levels, $w(z) = z$ below the middle and $n - 1 - z$ above it, scaled to
# about 1 in the middle. What counts is one weight against another, so any scale will do.

# %% task="hat"

# %% [markdown] about="gsolve"
# ## 2 · Debevec and Malik: one system for all ({points})
#
# The camera makes $Z_{ij} = f(E_i t_j)$, hence $g(Z_{ij}) = \ln E_i + B_j$. All $n$ values of $g$ and
# all $N$ of $\ln E_i$ stand in it linearly. Minimise
#
# $$\sum_{i,j} \bigl\{ w(Z_{ij})\,[\,g(Z_{ij}) - \ln E_i - B_j\,] \bigr\}^2
#   + \sum_{z=1}^{n-2} \bigl\{\lambda\, w(z)\,[\,g(z-1) - 2 g(z) + g(z+1)\,] \bigr\}^2.$$
#
# Each term is a row of a matrix $A$ with $n + N$ columns, first $g$, then $\ln E$; one further row says
# $g(n/2) = 0$. That makes $NP + 1 + n - 2$ rows. `np.linalg.lstsq` does the rest; a solver that iterates,
# like `lsqr`, stops far too early by default: give it `atol=btol=1e-12`, `conlim=0` and `iter_lim=50_000`.
# $\lambda$ is called `smoothness`, and $n$ is `len(w)`.

# %% task="gsolve"
# Return g and lE that minimise the sum of squares: the curve, and each sample's ln irradiance.

# %% about="gsolve hat"
found = gsolve(Z, B, 30, hat())
ax = plots.samples(Z, found[1], B, g=found[0])
pictures.picture(
    ax, alt="The sixty pixels' points, moved sideways by their ln E, lie on one rising curve, g"
)

# %% [markdown] about="irradiance"
# ## 3 · Robertson: the best irradiance for a curve ({points})
#
# Robertson, Borman and Stevenson ask for the most probable curve under noise, and alternate. First half:
# were $f^{-1}$ known, each sample's irradiance would be a weighted mean of what its photographs
# say, $f^{-1}(Z_{ij})/t_j$. Long exposures know better, by $t_j^2$, so
#
# $$E_i = \frac{\sum_j w(Z_{ij})\, t_j\, f^{-1}(Z_{ij})}{\sum_j w(Z_{ij})\, t_j^2},$$
#
# and NaN for a sample that no photograph saw well, where this is $0/0$.

# %% task="irradiance"

# %% [markdown] about="update"
# ## 4 · Robertson: the best curve for irradiances ({points})
#
# Second half: were the $E_i$ known, $f^{-1}(m)$ would be the mean exposure of all pixels of level $m$,
#
# $$f^{-1}(m) = \frac{1}{|E_m|}\sum_{(i,j) \in E_m} E_i\, t_j, \qquad E_m = \{(i,j) : Z_{ij} = m\},$$
#
# a plain mean, in which the weights have no say. Samples without irradiance are left out; a level without
# pixels is NaN.

# %% task="update"

# %% [markdown] about="recover_steps"
# ## 5 · Robertson: step by step ({points})
#
# Begin with the line of a linear camera, $f^{-1}(m) = m/128$, yield it, and then iterate: irradiances from
# the curve, the curve from the irradiances, levels without pixels filled from their neighbours (on a line
# between them, or from the nearest: as you like), and all divided by $f^{-1}(128)$. Yield after every
# iteration, and end when $f^{-1}$ changes by less than `tolerance` anywhere, or after `max_iterations`.
#
# A yielded state begins with $f^{-1}$; that alone, in a tuple, is enough. A list of states will do, too.

# %% task="recover_steps"
# Yield the state of one channel, before the first iteration and after each.

# %% [markdown] about="recover_steps"
# **Predict.** Photographs two stops apart leave something open: whatever repeats with a period of two stops
# in $\ln E$ can be moved from $f^{-1}$ into the $E_i$. What will that look like?

# %% about="recover_steps hat"
states = list(recover_steps(sampling.by_rank(grays, 800), bracket.times, hat()))
ax = plots.response(responses.true_g(), label="true")
plots.response(np.log(states[-1][0]), label=f"after {len(states) - 1} iterations", ax=ax)
ax.lines[-1].set(color="#0072B2", linestyle="--")
ax.legend()
pictures.picture(
    ax, alt="The curve after the last iteration winds about the true one, once in two stops"
)

# %% [markdown] about="recover"
# ## 6 · Mitsunaga and Nayar: a polynomial, and rough times ({points})
#
# A response is smooth, so for its inverse a polynomial of low order will do:
# $f^{-1}(M) = \sum_{k=1}^{K} c_k M^k$, $M = Z/255$, with $f^{-1}(1) = 1$. And a shutter's times are rough, so
# they are corrected in turn with the curve. For neighbours in time, with the ratio $R_q = t_q / t_{q+1} < 1$,
#
# $$\varepsilon = \sum_q \sum_p \bigl[\, f^{-1}(M_{p,q}) - R_q\, f^{-1}(M_{p,q+1}) \,\bigr]^2$$
#
# is least squares in the $c_k$; then each $R_q$ is the quotient of the sums of $f^{-1}$ over the two frames
# (the paper takes the mean of quotients, to which dark pixels add mostly noise); and so on, until $f^{-1}$
# changes by less than `eps`, or for fifty turns. Each channel may have ratios of its own. The sum begins with
# $k = 1$, so no light is level 0, where $g = -\infty$; put that there, or a part of what level 1 has.
#
# `images` are `(P, H, W[, 3])` bytes. Choose samples that both frames see well, between 0.05 and 0.98.
# Return $g = \ln f^{-1}$, `(256,)` or `(256, 3)`, rising, with $g(128) = 0$ in each channel. Knobs that
# checks pass: `order` and `eps`.

# %% task="recover"

# %% about="recover"
curves = recover(bracket.images, bracket.times)
ax = plots.response(responses.true_g(), label="true")
plots.response(curves, ax=ax)
pictures.picture(ax, alt="The polynomials of three channels beside the true curve")

# %% [markdown]
# ## The whole sheet
#
# The last cell runs all checks, as grading does. The grader draws inputs of its own for you, so answers
# that only fit the examples do not carry far.

# %%
check("hw2")
