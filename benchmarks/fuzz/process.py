"""The process in which files are read, as its parent sees it: it is started again when it is dead."""

import contextlib
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any, NamedTuple

from benchmarks.fuzz.readers import Reader
from benchmarks.measure import ROOT, THREADS

# by the clock, of a file whose reader waits for something; a busy one is ended after 5 s of a
# processor
PATIENCE = 60.0


class Verdict(NamedTuple):
    """What became of a file: its kind, which is the same for what goes wrong at the same place, and words."""

    kind: str
    said: str = ""


class Process:
    """A worker that judges files of one reader."""

    def __init__(self, reader: Reader) -> None:
        self.reader = reader
        self.folder = tempfile.TemporaryDirectory(prefix="hdrlab-fuzz-")
        self.child: subprocess.Popen[str] | None = None

    def __enter__(self) -> "Process":
        return self

    def __exit__(self, *_: object) -> None:
        self._end()
        self.folder.cleanup()

    def judge(self, data: bytes) -> Verdict:
        """Return what became of a file of these bytes."""
        path = Path(self.folder.name, f"fuzzed{self.reader.suffix}")
        path.write_bytes(data)
        if self.child is None:
            self.child = self._started()
        child = self.child
        requests, answers = _pipes(child)
        with contextlib.suppress(BrokenPipeError):  # the child has died, which is noticed below
            requests.write(f"{path}\n")
            requests.flush()
        if not select.select([answers], [], [], PATIENCE)[0]:
            self._end()
            return Verdict("hang", f"no answer in {PATIENCE:.0f} s")
        answer = answers.readline()
        if answer:
            return Verdict(*json.loads(answer))
        code = child.wait()
        self._end()
        if code == -signal.SIGPROF:
            return Verdict("slow", "more than 5 s of a processor")
        return Verdict("crash", f"the process ended with {code}")

    def alike(self, kind: str) -> Callable[[bytes], bool]:
        """Return what says of a file whether the same becomes of it."""
        return lambda data: self.judge(data).kind == kind

    def _started(self) -> "subprocess.Popen[str]":
        env: dict[str, str] = {**os.environ, **dict.fromkeys(THREADS, "1")}
        start = "import sys; from benchmarks.fuzz import worker; worker.main(*sys.argv[1:])"
        command = [sys.executable, "-c", start, self.reader.name, self.folder.name]
        pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        child = subprocess.Popen(command, cwd=ROOT, env=env, **pipes)
        if _pipes(child)[1].readline() != "ready\n":
            raise RuntimeError(f"the process that reads {self.reader.name} does not start")
        return child

    def _end(self) -> None:
        if self.child is not None:
            self.child.kill()
            for pipe in _pipes(self.child):
                with contextlib.suppress(BrokenPipeError):
                    pipe.close()
            self.child.wait()
            self.child = None


def _pipes(child: "subprocess.Popen[str]") -> tuple[IO[str], IO[str]]:
    assert child.stdin is not None and child.stdout is not None
    return child.stdin, child.stdout
