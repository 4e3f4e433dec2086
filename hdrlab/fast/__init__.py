"""The lessons' functions, fast: same module and function name, same signature, same result."""

from collections.abc import Callable
from functools import update_wrapper
from types import FunctionType
from typing import Any


def with_parts(home: str, *lessons: Callable[..., Any], **parts: Callable[..., Any]) -> Any:
    """Return functions of one lesson, that call each other and `parts` in place of what they call there.

    They are the lesson's own code, so their signature and all that is not a part stand once.

    Examples
    --------
    >>> import numpy as np
    >>> from hdrlab.tonemap import chiu
    >>> scale, tonemap = with_parts("here", chiu.scale, chiu.tonemap, gaussian_filter=lambda L, sigma: L)
    >>> scale(np.array([[1.0, 4.0]]), headroom=2.0).tolist()
    [[0.5, 0.125]]
    """
    names: dict[str, Any] = {}
    for lesson in lessons:
        assert isinstance(lesson, FunctionType)
        names = names or {**lesson.__globals__, **parts}
        fast = FunctionType(lesson.__code__, names, lesson.__name__, lesson.__defaults__)
        names[lesson.__name__] = update_wrapper(fast, lesson)
        fast.__kwdefaults__, fast.__module__ = lesson.__kwdefaults__, home
    return [names[lesson.__name__] for lesson in lessons]
