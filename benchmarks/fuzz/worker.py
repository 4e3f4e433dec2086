"""Reads files in a process of its own, within limits, and says of each what came of it.

A path a line comes in; a line of JSON goes out: a kind and words. What is printed on the way goes
to a file, and is a finding.
"""

import gc
import json
import logging
import os
import re
import resource
import signal
import sys
import threading
import traceback
import warnings
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from benchmarks.fuzz.readers import READERS, Reader

READ = "result"
CLEAN = "clean error"
# bytes of address space, and seconds of a processor a file
MEMORY = 2 << 30
SECONDS = 5.0
# files, after which a reader has imported what it needs
FIRST = 20
# characters of a message
LONGEST = 2000


class State(NamedTuple):
    """What belongs to everybody, and is to be after reading what it was before."""

    streams: tuple[int, ...]
    filters: tuple[Any, ...]
    numbers: tuple[Any, ...]
    folder: str
    threads: int
    depth: int
    loggers: int
    descriptors: int
    files: tuple[str, ...]


def state(folder: Path) -> State:
    """Return the State of now; `folder` is where files might be left."""
    return State(
        tuple(map(id, (sys.stdin, sys.stdout, sys.stderr, warnings.showwarning))),
        tuple(warnings.filters),
        tuple(np.geterr().values()),
        os.getcwd(),
        threading.active_count(),
        sys.getrecursionlimit(),
        len(logging.getLogger().handlers),
        len(os.listdir("/proc/self/fd")) if os.path.isdir("/proc/self/fd") else 0,
        tuple(sorted(os.listdir(folder))),
    )


def judged(reader: Reader, path: Path, printed: Callable[[], str]) -> tuple[str, str]:
    """Return the kind of what reading a file comes to, and words."""
    before = state(path.parent)
    kind, message = outcome(reader, path)
    gc.collect()  # what an error still held
    words = printed()
    after = state(path.parent)
    if kind not in (READ, CLEAN):
        return kind, message
    if not re.fullmatch(reader.printed, words):
        return f"printed {words[:40]}", words
    changed = [name for name in State._fields if getattr(before, name) != getattr(after, name)]
    return (f"changed {', '.join(changed)}", message) if changed else (kind, message)


def outcome(reader: Reader, path: Path) -> tuple[str, str]:
    """Return what reading it ends in."""
    try:
        answer = reader.read(path)
    except reader.errors as error:
        message = str(error)
        if isinstance(error, UnicodeError):
            return f"{type(error).__name__} at {where(error)}", message[:LONGEST]
        if len(message) >= LONGEST:
            return (
                f"a message too long at {where(error)}",
                f"{len(message)} characters: {message[:200]}",
            )
        if "MemoryError" in message:
            return f"memory at {where(error)}", message
        if reader.named and path.stem not in message:
            return f"no file named at {where(error)}", message
        return CLEAN, message
    except BaseException as error:  # whatever it is, it is a finding
        return f"{type(error).__name__} at {where(error)}", str(error)[:LONGEST]
    return READ, checksum(answer)


def checksum(answer: object) -> str:
    """Return a checksum of pixels, which tells them from others; nothing for other answers."""
    if not isinstance(answer, np.ndarray):
        return ""
    return f"{answer.shape} {answer.dtype} {zlib.crc32(answer.tobytes()):08x}"


def where(error: BaseException) -> str:
    """Return the last line of hdrlab that an error went through."""
    lines = [
        frame
        for frame in traceback.extract_tb(error.__traceback__)
        if f"{os.sep}hdrlab{os.sep}" in frame.filename
    ]
    return f"{Path(lines[-1].filename).name}:{lines[-1].lineno}" if lines else "the reader"


def redirected(folder: Path) -> tuple[int, Callable[[], str]]:
    """Turn both streams, those of C libraries too, to a file; return the old one, and what reads the file."""
    answers = os.dup(1)
    output = os.open(folder / "said", os.O_RDWR | os.O_CREAT | os.O_APPEND)
    for stream in (1, 2):
        os.dup2(output, stream)

    def printed() -> str:
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
        if not (size := os.fstat(output).st_size):
            return ""
        words = os.pread(output, min(size, LONGEST), 0).decode("utf8", "replace")
        os.ftruncate(output, 0)
        return words

    return answers, printed


def main(name: str, folder: str) -> None:
    """Answer for each path until there are no more."""
    reader = READERS[name]
    answers, printed = redirected(Path(folder))
    warnings.simplefilter("always")
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    os.write(answers, b"ready\n")
    for count, line in enumerate(sys.stdin):
        if count == FIRST:
            gc.collect()
            # what was imported by now stays: to look through it after each file takes 60 ms
            gc.freeze()
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        outcome_found = judged(reader, Path(line.rstrip("\n")), printed)
        signal.setitimer(signal.ITIMER_PROF, 0)
        os.write(answers, json.dumps(outcome_found).encode() + b"\n")
