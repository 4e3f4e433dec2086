"""Commands that are killed, interrupted, or lack disk space or permissions leave no half-written file.

A command that was disturbed, then run again, leaves the files of a run that nobody disturbed, and
nothing else: no temporary file or folder of the first run.
"""

import json
import re
import shutil
import signal
import sqlite3
import subprocess
import time
import zipfile
from collections.abc import Callable, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

import nbformat
import numpy as np
import pytest
from PIL import Image
from support import interrupted_commands, linux_processes, one_task_homework

from benchmarks import own_camera
from hdrlab import cli, scenes
from hdrlab.capture import camera, sensor
from hdrlab.io import photos, radiance, response_files

pytestmark = [
    pytest.mark.grading,
    pytest.mark.skipif(
        not (
            hasattr(interrupted_commands.os, "fork")
            and hasattr(interrupted_commands.os, "memfd_create")
        ),
        reason="commands are forked and watched as on Linux",
    ),
]

DISK_BYTES = 16 * 2**20
CLOSES = "2099-01-01T00:00+00:00"
ADDRESS = "https://vote.example.edu"
TOKEN = re.compile(rb"[A-Za-z0-9_-]{20,}|'[A-Za-z0-9_-]{12}'")
PACKED_AT = re.compile(rb'"made": ".*?"')
TIME = re.compile(rb"\d{4}-\d\d-\d\dT[\d:]+\.\d+")
# The moments of a run at which it is killed, as fractions of its changes of files.
MOMENTS = tuple(k / 9 for k in range(10))
SLOW_MOMENTS = (0.6,)
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
    same : by the end of a file's name, what returns from its bytes what two runs have in common
    is_slow : whether the command takes so long that it is disturbed at fewer moments
    """

    words: str
    before: tuple[str, ...] = ()
    output: str = ""
    refuses_twice: bool = False
    same: Mapping[str, Callable[[bytes], object]] = field(default_factory=dict)
    is_slow: bool = False


def size_of_image(data):
    """Return the size of an image; its pixels may contain a duration, which differs between runs."""
    return Image.open(BytesIO(data)).size


def without_random_words(data):
    """Return a text without random words and without the current date and time."""
    return TIME.sub(b"", TOKEN.sub(b"", data))


def source_of_notebook(data):
    """Return the cells of an executed notebook; their outputs contain the ids of widgets."""
    return [cell["source"] for cell in json.loads(data)["cells"]]


def members_without_random_words(data):
    """Return the members of an archive without its secrets and packing times."""
    with zipfile.ZipFile(BytesIO(data)) as archive:
        members = {member: archive.read(member) for member in archive.namelist()}
    for member in [member for member in members if member.endswith(".json")]:
        members[member] = PACKED_AT.sub(b"", without_random_words(members[member]))
    return members


# Written by one transaction after the other, each of which is whole.
GRADUAL = (".sqlite",)
GALLERY = {".sqlite": without_random_words, "links.csv": without_random_words}
INIT = f"gallery init out/g --closes {CLOSES}"
ADD = "gallery add out/g --roster roster.csv team1.png team2.png"
LINKS = f"gallery links out/g -o out/links.csv --address {ADDRESS}"
GRADE = (
    "grade class --homework hw2 --tier practice --plan plan.toml --roster roster.csv --jobs 1 "
    "-o out/results --secret-file secret.txt"
)
COMMANDS = {
    "assemble": Command(
        "assemble photos --stops 2 -o out/room.hdr --picture out/room.png --report out/report "
        "--uncertainty out/error.exr --why",
        output="out/room.hdr",
        is_slow=True,
    ),
    "tonemap": Command("tonemap map.exr -o out/a.png", output="out/a.png"),
    "compare": Command(
        "compare map.exr -o out/a.png --size 60 --operators reinhard,ward",
        output="out/a.png",
        same={"out/a.png": size_of_image},
    ),
    "convert": Command("convert map.exr -o out/a.hdr", output="out/a.hdr"),
    "calibrate": Command(
        "calibrate photos --times times.txt --align none -o out/a.csv -o out/a.m --plot out/a.svg",
        output="out/a.csv",
    ),
    "noise": Command("noise dark flat -o out/a.json", output="out/a.json"),
    "correct": Command("correct team1.png -o out/a.png", output="out/a.png"),
    "video": Command(
        "video photos --times 1,1/4 --response curve.csv -o out/a.gif", output="out/a.gif"
    ),
    "video of maps": Command(
        "video photos --times 1,1/4 --response curve.csv -o out/maps",
        output="out/maps",
        refuses_twice=True,
    ),
    "demo": Command("demo -o out/demo", is_slow=True),
    "lab": Command("lab --copy-only -o out/lab"),
    "check": Command(
        "check hw2.py --plan plan.toml --report out/a.html", output="out/a.html", is_slow=True
    ),
    "grade": Command("grade hw2.py --tier practice --plan plan.toml -o out/results", is_slow=True),
    "grade a class": Command(GRADE, is_slow=True),
    "regrade": Command("regrade out/results --jobs 1", before=(GRADE,), is_slow=True),
    "viva": Command("viva hw2.py --tier practice --plan plan.toml -o out/viva", is_slow=True),
    "course build": Command(
        "course build --plan out/ours/plan.toml --sources out/ours/sheets -o out/sheets",
        before=("course new-task flat --homework extra -o out/ours",),
        is_slow=True,
    ),
    "course export": Command("course export --nbgrader out/a --gradescope out/b --plan plan.toml"),
    "course export with a new secret": Command(
        "course export --gradescope out/b --plan plan.toml --secret-file out/secret.txt",
        same={"secret.txt": without_random_words, ".zip": members_without_random_words},
    ),
    "course gain": Command(
        "course gain answers.csv answers.csv -o out/a.html", output="out/a.html"
    ),
    "course move": Command("course move 2027-04-05 -o out/plan.toml", output="out/plan.toml"),
    "course new-task": Command("course new-task flat -o out/ours", refuses_twice=True),
    "course new-task for the second time": Command(
        "course new-task dark -o out/ours",
        before=("course new-task flat -o out/ours",),
        refuses_twice=True,
    ),
    "course pack": Command("course pack out/solutions --plan plan.toml"),
    "course questions": Command("course questions --inventory -o out/a.zip", output="out/a.zip"),
    "course slides": Command(
        "course slides small.ipynb -o out/slides",
        same={".ipynb": source_of_notebook},
        is_slow=True,
    ),
    "course toy": Command("course toy out/class", refuses_twice=True, is_slow=True),
    "gallery init": Command(INIT, refuses_twice=True, same=GALLERY),
    "gallery add": Command(ADD, before=(INIT,), same=GALLERY),
    "gallery links": Command(LINKS, before=(INIT, ADD), output="out/links.csv", same=GALLERY),
    "gallery links --all-anew": Command(
        f"{LINKS} --all-anew",
        before=(INIT, ADD, LINKS),
        same=GALLERY,
    ),
    "gallery close": Command("gallery close out/g", before=(INIT,), same=GALLERY),
    "gallery results": Command(
        "gallery results out/g -o out/results.csv",
        before=(INIT, ADD, "gallery close out/g"),
        output="out/results.csv",
    ),
    "report": Command("report out/project"),
    "report --example": Command("report --example out/empty", refuses_twice=True),
    "submit": Command(
        "submit out/project --force -o out/a.zip",
        output="out/a.zip",
        same={"out/a.zip": members_without_random_words},
    ),
}
# Commands without an output file, and those that other tests disturb.
WITHOUT_OUTPUT = {"doctor", "info", "meter", "plan", "receipt", "score", "why"}
DISTURBED_ELSEWHERE = {
    "gallery serve": "course/test_gallery.py",
    "shoot": "io/test_tethered.py",
    "site": "course/test_site.py",
}
# Other formats of the same commands, which other libraries write.
FORMATS = {
    words.rpartition(" -o ")[2]: Command(words, output=words.rpartition(" -o ")[2])
    for words in (
        "convert map.exr -o out/a.exr",
        "convert map.exr -o out/a.pfm",
        "convert map.exr -o out/a.tif",
        "tonemap map.exr -o out/a.jpg",
        "tonemap map.exr -o out/b.tif",
        "tonemap map.exr -o out/a.avif",
        "tonemap map.exr -o out/a.jxl",
        "tonemap map.exr --to png -o out/b.png",
        "tonemap map.exr --to ultrahdr -o out/b.jpg",
        "video photos --times 1,1/4 --response curve.csv -o out/a.mp4",
        "calibrate photos --times times.txt --align none --plot out/a.png -o out/b.csv",
    )
}


@pytest.fixture(scope="module")
def commands(tmp_path_factory):
    """A process that runs commands."""
    running = interrupted_commands.CommandServer(tmp_path_factory.mktemp("matplotlib"))
    yield running
    running.close()


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with the input files of the commands."""
    here = tmp_path_factory.mktemp("made")
    for name in ("photos", "tmp", "out"):
        (here / name).mkdir()
    room = scenes.room((60, 90))
    shot = camera.shoot(room, camera.times_around(room, 3, stops=2), camera.Camera(), rng=1)
    for name, image in zip("abc", shot.images, strict=True):
        photos.write_picture(here / f"photos/{name}.png", image)
    lines = [f"{name}.png {time}" for name, time in zip("abc", shot.times, strict=True)]
    own_camera.write_photos(
        here, sensor.Sensor(), studio=own_camera.Studio(side=120, times=(0.1, 0.3, 0.6, 0.9))
    )
    (here / "times.txt").write_text("\n".join(lines) + "\n")
    rng = np.random.default_rng(1)
    radiance.write_radiance(here / "map.exr", rng.uniform(0.01, 5, (90, 120, 3)))
    for team in ("team1", "team2"):
        photos.write_picture(here / f"{team}.png", rng.integers(0, 256, (90, 120, 3), np.uint8))
    (here / "roster.csv").write_text("student,name,team\nann,Ann,team1\nben,Ben,team2\n")
    (here / "answers.csv").write_text("student,q1,q2\nann,a,b\nben,c,\n")
    (here / "plan.toml").write_text(one_task_homework.PLAN)
    (here / "secret.txt").write_text("a secret\n")
    levels = np.arange(1, 257) / 256
    response_files.write_curve(here / "curve.csv", np.log(levels))
    (here / "hw2.py").write_text(one_task_homework.CORRECT_CODE)
    write_small_notebook(here / "small.ipynb")
    (here / "class").mkdir()
    (here / "class/team1.py").write_text(one_task_homework.CORRECT_CODE)
    (here / "class/ben.py").write_text("def hat(n=256):\n    return 1\n")
    make_project(here)
    return here


def write_small_notebook(path):
    """Write a notebook with a title and one question, which asks for a number."""
    code = "from hdrlab.show.widgets import predict\npredict.entry('How much is 1 + 1?', 2)"
    cells = [nbformat.v4.new_markdown_cell("# A small page"), nbformat.v4.new_code_cell(code)]
    for number, cell in enumerate(cells):
        cell["id"] = f"cell{number}"
    nbformat.write(nbformat.v4.new_notebook(cells=cells), path)


def make_project(here):
    """Make a project below `out`, where its report is written."""
    (here / "out/empty").mkdir()
    folder = here / "out/project"
    (folder / "photographs").mkdir(parents=True)
    for name in "abc":
        shutil.copyfile(here / f"photos/{name}.png", folder / f"photographs/{name}.png")
    shutil.copyfile(here / "team1.png", folder / "artifact.png")
    shutil.copyfile(here / "map.exr", folder / "map.exr")
    (folder / "report.md").write_text("# Dusk\n\n## Results\n\nA room.\n")
    (folder / "project.toml").write_text('students = ["ann"]\ntitle = "Dusk"\ncaption = ""\n')


@contextmanager
def small_disk(folder):
    """Mount a small disk at a folder; skip the test if the user may not mount."""
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
    """A folder in which one command runs, and the files that an undisturbed run leaves there."""

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
        assert self.changes > 0

    def reset(self):
        """Restore the state from before the command."""
        for name in ("out", "tmp"):
            shutil.rmtree(self.here / name)
            shutil.copytree(self.start / name, self.here / name)

    def run(self, *, words=None, **how):
        """Run the command, or the one that is passed."""
        words = (words or self.command.words).split()
        return self.commands.run(
            interrupted_commands.CommandRun(words=words, folder=str(self.here), **how)
        )

    def contents(self):
        """Return all files and folders, without the parts that differ between two runs."""
        files = {}
        for name, data in interrupted_commands.read_folder(self.here).items():
            if name.endswith(("-wal", "-shm")) or name == "out/ballast":
                continue
            if name.endswith(".sqlite"):
                data = self.dump(self.here / name)
            for suffix, what_is_same in self.command.same.items():
                if name.endswith(suffix) and "/.hdrlab-" not in name:
                    data = what_is_same(data)
            files[name] = data
        return files

    def dump(self, database):
        """Return the rows of a copy of a database; SQLite writes to a database that it reads."""
        with TemporaryDirectory(dir=self.start) as folder:
            for path in database.parent.glob(f"{database.name}*"):
                shutil.copyfile(path, Path(folder) / path.name)
            with closing(sqlite3.connect(Path(folder) / database.name)) as db:
                return "\n".join(db.iterdump()).encode()

    def check_whole(self):
        """Check that each file is the one from before or from an undisturbed run."""
        contents = self.contents()
        for name, data in contents.items():
            if name.startswith("out/") and not name.endswith(GRADUAL):
                assert data in (self.before.get(name, data), self.after.get(name, data)), name
        return contents

    def check_no_leftover(self):
        """Check that the command left only files that an undisturbed run leaves."""
        contents = self.check_whole()
        assert set(contents) <= set(self.before) | set(self.after)

    def check_run_again(self):
        """Check that the next run leaves exactly the files of an undisturbed run."""
        is_complete = self.check_whole().items() >= self.after.items()
        ended = self.run()
        if ended.code != 0:
            assert is_complete and self.command.refuses_twice, ended.err
        contents = self.contents()
        assert set(contents) == set(self.after)
        assert [name for name in contents if contents[name] != self.after[name]] == []


@pytest.fixture(scope="module")
def places(commands, made, tmp_path_factory):
    """Return a function that makes the Place of a command."""
    known = {}

    def find(name):
        if name not in known:
            home = tmp_path_factory.mktemp("place")
            known[name] = Place(commands, made, home, (COMMANDS | FORMATS)[name])
        known[name].reset()
        return known[name]

    return find


def list_commands(group, prefix=""):
    """Yield the names of all commands of a group, also of the groups in it."""
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from list_commands(command, f"{prefix}{name} ")
        else:
            yield f"{prefix}{name}"


def test_every_command_that_writes_files_is_disturbed():
    disturbed = {
        name
        for name in list_commands(cli.main)
        if any(command.words.startswith(f"{name} ") for command in COMMANDS.values())
    }
    assert set(list_commands(cli.main)) == disturbed | WITHOUT_OUTPUT | set(DISTURBED_ELSEWHERE)
    for file in DISTURBED_ELSEWHERE.values():
        assert (Path(__file__).parents[1] / file).exists()


def wait_for_processes(folder):
    """Wait until the child processes of a killed command have ended."""
    until = time.monotonic() + 60
    while linux_processes.processes_using(folder / "tmp") and time.monotonic() < until:
        time.sleep(0.02)


def change_at(place, moment):
    """Return the number of the file change at a fraction of the run; the first has the number 1."""
    return 1 + round(moment * (place.changes - 1))


@pytest.mark.parametrize("name", COMMANDS)
def test_a_killed_command_that_is_run_again_gives_the_result_of_an_undisturbed_run(name, places):
    place = places(name)
    moments = SLOW_MOMENTS if COMMANDS[name].is_slow else MOMENTS
    for change in sorted({change_at(place, moment) for moment in moments}):
        place.reset()
        ended = place.run(signal=signal.SIGKILL, change=change)
        assert ended.code == -signal.SIGKILL
        wait_for_processes(place.here)
        place.check_run_again()


@pytest.mark.parametrize("name", COMMANDS)
def test_an_interrupted_command_prints_one_line_and_leaves_no_files(name, places):
    place = places(name)
    for sent, moment in SIGNALS.items():
        if COMMANDS[name].is_slow and sent != "SIGINT":
            continue
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


@pytest.mark.parametrize("name", [*COMMANDS, *FORMATS])
def test_a_full_disk_is_named_in_a_line(name, places):
    place = places(name)
    out = place.here / "out"
    rooms = [place.written_bytes // 2]
    if name in COMMANDS and not place.command.is_slow:
        rooms.append(0)
    for room in rooms:
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
