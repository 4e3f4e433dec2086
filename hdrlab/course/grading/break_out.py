"""A harmless attempt to break out of a sandbox, which `doctor` runs inside each tier as text."""

import ctypes
import os


def break_out(secret, target):
    """Return which forbidden things were possible.

    The calls go to the C library, past the checks that Python itself makes.

    Parameters
    ----------
    secret : path of a file of the grader, as bytes
    target : path of a file to write, as bytes
    """
    libc = ctypes.CDLL(None)
    done = []
    if libc.open(secret, os.O_RDONLY) >= 0:
        done.append("a file of the grader could be read")
    if libc.open(target, os.O_WRONLY | os.O_CREAT, 0o600) >= 0:
        done.append("a file could be written")
    libc.unlink(target)
    internet = 2
    stream = 1
    if libc.socket(internet, stream, 0) >= 0:
        done.append("a socket could be made")
    child = libc.fork()
    if child == 0:
        os._exit(0)
    if child > 0:
        done.append("a process could be started")
    return done
