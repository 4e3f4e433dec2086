"""A Dask cluster on this machine, started as an instructor would: a scheduler, and workers of one thread."""

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

from benchmarks.experiments import Skipped, one_thread
from benchmarks.measure import ROOT

READY = 60.0  # seconds for a cluster to be there


@contextmanager
def cluster(folder: Path, number: int) -> Iterator[tuple[str, list[int]]]:
    """Yield the address of a cluster of so many workers, and its processes' numbers.

    Raises
    ------
    Skipped
        Where Dask is not installed.
    RuntimeError
        Where the workers do not come.
    """
    if find_spec("distributed") is None:
        raise Skipped('no distributed: pip install "hdrlab[cluster]"')
    folder.mkdir(parents=True)
    file = folder / "scheduler.json"
    arguments = ["--scheduler-file", str(file), "--no-dashboard"]
    with one_thread():
        scheduler = _started("dask_scheduler", *arguments, "--host", "127.0.0.1", "--port", "0")
        started = [scheduler]
        try:
            _wait(file.exists)
            options = ("--nthreads", "1", "--host", "127.0.0.1", "--local-directory", str(folder))
            started += [_started("dask_worker", *arguments, *options) for _ in range(number)]
            yield _address(file, number), [worker.pid for worker in started]
        finally:
            for worker in reversed(started):
                worker.terminate()
            for worker in started:
                worker.wait()


def _started(name: str, *words: str) -> "subprocess.Popen[bytes]":
    command = [sys.executable, "-m", f"distributed.cli.{name}", *words]
    return subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def _address(file: Path, number: int) -> str:
    """Return the address of the scheduler, when its workers are there."""
    from distributed import Client

    with Client(scheduler_file=str(file), set_as_default=False) as client:
        client.wait_for_workers(number, timeout=READY)
        return str(client.scheduler.address)


def _wait(there: Callable[[], bool]) -> None:
    end = time.monotonic() + READY
    while not there():
        if time.monotonic() > end:
            raise RuntimeError("the cluster's scheduler did not start")
        time.sleep(0.05)
