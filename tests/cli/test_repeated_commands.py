"""A command that writes into the folder of the photos gives the same result when it is repeated."""

import imagecodecs
import numpy as np
import pytest
import tifffile
from PIL import Image
from support.codec_features import require_avif, require_avif_primaries

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.cli import run
from hdrlab.io import album, decode, photos, radiance
from hdrlab.io.own_pictures import is_own_picture, is_radiance_map

SHAPE = (64, 96)
TIMES = (0.01, 0.04, 0.16)


@pytest.fixture(params=[".jpg"])
def folder(request, tmp_path):
    """Return a folder of three photos and a list of their times."""
    bracket = camera.shoot(scenes.room(SHAPE), TIMES, rng=1)
    lines = []
    for j, image in enumerate(bracket.images):
        name = f"photo{j}{request.param}"
        photos.write_picture(tmp_path / name, image)
        lines.append(f"{name} {bracket.times[j]}\n")
    (tmp_path / "times.txt").write_text("".join(lines))
    return tmp_path


def run_command(*words):
    """Run hdrlab, and raise an AssertionError if it ends with an error."""
    with pytest.raises(SystemExit) as ended:
        run([str(word) for word in words])
    assert not ended.value.code


def select_names(folder):
    return [path.stem for path in album.select(folder).paths]


def test_assemble_reads_the_header_of_each_photo_once(folder, monkeypatch):
    opened = []
    read_header = decode.read_header

    def count(path, **options):
        opened.append(path.name)
        return read_header(path, **options)

    monkeypatch.setattr(decode, "read_header", count)
    run_command("assemble", folder, "--times", folder / "times.txt", "-o", folder / "map.hdr")
    assert sorted(opened) == ["photo0.jpg", "photo1.jpg", "photo2.jpg"]


@pytest.mark.papers
@pytest.mark.parametrize(
    ("folder", "map_name"),
    [(".jpg", "map.tif"), (".tif", "photo0_hdr.tiff"), (".png", "map.exr")],
    indirect=["folder"],
)
def test_assemble_gives_the_same_map_twice(folder, map_name):
    out = folder / map_name
    words = ["assemble", folder, "--times", folder / "times.txt", "-o", out]
    words += ["--picture", folder / "picture.png", "--report", folder / "report"]
    run_command(*words)
    first = radiance.read_radiance(out)
    run_command(*words)
    np.testing.assert_array_equal(radiance.read_radiance(out), first)


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("a.jpg", "picture"),
        ("a.tif", "picture"),
        ("a.png", "picture"),
        ("a.jpg", "ultrahdr"),
        ("a.png", "png"),
        ("a.avif", "avif"),
        ("a.jxl", "jxl"),
    ],
)
def test_tone_mapped_files_of_every_kind_are_no_photos(folder, name, kind):
    if kind == "avif":
        require_avif()
        require_avif_primaries()
    run_command("assemble", folder, "--times", folder / "times.txt", "-o", folder / "map.exr")
    before = select_names(folder)
    for _ in range(2):
        run_command("tonemap", folder / "map.exr", "-o", folder / name, "--to", kind)
        assert select_names(folder) == before


def test_other_commands_on_a_folder_can_be_repeated(folder):
    photo = next(folder.glob("photo1.*"))
    for _ in range(2):
        # fmt: skip
        run_command(
            "calibrate",
            folder,
            "--times",
            folder / "times.txt",
            "-o",
            folder / "curve.m",
            "--plot",
            folder / "plot.png",
        )
        run_command("correct", photo, "-o", folder / "corrected.png")
        assert select_names(folder) == ["photo0", "photo1", "photo2"]


def test_marked_files_keep_their_pixels(tmp_path):
    require_avif_primaries()
    E = np.random.default_rng(0).uniform(0.01, 4, (32, 48, 3)).astype(np.float32)
    radiance.write_radiance(tmp_path / "map.exr", E)
    run_command("tonemap", tmp_path / "map.exr", "-o", tmp_path / "a.avif")
    run_command("tonemap", tmp_path / "map.exr", "-o", tmp_path / "a.jpg", "--to", "ultrahdr")
    run_command("tonemap", tmp_path / "map.exr", "-o", tmp_path / "b.jpg")
    for name in ("a.avif", "a.jpg"):
        assert is_own_picture(tmp_path / name)
    assert imagecodecs.avif_decode((tmp_path / "a.avif").read_bytes()).shape == E.shape
    np.testing.assert_array_equal(
        photos.read_photo(tmp_path / "a.jpg"), photos.read_photo(tmp_path / "b.jpg")
    )
    hdr = imagecodecs.ultrahdr_decode((tmp_path / "a.jpg").read_bytes())
    assert hdr.shape[:2] == E.shape[:2]


def test_ultra_hdr_photos_of_phones_stay_photos(tmp_path):
    light = np.random.default_rng(0).uniform(0.1, 3, (64, 64, 4)).astype(np.float16)
    for name in ("a.jpg", "b.jpg"):
        (tmp_path / name).write_bytes(imagecodecs.ultrahdr_encode(light))
    assert [path.name for path in album.select(tmp_path).paths] == ["a.jpg", "b.jpg"]


def test_avif_photos_of_other_programs_stay_photos(tmp_path):
    require_avif()
    image = np.random.default_rng(0).integers(0, 255, (64, 64, 3), np.uint8)
    for name in ("a.avif", "b.avif"):
        Image.fromarray(image).save(tmp_path / name, "AVIF")
    assert [path.name for path in album.select(tmp_path).paths] == ["a.avif", "b.avif"]


def test_floating_point_tiff_of_another_program_is_a_map_and_no_photo(folder):
    E = np.ones((*SHAPE, 3), np.float32)
    tifffile.imwrite(folder / "light.tif", E, photometric="rgb")
    assert is_radiance_map(folder / "light.tif")
    selection = album.select(folder)
    assert "light" not in [path.stem for path in selection.paths]
    assert any("light.tif" in text and "map" in text for text in selection.details)
