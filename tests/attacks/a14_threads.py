"""Start threads without an end."""

import threading
import time


def double(x):
    for _ in range(500):
        threading.Thread(target=time.sleep, args=(0.5,), daemon=True).start()
    return 2 * x
