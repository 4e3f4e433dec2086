"""Start a message and end the process in the middle of it."""

import os
import stat


def double(x):
    for descriptor in range(64):
        try:
            if stat.S_ISSOCK(os.fstat(descriptor).st_mode) or descriptor == 1:
                os.write(descriptor, b"PASS\nPASS\n" if descriptor == 1 else b"\x00\x00\x01\x00{")
        except OSError:
            continue
    os._exit(0)
