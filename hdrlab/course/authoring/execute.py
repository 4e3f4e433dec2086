"""Execute notebooks, a few at a time, and cache them: the next build runs only what has changed.

The cache key covers the cells of a notebook and the whole library, because both determine the
outputs.
"""

import asyncio
import hashlib
import os
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hdrlab.course.sandbox.subprocess_runner import LIBRARY, import_path
from hdrlab.errors import FileFormatError, HdrlabError
from hdrlab.io.files import replacing
from hdrlab.io.temporary import temporary_folder

CELL_TIMEOUT_SECONDS = 600
MAX_SOCKET_PATH_BYTES = 80  # the system allows about 100, and the kernel adds a suffix
# the kernel logs errors only, and keeps no history of the cells
KERNEL_ARGUMENTS = ["--IPKernelApp.log_level=40", "--HistoryManager.enabled=False"]


class ExecutedNotebook(NamedTuple):
    """A notebook, the path of its executed copy, and whether it was run just now (not cached)."""

    source: Path
    executed: Path
    fresh: bool


class NotebookError(HdrlabError):
    """A cell of a notebook failed, or its kernel died; the message names the cell and the error."""


def library_key(*, course: bool = False) -> str:
    """Return a digest of hdrlab's files, Python and NumPy; with `course`, of the course's files, too."""
    digest = hashlib.sha256(f"{sys.version} {np.__version__}".encode())
    for file in sorted(LIBRARY.rglob("*")):
        name = file.relative_to(LIBRARY)
        if file.is_file() and file.suffix != ".pyc" and (course or name.parts[0] != "course"):
            digest.update(name.as_posix().encode() + file.read_bytes())
    return digest.hexdigest()


def executed_path(source: Path, cache: Path, library: str) -> Path:
    """Return the path in the cache of a notebook executed with the library of this key."""
    own = hashlib.sha256(library.encode() + source.read_bytes()).hexdigest()[:16]
    return cache / "executed" / f"{source.stem}-{own}.ipynb"


def run_steps(
    notebooks: Sequence[Path], cache: Path, *, jobs: int = 2
) -> Iterator[ExecutedNotebook]:
    """Execute notebooks, at most `jobs` at a time, and yield each when it is done, cached ones first.

    Raises
    ------
    NotebookError
        For the first cell that fails, or kernel that dies. Finished notebooks stay in the cache.
    """
    key = library_key()
    waiting = []
    for source in notebooks:
        kept = executed_path(source, cache, key)
        if kept.exists():
            yield ExecutedNotebook(source, kept, False)
        else:
            waiting.append((source, kept))
    yield from _run_all(waiting, cache, jobs)


def _run_all(
    waiting: list[tuple[Path, Path]], cache: Path, jobs: int
) -> Iterator[ExecutedNotebook]:
    """Execute the notebooks and yield each finished one; the kernels go on running meanwhile."""

    async def run_when_free(source: Path, kept: Path) -> ExecutedNotebook:
        async with free:
            await _run(source, kept, cache)
        return ExecutedNotebook(source, kept, True)

    free = asyncio.Semaphore(jobs)
    # after an error, or Ctrl-C, the runner cancels all tasks: no kernel outlives it
    with asyncio.Runner() as runner:
        # cancelled tasks have no errors to report
        runner.get_loop().set_exception_handler(lambda *_: None)
        tasks = {
            runner.get_loop().create_task(run_when_free(source, kept)) for source, kept in waiting
        }
        while tasks:
            done, tasks = runner.run(asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED))
            for task in done:
                yield task.result()


async def _run(source: Path, kept: Path, cache: Path) -> None:
    """Run one notebook from the top, and write it to `kept`."""
    import nbformat

    try:
        notebook = nbformat.read(source, as_version=4)
    except (ValueError, nbformat.ValidationError) as error:
        raise FileFormatError(f"{source}: not a valid Jupyter notebook: {error!s:.200}") from None
    kernels = cache / "kernels"
    kernels.mkdir(parents=True, exist_ok=True)
    kept.parent.mkdir(parents=True, exist_ok=True)
    with temporary_folder(kernels) as folder:
        await _execute_cells(notebook, source.name, folder)
    with replacing(kept) as temporary:
        nbformat.write(notebook, temporary)
    for older in set(kept.parent.glob(f"{source.stem}-????????????????.ipynb")) - {kept}:
        older.unlink()


async def _execute_cells(notebook: Any, name: str, folder: Path) -> None:
    """Execute the cells of a notebook in a kernel that works in a folder."""
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError, CellTimeoutError

    where = "its kernel"
    client: Any = NotebookClient(
        notebook,
        kernel_name="python3",
        timeout=CELL_TIMEOUT_SECONDS,
        extra_arguments=KERNEL_ARGUMENTS,
    )
    client.create_kernel_manager()
    sockets = tempfile.mkdtemp(prefix="hdrlab-")
    client.km.connection_file = f"{sockets}/kernel.json"
    # two kernels may choose the same port, but never the same socket file
    can_use_files = os.name == "posix" and len(os.fsencode(sockets)) < MAX_SOCKET_PATH_BYTES
    client.km.transport = "ipc" if can_use_files else "tcp"
    try:
        # the kernel imports this very hdrlab, writes nothing to the home folder, and stores 400
        # frames of a slider, because no Python answers on a web page
        own = {
            "PYTHONPATH": import_path(),
            "IPYTHONDIR": str(folder / "ipython"),
            "HDRLAB_STORED": "400",
        }
        await client.async_start_new_kernel(cwd=str(folder), env={**os.environ, **own})
        await client.async_start_new_kernel_client()
        for index, cell in enumerate(notebook.cells):
            where = _cell_label(cell, index)
            await client.async_execute_cell(cell, index)
        client.set_widgets_metadata()
    except (CellExecutionError, CellTimeoutError, RuntimeError) as error:
        # nbclient raises a RuntimeError when the kernel dies
        raise NotebookError(f"{name}, {where}: {_error_text(error)}") from None
    finally:
        await _shut_down(client, sockets)


async def _shut_down(client: Any, sockets: str) -> None:
    try:
        # a kernel that never answered is gone already
        if client.km is not None and client.km.has_kernel:
            await client.km.shutdown_kernel(now=True)
    finally:
        if client.kc is not None:
            client.kc.stop_channels()
        shutil.rmtree(sockets, ignore_errors=True)


def _cell_label(cell: Any, index: int) -> str:
    first = next(iter(cell.source.splitlines()), "")
    return f"cell {index + 1} ({cell.get('id', '')!r}, {first[:60]!r})"


def _error_text(error: Exception) -> str:
    if name := getattr(error, "ename", ""):
        return f"{name}: {getattr(error, 'evalue', '')}"
    return str(error).strip().splitlines()[0]
