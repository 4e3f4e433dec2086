"""Temporary files and folders are removed when their process has ended, however it ended, and not
earlier.
"""

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

pytest.importorskip("fcntl", reason="this system keeps leftovers, because it has no file locks")


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


def test_another_thread_or_block_of_the_same_process_keeps_its_files(tmp_path):
    with files.replacing(tmp_path / "a.txt") as name:
        name.write_text("all of it")
        temporary.remove_leftovers(tmp_path)
    assert (tmp_path / "a.txt").read_text() == "all of it"


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
