"""A command that cannot write its output changes nothing, names the reason, and can be run again.

The disk is a small file system in memory, which root may mount; elsewhere these tests are skipped.
"""

import csv
import subprocess
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from hdrlab import cli
from hdrlab.course.classroom.jobs import lock_folder
from hdrlab.course.gallery import store, tokens
from hdrlab.io import photos, radiance

DISK_BYTES = 4 * 2**20
CLOSES = "2099-01-01T00:00+00:00"
ADDRESS = "https://vote.example.edu"
LINKS = f"gallery links DISK/g -o DISK/links.csv --address {ADDRESS}"
# the commands that come before the first links
BEFORE_LINKS = (
    f"gallery init DISK/g --closes {CLOSES}",
    "gallery add DISK/g --roster roster.csv team1.png",
)


def mount(folder, options):
    """Mount a file system in memory, or change the options of one."""
    words = ["mount", "-t", "tmpfs", "-o", options, "hdrlab-test", str(folder)]
    return subprocess.run(words, capture_output=True).returncode == 0


@pytest.fixture
def disk(tmp_path, monkeypatch):
    """A small disk, in a folder with the input files of the commands."""
    folder = tmp_path / "DISK"
    folder.mkdir()
    try:
        is_mounted = mount(folder, f"size={DISK_BYTES}")
    except FileNotFoundError:
        is_mounted = False
    if not is_mounted:
        pytest.skip("only root can mount a small disk")
    monkeypatch.chdir(tmp_path)
    rng = np.random.default_rng(1)
    radiance.write_radiance("map.exr", rng.uniform(0.01, 5, (150, 200, 3)))
    for team in ("team1", "team2"):
        photos.write_picture(f"{team}.png", rng.integers(0, 256, (90, 120, 3), np.uint8))
    Path("roster.csv").write_text("student,name,team\nann,Ann,team1\nben,Ben,team2\n")
    try:
        yield folder
    finally:
        subprocess.run(["umount", "-l", str(folder)], check=True)


def run(command):
    """Run a command, and return its exit code."""
    with pytest.raises(SystemExit) as stop:
        cli.run(command.split())
    return stop.value.code or 0


def fill(disk, room):
    """Fill the disk up to a number of bytes."""
    free = subprocess.run(
        ["stat", "-f", "-c", "%a %S", str(disk)], capture_output=True, check=True, text=True
    )
    blocks, block_bytes = map(int, free.stdout.split())
    (disk / "ballast").write_bytes(bytes(max(0, blocks * block_bytes - room)))


def is_link_valid(disk, link):
    """Return whether the gallery knows a personal link."""
    with closing(store.connect(disk / "g")) as db:
        return tokens.whose(db, link.rpartition("/")[2], "link") is not None


@pytest.mark.parametrize("fault", ["missing folder", "full disk"])
def test_personal_links_stay_valid_until_new_ones_are_written(fault, disk):
    for command in [*BEFORE_LINKS, LINKS]:
        assert run(command) == 0
    with open(disk / "links.csv", newline="", encoding="utf-8-sig") as file:
        links = [row["link"] for row in csv.DictReader(file)]
    assert len(links) == 2
    out = "missing/links.csv" if fault == "missing folder" else "DISK/new.csv"
    if fault == "full disk":
        fill(disk, 0)
    command = f"gallery links DISK/g -o {out} --address {ADDRESS} --all-anew"
    assert run(command) == 2
    (disk / "ballast").unlink(missing_ok=True)
    assert all(is_link_valid(disk, link) for link in links)


def test_first_links_that_could_not_be_written_are_written_by_the_next_run(disk):
    for command in BEFORE_LINKS:
        assert run(command) == 0
    fill(disk, 0)
    assert run(LINKS) == 2
    (disk / "ballast").unlink()
    assert run(LINKS) == 0
    with open(disk / "links.csv", newline="", encoding="utf-8-sig") as file:
        assert [row["student"] for row in csv.DictReader(file)] == ["ann", "ben"]


@pytest.mark.parametrize("out", ["g/gallery.sqlite", "g/gallery.sqlite-wal", "g/pictures/x.csv"])
def test_links_never_overwrite_the_gallery(out, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(f"gallery init g --closes {CLOSES}") == 0
    before = (tmp_path / "g/gallery.sqlite").read_bytes()
    assert run(f"gallery links g -o {out} --address {ADDRESS}") == 2
    assert (tmp_path / "g/gallery.sqlite").read_bytes() == before


def test_a_site_is_built_by_one_process_at_a_time(tmp_path, capsys):
    (tmp_path / "small.ipynb").write_text("{}")
    with lock_folder(tmp_path / ".site.cache"):
        assert run(f"site --out {tmp_path / 'site'} --notebooks {tmp_path / 'small.ipynb'}") == 2
    error = capsys.readouterr().err
    assert "another run" in error
    assert error.count("\n") == 1


def test_a_gallery_that_another_process_has_made_meanwhile_is_kept(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(f"gallery init g --closes {CLOSES}") == 0
    before = (tmp_path / "g/gallery.sqlite").read_bytes()
    monkeypatch.setattr(Path, "exists", lambda path: False)
    assert run(f"gallery init g --closes {CLOSES} --title Other") == 2
    monkeypatch.undo()
    assert (tmp_path / "g/gallery.sqlite").read_bytes() == before
