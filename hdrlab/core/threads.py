"""Run work in threads: one for each processor, at most four.

NumPy releases the interpreter's lock while it computes, so threads are enough.
"""

import os
from collections import deque
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from contextvars import copy_context
from typing import Any, Generic, TypeVar

Answer = TypeVar("Answer")

# For images with fewer pixels, threads cost as much time as they save.
MIN_PIXELS_FOR_THREAD = 1 << 22
PROCESSORS = (
    len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
)
# At most four, because each thread may hold a photo in memory.
THREADS = min(PROCESSORS, 4)


class DeferredTask(Generic[Answer]):
    """A call that result() makes, in the calling thread."""

    def __init__(self, work: Callable[[], Answer]) -> None:
        self._work = work

    def result(self) -> Answer:
        """Make the call and return its result."""
        return self._work()


Task = Future[Answer] | DeferredTask[Answer]


def run_in_background(
    work: Callable[[], Answer], *, pixels: int = MIN_PIXELS_FOR_THREAD
) -> Task[Answer]:
    """Start work() in a thread and return a task, whose result() waits for it.

    With one processor, or fewer than MIN_PIXELS_FOR_THREAD pixels, a thread would not help. Then
    work() runs when result() is called.

    Examples
    --------
    >>> task = run_in_background(lambda: 6 * 7)
    >>> task.result()
    42
    """
    if THREADS == 1 or pixels < MIN_PIXELS_FOR_THREAD:
        return DeferredTask(work)
    pool = ThreadPoolExecutor(1)
    task = pool.submit(copy_context().run, work)
    pool.shutdown(wait=False)
    return task


def map_in_threads(
    work: Callable[[Any], Answer], items: Iterable[Any], *, pixels: int = MIN_PIXELS_FOR_THREAD
) -> Generator[Answer]:
    """Yield work(item) for each item, in order, computed in threads a few items ahead.

    With one processor, or fewer than MIN_PIXELS_FOR_THREAD pixels, no thread is started: each thread
    has its own memory pool, which is slower.

    Examples
    --------
    >>> list(map_in_threads(abs, [-3, 1, -2]))
    [3, 1, 2]
    """
    if THREADS == 1 or pixels < MIN_PIXELS_FOR_THREAD:
        yield from map(work, items)
        return
    tasks: deque[Future[Answer]] = deque()
    pool = ThreadPoolExecutor(THREADS)
    # Python may collect an abandoned generator anywhere, even while another thread starts. To wait
    # for threads there could wait forever.
    waits_for_threads = True
    try:
        for item in items:
            # np.errstate belongs to the context, so each thread gets a copy of it.
            tasks.append(pool.submit(copy_context().run, work, item))
            if len(tasks) > THREADS:
                yield tasks.popleft().result()
        while tasks:
            yield tasks.popleft().result()
    except GeneratorExit:
        waits_for_threads = False
        raise
    finally:
        pool.shutdown(wait=waits_for_threads, cancel_futures=True)
