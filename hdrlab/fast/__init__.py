"""The lessons' functions, fast: same module and function name, same signature, same result."""

from collections.abc import Callable
from functools import update_wrapper
from types import FunctionType
from typing import Any, TypeVar

from hdrlab.errors import InputError

Function = TypeVar("Function", bound=Callable[..., Any])


def with_parts(home: str, lesson: Function, **parts: Any) -> Function:
    """Return a copy of a lesson's function that calls the functions in `parts` instead of its own.

    So the signature, the checks and the equations are written only once, in the lesson. The copy
    says that it belongs to the module `home`.

    Examples
    --------
    >>> import numpy as np
    >>> from hdrlab.tonemap import chiu
    >>> scale = with_parts("here", chiu.scale, gaussian_filter=lambda L, sigma: L)
    >>> scale(np.array([[1.0, 4.0]]), headroom=2.0).tolist()
    [[0.5, 0.125]]
    """
    plain: Any = lesson
    unknown = parts.keys() - set(plain.__code__.co_names)
    if unknown:
        raise InputError(
            f"expected functions that {plain.__name__} calls, got {', '.join(sorted(unknown))}"
        )
    names = {**plain.__globals__, **parts}
    fast: Any = FunctionType(plain.__code__, names, plain.__name__, plain.__defaults__)
    update_wrapper(fast, plain)
    fast.__kwdefaults__ = plain.__kwdefaults__
    fast.__module__ = home
    return fast
