"""Known mistakes in `fit_channel_scales`, the task of hdrlab.radiance.scales.fit_channel_scales."""

import numpy as np
import scipy

from hdrlab.course.checks.mistakes import mistake
from hdrlab.radiance.scales import chromaticity


@mistake(
    "fit_channel_scales_brightness_left_in",
    says="You compare k I with M itself, so bright pixels count more. Divide both by their "
    "lengths first: only the directions count.",
)
def brightness_left_in(I, M):
    a = np.asarray(I, np.float64)
    target = np.asarray(M, np.float64)
    k = np.sum(a * target, axis=0) / np.sum(a**2, axis=0)
    return k / k[1]


@mistake(
    "fit_channel_scales_mean_of_quotients",
    says="You average the quotients M / I of the channels, in which a pixel with hardly any light "
    "in a channel has a large error. Minimize the distance of the directions.",
)
def mean_of_quotients(I, M):
    quotients = np.asarray(M, np.float64) / np.asarray(I, np.float64)
    k = np.exp(np.mean(np.log(quotients / quotients[:, 1:2]), axis=0))
    return k / k[1]


@mistake(
    "fit_channel_scales_only_the_photo_normalized",
    says="You divide M by its length, but not k I. Divide k I by |k I|, which depends on k.",
)
def only_the_photo_normalized(I, M):
    a = np.asarray(I, np.float64)
    a = a / a[:, 1:2]
    target = chromaticity(M)
    k = np.sum(a * target, axis=0) / np.sum(a**2, axis=0)
    return k / k[1]


@mistake(
    "fit_channel_scales_turned_over",
    says="Your scales turn the colors of the photo into those of the radiance. k multiplies the "
    "radiance: take 1 / k.",
)
def turned_over(I, M):
    radiance = np.asarray(I, np.float64)
    target = chromaticity(M)

    def residuals(ln_k):
        return (chromaticity(radiance * np.exp([ln_k[0], 0, ln_k[1]])) - target).ravel()

    ln_k = scipy.optimize.least_squares(residuals, np.zeros(2)).x
    return np.exp([-ln_k[0], 0.0, -ln_k[1]])


@mistake(
    "fit_channel_scales_green_is_not_1",
    says="Your ratios are right, but k has another unit. Divide it by the scale of green, so that "
    "k[1] is 1.",
)
def green_is_not_1(I, M):
    radiance = np.asarray(I, np.float64)
    target = chromaticity(M)

    def residuals(ln_k):
        return (chromaticity(radiance * np.exp([ln_k[0], 0, ln_k[1]])) - target).ravel()

    ln_k = scipy.optimize.least_squares(residuals, np.zeros(2)).x
    k = np.exp([ln_k[0], 0.0, ln_k[1]])
    return k / np.linalg.norm(k)
