"""Slow commands: their progress on a terminal, and what Ctrl-C leaves behind."""

import os
import select
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from hdrlab.io.maps import pfm

pytestmark = pytest.mark.papers

pty = pytest.importorskip("pty", reason="there are no such terminals here")

SIDES = (3000, 4000)  # 12 megapixels
PATIENCE = 600  # seconds: what hangs ends
LONG = {
    "tonemap": ["--operator", "chiu", "--set", "passes=2000"],
    "compare": ["--operators", "chiu,fattal,brush", "--size", "4000"],
}


@pytest.fixture(scope="module")
def large(tmp_path_factory):
    """A radiance map of 12 megapixels, gray, over six decades."""
    file = tmp_path_factory.mktemp("large") / "large.pfm"
    pfm.write(
        file, np.geomspace(1, 1e6, SIDES[1], dtype=np.float32) * np.ones((SIDES[0], 1), np.float32)
    )
    return file


def started(*arguments):
    """Start the command; return the process and its terminal."""
    terminal, its_end = pty.openpty()
    command = [sys.executable, "-m", "hdrlab", *map(str, arguments)]
    process = subprocess.Popen(command, stdout=its_end, stderr=its_end, stdin=subprocess.DEVNULL)
    os.close(its_end)
    return process, terminal


def shown(terminal, until):
    """Return what the terminal shows until `until` returns True, or until the command ends."""
    output = ""
    deadline = time.monotonic() + PATIENCE
    while not until(output) and time.monotonic() < deadline:
        if select.select([terminal], [], [], 1)[0]:
            try:
                output += os.read(terminal, 4096).decode()
            except OSError:  # the command has ended, and closed it
                break
    return output


@pytest.mark.parametrize("command", LONG)
def test_twelve_megapixels_show_the_seconds_and_ctrl_c_leaves_what_was_there(
    command, large, tmp_path
):
    out = tmp_path / "out.png"
    out.write_bytes(b"precious")
    process, terminal = started(command, large, "-o", out, *LONG[command])
    try:
        assert "chiu: " in shown(terminal, lambda output: " s" in output)
        process.send_signal(signal.SIGINT)
        ended = shown(terminal, lambda _: False)
        assert process.wait(PATIENCE) == 130
    finally:
        process.kill()
        process.wait()
        os.close(terminal)
    assert ended.strip().endswith("hdrlab: interrupted") and "Traceback" not in ended
    assert [file.name for file in tmp_path.iterdir()] == ["out.png"]
    assert out.read_bytes() == b"precious"
