"""Wrong answers to tasks of homework 5. Each one breaks one sentence of its assignment, and no other.

A function's name begins with the id of its task.
"""

import numpy as np
from scipy.ndimage import uniform_filter

from hdrlab.capture.development import XYZ_OF_SRGB, balance_white, screen_from_camera
from hdrlab.capture.metering import centre, optimum, spot
from hdrlab.core.filters.guided import guided
from hdrlab.core.gainmap import apply_gain, gain_map
from hdrlab.core.transfer import brightness_transfer
from hdrlab.core.weights import snr
from hdrlab.enhance.mertens import contrast, exposedness, saturation, weight
from hdrlab.radiance.uncertainty import inverse_variance_merge, variance
from hdrlab.response.debevec import solve_by_svd
from hdrlab.response.selection import flat
from hdrlab.tonemap.local_laplacian import remap
from hdrlab.tonemap.transfer import pq


def variance_at_least_0_01(X, D, N, R):
    return variance(X, D, N, R) + 0.01


def variance_of_the_whole_image(X, D, N, R):
    return variance(X, D, N, R).mean()


def inverse_variance_merge_variance_of_one_photo(X, D, measured, t, N, R):
    E, s = inverse_variance_merge(X, D, measured, t, N, R)
    return E, s * np.sqrt(measured.sum(axis=0))


def guided_p_must_be_given(guide, p=None, *, radius, epsilon):
    return guided(guide, np.zeros_like(guide) if p is None else p, radius=radius, epsilon=epsilon)


def guided_b_not_averaged(guide, p=None, *, radius, epsilon):
    p = guide if p is None else p
    size = 2 * radius + 1
    mean_I = uniform_filter(guide, size)
    mean_p = uniform_filter(p, size)
    a = (uniform_filter(guide * p, size) - mean_I * mean_p) / (
        uniform_filter(guide * guide, size) - mean_I**2 + epsilon
    )
    b = mean_p - a * mean_I
    return uniform_filter(a, size) * guide + b


def guided_divided_by_one_less(guide, p=None, *, radius, epsilon):
    count = (2 * radius + 1) ** 2
    return guided(guide, p, radius=radius, epsilon=epsilon * (count - 1) / count)


def guided_clipped(guide, p=None, *, radius, epsilon):
    return np.clip(guided(guide, p, radius=radius, epsilon=epsilon), 0, 2)


def remap_of_the_light(lL, g, *, sigma, alpha, beta):
    return remap(lL, g, sigma=sigma, alpha=alpha, beta=beta) + 0.01 * g


def remap_always_upward(lL, g, *, sigma, alpha, beta):
    return remap(g + np.abs(lL - g), g, sigma=sigma, alpha=alpha, beta=beta)


def remap_step_for_every_alpha(lL, g, *, sigma, alpha, beta):
    d = np.abs(lL - g)
    y = np.clip(d / 0.01 - 1, 0, 1)
    tau = y**2 * (2 - y) ** 2
    x = np.minimum(d / sigma, 1)
    f = tau * x**alpha + (1 - tau) * x
    return g + np.sign(lL - g) * (sigma * f + beta * np.maximum(d - sigma, 0))


def pq_of_100(FD):
    return pq(100 * np.asarray(FD, float).clip(0, 100))


def pq_of_ten_bits(FD):
    return np.round(pq(FD) * 1023) / 1023


def gain_map_always_default_offsets(sdr, hdr, low, high, *, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    return gain_map(sdr, hdr, low, high, gamma=gamma)


def gain_map_first_channel_for_all(sdr, hdr, low, high, *, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    low, high, gamma = (np.ravel(one)[0] for one in (low, high, gamma))
    return gain_map(sdr, hdr, low, high, gamma=gamma, k=k)


def gain_map_clipped_after_the_power(sdr, hdr, low, high, *, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    G = np.log2((hdr + k[1]) / (sdr + k[0]))
    return np.clip(((G - low) / np.subtract(high, low)) ** gamma, 0, 1)


def apply_gain_always_whole(sdr, g, low, high, *, W=1.0, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    return apply_gain(sdr, g, low, high, gamma=gamma, k=k)


def apply_gain_offset_of_sdr_left(sdr, g, low, high, *, W=1.0, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    return apply_gain(sdr, g, low, high, W=W, gamma=gamma, k=(0, k[1]))


def apply_gain_first_channel_for_all(
    sdr, g, low, high, *, W=1.0, gamma=1.0, k=(1 / 1024, 1 / 1024)
):
    low, high, gamma = (np.ravel(one)[0] for one in (low, high, gamma))
    return apply_gain(sdr, g, low, high, W=W, gamma=gamma, k=k)


def apply_gain_never_above_white(sdr, g, low, high, *, W=1.0, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    return np.minimum(apply_gain(sdr, g, low, high, W=W, gamma=gamma, k=k), 1)


def line_with_intercept(S, V):
    w = 1 / V
    return np.polyfit(S, V, 1, w=w)[0]


def brightness_transfer_rounded(h_A, h_B):
    return np.round(brightness_transfer(h_A, h_B))


def brightness_transfer_lowest_taken(h_A, h_B):
    T = brightness_transfer(h_A, h_B)
    return np.where(np.isnan(T) & (np.arange(len(T)) < len(T) // 2), 0, T)


def brightness_transfer_nearest_edge(h_A, h_B):
    H_A = np.concatenate([[0], np.cumsum(h_A) / np.sum(h_A)])
    H_B = np.cumsum(h_B) / np.sum(h_B)
    T = np.searchsorted(H_B, (H_A[1:] + H_A[:-1]) / 2).astype(float)
    return np.where((T < 1) | (T > len(T) - 2), np.nan, T)


def snr_span_of_one(g, *, least=0.01, span=4):
    return snr(g, least=least, span=1)


def snr_ends_are_0_within_the_span(g, *, least=0.01, span=4):
    w = snr(g, least=least, span=span)
    w[:span] = 0
    w[-span:] = 0
    return w


def snr_least_absolute(g, *, least=0.01, span=4):
    f = np.exp(np.asarray(g, float))
    z = np.arange(len(g))
    low = np.maximum(z - span, 0)
    high = np.minimum(z + span, len(g) - 1)
    w = f / np.maximum((f[high] - f[low]) / (high - low), least / len(g))
    w[[0, -1]] = 0
    return w


def weight_gray_is_the_mean(F, powers=(1, 1, 1)):
    gray = np.broadcast_to(F.mean(axis=0), F.shape)
    return contrast(gray) ** powers[0] * saturation(F) ** powers[1] * exposedness(F) ** powers[2]


def weight_divided_by_2(F, powers=(1, 1, 1)):
    return (
        contrast(F) ** powers[0]
        * (saturation(F) * np.sqrt(1.5)) ** powers[1]
        * exposedness(F) ** powers[2]
    )


def weight_powers_ignored(F, powers=(1, 1, 1)):
    return weight(F, tuple(min(power, 1) and 1 for power in powers))


def weight_wide_curve(F, powers=(1, 1, 1)):
    return contrast(F) ** powers[0] * saturation(F) ** powers[1] * exposedness(F) ** (powers[2] / 2)


def optimum_reading_of_0_5(EV_pre, B_pre, B_opt=0.5):
    return optimum(EV_pre, B_pre, B_opt)


def spot_centers_at_corners(shape, *, at=(0.5, 0.5), share=0.03):
    H, W = shape
    return spot(shape, at=(at[0] + 0.5 / H, at[1] + 0.5 / W), share=share)


def spot_in_the_middle(shape, *, at=(0.5, 0.5), share=0.03):
    return spot(shape, share=share)


def spot_of_no_pixel(shape, *, at=(0.5, 0.5), share=0.03):
    w = spot(shape, at=at, share=share)
    return w if share * w.size >= 0.5 else 0 * w


def spot_default_share(shape, *, at=(0.5, 0.5), share=0.03):
    return spot(shape, at=at)


def centre_in_the_middle(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    return centre(shape, inside=inside, share=share)


def centre_default_inside(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    return centre(shape, share=share, at=at)


def flat_of_the_first_frame(A, *, size=5, psi=0.05, sigma=0.01):
    return flat(A[:1], size=size, psi=psi, sigma=sigma)


def flat_limit_of_one_frame(A, *, size=5, psi=0.05, sigma=0.01):
    A = np.asarray(A)
    if len(A) == 1:
        return flat(A, size=size, psi=psi, sigma=sigma)
    deviation = np.sqrt(uniform_filter(A.var(axis=0, ddof=1), size) / len(A))
    return flat((A.mean(axis=0) / deviation)[None], size=size, psi=psi, sigma=1.0)


def flat_sigma_for_several_frames(A, *, size=5, psi=0.05, sigma=0.01):
    return flat(np.mean(A, axis=0)[None], size=size, psi=psi, sigma=sigma / np.sqrt(len(A)))


def flat_default_psi(A, *, size=5, psi=0.05, sigma=0.01):
    return flat(A, size=size, sigma=sigma)


def flat_default_size(A, *, size=5, psi=0.05, sigma=0.01):
    return flat(A, psi=psi, sigma=sigma)


def solve_by_svd_rtol_ignored(A, b, *, rtol=1e-10):
    return solve_by_svd(A, b)


def solve_by_svd_of_the_first_rows(A, b, *, rtol=1e-10):
    k = A.shape[1]
    return solve_by_svd(A[:k], b[:k], rtol=rtol)


def snr_least_absolute_unit(g, *, least=0.01, span=4):
    w = snr(g, least=least, span=span)
    return w / (1 + np.exp(np.asarray(g, float)))


def inverse_variance_merge_of_E_alone(X, D, measured, t, N, R):
    return inverse_variance_merge(X, D, measured, t, N, R)[0]


def balance_white_blue_for_red(X, c, gains):
    return balance_white(X, c, np.asarray(gains)[::-1])


def balance_white_divided_by_green(X, c, gains):
    return np.minimum(X * (np.asarray(gains) / gains[1])[c], 1)


def balance_white_clipped_before(X, c, gains):
    return np.minimum(X, 1) * (np.asarray(gains) / np.min(gains))[c]


def balance_white_always_rggb(X, c, gains):
    height, width = X.shape
    rggb = np.tile([[0, 1], [1, 2]], (height // 2 + 1, width // 2 + 1))[:height, :width]
    return balance_white(X, rggb, gains)


def screen_from_camera_always_srgb(M, P):
    return screen_from_camera(M, XYZ_OF_SRGB)


def screen_from_camera_columns(M, P):
    A = np.asarray(M) @ P
    return np.linalg.inv(A / A.sum(axis=0, keepdims=True))
