"""The file beside a map from which `hdrlab why` explains its pixels."""

import zipfile
from dataclasses import replace

import numpy as np
import pytest

from hdrlab import pipeline, scenes
from hdrlab.capture import camera, movers
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io import radiance
from hdrlab.pipeline.evidence_file import evidence_path, explain_map_pixel, write_evidence


def room(shape=(150, 90), channels=3, bits=8):
    taken = camera.shoot(
        scenes.room(shape), [0.02, 0.08, 0.32], camera.Camera(bits=bits, hot=2e-3), rng=2
    )
    if channels == 1:
        taken = replace(taken, images=np.ascontiguousarray(taken.images[..., 1]))
    return pipeline.assemble(taken, align="none", ghosts="none")


def moving():
    wall = np.broadcast_to(np.geomspace(0.2, 0.8, 160).astype(np.float32), (120, 160)).copy()
    ball = movers.ball((120, 160), (60, 60), 15, 2.0)
    taken = movers.shoot(wall, ball, movers.path(3, (0, 40)), [0.25, 0.5, 1.0]).bracket
    return pipeline.assemble(taken, align="none", ghosts="regions", times="stated")


def assert_same(first, second):
    """Assert that two explanations agree to the rounding of the map's file."""
    assert first.sentence == second.sentence
    assert first.photos == second.photos
    assert first.changes == second.changes
    assert (first.y, first.x) == (second.y, second.x)


@pytest.mark.parametrize("suffix", [".exr", ".pfm", ".tif"])
@pytest.mark.parametrize("channels", [1, 3])
def test_the_file_gives_the_same_explanation_as_the_photos(suffix, channels, tmp_path):
    state = room(channels=channels)
    map_path = tmp_path / f"room{suffix}"
    radiance.write_radiance(map_path, state.E)
    path = write_evidence(evidence_path(map_path), state)
    assert path.name == "room.why.npz"
    E = radiance.read_radiance(map_path)
    stuck = [tuple(place) for place in np.argwhere(state.quality == 4)[:2]]
    # the first, the last and others, at the ends of bands of rows as well
    for y, x in [(0, 0), (149, 89), (63, 4), (64, 80), (128, 40), *stuck]:
        assert_same(explain_map_pixel(path, E, y, x), state.why(y, x))


def test_a_map_of_three_equal_channels_fits_gray_photos(tmp_path):
    state = room(channels=1)
    path = write_evidence(tmp_path / "room.why.npz", state)
    E = np.repeat(state.E[..., None], 3, axis=-1)
    assert_same(explain_map_pixel(path, E, 10, 20), state.why(10, 20))


def test_an_rgbe_map_with_its_rounding_is_accepted(tmp_path):
    state = room()
    map_path = tmp_path / "room.hdr"
    radiance.write_radiance(map_path, state.E)
    path = write_evidence(evidence_path(map_path), state)
    explanation = explain_map_pixel(path, radiance.read_radiance(map_path), 10, 20)
    assert explanation.luminance == pytest.approx(state.why(10, 20).luminance, rel=0.02)


def test_photos_left_out_because_something_moved_are_named_from_the_file(tmp_path):
    state = moving()
    path = write_evidence(tmp_path / "ball.why.npz", state)
    y, x = np.argwhere((~state.record.used).any(axis=0))[0]
    assert_same(explain_map_pixel(path, state.E, int(y), int(x)), state.why(int(y), int(x)))
    assert "moved" in state.why(int(y), int(x)).sentence


def test_sixteen_bits_masks_and_the_deviation_are_stored(tmp_path):
    raw = camera.Camera(response="linear", bits=16, full_well=20_000)
    taken = camera.shoot(scenes.room((60, 90)), [0.02, 0.08, 0.32], raw, rng=2)
    valid = np.ones(taken.images.shape[:3], bool)
    valid[0, :10] = False
    state = pipeline.assemble(replace(taken, valid=valid), align="none", ghosts="none")
    state = pipeline.measure_deviation(state)
    path = write_evidence(tmp_path / "room.why.npz", state)
    for y, x in [(5, 5), (30, 40)]:
        assert_same(explain_map_pixel(path, state.E, y, x), state.why(y, x))


def test_the_file_of_another_map_is_refused(tmp_path):
    state = room()
    path = write_evidence(tmp_path / "room.why.npz", state)
    for other in (state.E * np.float32(1.5), state.E[:-1], state.E[::-1]):
        with pytest.raises(InputError, match="another map"):
            explain_map_pixel(path, other, 3, 3)


def test_a_pixel_outside_of_the_map_is_refused_with_the_maps_size(tmp_path):
    state = room()
    path = write_evidence(tmp_path / "room.why.npz", state)
    with pytest.raises(InputError, match="90 x 150"):
        explain_map_pixel(path, state.E, 150, 3)


def test_a_damaged_file_is_one_clear_error(tmp_path):
    state = room()
    path = write_evidence(tmp_path / "room.why.npz", state)
    whole = path.read_bytes()
    rng = np.random.default_rng(1)
    damaged = [b"", b"no archive", whole[: len(whole) // 2]]
    for _ in range(20):
        changed = bytearray(whole)
        start = int(rng.integers(len(whole) - 40))
        changed[start : start + 40] = rng.integers(0, 256, 40, np.uint8).tobytes()
        damaged.append(bytes(changed))
    for content in damaged:
        path.write_bytes(content)
        try:
            explain_map_pixel(path, state.E, 3, 3)
        except FileFormatError as error:
            assert path.name in str(error)


def test_an_archive_without_the_arrays_is_refused(tmp_path):
    path = tmp_path / "room.why.npz"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("header.json", "{}")
    with pytest.raises(FileFormatError, match=r"room\.why\.npz"):
        explain_map_pixel(path, np.ones((4, 5), np.float32), 0, 0)


def test_arrays_that_do_not_fit_together_are_refused(tmp_path):
    state = room()
    path = write_evidence(tmp_path / "room.why.npz", state)
    small = write_evidence(tmp_path / "small.why.npz", room((40, 60)))
    with zipfile.ZipFile(path) as archive, zipfile.ZipFile(small) as other:
        members = {name: archive.read(name) for name in archive.namelist()}
        members["quality-0.npy"] = other.read("quality-0.npy")
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    with pytest.raises(FileFormatError, match=r"room\.why\.npz"):
        explain_map_pixel(path, state.E, 3, 3)


def test_numpy_reads_the_file_and_it_is_the_same_a_second_time(tmp_path):
    state = room()
    first = write_evidence(tmp_path / "a.npz", state).read_bytes()
    second = write_evidence(tmp_path / "b.npz", state).read_bytes()
    assert first == second
    with np.load(tmp_path / "a.npz", allow_pickle=False) as archive:
        np.testing.assert_array_equal(archive["times"], state.bracket.times)
