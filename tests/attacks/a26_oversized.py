"""Announce a message of four gigabytes, and an array of an exabyte in it."""

import json
import os
import stat
import struct


def double(x):
    label = {"name": "0", "dtype": "float64", "shape": [1 << 57], "bytes": 1 << 60}
    head = {
        "kind": "answer",
        "call": 1,
        "value": {"tuple": ["", {"array": "0"}]},
        "arrays": [label],
    }
    text = json.dumps(head).encode()
    for descriptor in range(64):
        try:
            if stat.S_ISSOCK(os.fstat(descriptor).st_mode) or descriptor == 1:
                os.write(
                    descriptor,
                    b"PASS\nPASS\n" if descriptor == 1 else struct.pack(">I", len(text)) + text,
                )
        except OSError:
            continue
    os.write(1, b"\xff\xff\xff\xff")
