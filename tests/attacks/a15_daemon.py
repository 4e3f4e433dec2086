"""Leave a process behind that has left its group and its parent, and that writes a file later."""

import os
import time

PLACE = ""


def double(x):
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            time.sleep(0.3)
            with open(os.path.join(PLACE, "daemon"), "w") as file:
                file.write("still here")
        os._exit(0)
    return 2 * x
