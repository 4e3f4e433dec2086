"""scipy.ndimage.uniform_filter with its default, the picture mirrored at its edges."""

from scipy.ndimage import uniform_filter


def guided(I, p=None, *, radius, epsilon):
    if p is None:
        p = I
    size = 2 * radius + 1
    I_mean, p_mean = uniform_filter(I, size), uniform_filter(p, size)
    covariance = uniform_filter(I * p, size) - I_mean * p_mean
    variance = uniform_filter(I * I, size) - I_mean * I_mean
    slope = covariance / (variance + epsilon)
    offset = p_mean - slope * I_mean
    return uniform_filter(slope, size) * I + uniform_filter(offset, size)
