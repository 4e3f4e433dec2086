"""A reader's own photos: the answers of the browser's Python, run here without a browser.

`tests/wasm/test_photos_in_chromium.py` drops photos on the page.
"""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from PIL.ExifTags import IFD, Base

from hdrlab import pipeline, scenes
from hdrlab.capture import camera
from hdrlab.core.optional import MissingPackageError
from hdrlab.course.site.lite import own_photos
from hdrlab.io import photos, radiance
from hdrlab.pipeline import catalogue, pictures

SHAPE = (96, 144)
COUNT = 4


def exif_of(seconds, orientation=1):
    """Return EXIF with an exposure."""
    exif = Image.Exif()
    exif[Base.Orientation] = orientation
    exposure = {Base.ExposureTime: float(seconds), Base.FNumber: 8.0, Base.ISOSpeedRatings: 100}
    exif.get_ifd(IFD.Exif).update(exposure)
    return exif


@pytest.fixture(scope="module")
def taken():
    """A bracket of a simulated camera, on a tripod."""
    scene = scenes.room(SHAPE)
    times = [1 / 64, 1 / 16, 1 / 4, 1]
    return camera.shoot(scene, times, rng=1)


@pytest.fixture(scope="module")
def files(taken, tmp_path_factory):
    """Its photos as JPEGs, from dark to bright."""
    folder = tmp_path_factory.mktemp("files")
    paths = []
    for number, (image, seconds) in enumerate(zip(taken.images, taken.times, strict=True), 1):
        path = folder / f"photo_{number}.jpg"
        Image.fromarray(image).save(path, quality=95, exif=exif_of(seconds))
        paths.append(path)
    return paths


@pytest.fixture
def own(tmp_path):
    """The photos of a reader, none at first."""
    return own_photos.OwnPhotos(tmp_path / "own")


def add(own, path):
    """Add a file as the page does, and return the answer."""
    shutil.copy(path, own.photo_folder / path.name)
    return json.loads(own.add(path.name))


def assemble(own, times, report=lambda *_: None, **options):
    """Press Start, and return the answer."""
    return json.loads(own.assemble(json.dumps(times), report, **options))


def add_all(own, paths):
    """Add files, and return the times in the list."""
    return {path.name: add(own, path)["time"] for path in paths}


def test_the_map_is_that_of_the_command_and_its_file_repeats_the_warnings(own, files, tmp_path):
    times = add_all(own, files)
    assert list(times.values()) == ["1/64 s", "1/16 s", "1/4 s", "1 s"]
    answer = assemble(own, times)
    assert json.loads(own.write_map()) == {}
    expected = pipeline.assemble(photos.read_bracket(files))
    expected_path = tmp_path / "expected.hdr"
    radiance.write_radiance(expected_path, expected.E)
    written = own.folder / own_photos.MAP_NAME
    assert np.array_equal(radiance.read_radiance(written), radiance.read_radiance(expected_path))
    assert answer["warnings"] == list(expected.warnings)
    assert f"the {COUNT} photos agree" in answer["summary"]
    unit = radiance.read_luminance_of_unit(written)
    assert unit == pytest.approx(expected.bracket.luminance_of_unit)


def test_each_operator_writes_the_picture_of_the_library(own, files):
    assert "press Start" in json.loads(own.tone_map("reinhard"))["error"]
    assemble(own, add_all(own, files))
    expected = pipeline.assemble(photos.read_bracket(files))
    answer = json.loads(own.tone_map("reinhard"))
    assert "reinhard" in answer["settings"]
    picture = photos.read_photo(own.folder / "tone_mapped.png")
    assert np.array_equal(picture, pipeline.develop(expected.E, "reinhard"))
    assert (own.folder / "tone_mapped.jpg").exists()


def test_the_page_has_a_button_for_each_operator():
    theme = Path(own_photos.__file__).parents[1] / "theme"
    listed = re.search(r"operators = (\[.*?\])", (theme / "own_photos.html").read_text("utf8"))[1]
    assert sorted(json.loads(listed)) == sorted([pictures.AUTO, *catalogue.names("tonemap")])


def test_every_step_is_reported_before_the_map_is_there(own, files):
    reports = []
    assemble(own, add_all(own, files), lambda *report: reports.append(report))
    words = [text for text, _, _ in reports]
    done = [done / total for _, done, total in reports]
    assert words[0] == f"Reading photo 1 of {COUNT}"
    assert "Aligning the photos" in words and "Merging the photos" in words
    assert done == sorted(done) and done[-1] < 1


def test_a_bad_file_is_named_and_the_others_stay(own, files, tmp_path):
    letter = tmp_path / "letter.jpg"
    letter.write_text("this is no photo")
    drawing = tmp_path / "drawing.gif"
    Image.new("RGB", (8, 8)).save(drawing)
    deep = tmp_path / "deep.png"
    Image.fromarray(np.zeros((8, 8), np.uint16)).save(deep)
    for path in (letter, drawing, deep):
        error = add(own, path)["error"]
        assert error.startswith(f"{path.name}: ") and str(own.folder) not in error
        assert not (own.photo_folder / path.name).exists()
    assert "error" not in assemble(own, add_all(own, files))


def test_one_photo_too_many_photos_and_two_sizes_are_refused_in_words(own, files, tmp_path):
    times = add_all(own, files)
    first, *_, last = times
    assert "one photo is no bracket" in assemble(own, {first: times[first]})["error"]
    small = tmp_path / "small.jpg"
    Image.new("RGB", (20, 10)).save(small, exif=exif_of(1))
    with_small = {first: times[first], last: times[last], small.name: add(own, small)["time"]}
    error = assemble(own, with_small)["error"]
    assert "expected frames of one size" in error and "small.jpg is 20 x 10" in error
    own.remove(small.name)
    more = {}
    for number in range(own_photos.MAX_PHOTOS):
        path = tmp_path / f"more_{number}.jpg"
        shutil.copy(files[0], path)
        more[path.name] = add(own, path)["time"]
    assert "at most" in assemble(own, times | more)["error"]


def test_times_that_are_unknown_are_estimated_and_typed_ones_are_used(own, files):
    times = add_all(own, files)
    stated = assemble(own, times)
    unknown = dict.fromkeys(times, "")
    estimated = assemble(own, unknown)
    assert any("estimated from the pixels" in note for note in estimated["notes"])
    assert not any("estimated from the pixels" in note for note in stated["notes"])

    # twice the time for each photo: the same map at half the radiance, and the scene is darker
    own.write_map()
    typed = {name: f"{2 * seconds_of(time):.8f} s" for name, time in times.items()}
    assert "error" not in assemble(own, typed)
    own.write_map()
    E = radiance.read_radiance(own.folder / own_photos.MAP_NAME)
    expected = pipeline.assemble(photos.read_bracket(files)).E
    assert np.median(E / expected) == pytest.approx(0.5, rel=0.02)

    first = next(iter(times))
    error = assemble(own, times | {first: "a moment"})["error"]
    assert error.startswith(first) and "1/60" in error


def seconds_of(text):
    """Return the number of "1/64 s" or "1 s"."""
    numerator, _, denominator = text.removesuffix(" s").partition("/")
    return float(numerator) / float(denominator or 1)


def test_advice_about_times_names_the_list_and_other_options_are_explained(own, files, monkeypatch):
    unknown = dict.fromkeys(add_all(own, files), "")
    answer = assemble(own, unknown)
    texts = [*answer["warnings"], *answer["notes"]]
    assert any("times into the list" in text for text in texts)
    assert not any("--" in text for text in texts)

    # as if the page had nothing in place of these options
    monkeypatch.setattr(own_photos, "ADVICE_OF_THE_PAGE", {})
    assert own_photos.OPTION_NOTE in assemble(own, unknown)["notes"]


def test_large_photos_are_reduced_stand_upright_and_keep_their_exposure(
    own, taken, tmp_path, monkeypatch
):
    monkeypatch.setattr(own_photos, "MAX_PHOTO_PIXELS", 4000)
    paths = []
    for number, (image, seconds) in enumerate(zip(taken.images, taken.times, strict=True), 1):
        path = tmp_path / f"turned_{number}.jpg"
        turned = Image.fromarray(np.rot90(image))  # upright after a quarter turn to the right
        turned.save(path, quality=95, exif=exif_of(seconds, orientation=6))
        paths.append(path)
    height, width = taken.images.shape[1:3]
    answers = [add(own, path) for path in paths]
    assert answers[0]["size"] == f"{width} x {height}"
    reduced_width, reduced_height = map(int, answers[0]["reducedTo"].split(" x "))
    assert 3500 < reduced_width * reduced_height <= 4000 and reduced_width > reduced_height
    times = {path.name: answer["time"] for path, answer in zip(paths, answers, strict=True)}
    assert list(times.values())[-1] == "1 s"
    assert "error" not in assemble(own, times)
    picture = photos.read_photo(own.folder / "tone_mapped.png").mean(axis=-1)
    lost = np.subtract((reduced_height, reduced_width), picture.shape)
    assert (lost >= 0).all() and (lost <= 4).all(), "the alignment crops the map"
    full = pipeline.develop(pipeline.assemble(photos.read_bracket(paths)).E).mean(axis=-1)
    reference = np.asarray(Image.fromarray(full.astype(np.uint8)).resize(picture.shape[::-1]))
    assert np.corrcoef(picture.ravel(), reference.ravel())[0, 1] > 0.85


def test_the_page_learns_that_scikit_image_is_missing(own, files, monkeypatch):
    def raise_missing(*_, **__):
        raise MissingPackageError("this part of hdrlab needs skimage", name="skimage")

    times = add_all(own, files)
    monkeypatch.setattr(pipeline, "assemble_steps", raise_missing, raising=False)
    assert assemble(own, times)["isMissing"]
    monkeypatch.undo()
    assert "error" not in assemble(own, times, align="mtb")


def test_too_little_memory_is_an_answer_in_words(own, files, monkeypatch):
    def raise_memory_error(*_, **__):
        raise MemoryError

    times = add_all(own, files)
    monkeypatch.setattr(pipeline, "assemble_steps", raise_memory_error, raising=False)
    assert "too little memory" in assemble(own, times)["error"]


def test_the_exposure_of_the_slider_doubles_with_each_stop():
    E = np.full((40, 50, 3), 5, np.float32)
    E[0, 0] = 40  # three stops above the median
    levels = [int(own_photos.expose(E, stops)[0, 0, 0]) for stops in (-3, -2)]
    middle = int(own_photos.expose(E, 0)[9, 9, 0])
    assert levels[0] == middle and levels[1] == int(own_photos.expose(E, 1)[9, 9, 0])
    assert own_photos.expose(E, 0)[0, 0].tolist() == [255, 255, 255]
