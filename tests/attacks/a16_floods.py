"""Print without an end, and write a file as large as possible."""

import os
import sys

PLACE = ""


def double(x):
    for _ in range(200):
        print("x" * 100_000)
        print("y" * 100_000, file=sys.stderr)
    for folder in (PLACE, ".", "/tmp", "/dev/shm", "/var/tmp"):
        try:
            with open(os.path.join(folder, "flood"), "wb") as file:
                file.write(bytes(1 << 22))
        except OSError:
            continue
        return 2 * x
    raise PermissionError("no place could be flooded")
