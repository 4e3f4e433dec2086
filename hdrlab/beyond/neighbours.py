"""Frames with those before and after them, one at a time: a film need not fit into memory."""

from collections import deque
from collections.abc import Iterable, Iterator
from itertools import chain, repeat
from typing import Any, TypeVar

Item = TypeVar("Item")


def slide_windows(items: Iterable[Item], span: int) -> Iterator[tuple[int, tuple[Item, ...]]]:
    """Yield of each item its place in the window, and the window: up to `span` items on either side.

    Only 2 span + 1 items are held, and each window is yielded as soon as its last item is there.

    Examples
    --------
    >>> list(slide_windows("abc", 1))
    [(0, ('a', 'b')), (1, ('a', 'b', 'c')), (1, ('b', 'c'))]
    """
    blank: Any = object()
    window = deque([blank] * (2 * span + 1), maxlen=2 * span + 1)  # whose middle is the item
    for item in chain(items, repeat(blank, span)):
        window.append(item)
        if window[span] is not blank:
            before = sum(one is not blank for one in list(window)[:span])
            yield before, tuple(one for one in window if one is not blank)
