"""The lessons' functions, fast: same module and function name, same signature, same result."""

from collections.abc import Callable
from functools import update_wrapper
from types import FunctionType
from typing import Any, TypeVar

from hdrlab.errors import InputError

Function = TypeVar("Function", bound=Callable[..., Any])


def with_parts(home: str, lesson: Function, **parts: Any) -> Function:
    """Return a lesson's function that uses fast `parts` where the lesson calls its own, for module `home`.

    The code is the lesson's own: the signature, the checks and the equations stand once.

    Examples
    --------
    >>> import numpy as np
    >>> from hdrlab.tonemap import chiu
    >>> scale = with_parts("here", chiu.scale, gaussian_filter=lambda L, sigma: L)
    >>> scale(np.array([[1.0, 4.0]]), headroom=2.0).tolist()
    [[0.5, 0.125]]
    """
    plain: Any = lesson
    if strange := parts.keys() - set(plain.__code__.co_names):
        raise InputError(
            f"expected functions that {plain.__name__} calls, got {', '.join(sorted(strange))}"
        )
    names = {**plain.__globals__, **parts}
    fast: Any = FunctionType(plain.__code__, names, plain.__name__, plain.__defaults__)
    update_wrapper(fast, plain)
    fast.__kwdefaults__, fast.__module__ = plain.__kwdefaults__, home
    return fast
