"""Radiance files: written and read, the bytes in the operating system's memory."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from benchmarks import data, peers
from benchmarks.rows import OURS, Case, Row, Run, close, faster
from hdrlab.core.arrays import Array
from hdrlab.io.files import replacing, reserve
from hdrlab.io.maps import exr, pfm, rgbe

Peer = Callable[[Path, Array, bool], Run]


def reading(
    form: ModuleType, peer: str, make: Peer, suffix: str, folder: Path, one_thread: bool
) -> Case:
    """Return the work of reading what hdrlab wrote; the error is against what the peer reads."""
    E = data.scene(folder)
    path = folder / f"read{suffix}"
    form.write(path, E)
    theirs, missing = peers.present({peer: lambda: make(path, E, one_thread)})
    same = upright(peer, theirs[peer]()) if theirs else None

    def error(who: str, result: Any) -> float | None:
        return None if same is None else float(np.abs(upright(who, result) - same).max())

    return Case({OURS: lambda: form.read(path)} | theirs, missing, error, least=path.read_bytes)


def writing(
    form: ModuleType, peer: str, make: Peer, suffix: str, folder: Path, one_thread: bool
) -> Case:
    """Return the work of writing; the error is the size of the file, against the peer's."""
    E = data.scene(folder)
    paths = {who: folder / f"write-{who}{suffix}" for who in (OURS, peer)}
    theirs, missing = peers.present({peer: lambda: make(paths[peer], E, one_thread)})
    for run in theirs.values():
        run()

    def error(who: str, result: Any) -> float | None:
        return abs(paths[who].stat().st_size / paths[peer].stat().st_size - 1) if theirs else None

    form.write(paths[OURS], E)
    least = partial(at_least, folder / f"least{suffix}", paths[OURS].read_bytes())
    return Case({OURS: lambda: form.write(paths[OURS], E)} | theirs, missing, error, least=least)


def at_least(path: Path, content: bytes) -> None:
    """Write bytes by one call as a new file that takes the old one's place: whole or not at all."""
    with replacing(path) as name, open(name, "wb") as file:
        reserve(file, len(content))
        file.write(content)


def upright(who: str, E: Array) -> Array:
    """Return RGB from what a reader gives."""
    return E[..., ::-1] if who == peers.OPENCV else E


def opencv_read(path: Path, E: Array, one_thread: bool) -> Run:
    """Return imread."""
    cv2 = peers.opencv(one_thread)
    return lambda: cv2.imread(str(path), cv2.IMREAD_UNCHANGED)


def opencv_write(path: Path, E: Array, one_thread: bool) -> Run:
    """Return imwrite."""
    cv2 = peers.opencv(one_thread)
    bgr = np.ascontiguousarray(E[..., ::-1])
    return lambda: cv2.imwrite(str(path), bgr)


def openexr_read(path: Path, E: Array, one_thread: bool) -> Run:
    """Return OpenEXR's own reader."""
    module = peers.openexr()

    def run() -> Array:
        with module.File(str(path)) as file:
            return np.asarray(file.channels()["RGB"].pixels)

    return run


def openexr_write(path: Path, E: Array, one_thread: bool) -> Run:
    """Return OpenEXR's own writer, with the compression that hdrlab takes."""
    module = peers.openexr()
    header = {"compression": module.ZIP_COMPRESSION, "type": module.scanlineimage}

    def run() -> None:
        with module.File(header, {"RGB": E}) as file:
            file.write(str(path))

    return run


Limits = tuple[float, float | None]  # hold and goal
FORMATS: dict[str, tuple[ModuleType, str, Peer, Peer, Limits, Limits]] = {
    "hdr": (rgbe, peers.OPENCV, opencv_read, opencv_write, (1.1, 1.5), (0.85, 1.2)),
    "pfm": (pfm, peers.OPENCV, opencv_read, opencv_write, (15, None), (4, None)),
    "exr": (exr, peers.OPENEXR, openexr_read, openexr_write, (1 / 1.1, None), (1 / 1.1, None)),
}


def rows() -> tuple[Row, ...]:
    """Return a row for reading and one for writing each format."""
    made = []
    for name, (form, peer, read, write, reads, writes) in FORMATS.items():
        made.append(
            Row(
                f"{name}-read",
                f".{name} read",
                partial(reading, form, peer, read, f".{name}"),
                (faster(*reads), close(0, "from what the peer reads")),
                "largest difference from the peer",
            )
        )
        made.append(
            Row(
                f"{name}-write",
                f".{name} written",
                partial(writing, form, peer, write, f".{name}"),
                (faster(*writes), close(0.01, "of size from the peer's file")),
                "size, against the peer's file",
            )
        )
    return tuple(made)


ROWS = rows()
