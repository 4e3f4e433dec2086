"""The response of a bracket, by a method of `response` or a function of the reader's."""

from collections.abc import Callable
from functools import partial

from numpy.typing import ArrayLike

from hdrlab.core.types import F64
from hdrlab.diagnostics.plausibility import validate_response
from hdrlab.fast import robertson
from hdrlab.pipeline import catalogue
from hdrlab.pipeline.assembly import Method
from hdrlab.response import self_calibration

Recover = Callable[..., F64]
# methods that need more than their paper for photographs as people take them
EXTENDED: dict[Method, Recover] = {
    "robertson": partial(robertson.recover, steps=robertson.Smooth(100)),
    "mitsunaga": self_calibration.find_response,
}


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
