"""Yield slowly and without an end."""

import time


def double(x):
    while True:
        yield x
        time.sleep(0.05)
