"""Every command that writes, killed, stopped, without room or rights: one clear line, nothing half written.

A command that was disturbed, then run again, leaves the files of a run that nobody disturbed, and
nothing else: no temporary file or folder of the first run.
"""

import re
import shutil
import signal
import sqlite3
import subprocess
import zipfile
from contextlib import closing, contextmanager
from dataclasses import dataclass
from io import BytesIO

import disturbed
import numpy as np
import pytest
from PIL import Image

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.io import photos, radiance

pytestmark = [
    pytest.mark.papers,
    pytest.mark.skipif(
        not (hasattr(disturbed.os, "fork") and hasattr(disturbed.os, "memfd_create")),
        reason="commands are forked and watched as on Linux",
    ),
]

DISK_BYTES = 16 * 2**20
CLOSES = "2099-01-01T00:00+00:00"
ADDRESS = "https://vote.example.edu"
TOKEN = re.compile(rb"[A-Za-z0-9_-]{20,}")
# The moments of a run at which it is killed, as fractions of its changes of files.
MOMENTS = (0, 0.25, 0.5, 0.75, 1)
SIGNALS = {"SIGINT": 0.2, "SIGTERM": 0.5, "SIGHUP": 0.9}


@dataclass(frozen=True)
class Command:
    """A command that writes below the folder `out`.

    Attributes
    ----------
    words : the command
    before : the commands that come first
    output : what the command refuses to write into a missing folder, or "" if it makes the folder
    refuses_twice : whether a second run is refused, because the result is there
    same : returns what two runs have in common of the bytes of a file, by its name
    """

    words: str
    before: tuple[str, ...] = ()
    output: str = ""
    refuses_twice: bool = False
    same: object = None


def size_of_image(name, data):
    """Return the size of an image, whose pixels show how long something took."""
    return Image.open(BytesIO(data)).size


def members_without_times(name, data):
    """Return the members of a project's archive, without the time at which it was packed."""
    with zipfile.ZipFile(BytesIO(data)) as archive:
        members = {member: archive.read(member) for member in archive.namelist()}
    return {member: re.sub(rb'"made": ".*?"', b"", text) for member, text in members.items()}


def without_tokens(name, data):
    """Return a text without random words."""
    return TOKEN.sub(b"", data)


INIT = f"gallery init out/g --closes {CLOSES}"
ADD = "gallery add out/g --roster roster.csv team1.png team2.png"
LINKS = f"gallery links out/g -o out/links.csv --address {ADDRESS}"
COMMANDS = {
    "assemble": Command(
        "assemble photos --stops 2 -o out/room.hdr --picture out/room.png --report out/report "
        "--uncertainty out/error.exr",
        output="out/room.hdr",
    ),
    "tonemap": Command("tonemap map.exr -o out/a.png", output="out/a.png"),
    "compare": Command(
        "compare map.exr -o out/a.png --size 60 --operators reinhard,ward",
        output="out/a.png",
        same=size_of_image,
    ),
    "convert": Command("convert map.exr -o out/a.hdr", output="out/a.hdr"),
    "gallery init": Command(INIT, refuses_twice=True, same=without_tokens),
}


@pytest.fixture(scope="module")
def commands(tmp_path_factory):
    """A process that runs commands."""
    running = disturbed.Commands(tmp_path_factory.mktemp("matplotlib"))
    yield running
    running.close()


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with what the commands read."""
    here = tmp_path_factory.mktemp("made")
    for name in ("photos", "tmp", "out"):
        (here / name).mkdir()
    room = scenes.room((60, 90))
    shot = camera.shoot(room, camera.times_around(room, 3, stops=2), camera.Camera(), rng=1)
    for name, image in zip("abc", shot.images, strict=True):
        photos.write_picture(here / f"photos/{name}.png", image)
    rng = np.random.default_rng(1)
    radiance.write_radiance(here / "map.exr", rng.uniform(0.01, 5, (90, 120, 3)))
    for team in ("team1", "team2"):
        photos.write_picture(here / f"{team}.png", rng.integers(0, 256, (90, 120, 3), np.uint8))
    (here / "roster.csv").write_text("student,name,team\nann,Ann,team1\nben,Ben,team2\n")
    return here


@contextmanager
def small_disk(folder):
    """Put a small disk in the place of a folder, or skip the test where nobody may."""
    words = ["mount", "-t", "tmpfs", "-o", f"size={DISK_BYTES}", "hdrlab-test", str(folder)]
    try:
        is_mounted = subprocess.run(words, capture_output=True).returncode == 0
    except FileNotFoundError:
        is_mounted = False
    if not is_mounted:
        pytest.skip("only root can mount a small disk")
    try:
        yield
    finally:
        subprocess.run(["umount", "-l", str(folder)], check=True)


class Place:
    """A folder in which one command runs, and what an undisturbed run leaves there."""

    def __init__(self, commands, made, home, command):
        self.commands = commands
        self.command = command
        self.here = home / "here"
        self.start = home / "start"
        shutil.copytree(made, self.here)
        for words in command.before:
            ended = self.run(words=words)
            assert ended.code == 0, ended.err
        shutil.copytree(self.here, self.start)
        self.before = self.contents()
        ended = self.run()
        assert ended.code == 0, ended.err
        self.changes = ended.changes
        self.after = self.contents()
        sizes = {path: path.stat().st_size for path in (self.here / "out").rglob("*")}
        new = [path for path in sizes if str(path.relative_to(self.here)) not in self.before]
        self.written_bytes = sum(sizes[path] for path in new if path.is_file())
        assert self.changes > 0 and self.before != self.after

    def reset(self):
        """Return to the state before the command."""
        for name in ("out", "tmp"):
            shutil.rmtree(self.here / name)
            shutil.copytree(self.start / name, self.here / name)

    def run(self, *, words=None, **how):
        """Run the command, or another."""
        words = (words or self.command.words).split()
        return self.commands.run(disturbed.Run(words=words, folder=str(self.here), **how))

    def contents(self):
        """Return all files and folders, as far as two runs have them in common."""
        found = {}
        for name, data in disturbed.files_below(self.here).items():
            if name.endswith(("-wal", "-shm")) or name == "out/ballast":
                continue
            if name.endswith(".sqlite"):
                with closing(sqlite3.connect(self.here / name)) as db:
                    data = "\n".join(db.iterdump()).encode()
            is_written = name.startswith("out/") and "/.hdrlab-" not in name
            if data is not None and is_written and self.command.same:
                data = self.command.same(name, data)
            found[name] = data
        return found

    def check_whole(self):
        """Check that each file is the one from before or from an undisturbed run."""
        found = self.contents()
        for name, data in found.items():
            if name.startswith("out/"):
                assert data in (self.before.get(name, data), self.after.get(name, data)), name
        return found

    def check_no_leftover(self):
        """Check that there is nothing that an undisturbed run does not leave."""
        found = self.check_whole()
        assert set(found) <= set(self.before) | set(self.after)

    def check_run_again(self):
        """Check that the next run gives what an undisturbed one gives, and nothing else."""
        is_complete = self.check_whole().items() >= self.after.items()
        ended = self.run()
        if ended.code != 0:
            assert is_complete and self.command.refuses_twice, ended.err
        found = self.contents()
        assert set(found) == set(self.after)
        assert [name for name in found if found[name] != self.after[name]] == []


@pytest.fixture(scope="module")
def places(commands, made, tmp_path_factory):
    """Return the place of a command."""
    known = {}

    def find(name):
        if name not in known:
            home = tmp_path_factory.mktemp("place")
            known[name] = Place(commands, made, home, COMMANDS[name])
        known[name].reset()
        return known[name]

    return find


def change_at(place, moment):
    """Return the number of a change of a file, of which the first is 1."""
    return 1 + round(moment * (place.changes - 1))


@pytest.mark.parametrize("name", COMMANDS)
def test_a_killed_command_that_is_run_again_gives_the_result_of_an_undisturbed_run(name, places):
    place = places(name)
    for change in sorted({change_at(place, moment) for moment in MOMENTS}):
        place.reset()
        ended = place.run(signal=signal.SIGKILL, change=change)
        assert ended.code == -signal.SIGKILL
        place.check_run_again()


@pytest.mark.parametrize("name", COMMANDS)
def test_a_stopped_command_says_so_in_a_line_and_leaves_nothing(name, places):
    place = places(name)
    for sent, moment in SIGNALS.items():
        place.reset()
        ended = place.run(signal=getattr(signal, sent), change=change_at(place, moment))
        assert ended.code in (0, 130), ended.err
        assert "Traceback" not in ended.err
        assert ended.code == 0 or ended.last_line == "hdrlab: interrupted"
        place.check_no_leftover()
        place.check_run_again()


@pytest.mark.parametrize("name", COMMANDS)
def test_a_read_only_folder_is_named_in_a_line(name, places):
    place = places(name)
    folders = [path for path in [place.here / "out", *place.here.glob("out/**/")] if path.is_dir()]
    for folder in folders:
        folder.chmod(0o555)
    ended = place.run(is_ordinary_user=True)
    for folder in folders:
        folder.chmod(0o755)
    assert ended.code == 2, ended.err
    assert "Traceback" not in ended.err
    assert "Permission denied" in ended.last_line
    assert ".hdrlab-" not in ended.last_line
    assert place.contents() == place.before
    place.check_run_again()


@pytest.mark.parametrize("name", [name for name in COMMANDS if COMMANDS[name].output])
def test_a_missing_folder_is_named_in_a_line(name, places):
    place = places(name)
    output = COMMANDS[name].output
    words = COMMANDS[name].words.replace(output, output.replace("out/", "out/missing/"))
    ended = place.run(words=words)
    assert ended.code == 2, ended.err
    assert "Traceback" not in ended.err
    assert "no folder" in ended.last_line
    assert "missing" in ended.last_line
    assert place.contents() == place.before


def fill(disk, room):
    """Fill the disk up to a number of bytes."""
    free = shutil.disk_usage(disk).free
    (disk / "ballast").write_bytes(bytes(max(0, free - room)))


@pytest.mark.parametrize("name", COMMANDS)
def test_a_full_disk_is_named_in_a_line(name, places):
    place = places(name)
    out = place.here / "out"
    for room in (0, place.written_bytes // 2):
        with small_disk(out):
            shutil.copytree(place.start / "out", out, dirs_exist_ok=True)
            fill(out, room)
            ended = place.run()
            assert "Traceback" not in ended.err
            if ended.code == 0:  # there was room enough
                assert room > 0
                continue
            assert ended.code == 2, ended.err
            assert "No space left on device" in ended.last_line
            assert ".hdrlab-" not in ended.last_line
            place.check_no_leftover()
            (out / "ballast").unlink()
            place.check_run_again()
