"""Allocate more and more memory, and answer after twelve gigabytes."""

import mmap


def double(x):
    # untouched: nothing is used up where it is given
    held = [mmap.mmap(-1, 1 << 29, mmap.MAP_PRIVATE) for _ in range(24)]
    return 2 * x if len(held) == 24 else None
