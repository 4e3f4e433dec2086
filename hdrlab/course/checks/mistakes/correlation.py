"""Known mistakes in `correlation`, the task of hdrlab.align.cerman.correlation."""

import numpy as np
import scipy

from hdrlab.align import light
from hdrlab.course.checks.mistakes import mistake


@mistake(
    "correlation_wraps_around",
    says="Your transform has the size of the photos, so a shifted photo comes in again at the "
    "other side. Pad with zeros to (2 h - 1, 2 w - 1).",
)
def wraps_around(X):
    a, b = [np.where(np.isfinite(x), x - light.local_mean(x), 0) for x in X]
    c = np.fft.irfft2(np.fft.rfft2(a) * np.conj(np.fft.rfft2(b)), a.shape)
    y = np.arange(1 - a.shape[0], a.shape[0])
    x = np.arange(1 - a.shape[1], a.shape[1])
    return c[np.ix_(y, x)]


@mistake(
    "correlation_one_mean",
    says="You subtract one mean from the whole photo. Then light that falls off slowly decides. "
    "Subtract the local mean around each pixel.",
)
def one_mean(X):
    a, b = [np.where(np.isfinite(x), x - np.nanmean(x), 0) for x in X]
    return scipy.signal.fftconvolve(a, b[::-1, ::-1])


@mistake(
    "correlation_not_centered",
    says="You correlate the photos without subtracting a mean, so the largest overlap wins. "
    "Subtract the local mean of each photo first.",
)
def not_centered(X):
    a, b = [np.where(np.isfinite(x), x, 0) for x in X]
    return scipy.signal.fftconvolve(a, b[::-1, ::-1])


@mistake(
    "correlation_exchanged",
    says="Your shifts move the first photo onto the second. Take the conjugate of the second "
    "photo's spectrum, not of the first one's.",
)
def exchanged(X):
    a, b = [np.where(np.isfinite(x), x - light.local_mean(x), 0) for x in X]
    return scipy.signal.fftconvolve(b, a[::-1, ::-1])


@mistake(
    "correlation_discarded_are_black",
    says="Your local mean counts discarded pixels as black. Divide the filtered photo by the "
    "filtered mask of kept pixels.",
)
def discarded_are_black(X):
    def local_mean(x):
        return scipy.ndimage.gaussian_filter(np.where(np.isfinite(x), x, 0), 4.0)

    a, b = [np.where(np.isfinite(x), x - local_mean(x), 0) for x in X]
    return scipy.signal.fftconvolve(a, b[::-1, ::-1])
