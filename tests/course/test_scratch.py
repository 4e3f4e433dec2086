"""Temporary files of a command are removed at its end; the next command removes those of a killed one."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from hdrlab.course.scratch import locked_folder, temporary_folder

SLEEPER = """
import sys, tempfile, time
from hdrlab.course.scratch import temporary_folder
with temporary_folder() as folder:
    (folder / "left").write_text("x")
    tempfile.mkdtemp(prefix="hdrlab-read-")
    print(folder, flush=True)
    time.sleep(60)
"""


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


def sleeper(place):
    """Start a process that holds a temporary folder, and return the process and the folder."""
    environment = os.environ | {"TMPDIR": str(place)}
    process = subprocess.Popen(
        [sys.executable, "-c", SLEEPER], env=environment, stdout=subprocess.PIPE
    )
    return process, Path(process.stdout.readline().decode().strip())


@pytest.mark.parametrize("how", ["kill", "terminate"])
def test_the_next_command_removes_what_a_killed_one_left(place, how):
    (place / "another").mkdir()
    lives, held = sleeper(place)
    dies, left = sleeper(place)
    getattr(dies, how)()
    dies.wait()
    dies.stdout.close()
    assert (left / "left").exists()
    with temporary_folder() as mine:
        folders = {path for path in place.iterdir() if path.is_dir()}
        assert folders == {held, mine, place / "another"}
    lives.kill()
    lives.wait()
    lives.stdout.close()
    with locked_folder():
        pass
    assert set(place.iterdir()) == {place / "another"}
