"""Temporary files and folders are removed when their process has ended, however it ended, and not
earlier.
"""

import errno
import os
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest

from hdrlab.io import files, temporary

WRITER = """
import sys, time
from pathlib import Path
from hdrlab.io import files, temporary
folder = Path(sys.argv[1])
with files.replacing(folder / "map.hdr") as name, temporary.temporary_folder(folder) as inside:
    name.write_text("half")
    (inside / "page.html").write_text("half")
    print("writing", flush=True)
    time.sleep(600)
"""
NEXT = """
import sys
from pathlib import Path
from hdrlab.io import files
files.write(Path(sys.argv[1]) / "other.txt", "whole")
"""

try:
    import fcntl
except ImportError:
    fcntl = None

needs_locks = pytest.mark.skipif(fcntl is None, reason="this system locks files in another way")
LEFTOVER = ".hdrlab-0123456789ab"


class WindowsFiles:
    """The module `os` as on Windows: an open file cannot be renamed, replaced or removed."""

    name = "nt"

    def __init__(self):
        self.open_files = {}

    def __getattr__(self, name):
        return getattr(os, name)

    def open(self, path, *arguments):
        handle = os.open(path, *arguments)
        self.open_files[handle] = str(path)
        return handle

    def close(self, handle):
        os.close(handle)
        del self.open_files[handle]

    def require_closed(self, path):
        if str(path) in self.open_files.values():
            raise PermissionError(errno.EACCES, "The process cannot access the file", str(path))

    def rename(self, source, target):
        self.require_closed(source)
        os.rename(source, target)

    def replace(self, source, target):
        self.require_closed(source)
        os.replace(source, target)


@pytest.fixture
def windows(monkeypatch):
    """hdrlab.io.temporary without fcntl, on a system that does not rename open files."""
    files_of_windows = WindowsFiles()
    monkeypatch.setattr(temporary, "fcntl", None)
    monkeypatch.setattr(temporary, "os", files_of_windows)
    return files_of_windows


def test_on_windows_a_file_is_replaced_and_no_file_stays_open(tmp_path, windows):
    (tmp_path / "a.txt").write_text("old")
    with files.replacing(tmp_path / "a.txt") as name:
        name.write_text("all of it")
        assert len(windows.open_files) == 1
    assert (tmp_path / "a.txt").read_text() == "all of it"
    assert names(tmp_path) == {"a.txt"}
    assert not windows.open_files


def test_on_windows_leftovers_are_removed_but_not_what_is_open(tmp_path, windows):
    with temporary.temporary_folder(tmp_path) as living:
        (living / "page.html").write_text("half")
        (tmp_path / LEFTOVER).mkdir()
        (tmp_path / f"{LEFTOVER}.lock").touch()
        (tmp_path / ".hdrlab-0123456789ac.hdr").write_text("half")
        temporary.remove_leftovers(tmp_path)
        assert names(tmp_path) == {living.name, f"{living.name}/page.html", f"{living.name}.lock"}
    assert names(tmp_path) == set()


def test_without_any_locks_files_are_replaced_and_leftovers_stay(tmp_path, monkeypatch):
    """As Python in a browser: nobody can tell a leftover from the file of a living process."""
    monkeypatch.setattr(temporary, "fcntl", None)
    (tmp_path / LEFTOVER).write_text("half")
    temporary.remove_leftovers(tmp_path)
    with files.replacing(tmp_path / "a.txt") as name:
        name.write_text("all of it")
    assert names(tmp_path) == {"a.txt", LEFTOVER}


@contextmanager
def writer(folder):
    """Start a process and stop it while it writes a file and a folder."""
    command = [sys.executable, "-c", WRITER, str(folder)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        try:
            assert process.stdout.readline() == b"writing\n"
            yield process
        finally:
            process.kill()


def write_another(folder):
    """Write a file from another process."""
    subprocess.run([sys.executable, "-c", NEXT, str(folder)], check=True)


def names(folder):
    return {str(path.relative_to(folder)) for path in Path(folder).rglob("*")}


@needs_locks
def test_the_next_process_removes_what_a_killed_one_left_and_nothing_of_a_living_one(tmp_path):
    (tmp_path / ".hdrlab-settings").write_text("of a user")
    with writer(tmp_path) as living:
        held = names(tmp_path)
        with writer(tmp_path) as dying:
            dying.send_signal(signal.SIGKILL)
            dying.wait()
        assert names(tmp_path) > held
        write_another(tmp_path)
        assert names(tmp_path) == held | {"other.txt"}
        living.send_signal(signal.SIGKILL)
        living.wait()
    write_another(tmp_path)
    assert names(tmp_path) == {".hdrlab-settings", "other.txt"}


@needs_locks
def test_another_thread_or_block_of_the_same_process_keeps_its_files(tmp_path):
    with files.replacing(tmp_path / "a.txt") as name:
        name.write_text("all of it")
        temporary.remove_leftovers(tmp_path)
    assert (tmp_path / "a.txt").read_text() == "all of it"


@needs_locks
def test_links_are_no_leftovers(tmp_path):
    (tmp_path / "precious.txt").write_text("precious")
    (tmp_path / ".hdrlab-0123456789ab").symlink_to("precious.txt")
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder/precious.txt").write_text("precious")
    (tmp_path / ".hdrlab-0123456789ac").symlink_to("folder")
    (tmp_path / ".hdrlab-0123456789ac.lock").touch()
    temporary.remove_leftovers(tmp_path)
    assert (tmp_path / "precious.txt").read_text() == "precious"
    assert (tmp_path / "folder/precious.txt").read_text() == "precious"
    assert (tmp_path / ".hdrlab-0123456789ab").is_symlink()
