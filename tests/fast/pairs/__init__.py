"""Input for the pairs of lesson and fast function; a file for each module of `fast`, which is found here.

Each file has PAIRS, {"function": (make, tolerance)}. make(kind, rng) returns (arguments, named
arguments) for a kind of input, or None where such input has no meaning for this function. The
tolerance is the largest allowed difference, absolute, or relative to the largest finite value of
the lesson's answer, whichever is larger; exact is 0. A tuple of tolerances is one for each part of
the answer.
"""

import pkgutil
from collections.abc import Iterator
from copy import deepcopy
from importlib import import_module

import numpy as np

KINDS = ("random", "flat", "tiny", "row", "clipped", "deep", "gray", "colour")


def photographs(kind, rng, frames=3):
    """Return photographs (P, H, W[, 3]) of a kind: `deep` has 16 bits, `tiny` three pixels."""
    shape = {"tiny": (1, 3), "row": (1, 24)}.get(kind, (23, 37))
    shape = (frames, *shape, *((3,) if kind == "colour" else ()))
    if kind == "flat":
        return np.full(shape, 117, np.uint8)
    light = np.sort(rng.lognormal(0, 1.2, shape), axis=0)
    top = 65535 if kind == "deep" else 255
    gain = 2.0 if kind == "clipped" else 0.2
    return np.clip(light * gain * top, 0, top).astype(np.uint16 if kind == "deep" else np.uint8)


def luminance(kind, rng):
    """Return luminance (H, W) float32 of a kind: `clipped` has areas at the maximum, `deep` 12 decades."""
    shape = {"tiny": (1, 3), "row": (1, 24)}.get(kind, (23, 37))
    if kind == "flat":
        return np.full(shape, 0.7, np.float32)
    L = rng.lognormal(0, 6 if kind == "deep" else 1.5, shape).astype(np.float32)
    return np.minimum(L, np.float32(1.5)) if kind == "clipped" else L


def compare(slow, quick, args, named, tolerance):
    """Assert that both functions return the same or raise the same error, and do not change their
    input.
    """
    before = deepcopy((args, named))
    expected = _answer(slow, *deepcopy((args, named)))
    came = _answer(quick, *deepcopy((args, named)))
    _same(came, expected, tolerance)
    quick_given = deepcopy((args, named))
    _answer(quick, *quick_given)
    _same(quick_given, before, 0)


def _answer(function, args, named):
    try:
        answer = function(*args, **named)
        return list(answer) if isinstance(answer, Iterator) else answer
    except ValueError:
        return "ValueError"


def _same(came, expected, tolerance):
    if isinstance(expected, dict):
        assert list(came) == list(expected)
        came = list(came.values())
        expected = list(expected.values())
    if isinstance(expected, tuple | list):
        assert isinstance(came, tuple | list) and len(came) == len(expected), (came, expected)
        tolerances = tolerance if isinstance(tolerance, tuple) else [tolerance] * len(expected)
        for value, other, allowed in zip(came, expected, tolerances, strict=True):
            _same(value, other, allowed)
        return
    if expected is None or callable(expected) or isinstance(expected, str):
        assert came is expected or came == expected or callable(expected)
        return
    a = np.asarray(came)
    b = np.asarray(expected)
    assert a.shape == b.shape, (a.shape, b.shape)
    assert a.dtype == b.dtype, (a.dtype, b.dtype)
    if b.dtype.kind not in "biuf":
        assert np.array_equal(a, b)
        return
    a = a.astype(np.float64)
    b = b.astype(np.float64)
    same = (a == b) | (np.isnan(a) & np.isnan(b))
    finite = np.abs(b[np.isfinite(b)])
    allowed = tolerance * max(1.0, finite.max(initial=0.0))
    with np.errstate(invalid="ignore"):
        same |= np.abs(a - b) <= allowed
    assert same.all(), f"apart by {np.nanmax(np.abs(a - b)[~same])}, allowed {allowed}"


MAKERS = {
    f"{info.name}.{name}": pair
    for info in pkgutil.iter_modules(__path__)
    for name, pair in import_module(f"pairs.{info.name}").PAIRS.items()
}
