"""The response of a bracket, by a method of `response` or a function of the reader's."""

from collections.abc import Callable
from functools import partial

from numpy.typing import ArrayLike

from hdrlab.core.types import F64
from hdrlab.diagnostics.plausibility import validate_response
from hdrlab.fast.robertson import Smooth
from hdrlab.pipeline import catalogue
from hdrlab.pipeline.assembly import Method

Recover = Callable[..., F64]
# what a method needs beyond its paper's defaults for photographs as people take them
KNOBS = {"robertson": {"steps": Smooth(100)}}


def method(response: Method) -> Recover:
    """Return a method by its name, with its KNOBS; a function is taken as it is."""
    found = catalogue.method("response", response)
    return partial(found, **KNOBS[response]) if response in KNOBS else found


def validated(response: Method) -> Recover:
    """Return `recover(images, times, *, valid) -> g`, which refuses a response that the images contradict.

    A function is taken as it is, and so is "linear", which does not ask the images.
    """
    found = method(response)
    return found if callable(response) or response == "linear" else partial(recover, found)


def recover(method: Recover, images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None) -> F64:
    """Return the response that a method finds, or raise a ValueError: see `validate_response`."""
    return validate_response(method(images, times, valid=valid), images, times, valid=valid)
