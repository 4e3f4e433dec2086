"""Fattal's operator with fast pyramids, and the equations of neighbours in bands of rows."""

from functools import partial
from typing import Any

import numpy as np

from hdrlab.core.arrays import F32
from hdrlab.fast import _bands, pyramid, with_parts
from hdrlab.tonemap import fattal

SATURATION = fattal.SATURATION


def _slope(lL: F32, k: int) -> F32:
    return _bands.banded(partial(fattal.slope, k=k), lL, margin=1)


def _attenuation(slope: F32, mean: float, **knobs: Any) -> F32:
    return _bands.banded(partial(fattal.attenuation, mean=mean, **knobs), slope)


def _divergence(lL: F32, Phi: F32) -> F32:
    divG = np.zeros_like(lL)
    _add_divergence_of_columns(lL, Phi, divG)
    _add_divergence_of_columns(lL.T, Phi.T, divG.T)
    return divG


def _add_divergence_of_columns(lL: F32, Phi: F32, divG: F32) -> None:
    """Add what the differences between rows contribute to divG, in place."""
    G = np.diff(lL, axis=0) * ((Phi[1:] + Phi[:-1]) * np.float32(0.5))
    divG[:-1] += G
    divG[1:] -= G


def divergence(lL: F32, Phi: F32) -> F32:
    """Return div G, for `poisson.solve`: Laplacian lLd = div G [Fattal02; Battiato08 eq. 1.40]."""
    return _bands.banded(_divergence, lL, Phi, margin=1)


_parts = {"slope": _slope, "attenuation": _attenuation, "pyramid": pyramid}
attenuation_steps = with_parts(__name__, fattal.attenuation_steps, **_parts)
tonemap = with_parts(
    __name__, fattal.tonemap, attenuation_steps=attenuation_steps, divergence=divergence
)
