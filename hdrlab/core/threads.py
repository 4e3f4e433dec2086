"""Work in threads, one for each processor at hand, at most four: NumPy lets others compute while it does."""

import os
from collections import deque
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from contextvars import copy_context
from typing import Any, TypeVar

Answer = TypeVar("Answer")

# of a picture: with fewer, threads cost what they gain
PIXELS = 1 << 22
PROCESSORS = (
    len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
)
# each may hold a photograph in memory
THREADS = min(PROCESSORS, 4)


def beside(work: Callable[[], Answer], *, pixels: int = PIXELS) -> Callable[[], Answer]:
    """Return a function that waits for work(), which begins now; it is `work` itself where no thread helps.

    Examples
    --------
    >>> answer = beside(lambda: 6 * 7)
    >>> answer()
    42
    """
    if THREADS == 1 or pixels < PIXELS:
        return work
    pool = ThreadPoolExecutor(1)
    begun = pool.submit(copy_context().run, work)
    pool.shutdown(wait=False)
    return begun.result


def each(
    work: Callable[[Any], Answer], items: Iterable[Any], *, pixels: int = PIXELS
) -> Generator[Answer]:
    """Yield work(item) of every item, in their order, with no threads where all are of fewer than PIXELS.

    A thread of its own has a memory pool of its own, which is slower: with one processor there is
    none.

    Examples
    --------
    >>> list(each(abs, [-3, 1, -2]))
    [3, 1, 2]
    """
    if THREADS == 1 or pixels < PIXELS:
        yield from map(work, items)
        return
    begun: deque[Future[Answer]] = deque()
    pool = ThreadPoolExecutor(THREADS)
    try:
        for item in items:
            begun.append(
                pool.submit(copy_context().run, work, item)
            )  # np.errstate is the context's
            if len(begun) > THREADS:
                yield begun.popleft().result()
        while begun:
            yield begun.popleft().result()
    finally:
        pool.shutdown(cancel_futures=True)
