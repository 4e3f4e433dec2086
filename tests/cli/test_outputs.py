"""A command never overwrites its input."""

import os

import numpy as np
import pytest

from hdrlab import cli, scenes
from hdrlab.capture import camera
from hdrlab.io import files, radiance
from hdrlab.io.photos import write_picture

COMMANDS = {
    "assemble": "photos/a.png photos/b.png --stops 2 -o room.hdr --picture photos/b.png",
    "assemble a folder": "photos --stops 2 -o room.hdr --picture photos/b.png",
    "assemble in a folder": "{here}/photos --stops 2 -o room.hdr --picture ./photos/../photos/b.png",
    "assemble --uncertainty": "photos --stops 2 -o room.hdr --uncertainty photos/link.exr",
    "assemble --noise": "photos --stops 2 -o room.hdr --uncertainty link.exr --noise link.exr",
    "assemble into one file": "photos --stops 2 -o new.tif --picture new.tif",
    "assemble into one file by another path": "photos --stops 2 -o new.tif --picture ./photos/../new.tif",
    "assemble into one file by a link": "photos --stops 2 -o link.exr --uncertainty photos/link.exr",
    "calibrate into one file": "photos --times times.csv -o new.csv -o new.csv",
    "calibrate --times": "photos --times times.csv -o times.csv",
    "calibrate --plot": "photos --times times.csv --plot photos/b.png",
    "correct": "photos/b.png -o photos/b.png",
    "tonemap": "photos/room.hdr -o link.png",
    "compare": "photos/room.hdr -o link.png",
    "convert": "photos/room.hdr -o hard.hdr",
    "check": "hw2.py --report hw2.py",
    "grade": "photos --homework hw2 --roster times.csv -o photos",
    "course build": "--sources photos --out photos",
    "course gain": "times.csv hard.hdr -o times.csv",
    "submit": "photos --force -o photos/notes.txt",
}


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A folder of photos and a map, with links from outside the folder."""
    (tmp_path / "photos").mkdir()
    shot = camera.shoot(scenes.room((48, 64)), [0.1, 0.4], camera.Camera(sensitivity=0.05), rng=1)
    for name, image in zip("ab", shot.images, strict=True):
        write_picture(tmp_path / f"photos/{name}.png", image)
    radiance.write_radiance(tmp_path / "photos/room.hdr", np.ones((4, 5, 3)))
    (tmp_path / "photos/notes.txt").write_text("three days of work")
    (tmp_path / "times.csv").write_text("file,seconds\na.png,0.1\nb.png,0.4\n")
    (tmp_path / "hw2.py").write_text("def hat():\n    pass\n")
    os.link(tmp_path / "photos/room.hdr", tmp_path / "hard.hdr")
    (tmp_path / "link.exr").symlink_to("photos/link.exr")
    (tmp_path / "link.png").symlink_to("photos/room.hdr")
    (tmp_path / "photos/link.exr").symlink_to("a.png")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def contents(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("name", COMMANDS)
def test_no_command_overwrites_its_input(name, here, capsys):
    before = contents(here)
    words = name.split()[: 2 if name.startswith("course") else 1]
    with pytest.raises(SystemExit) as stop:
        cli.run([*words, *COMMANDS[name].format(here=here).split()])
    errors = capsys.readouterr().err
    assert stop.value.code == 2
    assert errors.count("\n") == 1
    assert "another name" in errors or "a new name" in errors
    assert contents(here) == before


@pytest.mark.parametrize("picture", ["c.png", "c.jpg", "c.tif"])
def test_command_can_be_repeated_with_its_outputs_among_the_photos(picture, here, capsys):
    command = f"assemble photos -v --stops 2 -o photos/room.hdr --picture photos/{picture}"
    maps = []
    for _ in range(2):
        with pytest.raises(SystemExit) as stop:
            cli.run(command.split())
        assert not stop.value.code
        maps.append((here / "photos/room.hdr").read_bytes())
    assert maps[0] == maps[1]
    assert picture in capsys.readouterr().err  # a detail says that the picture is no photo


def test_require_other_finds_two_names_of_one_file(tmp_path):
    """On Windows and macOS, both names are the same file; a link simulates this here."""
    (tmp_path / "IMG.JPG").write_bytes(b"original")
    os.link(tmp_path / "IMG.JPG", tmp_path / "img.jpg")
    with pytest.raises(ValueError, match="img.jpg.*IMG.JPG"):
        files.require_other([tmp_path / "img.jpg"], [tmp_path / "IMG.JPG"])


def test_require_other_ignores_values_that_are_no_file_names(tmp_path):
    files.require_other([tmp_path], ["x" * 5000, "a\0b", ""])


@pytest.mark.parametrize(
    "words",
    [
        "assemble photos --stops 2 -o room.xyz",
        "assemble photos --stops 2 -o room.hdr --picture room.xyz",
        "assemble photos --stops 2 -o room.hdr --uncertainty room.xyz",
        "calibrate photos --times times.csv -o curve.xyz",
        "calibrate photos --times times.csv --plot curve.xyz",
        "noise photos photos -o room.xyz",
        "correct photos/b.png -o room.xyz",
        "tonemap photos/room.hdr -o room.xyz",
        "tonemap photos/room.hdr -o room.xyz --to ultrahdr",
        "tonemap photos/room.hdr -o room.xyz --to png",
        "compare photos/room.hdr -o room.xyz",
        "convert photos/room.hdr -o room.xyz",
        "video photos --times 0.1,0.4 -o room.xyz",
        "assemble photos --stops 2 -o missing/room.hdr",
        "assemble photos --stops 2 -o room.hdr --picture missing/room.png",
        "assemble photos --stops 2 -o room.hdr --picture photos",
        "assemble photos --stops 2 -o room.hdr --uncertainty missing/room.exr",
        "assemble photos --stops 2 -o room.hdr --report times.csv",
        "calibrate photos --times times.csv -o missing/curve.csv",
        "calibrate photos --times times.csv --plot missing/curve.png",
        "noise photos photos -o missing/room.json",
        "correct photos/b.png -o missing/room.png",
        "tonemap photos/room.hdr -o missing/room.png",
        "compare photos/room.hdr -o missing/room.png",
        "convert photos/room.hdr -o missing/room.exr",
        "convert photos/room.hdr -o room.pfm --half",
        "video photos --times 0.1,0.4 -o missing/room.gif",
        "check hw2.py --report missing/page.html",
    ],
)
def test_bad_name_of_an_output_is_rejected_before_any_input_is_read(
    words, here, capsys, monkeypatch
):
    def read(*_, **__):
        pytest.fail("an input was read")

    monkeypatch.setattr("hdrlab.io.photos.read_bracket", read)
    monkeypatch.setattr("hdrlab.io.photos.read_photo", read)
    monkeypatch.setattr("hdrlab.io.radiance.read_sanitized", read)
    monkeypatch.setattr("hdrlab.cli.assignments.find_homework", read)
    before = contents(here)
    with pytest.raises(SystemExit) as stop:
        cli.run(words.split())
    error = capsys.readouterr().err
    assert stop.value.code == 2
    assert error.count("\n") == 1
    assert any(name in error for name in ("room", "curve", "page", "photos", "times.csv"))
    assert contents(here) == before
