"""The response of a bracket: by a method of `response`, by a function of the reader's, or "auto".

A map needs some response. So where a method finds none, or one that no camera has, one that a prior settles
takes its place, with a doubt: that of `response.space`, and failing that a usual camera's.
"""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hdrlab.core.bracket import Bracket
from hdrlab.core.types import F64
from hdrlab.diagnostics.plausibility import validate_response
from hdrlab.fast import robertson
from hdrlab.pipeline import catalogue, relative_times, response_choice
from hdrlab.pipeline.assembly import Method
from hdrlab.response import self_calibration

Recover = Callable[..., F64]
# methods that need more than their paper for photographs as people take them
EXTENDED: dict[Method, Recover] = {
    "robertson": partial(robertson.recover, steps=robertson.Smooth(100)),
    "mitsunaga": self_calibration.find_response,
}


class Found(NamedTuple):
    """A response g (n,) or (n, 3), notes on it, doubts about it, and why it is worth no map, or ""."""

    g: F64
    notes: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()
    fallback: str = ""


def find_method(response: Method) -> Recover:
    """Return a method by its name, EXTENDED where it is; a function is taken as it is."""
    return EXTENDED.get(response) or catalogue.method("response", response)


def find_validated_method(response: Method) -> Recover:
    """Return `recover(images, times, *, valid) -> g`, which refuses a response that the images contradict.

    A function is taken as it is, and so is "linear", which does not ask the images.
    """
    found = find_method(response)
    return found if callable(response) or response == "linear" else partial(_recover, found)


def _recover(method: Recover, images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None) -> F64:
    """Return the response that a method finds, or raise a ValueError: see `validate_response`."""
    return validate_response(method(images, times, valid=valid), images, times, valid=valid)


def resolve_auto(response: Method, bracket: Bracket) -> Method:
    """Return the method that "auto" begins with: linear where the bracket is, else debevec."""
    if response == "auto":
        return "linear" if bracket.linear else "debevec"
    return response


def find_response(response: Method, bracket: Bracket) -> Found:
    """Return the Found response of an aligned bracket; "auto" is what held-out pixels choose.

    Raises
    ------
    ValueError
        For names that no method has, and photographs of which no two see anything well.
    """
    images, times, _, valid, linear = bracket
    if response == "auto" and not linear:
        method, notes = response_choice.choose_response(bracket)
        method = partial(_recover, method)
    else:
        method, notes = find_validated_method(resolve_auto(response, bracket)), ()
    try:
        return Found(method(images, times, valid=valid), notes)
    except ValueError as error:
        if callable(response) or not np.isfinite(relative_times.compare_order(bracket)).any():
            raise
        reason = f"no response was found ({error}), so that of"
    try:
        g = find_validated_method("space")(images, times, valid=valid)
        return Found(g, doubts=(f"{reason} the likeliest camera was taken: check the times",))
    except ValueError:
        reason += " a usual camera was taken"
        return Found(relative_times.usual_response(256, linear), (), (reason,), reason)
