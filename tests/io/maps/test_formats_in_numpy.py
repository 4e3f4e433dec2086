"""Maps are read and written without OpenEXR and imagecodecs, as in a browser, and compared with both."""

from types import SimpleNamespace

import numpy as np
import OpenEXR
import pytest

from hdrlab.errors import FileFormatError
from hdrlab.io import radiance
from hdrlab.io.maps import exr, layers, rgbe
from hdrlab.scenes.places import FOLDER

NO_CODECS = SimpleNamespace(has_codec=lambda name: False)
COMPRESSIONS = {
    "none": OpenEXR.NO_COMPRESSION,
    "ZIPS": OpenEXR.ZIPS_COMPRESSION,
    "ZIP": OpenEXR.ZIP_COMPRESSION,
}


@pytest.fixture
def without_openexr(monkeypatch):
    """Return a function that hides the module OpenEXR from hdrlab."""
    return lambda: monkeypatch.setattr(exr, "OpenEXR", None)


@pytest.fixture
def without_rgbe(monkeypatch):
    """Return a function that hides imagecodecs' RGBE codec from hdrlab."""
    return lambda: monkeypatch.setattr(rgbe, "imagecodecs", NO_CODECS)


def light(shape=(37, 21, 3)):
    """Return radiance with smooth and noisy parts, over ten stops."""
    rng = np.random.default_rng(3)
    E = np.exp(rng.uniform(-3, 4, shape)).astype(np.float32)
    E[: shape[0] // 2] = E[0]
    return E


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.exr")), ids=lambda path: path.stem)
def test_a_scene_is_read_to_the_bit(path, without_openexr):
    expected = layers.read_layers(path)
    without_openexr()
    decoded = layers.read_layers(path)
    assert decoded.keys() == expected.keys()
    for name, layer in expected.items():
        assert np.array_equal(decoded[name], layer, equal_nan=True)


@pytest.mark.parametrize("compression", COMPRESSIONS)
@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.uint32])
def test_files_of_the_official_writer_are_read(compression, dtype, tmp_path, without_openexr):
    path = tmp_path / "a.exr"
    Y = (light()[..., 0] * 50).astype(dtype)
    header = {"compression": COMPRESSIONS[compression], "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"Y": Y}) as file:
        file.write(str(path))
    expected = exr.read(path)
    without_openexr()
    assert np.array_equal(exr.read(path), expected)
    assert exr.read_dtypes(path) == (np.dtype(dtype).name,)


@pytest.mark.parametrize("half", [False, True])
@pytest.mark.parametrize("shape", [(37, 21, 3), (16, 5), (1, 1)])
def test_the_official_reader_reads_written_files(half, shape, tmp_path, monkeypatch):
    path = tmp_path / "a.exr"
    E = light(shape)
    with monkeypatch.context() as patch:
        patch.setattr(exr, "OpenEXR", None)
        exr.write(path, E, half=half, comments=["by hand"], white_luminance=12.5)
        assert radiance.read_luminance_of_unit(path) == 12.5
        decoded = exr.read(path)
    assert np.array_equal(exr.read(path), decoded)
    assert np.array_equal(decoded, E.astype(np.float16 if half else np.float32))
    header = exr.read_header(path)
    assert header.attributes["comments"] == "by hand"
    assert header.attributes["whiteLuminance"] == 12.5


def test_several_parts_are_written_and_read(tmp_path, without_openexr, monkeypatch):
    path = tmp_path / "layers.exr"
    written = {"radiance": light(), "depth": light((37, 21)), "mover": light((37, 21, 4))}
    with monkeypatch.context() as patch:
        patch.setattr(exr, "OpenEXR", None)
        layers.write_layers(path, written)
        read_by_numpy = layers.read_layers(path)
    read_by_openexr = layers.read_layers(path)
    for name, layer in written.items():
        assert np.array_equal(read_by_numpy[name], layer)
        assert np.array_equal(read_by_openexr[name], layer)


def test_other_compressions_are_refused_with_what_to_install(tmp_path, without_openexr):
    path = tmp_path / "a.exr"
    header = {"compression": OpenEXR.PIZ_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"RGB": light()}) as file:
        file.write(str(path))
    without_openexr()
    with pytest.raises(FileFormatError, match="PIZ.*pip install OpenEXR"):
        exr.read(path)


def test_damaged_files_are_refused_or_read_without_another_error(tmp_path, without_openexr):
    path = tmp_path / "a.exr"
    exr.write(path, light())
    data = path.read_bytes()
    without_openexr()
    rng = np.random.default_rng(1)
    refused = 0
    for _ in range(200):
        damaged = bytearray(data)
        damaged[int(rng.integers(0, len(data)))] = int(rng.integers(0, 256))
        path.write_bytes(damaged[: int(rng.integers(8, len(data) + 1))])
        try:
            exr.read(path)
        except FileFormatError:
            refused += 1
    assert refused > 100


@pytest.mark.parametrize("shape", [(9, 8, 3), (70, 300, 3), (5, 7, 3), (4, 40)])
def test_run_lengths_of_rgbe_are_those_that_imagecodecs_reads(shape, tmp_path, monkeypatch):
    path = tmp_path / "a.hdr"
    E = light(shape)
    with monkeypatch.context() as patch:
        patch.setattr(rgbe, "imagecodecs", NO_CODECS)
        rgbe.write(path, E)
        decoded = rgbe.read(path)
    assert np.array_equal(rgbe.read(path), decoded)
    assert np.allclose(decoded, E.reshape(decoded.shape[:2] + (-1,)), rtol=0, atol=E.max() / 128)


def test_run_lengths_of_imagecodecs_are_read(tmp_path, without_rgbe):
    path = tmp_path / "a.hdr"
    rgbe.write(path, light((40, 130, 3)))
    expected = rgbe.read(path)
    without_rgbe()
    assert np.array_equal(rgbe.read(path), expected)
    path.write_bytes(path.read_bytes()[:-9])
    with pytest.raises(FileFormatError, match="damaged or cut short"):
        rgbe.read(path)
