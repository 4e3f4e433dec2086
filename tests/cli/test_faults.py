"""A full disk, Ctrl-C or a missing HOME ends a command in one line, or with its result; no file is lost.

The commands are those that write most. Each runs as a process, in a folder of its own.
"""

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from PIL import Image
from support.missing_environment import ENVIRONMENTS, turn_clock_back

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.io import radiance
from hdrlab.io.photos import write_picture

pytestmark = pytest.mark.papers

resource = pytest.importorskip("resource", reason="a system without limits cannot play a full disk")

PATIENCE = 1800  # seconds: what hangs ends
# bytes of the largest file that a full disk has room for
ROOM = 3000
# what assemble and tonemap write, and a file that stood there before
MAIN = {"assemble": "out/room.hdr", "tonemap": "out/map.png"}
OLD = b"precious"
# the option of prctl, and the capabilities that let root ignore file modes
PR_CAPBSET_DROP = 24
CAP_DAC_OVERRIDE = 1
CAP_DAC_READ_SEARCH = 2
COMMANDS = {
    "assemble": "assemble photos --stops 2 -o out/room.hdr --picture out/room.png --report out/report",
    "tonemap": "tonemap map.hdr -o out/map.png",
    "grade": "grade hw2.py --tier practice -o out/results",
    "site": "site --notebooks small.ipynb --out out/site",
}
HAT = '''def hat(n=256):
    """Return weights."""
    import numpy as np
    return np.minimum(np.arange(n), np.arange(n)[::-1]).astype(float)
'''


class Ended(NamedTuple):
    """How a command ended."""

    code: int
    out: str
    err: str

    @property
    def clear(self):
        """Return whether standard error ends with a line of hdrlab, without a traceback."""
        last = self.err.strip().splitlines()[-1:]
        return "Traceback" not in self.err and bool(last) and last[0].startswith("hdrlab: ")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with the input files of the commands."""
    here = tmp_path_factory.mktemp("made")
    (here / "photos").mkdir()
    room = scenes.room((120, 180))
    shot = camera.shoot(room, camera.times_around(room, 3, stops=2), camera.Camera(), rng=1)
    for name, image in zip("abc", shot.images, strict=True):
        write_picture(here / f"photos/{name}.png", image)
    E = np.geomspace(1e-2, 1e3, 120 * 180).reshape(120, 180, 1) * np.random.default_rng(1).uniform(
        0.5, 1, 3
    )
    radiance.write_radiance(here / "map.hdr", E)
    (here / "hw2.py").write_text(HAT)
    cells = [{"cell_type": "markdown", "id": "a", "metadata": {}, "source": ["# A small page\n"]}]
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    book = {"cells": cells, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}
    (here / "small.ipynb").write_text(json.dumps(book))
    return here


@pytest.fixture
def here(made, tmp_path):
    """A copy of `made`, with an empty folder `out`."""
    shutil.copytree(made, tmp_path / "here")
    (tmp_path / "here/out").mkdir()
    return tmp_path / "here"


def start(command, here, prepare=None, *, cwd=None, **environment):
    """Start a command as a process."""
    env = {**os.environ, **environment}
    # of a module that it compiles Python would keep the beginning, for all who follow
    if prepare is fill_disk:
        env["PYTHONDONTWRITEBYTECODE"] = "1"
    words = COMMANDS.get(command, command).split() if isinstance(command, str) else command
    return subprocess.Popen(
        [sys.executable, "-m", "hdrlab", *words],
        cwd=cwd or here,
        env={name: value for name, value in env.items() if value is not None},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        stdin=subprocess.DEVNULL,
        preexec_fn=prepare,
    )


def end(process):
    """Wait for a command and return how it ended."""
    try:
        out, err = process.communicate(timeout=PATIENCE)
    finally:
        process.kill()
    return Ended(
        process.returncode, (out or b"").decode(errors="replace"), err.decode(errors="replace")
    )


def files(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def assert_nothing_is_lost(here, made):
    """Assert that all input files are unchanged, and that no unfinished file is left."""
    for name in files(made):
        assert (here / name).read_bytes() == (made / name).read_bytes(), name
    half = [name for name in files(here) if Path(name).name.startswith((".hdrlab-", "tmp"))]
    assert not half


def fill_disk():
    """Limit the size of files, so that larger writes fail as on a full disk."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (ROOM, ROOM))


def obey_rights():
    """Drop root's capability to ignore file permissions."""
    if os.geteuid() == 0:
        import ctypes

        for right in (CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH):
            ctypes.CDLL(None).prctl(PR_CAPBSET_DROP, right, 0, 0, 0)


def stand_nowhere(folder):
    """Return a function that removes the folder in which a command is about to start."""
    folder.mkdir()
    return lambda: folder.rmdir()


def absolute(command, here):
    """Return the words of a command with absolute paths."""
    words = COMMANDS[command].split()
    return [
        str(here / word) if (here / word).exists() or word.startswith("out/") else word
        for word in words
    ]


@pytest.mark.parametrize("lacks", [*ENVIRONMENTS, "a clock", "a working folder"])
@pytest.mark.parametrize("command", ["assemble", "tonemap", "grade"])
def test_a_machine_that_lacks_something_gives_the_result(command, lacks, here, made):
    words = command
    options = ENVIRONMENTS.get(lacks, {})
    if lacks == "a clock":
        options = {"PYTHONPATH": turn_clock_back(here)}
    if lacks == "a working folder":
        gone = here.parent / "gone"
        words = absolute(command, here)
        options = {"prepare": stand_nowhere(gone), "cwd": gone}
    ended = end(start(words, here, **options))
    assert ended.code == 0 and "Traceback" not in ended.err, ended.err
    assert len(files(here / "out")) == {"assemble": 3, "tonemap": 1, "grade": 5}[command]
    assert_nothing_is_lost(here, made)


def test_a_site_in_a_folder_that_is_gone_ends_in_a_line(here, made):
    gone = here.parent / "gone"
    ended = end(start(absolute("site", here), here, stand_nowhere(gone), cwd=gone))
    assert ended.code == 2 and ended.clear, ended.err
    assert_nothing_is_lost(here, made)


@pytest.mark.parametrize("refusal", ["a full disk", "no right to write"])
@pytest.mark.parametrize(
    "command",
    ["assemble", "tonemap", "grade", pytest.param("site", marks=pytest.mark.notebooks)],
)
def test_a_full_or_read_only_disk_is_reported_in_one_line(command, refusal, here, made):
    full = refusal == "a full disk"
    if command in MAIN:
        (here / MAIN[command]).write_bytes(OLD)
    (here / "out").chmod(0o755 if full else 0o555)
    ended = end(start(command, here, fill_disk if full else obey_rights))
    (here / "out").chmod(0o755)
    assert ended.code == 2 and ended.clear, ended.err
    assert ("File too large" if full else "Permission denied") in ended.err.strip().splitlines()[-1]
    if command in MAIN:
        assert (here / MAIN[command]).read_bytes() == OLD
    assert_nothing_is_lost(here, made)


def test_a_full_disk_leaves_no_module_compiled_by_half(here):
    assert (
        end(start("--version", here, fill_disk, PYTHONPYCACHEPREFIX=str(here / "compiled"))).code
        == 0
    )
    assert not list(here.rglob("*.pyc"))


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("command", ["assemble", "tonemap", "grade"])
def test_a_command_can_be_stopped_at_any_moment(command, sent, made, here):
    for moment in (0.2, 0.5, 0.8, 1.1, 1.4, 1.8, 2.3):
        if command in MAIN:
            (here / MAIN[command]).write_bytes(OLD)
        process = start(
            command, here, lambda: signal.signal(signal.SIGINT, signal.default_int_handler)
        )
        try:
            process.wait(moment)
        except subprocess.TimeoutExpired:
            process.send_signal(sent)
        ended = end(process)
        # Python itself had not begun yet, or had only begun to look for the command
        if "Could not import runpy" in ended.err:
            continue
        if "frozen runpy" in ended.err and "hdrlab" not in ended.err:
            continue
        # before Python handles signals, or after its last line, the signal itself ends the process
        assert ended.code in (0, 130, -signal.SIGINT, -sent), ended.err
        assert "Traceback" not in ended.err, ended.err
        if command in MAIN:
            contents = (here / MAIN[command]).read_bytes()
            assert contents == OLD or contents[:4] in (b"#?RA", b"\x89PNG")
            assert contents == OLD or len(contents) > ROOM
        assert_nothing_is_lost(here, made)


@pytest.mark.parametrize("command", ["assemble", "tonemap", "grade"])
def test_two_runs_into_one_folder_leave_a_whole_result(command, here, made):
    assert [end(run).code for run in [start(command, here), start(command, here)]] == [0, 0]
    assert len(files(here / "out")) == {"assemble": 3, "tonemap": 1, "grade": 5}[command]
    assert_nothing_is_lost(here, made)


@pytest.mark.parametrize("command", ["assemble", "tonemap", "grade"])
def test_a_command_works_when_its_standard_output_is_closed(command, here, made):
    process = start(command, here)
    process.stdout.close()
    process.stdout = None
    ended = end(process)
    assert ended.code in (0, 1) and "Traceback" not in ended.err, ended.err
    assert_nothing_is_lost(here, made)


@pytest.mark.parametrize("suffix", [b".hdr", b".exr", b".pfm"])
def test_file_names_need_not_be_utf_8(suffix, here, made):
    """One exposure time is wrong, so that file names occur in a warning, in the map's header and in the
    report.
    """
    names = [b"photos/caf\xe9-%c.png" % letter for letter in b"abc"]
    for name, letter, seconds in zip(names, "abc", (0.01, 0.08, 0.16), strict=True):
        tags = Image.Exif()
        tags[274] = 1  # upright
        tags.get_ifd(0x8769)[33434] = seconds
        with (
            Image.open(here / f"photos/{letter}.png") as image,
            open(os.fsencode(here) + b"/" + name, "wb") as file,
        ):
            image.save(file, "PNG", exif=tags)
    out = b"out/\xe9" + suffix
    ended = end(start([b"assemble", *names, b"-o", out, b"--report", b"out/report"], here))
    assert ended.code == 0 and out[4:] in os.listdir(os.fsencode(here / "out")), ended.err
    assert "warning: " in ended.err
    again = end(start([b"tonemap", out, b"-o", b"out/\xe9.png"], here))
    # OpenEXR's module accepts only file names that are text, so the file has another name
    assert again.code == 0 if suffix != b".exr" else again.clear, again.err
    assert_nothing_is_lost(here, made)
