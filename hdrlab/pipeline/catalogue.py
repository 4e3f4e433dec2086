"""Which methods there are: a method is a module of its chapter that has the chapter's verb.

So a new operator is one new file, and everything that offers a choice finds it there. Where `fast`
has the same verb in a module of the same name, that one runs: its answer is the same, sooner.
"""

from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from hdrlab.errors import InputError

VERBS = {"align": "align", "response": "recover", "tonemap": "tonemap"}


def names(chapter: str) -> list[str]:
    """Return the names of a chapter's methods, sorted; the modules are read as text, not imported."""
    folder, verb = Path(__file__).parents[1] / chapter, f"\ndef {VERBS[chapter]}("
    return sorted(
        file.stem for file in folder.glob("*.py") if verb in file.read_text(encoding="utf8")
    )


def method(chapter: str, name: str | Callable[..., Any]) -> Callable[..., Any]:
    """Return the verb of a chapter's method, the fast one where there is one.

    A function is taken as it is, so that a reader's own plugs in.

    Raises
    ------
    ValueError
        For a name that the chapter does not have; it lists those that it has.

    Examples
    --------
    >>> method("response", "linear").__module__
    'hdrlab.response.linear'
    """
    if callable(name):
        return name
    if name not in names(chapter):
        raise InputError(
            f"expected a method of {chapter} out of {', '.join(names(chapter))}, got {name!r}"
        )
    fast = find_spec(f"hdrlab.fast.{name}") and import_module(f"hdrlab.fast.{name}")
    own = getattr(fast, VERBS[chapter], None) if fast else None
    return own or getattr(import_module(f"hdrlab.{chapter}.{name}"), VERBS[chapter])
