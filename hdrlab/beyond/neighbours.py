"""Sliding windows over the frames of a video, which need not fit into memory."""

from collections import deque
from collections.abc import Iterable, Iterator
from itertools import chain, repeat
from typing import Any, TypeVar

Item = TypeVar("Item")


def slide_windows(items: Iterable[Item], span: int) -> Iterator[tuple[int, tuple[Item, ...]]]:
    """Yield the place of each item in its window, and the window of up to `span` items on either side.

    Only 2 span + 1 items are kept, and each window is yielded as soon as its last item is there.

    Examples
    --------
    >>> list(slide_windows("abc", 1))
    [(0, ('a', 'b')), (1, ('a', 'b', 'c')), (1, ('b', 'c'))]
    """
    blank: Any = object()
    slots = deque([blank] * (2 * span + 1), maxlen=2 * span + 1)
    for next_item in chain(items, repeat(blank, span)):
        slots.append(next_item)
        if slots[span] is not blank:
            place = sum(item is not blank for item in list(slots)[:span])
            yield place, tuple(item for item in slots if item is not blank)
