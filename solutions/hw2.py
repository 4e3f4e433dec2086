# %% [markdown]
# # Homework 2 · The response curve
#
# Due {due}. {total} points. {late}
#
# A photo does not store light. It stores pixel values, which the camera computed from the light by
# its *camera response function* (CRF). The maker does not publish it. Three papers estimate it from
# a few photos, and you write the core of each.
#
# | symbol | meaning | shape |
# |---|---|---|
# | $Z_{ij}$ | pixel value, 0 to 255, of sample $i$ in photo $j$ | (N, P) |
# | $t_j$, $B_j = \ln t_j$ | exposure time in seconds, and its logarithm | (P,) |
# | $E_i$ | irradiance of sample $i$; `lE` $= \ln E_i$ | (N,) |
# | $f$ | the camera's response function: $Z = f(E\,t)$ | |
# | $f^{-1}$, `f_inv` | its inverse: the exposure of each pixel value | (256,) |
# | $g = \ln f^{-1}$ | the logarithm of the inverse | (256,) |
# | $w$ | weight: how much to trust a pixel value | (256,) |
#
# Under each task there is a cell `check("...")`. It shows which checks pass and draws what differs.
# Inside a task, use NumPy, SciPy and what this assignment gives you: hdrlab cannot be imported when
# your work is graded.

# %%
import numpy as np

from hdrlab import scenes
from hdrlab.capture import camera, responses
from hdrlab.core import sampling
from hdrlab.course.notebook import check, use_plan
from hdrlab.show import pictures, plots

use_plan("hw2")

# %% [markdown]
# ## The photos
#
# The photos show a room: seven exposures, two stops apart, on film. Sixty of their pixels are
# enough to begin with. The $E_i$ are still unknown, so the figure draws each pixel's values over
# $\ln t$, as if every $E_i$ were 1.

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
    alt="The values of sixty pixels over ln time: seven columns of dots",
)

# %% [markdown] about="hat"
# ## 1 · The hat weight ({points})
#
# Near 0, the rounding error is as large as the signal. Near the top, the sensor is saturated. The
# hat function weights a pixel value by its distance from both ends: for $n$ values, $w(z) = z$
# below the middle and $n - 1 - z$ above it, scaled to about 1 in the middle. Only ratios of weights
# matter, so any scale is right.

# %% task="hat"

# %% [markdown] about="gsolve"
# ## 2 · Debevec and Malik: one system of equations ({points})
#
# The camera makes $Z_{ij} = f(E_i t_j)$, so $g(Z_{ij}) = \ln E_i + B_j$. This equation is linear in
# all $n$ values of $g$ and all $N$ values of $\ln E_i$. With $z$ for a pixel value, minimize
#
# $$\sum_{i,j} \bigl\{ w(Z_{ij})\,[\,g(Z_{ij}) - \ln E_i - B_j\,] \bigr\}^2
#   + \sum_{z=1}^{n-2} \bigl\{\lambda\, w(z)\,[\,g(z-1) - 2 g(z) + g(z+1)\,] \bigr\}^2.$$
#
# Each term is a row of a matrix $A$ with $n + N$ columns, first $g$, then $\ln E$. One more row
# says $g(n/2) = 0$. That makes $NP + 1 + n - 2$ rows. `np.linalg.lstsq` solves the system. An
# iterative solver such as `lsqr` stops far too early by default: pass `atol=btol=1e-12`, `conlim=0`
# and `iter_lim=50_000`. The argument for $\lambda$ is `smoothness`, and $n$ is `len(w)`.

# %% task="gsolve"
# Return g and lE that minimize the sum of squares: the curve, and the ln irradiance of each sample.

# %% about="gsolve hat"
found = gsolve(Z, B, 30, hat())
ax = plots.samples(Z, found[1], B, g=found[0])
pictures.picture(
    ax, alt="The dots of the sixty pixels, shifted by their ln E, lie on one increasing curve, g"
)

# %% [markdown] about="irradiance"
# ## 3 · Robertson: the best irradiance for a curve ({points})
#
# Robertson, Borman and Stevenson look for the most probable curve under noise, by alternating
# between two steps. This is the first step. If $f^{-1}$ were known, the irradiance of each sample
# would be a weighted mean of the estimates $f^{-1}(Z_{ij})/t_j$ from its photos. Long exposures are
# more precise, by a factor of $t_j^2$, so
#
# $$E_i = \frac{\sum_j w(Z_{ij})\, t_j\, f^{-1}(Z_{ij})}{\sum_j w(Z_{ij})\, t_j^2}.$$
#
# If all weights of a sample are 0, this is $0/0$: return NaN for it.

# %% task="irradiance"

# %% [markdown] about="update"
# ## 4 · Robertson: the best curve for irradiances ({points})
#
# This is the second step. If the $E_i$ were known, $f^{-1}(m)$ would be the mean exposure of all
# pixels of value $m$:
#
# $$f^{-1}(m) = \frac{1}{|E_m|}\sum_{(i,j) \in E_m} E_i\, t_j, \qquad E_m = \{(i,j) : Z_{ij} = m\}.$$
#
# It is a plain mean, without weights. Ignore samples whose irradiance is NaN. If a value $m$ has no
# pixels, its result is NaN.

# %% task="update"

# %% [markdown] about="recover_steps"
# ## 5 · Robertson: all iterations ({points})
#
# Start with the line of a linear camera, $f^{-1}(m) = m/128$, and yield it. Then iterate:
#
# 1. Compute the irradiances from the curve, and the curve from the irradiances.
# 2. Fill values without pixels from their neighbors, by linear interpolation or from the nearest,
#    as you like.
# 3. Divide the curve by $f^{-1}(128)$, and yield it. (The checks accept any other factor.)
#
# Stop when $f^{-1}$ changes by less than `tolerance` everywhere, or after `max_iterations`.
#
# A yielded state begins with $f^{-1}$. A tuple with only $f^{-1}$ in it is enough. You may also
# return a list of states.

# %% task="recover_steps"
# Yield the state of one channel before the first iteration and after each iteration.

# %% [markdown] about="recover_steps"
# **Think.** Photos that are two stops apart leave something undetermined. Add a function of ln
# exposure with a period of two stops to $\ln f^{-1}$, and the same function to the $\ln E_i$: then
# $f^{-1}(Z_{ij}) = E_i t_j$ holds as well as before. What will that look like in the curve?

# %% about="recover_steps hat"
states = list(recover_steps(sampling.by_rank(grays, 800), bracket.times, hat()))
ax = plots.response(responses.true_g(), label="true")
plots.response(np.log(states[-1][0]), label=f"after {len(states) - 1} iterations", ax=ax)
ax.lines[-1].set(color="#0072B2", linestyle="--")
ax.legend()
pictures.picture(
    ax,
    alt="The curve after the last iteration oscillates around the true one, with a period of two stops",
)

# %% [markdown] about="recover"
# ## 6 · Mitsunaga and Nayar: a polynomial, and rough times ({points})
#
# A response function is smooth, so a polynomial of low order can represent its inverse: $f^{-1}(M)
# = \sum_{k=1}^{K} c_k M^k$ with $M = Z/255$ and $f^{-1}(1) = 1$. Shutter times are only roughly
# known, so the method improves the curve and the times in turn. For photos with adjacent exposure
# times and the ratio $R_q = t_q / t_{q+1} < 1$,
#
# $$\mathcal E = \sum_q \sum_p \bigl[\, f^{-1}(M_{p,q}) - R_q\, f^{-1}(M_{p,q+1}) \,\bigr]^2$$
#
# is a least-squares problem in the $c_k$. Then set each $R_q$ to the sum of $f^{-1}$ over photo
# $q$, divided by the sum over photo $q + 1$. (The paper takes the mean of quotients, to which dark
# pixels add mostly noise.) Repeat both steps until $f^{-1}$ changes by less than `eps`, or for
# thirty iterations. Each channel may have its own ratios. The sum begins with $k = 1$, so
# $f^{-1}(0) = 0$ and $g(0) = -\infty$. Return that for value 0, or use a fraction of the exposure
# of value 1.
#
# `images` are `(P, H, W[, 3])` bytes. Choose samples that both frames expose well, between 0.05 and
# 0.98. Return $g = \ln f^{-1}$, `(256,)` or `(256, 3)`, increasing, with $g(128) = 0$ in each
# channel. (The checks accept any number added to $g$.) They pass the parameters `order` and `eps`.

# %% task="recover"

# %% about="recover"
curves = recover(bracket.images, bracket.times)
ax = plots.response(responses.true_g(), label="true")
plots.response(curves, ax=ax)
pictures.picture(ax, alt="The polynomials of three channels beside the true curve")

# %% [markdown]
# ## All checks
#
# The last cell runs all checks, just like grading. The grader draws its own inputs for you, so
# answers that only fit the examples do not get far.

# %%
check("hw2")
