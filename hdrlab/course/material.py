"""Deprecated name of `hdrlab.course.authoring`, which tests of instructors' own tasks import."""

import warnings
from types import ModuleType


def __getattr__(name: str) -> ModuleType:
    if name != "stubs":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    message = "hdrlab.course.material is deprecated; import from hdrlab.course.authoring"
    warnings.warn(message, DeprecationWarning, stacklevel=2)
    from hdrlab.course.authoring import stubs

    return stubs
