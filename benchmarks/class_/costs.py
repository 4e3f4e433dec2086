"""What one submission costs at most: each that is made to cost much is a class of its own, and is graded.

All tasks of the homework are hostile in the same way, so that whatever is done for one task is done
for all. The seconds are those of `hdrlab grade`, with its own start, the reading, all checks, the
feedback and what is alike; a submission that waits is charged by the clock, and one that computes
by the processor.
"""

import bz2
import io
import os
import tarfile
from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import NamedTuple

from benchmarks.class_ import handed
from benchmarks.class_.grading import Used, grade
from benchmarks.class_.handed import Handed
from hdrlab.course import plan

HEAD = "import os, time, threading, hashlib\nimport numpy as np\n"
# bytes that an archive for reading unpacks to: it takes nearly all the seconds that reading has
SLOW = 24_000_000
CODE = {  # the body of each task
    "waits": "time.sleep(9.5)",
    "waits and ends": "time.sleep(9.5); os._exit(0)",
    "computes": "while True: pass",
    "computes nearly as long as it may": "while time.process_time() < 9: pass",
    "computes in threads": (
        "work = lambda: [hashlib.sha256(bytes(1 << 20)).digest() for _ in range(10**6)]; "
        "[threading.Thread(target=work).start() for _ in range(8)]; work()"
    ),
    "prints without end": "while True: print('\\u0301' * 10_000)",
    "the largest array": "return np.random.default_rng(0).random(1 << 23)",
    "arrays in lists": "return [np.zeros(1)] * 8_000",
    "as many values as travel": "return [[[k]] for k in range(5_000)]",
    "a text of a megabyte": "raise ValueError('a\\u0301' * 300_000)",
    "states without end": "while True: yield np.zeros((512, 512))",
    "fills the memory": "return [bytes(1 << 28) for _ in range(64)]",
    "ends its process": "os._exit(0)",
    "calls itself": "return given and np.vectorize(lambda x: sum(range(10**7)))(np.zeros(10**6))",
}


class Costly(NamedTuple):
    """A submission that is to cost much: its kind, which one, how its file's name ends, its bytes."""

    kind: str
    which: str
    ending: str
    data: Callable[[], bytes]


def costly_submissions() -> Iterator[Costly]:
    """Yield all of them."""
    for name, body in CODE.items():
        yield Costly("code", name, ".py", partial(_source, body))
    yield Costly(
        "code", "computes at import", ".py", lambda: b"while True: x = 1\n" + _source("return x")
    )
    for name, (ending, made) in handed.tests("hostile_submissions").UNREADABLE_FILES.items():
        yield Costly("file", name, ending, made)
    yield Costly(
        "archive",
        "slow to unpack, then computes",
        ".tar.bz2",
        lambda: _archive(_source(CODE["computes"])),
    )
    yield Costly("archive", "too slow to unpack", ".tar.bz2", lambda: _archive(b"", 5 * SLOW))


def _source(body: str) -> bytes:
    tasks = [task.id for task in plan.read().homeworks["hw2"].tasks]
    return (
        HEAD + "".join(f"def {task}(*given, **named):\n    {body}\n" for task in tasks)
    ).encode()


@cache
def _archive(source: bytes, size: int = SLOW) -> bytes:
    """Return an archive of a Python file and of bytes that do not get smaller."""
    plain = io.BytesIO()
    with tarfile.open(fileobj=plain, mode="w") as archive:
        for name, data in (("hw2.py", source), ("photographs.raw", os.urandom(size))):
            info = tarfile.TarInfo(name)
            info.size = len(data)
            archive.addfile(info, io.BytesIO(data))
    return bz2.compress(plain.getvalue(), 1)


def cost(folder: Path, number: int) -> Used:
    """Return what it takes to grade a class of one submission alone, by its number in `each`."""
    kind, which, ending, data = list(costly_submissions())[number]
    made = Handed("s000", ("s000",), f"s000_hw2{ending}", data(), 0.0, kind, which)
    place = folder / str(number)
    return grade(handed.write(place / "class", [made]), place / "out", "--jobs", "1")
