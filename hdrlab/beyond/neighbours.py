"""Frames with those before and after them, one at a time: a film need not fit into memory."""

from collections import deque
from collections.abc import Iterable, Iterator
from typing import TypeVar

Item = TypeVar("Item")


def slide_windows(items: Iterable[Item], span: int) -> Iterator[tuple[int, tuple[Item, ...]]]:
    """Yield of each item its place in the window, and the window: up to `span` items on either side.

    Only 2 span + 1 items are held, and each window is yielded as soon as its last item is there.

    Examples
    --------
    >>> list(slide_windows("abc", 1))
    [(0, ('a', 'b')), (1, ('a', 'b', 'c')), (1, ('b', 'c'))]
    """
    held: deque[Item] = deque()
    place = 0  # in `held`, of the next item to be yielded
    for item in items:
        held.append(item)
        if len(held) - place > span:
            yield place, tuple(held)
            place += 1
            if place > span:
                held.popleft()
                place -= 1
    while place < len(held):
        yield place, tuple(held)
        place += 1
        if place > span:
            held.popleft()
            place -= 1
