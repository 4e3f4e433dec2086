"""`hdrlab why` explains a pixel of a map that `hdrlab assemble --why` made, photo by photo."""

import numpy as np
import pytest

from hdrlab import cli, scenes
from hdrlab.capture import camera
from hdrlab.io import radiance
from hdrlab.io.photos import write_picture


def run(*words, capsys):
    """Run the command in this process; return its exit code, and what it printed."""
    with pytest.raises(SystemExit) as stop:
        cli.run([str(word) for word in words])
    return (stop.value.code or 0, *capsys.readouterr())


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with three photos, their map, and the file for `hdrlab why`."""
    here = tmp_path_factory.mktemp("why")
    (here / "photos").mkdir()
    taken = camera.shoot(scenes.room((60, 90)), [0.02, 0.08, 0.32], rng=1)
    lines = []
    for name, image, time in zip("abc", taken.images, taken.times, strict=True):
        write_picture(here / f"photos/{name}.png", image)
        lines.append(f"{name}.png {time}")
    (here / "photos/times.txt").write_text("\n".join(lines))
    words = ["assemble", here / "photos", "-o", here / "room.exr", "--align", "none", "--why"]
    with pytest.raises(SystemExit) as stop:
        cli.run([str(word) for word in words])
    assert not stop.value.code
    return here


def test_why_explains_column_x_of_row_y(folder, capsys):
    code, out, _ = run("why", folder / "room.exr", "70,20", capsys=capsys)
    assert code == 0
    title, *table = out.splitlines()
    assert "x 70, y 20" in title
    assert [line.split()[0] for line in table if ".png" in line] == ["a.png", "b.png", "c.png"]
    L = radiance.read_radiance(folder / "room.exr")[20, 70] @ [0.2126, 0.7152, 0.0722]
    assert float(title.split(": ")[1].split()[0]) == pytest.approx(L, rel=6e-3)
    value = title.split(": ")[1]
    assert f"The map has {value}." in table[-1]


def test_assemble_names_the_file_and_its_size(folder, tmp_path, capsys):
    out = tmp_path / "room.hdr"
    code, output, _ = run("assemble", folder / "photos", "-o", out, "--why", capsys=capsys)
    assert code == 0 and f"{tmp_path / 'room.why.npz'} (" in output and " MB)" in output


@pytest.mark.parametrize("pixel", ["90,20", "20,60", "20", "a,b", "20,3.5", "20,30,40"])
def test_an_invalid_pixel_gives_one_line_and_exit_code_2(folder, pixel, capsys):
    code, out, error = run("why", folder / "room.exr", pixel, capsys=capsys)
    assert (code, out) == (2, "") and len(error.splitlines()) == 1
    if pixel in ("90,20", "20,60"):
        assert "90 x 60" in error
    else:
        assert "X,Y" in error


def test_a_map_without_its_file_says_how_to_make_it(folder, tmp_path, capsys):
    alone = tmp_path / "alone.exr"
    alone.write_bytes((folder / "room.exr").read_bytes())
    code, _, error = run("why", alone, "3,4", capsys=capsys)
    assert code == 2 and "alone.why.npz" in error and "--why" in error


def test_the_file_of_another_map_is_named(folder, tmp_path, capsys):
    other = tmp_path / "other.exr"
    radiance.write_radiance(other, 2 * radiance.read_radiance(folder / "room.exr"))
    (tmp_path / "other.why.npz").write_bytes((folder / "room.why.npz").read_bytes())
    code, _, error = run("why", other, "3,4", capsys=capsys)
    assert code == 2 and "other.why.npz" in error and "another map" in error


def test_a_map_of_another_size_is_another_map(folder, tmp_path, capsys):
    other = tmp_path / "other.exr"
    radiance.write_radiance(other, np.ones((4, 5, 3), np.float32))
    (tmp_path / "other.why.npz").write_bytes((folder / "room.why.npz").read_bytes())
    code, _, error = run("why", other, "3,4", capsys=capsys)
    assert code == 2 and "another map" in error
