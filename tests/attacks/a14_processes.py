"""Start processes that start more processes; here, forty that sleep."""

import ctypes
import os
import time

libc = ctypes.CDLL(None)


def double(x):
    for _ in range(40):
        child = libc.fork()
        if child == 0:
            time.sleep(0.5)
            os._exit(0)
        if child < 0:
            raise PermissionError("no process could be started")
    return 2 * x
