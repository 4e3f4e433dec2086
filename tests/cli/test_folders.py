"""Commands that read a folder with many photos."""

from datetime import datetime, timedelta

import pytest
from PIL import ExifTags, Image

from hdrlab import cli, scenes
from hdrlab.capture import camera

START = datetime(2024, 5, 1, 12, 0, 0)


@pytest.fixture(scope="module")
def two_brackets(tmp_path_factory):
    """Return a folder with two brackets of three photos each."""
    folder = tmp_path_factory.mktemp("walk")
    room = scenes.room((60, 80))
    taken = camera.shoot(room, camera.times_around(room, 3, stops=2), rng=1)
    for j in range(6):
        exif = Image.Exif()
        tags = exif.get_ifd(ExifTags.IFD.Exif)
        tags[ExifTags.Base.ExposureTime] = float(taken.times[j % 3])
        tags[ExifTags.Base.FNumber] = 8.0
        tags[ExifTags.Base.ISOSpeedRatings] = 100
        moment = START + timedelta(seconds=j + 300 * (j // 3))
        tags[ExifTags.Base.DateTimeOriginal] = moment.strftime("%Y:%m:%d %H:%M:%S")
        exif[ExifTags.Base.Make] = "Canon"
        exif[ExifTags.Base.Model] = "Canon EOS 5D"
        image = Image.fromarray(taken.images[j % 3])
        image.save(folder / f"IMG_{j}.jpg", quality=95, subsampling=0, exif=exif)
    return folder


def run(capsys, *words):
    """Return exit code, standard output and standard error of a command."""
    with pytest.raises(SystemExit) as stop:
        cli.run([str(word) for word in words])
    output = capsys.readouterr()
    return stop.value.code or 0, output.out, output.err


def test_assemble_takes_the_first_of_two_brackets_and_lists_both(two_brackets, tmp_path, capsys):
    code, _, notes = run(capsys, "assemble", two_brackets, "-o", tmp_path / "a.hdr")
    assert code == 0
    assert "2 brackets" in notes
    assert "IMG_0.jpg" in notes
    assert "IMG_3.jpg" in notes


def test_assemble_all_writes_a_map_of_each_bracket(two_brackets, tmp_path, capsys):
    out = tmp_path / "a.hdr"
    picture = tmp_path / "a.png"
    words = ("assemble", two_brackets, "--all", "-o", out, "--picture", picture)
    assert run(capsys, *words)[0] == 0
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["a_IMG_0.hdr", "a_IMG_0.png", "a_IMG_3.hdr", "a_IMG_3.png"]


def test_a_bracket_that_fails_does_not_stop_the_others(two_brackets, tmp_path, capsys):
    photos = tmp_path / "photos"
    photos.mkdir()
    for path in two_brackets.iterdir():
        content = path.read_bytes()
        if path.name in ("IMG_0.jpg", "IMG_1.jpg"):
            # the header stays, so that the damage is found only when the pixels are read
            content = content[: len(content) // 3]
        (photos / path.name).write_bytes(content)
    code, _, errors = run(capsys, "assemble", photos, "--all", "-o", tmp_path / "a.hdr")
    assert code == 2
    assert "IMG_0.jpg" in errors
    assert (tmp_path / "a_IMG_3.hdr").exists()


def test_assemble_all_needs_a_folder(two_brackets, tmp_path, capsys):
    paths = sorted(two_brackets.iterdir())
    code, _, errors = run(capsys, "assemble", *paths, "--all", "-o", tmp_path / "a.hdr")
    assert code == 2
    assert "folder" in errors


def test_info_of_a_folder_shows_exposure_and_camera_of_each_photo(two_brackets, capsys):
    code, table, _ = run(capsys, "info", two_brackets)
    rows = [line for line in table.splitlines() if "IMG_" in line]
    assert code == 0
    assert len(rows) == 6
    for row in rows:
        assert "Canon EOS 5D" in row
        assert "80 x 60" in row
        assert " 100 " in row


def test_info_of_a_folder_names_what_is_missing_and_bad_files_and_goes_on(tmp_path, capsys):
    Image.new("RGB", (30, 20), (90, 90, 90)).save(tmp_path / "plain.png")
    (tmp_path / "bad.jpg").write_bytes(b"no photo")
    code, table, _ = run(capsys, "info", tmp_path)
    assert code == 0
    plain = next(line for line in table.splitlines() if line.strip().startswith("plain.png"))
    for missing in ("time", "ISO", "f-number", "camera"):
        assert missing in plain
    assert "bad.jpg" in table


def test_a_meter_reading_outside_of_the_photos_is_refused(two_brackets, tmp_path, capsys):
    out = tmp_path / "a.hdr"
    code, _, errors = run(capsys, "assemble", two_brackets, "-o", out, "--calibrate", "80,5=100")
    assert code == 2
    assert "--calibrate" in errors
    assert not out.exists()


def test_a_wrong_headroom_is_refused_before_the_map_is_read(tmp_path, capsys):
    (tmp_path / "a.hdr").write_bytes(b"no map")
    words = ("tonemap", tmp_path / "a.hdr", "-o", tmp_path / "a.jpg", "--to", "ultrahdr")
    code, _, errors = run(capsys, *words, "--headroom", "0.5")
    assert code == 2
    assert "headroom" in errors
