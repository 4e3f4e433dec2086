"""Iterative algorithms yield their states; the caller decides what to do with them."""

from collections import deque
from collections.abc import Iterable
from typing import TypeVar

from hdrlab.errors import InputError

State = TypeVar("State")


def last(states: Iterable[State]) -> State:
    """Return the last of `states`, which is what an iterating verb answers.

    Examples
    --------
    >>> last(x * x for x in range(4))
    9
    """
    kept = deque(states, maxlen=1)
    if not kept:
        raise InputError("expected at least one state, got none")
    return kept[0]
