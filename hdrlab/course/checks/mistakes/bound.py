"""Known mistakes in `bound`, the task of hdrlab.radiance.merge.bound."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake


@mistake(
    "bound_loosest",
    says="If several photos give bounds for a pixel, you take the loosest one. Take the tightest:"
    " that of the shortest clipped photo, or of the longest dark one.",
)
def loosest(Z, B, g, top, shown):
    B = np.reshape(B, (-1,) + (1,) * (Z.ndim - 1))
    lower = np.where(shown & (Z >= top), g[top] - B, np.inf).min(axis=0)
    upper = np.where(shown & (Z == 0), g[1] - B, -np.inf).max(axis=0)
    low = np.isfinite(lower)
    high = np.isfinite(upper)
    lE = (np.where(low, lower, 0) + np.where(high, upper, 0)) / np.maximum(1.0 * low + high, 1)
    flags = 1 * low + 2 * high + 8 * ~(low | high)  # Quality
    return np.where(low | high, np.exp(lE), 0.0), flags.astype(np.uint8)


@mistake(
    "bound_middle_of_radiance",
    says="Between two bounds you average the radiances, which is close to the upper bound. "
    "Average their logarithms.",
)
def middle_of_radiance(Z, B, g, top, shown):
    B = np.reshape(B, (-1,) + (1,) * (Z.ndim - 1))
    lower = np.where(shown & (Z >= top), g[top] - B, -np.inf).max(axis=0)
    upper = np.where(shown & (Z == 0), g[1] - B, np.inf).min(axis=0)
    low = np.isfinite(lower)
    high = np.isfinite(upper)
    lE = np.log(
        (np.where(low, np.exp(lower), 0) + np.where(high, np.exp(upper), 0))
        / np.maximum(1.0 * low + high, 1)
    )
    flags = 1 * low + 2 * high + 8 * ~(low | high)  # Quality
    return np.where(low | high, np.exp(lE), 0.0), flags.astype(np.uint8)


@mistake(
    "bound_clipped_alone",
    says="You handle only clipped pixels. A pixel that is dark in all photos has an upper "
    "bound, from the longest of them.",
)
def clipped_alone(Z, B, g, top, shown):
    B = np.reshape(B, (-1,) + (1,) * (Z.ndim - 1))
    lower = np.where(shown & (Z >= top), g[top] - B, -np.inf).max(axis=0)
    upper = np.where(shown & (Z == 0), g[1] - B, np.inf).min(axis=0)
    low = np.isfinite(lower)
    high = np.isfinite(upper)
    lE = lower
    flags = 1 * low + 2 * high + 8 * ~(low | high)  # Quality
    return np.where(low | high, np.exp(lE), 0.0), flags.astype(np.uint8)


@mistake(
    "bound_flags_swapped",
    says="Your flags are swapped: CLIPPED is 1, and DARK is 2.",
)
def flags_swapped(Z, B, g, top, shown):
    B = np.reshape(B, (-1,) + (1,) * (Z.ndim - 1))
    lower = np.where(shown & (Z >= top), g[top] - B, -np.inf).max(axis=0)
    upper = np.where(shown & (Z == 0), g[1] - B, np.inf).min(axis=0)
    low = np.isfinite(lower)
    high = np.isfinite(upper)
    lE = (np.where(low, lower, 0) + np.where(high, upper, 0)) / np.maximum(1.0 * low + high, 1)
    flags = 2 * low + 1 * high + 8 * ~(low | high)  # Quality
    return np.where(low | high, np.exp(lE), 0.0), flags.astype(np.uint8)


@mistake(
    "bound_hidden_frames_count",
    says="You use photos that do not show the pixel. `shown` says which photos do.",
)
def hidden_frames_count(Z, B, g, top, shown):
    B = np.reshape(B, (-1,) + (1,) * (Z.ndim - 1))
    lower = np.where(Z >= top, g[top] - B, -np.inf).max(axis=0)
    upper = np.where(Z == 0, g[1] - B, np.inf).min(axis=0)
    low = np.isfinite(lower)
    high = np.isfinite(upper)
    lE = (np.where(low, lower, 0) + np.where(high, upper, 0)) / np.maximum(1.0 * low + high, 1)
    flags = 1 * low + 2 * high + 8 * ~(low | high)  # Quality
    return np.where(low | high, np.exp(lE), 0.0), flags.astype(np.uint8)


@mistake(
    "bound_without_the_8",
    says="Your flag is 0 where a pixel has no bound at all. The flag of such a pixel is 8.",
)
def without_the_8(Z, B, g, top, shown):
    B = np.reshape(B, (-1,) + (1,) * (Z.ndim - 1))
    lower = np.where(shown & (Z >= top), g[top] - B, -np.inf).max(axis=0)
    upper = np.where(shown & (Z == 0), g[1] - B, np.inf).min(axis=0)
    low = np.isfinite(lower)
    high = np.isfinite(upper)
    bound_count = 1.0 * low + high
    lE = (np.where(low, lower, 0) + np.where(high, upper, 0)) / np.maximum(bound_count, 1)
    flags = 1 * low + 2 * high
    return np.where(low | high, np.exp(lE), 0.0), flags.astype(np.uint8)


@mistake(
    "bound_of_1_is_dark",
    says="You take pixels of value 1 for dark. Only the value 0 is: 1 is a measurement and gives no"
    " bound.",
)
def of_1_is_dark(Z, B, g, top, shown):
    B = np.reshape(B, (-1,) + (1,) * (Z.ndim - 1))
    lower = np.where(shown & (Z >= top), g[top] - B, -np.inf).max(axis=0)
    upper = np.where(shown & (Z <= 1), g[1] - B, np.inf).min(axis=0)
    low = np.isfinite(lower)
    high = np.isfinite(upper)
    bound_count = 1.0 * low + high
    lE = (np.where(low, lower, 0) + np.where(high, upper, 0)) / np.maximum(bound_count, 1)
    flags = 1 * low + 2 * high + 8 * ~(low | high)
    return np.where(low | high, np.exp(lE), 0.0), flags.astype(np.uint8)
