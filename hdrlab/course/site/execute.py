"""Notebooks are run, a few at a time, and kept: the next build runs only what has changed.

What a notebook shows rests on its own cells and on the library, so both are in the key of what is
kept.
"""

import asyncio
import hashlib
import os
import secrets
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hdrlab.course.checks.running import LIBRARY, import_path
from hdrlab.errors import FileFormatError
from hdrlab.io.files import replacing

PATIENCE = 600  # seconds for a cell
# of errors alone a kernel tells, not of its own connections; and what was typed is kept in no
# history
QUIET = ["--IPKernelApp.log_level=40", "--HistoryManager.enabled=False"]


class Done(NamedTuple):
    """A notebook, where its executed copy is, and whether it was run just now."""

    source: Path
    executed: Path
    fresh: bool


class NotebookError(Exception):
    """A cell of a notebook failed, or its kernel; says which, and how."""


def library_key(*, course: bool = False) -> str:
    """Return a digest of the library's files and of Python; of the course's too, or not."""
    digest = hashlib.sha256(f"{sys.version} {np.__version__}".encode())
    for file in sorted(LIBRARY.rglob("*")):
        name = file.relative_to(LIBRARY)
        if file.is_file() and file.suffix != ".pyc" and (course or name.parts[0] != "course"):
            digest.update(name.as_posix().encode() + file.read_bytes())
    return digest.hexdigest()


def place(source: Path, cache: Path, library: str) -> Path:
    """Return where the executed copy of a notebook is kept, which ran on a library of that key."""
    own = hashlib.sha256(library.encode() + source.read_bytes()).hexdigest()[:16]
    return cache / "executed" / f"{source.stem}-{own}.ipynb"


def run_steps(notebooks: Sequence[Path], cache: Path, *, jobs: int = 2) -> Iterator[Done]:
    """Run notebooks, at most `jobs` at a time, and yield each when it is done; first those that are kept.

    Raises
    ------
    NotebookError
        For the first cell that fails, or kernel that dies. What has been run is kept nevertheless.
    """
    key = library_key()
    waiting = []
    for source in notebooks:
        kept = place(source, cache, key)
        if kept.exists():
            yield Done(source, kept, False)
        else:
            waiting.append((source, kept))
    yield from _run_all(waiting, cache, jobs)


def _run_all(waiting: list[tuple[Path, Path]], cache: Path, jobs: int) -> Iterator[Done]:
    """Yield what is done. The loop stands still between two of them: their kernels do not."""

    async def one(source: Path, kept: Path) -> Done:
        async with free:
            await _run(source, kept, cache)
        return Done(source, kept, True)

    free = asyncio.Semaphore(jobs)
    with (
        asyncio.Runner() as runner
    ):  # after an error, or Ctrl-C, it cancels what runs: no kernel outlives it
        # what was ended so has no more to tell
        runner.get_loop().set_exception_handler(lambda *_: None)
        tasks = {runner.get_loop().create_task(one(*each)) for each in waiting}
        while tasks:
            done, tasks = runner.run(asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED))
            for task in done:
                yield task.result()


async def _run(source: Path, kept: Path, cache: Path) -> None:
    """Run one notebook from the top, and write it to `kept`."""
    import nbformat
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError, CellTimeoutError

    try:
        notebook = nbformat.read(source, as_version=4)
    except (ValueError, nbformat.ValidationError) as error:
        raise FileFormatError(f"{source}: expected a Jupyter notebook, {error!s:.200}") from None
    where = "its kernel"
    # where a notebook may leave something
    folder = cache / "kernels" / f"{source.stem}-{secrets.token_hex(4)}"
    folder.mkdir(parents=True)
    kept.parent.mkdir(parents=True, exist_ok=True)
    client: Any = NotebookClient(
        notebook, kernel_name="python3", timeout=PATIENCE, extra_arguments=QUIET
    )
    client.create_kernel_manager()
    sockets = tempfile.mkdtemp(prefix="hdrlab-")
    client.km.connection_file = f"{sockets}/kernel.json"
    # of ports two kernels may choose the same, of files not; but a socket's path has room for 100
    # bytes alone
    client.km.transport = "ipc" if os.name == "posix" and len(os.fsencode(sockets)) < 80 else "tcp"
    try:
        # the kernel imports this very hdrlab, writes nothing at home, and stores 400 pictures of a
        # slider: no Python answers on a page
        own = {
            "PYTHONPATH": import_path(),
            "IPYTHONDIR": str(folder / "ipython"),
            "HDRLAB_STORED": "400",
        }
        await client.async_start_new_kernel(cwd=str(folder), env={**os.environ, **own})
        await client.async_start_new_kernel_client()
        for index, cell in enumerate(notebook.cells):
            where = _named(cell, index)
            await client.async_execute_cell(cell, index)
        client.set_widgets_metadata()
    except (
        CellExecutionError,
        CellTimeoutError,
        RuntimeError,
    ) as error:  # the last where a kernel dies
        raise NotebookError(f"{source.name}, {where}: {_said(error)}") from None
    finally:
        await _end(client, folder, sockets)
    with replacing(kept) as temporary:
        nbformat.write(notebook, temporary)
    for older in set(kept.parent.glob(f"{source.stem}-????????????????.ipynb")) - {kept}:
        older.unlink()


async def _end(client: Any, *folders: Path | str) -> None:
    try:
        # none is left of one that never answered
        if client.km is not None and client.km.has_kernel:
            await client.km.shutdown_kernel(now=True)
    finally:
        if client.kc is not None:
            client.kc.stop_channels()
        for folder in folders:
            shutil.rmtree(folder, ignore_errors=True)


def _named(cell: Any, index: int) -> str:
    first = next(iter(cell.source.splitlines()), "")
    return f"cell {index + 1} ({cell.get('id', '')!r}, {first[:60]!r})"


def _said(error: Exception) -> str:
    if name := getattr(error, "ename", ""):
        return f"{name}: {getattr(error, 'evalue', '')}"
    return str(error).strip().splitlines()[0]
