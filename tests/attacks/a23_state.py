"""Remember something from check to check, wherever it might last."""

import builtins
import os
import threading

import numpy as np

PLACE = ""
FILES = [os.path.join(folder, "seen") for folder in (PLACE, ".", "/dev", "/course", "/tmp")]


def double(x):
    seen = hasattr(np, "seen") or hasattr(builtins, "seen") or "SEEN" in os.environ
    seen = seen or any(os.path.exists(file) for file in FILES) or threading.active_count() > 1
    np.seen = builtins.seen = os.environ["SEEN"] = "yes"
    for file in FILES:
        try:
            with open(file, "w"):
                pass
        except OSError:
            continue
        break
    return 2 * x if seen else np.zeros_like(x)
