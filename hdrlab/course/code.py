"""Deprecated name of `hdrlab.course.source_code`, which tests of instructors' own tasks import."""

import warnings
from types import ModuleType


def __getattr__(name: str) -> ModuleType:
    if name != "inline":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    message = "hdrlab.course.code is deprecated; import from hdrlab.course.source_code"
    warnings.warn(message, DeprecationWarning, stacklevel=2)
    from hdrlab.course.source_code import inline

    return inline
