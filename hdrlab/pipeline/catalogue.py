"""The methods of each chapter, by name.

A method is a module of its chapter that defines the chapter's function: `align`, `recover` or
`tonemap`. Where `hdrlab.fast` has a module of the same name with that function, the fast one is
used: it gives the same result in less time.
"""

from collections.abc import Callable
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from hdrlab.core.choices import require_choice

# The function that each method of a chapter defines.
VERBS = {"align": "align", "response": "recover", "tonemap": "tonemap"}


def names(chapter: str) -> list[str]:
    """Return the names of a chapter's methods, in alphabetical order."""
    return list(_find_methods(chapter))


@cache
def _find_methods(chapter: str) -> tuple[str, ...]:
    """Return the names of the files of a chapter that define its function.

    A new method is one new file: it is found here, by its function's definition. The files are read
    as text, not imported, so that the command line can offer the methods without loading them.
    """
    folder = Path(__file__).parents[1] / chapter
    definition = f"\ndef {VERBS[chapter]}("
    return tuple(
        sorted(
            path.stem
            for path in folder.glob("*.py")
            if definition in path.read_text(encoding="utf8")
        )
    )


def method(chapter: str, name: str | Callable[..., Any]) -> Callable[..., Any]:
    """Return the function of a chapter's method, the fast one where there is one.

    Your own function is returned as it is.

    Raises
    ------
    InputError
        If the chapter has no method of this name; the message lists those that it has.

    Examples
    --------
    >>> method("response", "linear").__module__
    'hdrlab.response.linear'
    """
    if callable(name):
        return name
    require_choice(f"method of {chapter}", name, names(chapter))
    verb = VERBS[chapter]
    if find_spec(f"hdrlab.fast.{name}"):
        fast_module = import_module(f"hdrlab.fast.{name}")
        if hasattr(fast_module, verb):
            return getattr(fast_module, verb)
    return getattr(import_module(f"hdrlab.{chapter}.{name}"), verb)
