"""Noisy photographs of random light, for recoveries of a response."""

import numpy as np

from hdrlab.capture import responses

TIMES = np.array([0.25, 1.0, 4.0])


def shots(scene, times=TIMES, curve="gamma", noise=0.003):
    """Return photographs (P, H, W[, 3]) of a scene whose light is 1 at the top level in one second."""
    X = np.clip(np.multiply.outer(times, scene), 0, 1)
    M = responses.as_response(curve).f(X) + noise * np.random.default_rng(2).standard_normal(
        X.shape
    )
    return np.rint(np.clip(M, 0, 1) * 255).astype(np.uint8)
