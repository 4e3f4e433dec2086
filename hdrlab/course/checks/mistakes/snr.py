"""Known mistakes in `snr`, the task of hdrlab.core.weights.snr."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "snr_upside_down",
    says="Your weight is inverted. The signal f belongs in the numerator, and the slope f' in the"
    " denominator.",
)
def upside_down(g, *, least=0.01, span=4):
    g = np.asarray(g, dtype=np.float64)
    f = np.exp(g - g[-1]).reshape(len(g), -1).mean(axis=1)
    z = np.arange(len(g))
    low = np.maximum(z - span, 0)
    high = np.minimum(z + span, len(g) - 1)
    slope = (f[high] - f[low]) / (high - low) * (len(g) - 1) / (f[-1] - f[0])
    w = np.maximum(slope, least) / f
    w[[0, -1]] = 0
    return w / w[len(g) // 2]


@mistake(
    "snr_signal_alone",
    says="You weight by the signal only. Divide by the slope f', which turns the noise of the "
    "pixel values into noise of the exposure.",
)
def signal_alone(g, *, least=0.01, span=4):
    g = np.asarray(g, dtype=np.float64)
    f = np.exp(g - g[-1]).reshape(len(g), -1).mean(axis=1)
    w = 1.0 * f
    w[[0, -1]] = 0
    return w / w[len(g) // 2]


@mistake(
    "snr_ends_count",
    says="The lowest and the highest pixel value are only bounds, not measurements: their weight "
    "is 0.",
)
def ends_count(g, *, least=0.01, span=4):
    g = np.asarray(g, dtype=np.float64)
    f = np.exp(g - g[-1]).reshape(len(g), -1).mean(axis=1)
    z = np.arange(len(g))
    low = np.maximum(z - span, 0)
    high = np.minimum(z + span, len(g) - 1)
    slope = (f[high] - f[low]) / (high - low) * (len(g) - 1) / (f[-1] - f[0])
    w = f / np.maximum(slope, least)
    return w / w[len(g) // 2]


@mistake(
    "snr_span_ignored",
    says="You compute the slope between neighboring values, where noise in a recovered curve has "
    "large slopes. Use `span` values on either side.",
)
def span_ignored(g, *, least=0.01, span=4):
    g = np.asarray(g, dtype=np.float64)
    f = np.exp(g - g[-1]).reshape(len(g), -1).mean(axis=1)
    z = np.arange(len(g))
    low = np.maximum(z - 1, 0)
    high = np.minimum(z + 1, len(g) - 1)
    slope = (f[high] - f[low]) / (high - low) * (len(g) - 1) / (f[-1] - f[0])
    w = f / np.maximum(slope, least)
    w[[0, -1]] = 0
    return w / w[len(g) // 2]


@mistake(
    "snr_slope_not_bounded",
    says="Your weight is unbounded where the curve is flat. Replace a slope below `least` "
    "times the mean slope by that limit.",
)
def slope_not_bounded(g, *, least=0.01, span=4):
    g = np.asarray(g, dtype=np.float64)
    f = np.exp(g - g[-1]).reshape(len(g), -1).mean(axis=1)
    z = np.arange(len(g))
    low = np.maximum(z - span, 0)
    high = np.minimum(z + span, len(g) - 1)
    slope = (f[high] - f[low]) / (high - low) * (len(g) - 1) / (f[-1] - f[0])
    w = f / np.maximum(slope, 1e-6)
    w[[0, -1]] = 0
    return w / w[len(g) // 2]
