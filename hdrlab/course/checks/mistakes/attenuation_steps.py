"""Known mistakes in `attenuation_steps`, the task of hdrlab.tonemap.fattal.attenuation_steps."""

import numpy as np

from hdrlab.core.filters.pyramid import depth, gaussian, interpolate
from hdrlab.course.checks.mistakes import mistake
from hdrlab.tonemap.fattal import MIN_LEVEL_SIDE, Level, attenuation, slope


@mistake(
    "attenuation_steps_power_inverted",
    says="Your phi grows with the gradient, so steep gradients become steeper. The power is beta "
    "- 1, which is negative.",
)
def power_inverted(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    def attenuation(slope, mean, *, alpha, beta, noise):
        return (np.maximum(slope / (mean or 1), noise) / alpha) ** (1 - beta)

    levels = gaussian(lL, depth(lL.shape, MIN_LEVEL_SIDE))
    Phi = np.ones_like(levels[-1][::2, ::2])
    for k, lL in reversed(list(enumerate(levels))):
        steepness = slope(lL, k)
        phi = attenuation(steepness, float(steepness.mean()), alpha=alpha, beta=beta, noise=noise)
        Phi = interpolate(Phi, lL.shape) * phi
        yield Level(k, lL, steepness, phi, Phi)


@mistake(
    "attenuation_steps_mean_of_the_finest",
    says="Compare each gradient with the mean gradient of its own level. You used the mean of the"
    " finest level for all levels.",
)
def mean_of_the_finest(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    levels = gaussian(lL, depth(lL.shape, MIN_LEVEL_SIDE))
    Phi = np.ones_like(levels[-1][::2, ::2])
    for k, lL in reversed(list(enumerate(levels))):
        steepness = slope(lL, k)
        phi = attenuation(
            steepness, 4 * float(slope(levels[0]).mean()), alpha=alpha, beta=beta, noise=noise
        )
        Phi = interpolate(Phi, lL.shape) * phi
        yield Level(k, lL, steepness, phi, Phi)


@mistake(
    "attenuation_steps_finest_alone",
    says="You use only the finest level. A soft edge with high contrast has small gradients "
    "there, so it is not attenuated.",
)
def finest_alone(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    levels = gaussian(lL, depth(lL.shape, MIN_LEVEL_SIDE))
    Phi = np.ones_like(levels[-1][::2, ::2])
    for k, lL in reversed(list(enumerate(levels))):
        steepness = slope(lL, k)
        phi = attenuation(steepness, float(steepness.mean()), alpha=alpha, beta=beta, noise=noise)
        Phi = phi
        yield Level(k, lL, steepness, phi, Phi)


@mistake(
    "attenuation_steps_phi_of_the_coarser",
    says="You use phi of the wrong level. Phi_k contains phi of level k itself; you used that of "
    "the next coarser level again.",
)
def phi_of_the_coarser(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    coarser_phi = None
    levels = gaussian(lL, depth(lL.shape, MIN_LEVEL_SIDE))
    Phi = np.ones_like(levels[-1][::2, ::2])
    for k, lL in reversed(list(enumerate(levels))):
        steepness = slope(lL, k)
        phi = attenuation(steepness, float(steepness.mean()), alpha=alpha, beta=beta, noise=noise)
        own_phi = phi
        if coarser_phi is not None:
            phi = interpolate(coarser_phi, lL.shape)
        coarser_phi = own_phi
        Phi = interpolate(Phi, lL.shape) * phi
        yield Level(k, lL, steepness, phi, Phi)
