"""A reader drops her own photos on a page of the site, and her browser makes a radiance map of them."""

from importlib.util import find_spec

import numpy as np
import pytest
import small_site
from PIL import Image
from PIL.ExifTags import IFD, Base

from hdrlab import pipeline, scenes
from hdrlab.capture import camera
from hdrlab.io import photos, radiance

pytestmark = [
    pytest.mark.wasm,
    pytest.mark.skipif(
        any(find_spec(name) is None for name in small_site.PACKAGES), reason=small_site.REASON
    ),
]
# the size of the scenes' photos: together with the hand's motion, 0.4 million pixels
SHAPE = (512, 768)
COUNT = 4
# Other versions of NumPy round differently, so a value may become the next one of the file, RGBE: in
# dark channels of colored pixels, such a step is the larger part of a stop.
COMMON_FRACTION = 0.999
MAX_COMMON_DIFFERENCE_STOPS = 0.005
MAX_DIFFERENCE_STOPS = 1.0
# what a browser may keep of files that are dropped on a page
DROP = """([selector, files]) => {
    const transfer = new DataTransfer();
    for (const { name, bytes } of files) transfer.items.add(new File([new Uint8Array(bytes)], name));
    const event = new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true });
    document.querySelector(selector).dispatchEvent(event);
}"""


@pytest.fixture(scope="module")
def bracket_files(tmp_path_factory):
    """JPEGs of a hand-held bracket, whose EXIF states the times, from dark to bright.

    Their colors have the full resolution, because decoders differ in how they enlarge reduced ones.
    """
    folder = tmp_path_factory.mktemp("bracket")
    scene = scenes.workshop(SHAPE)
    times = camera.times_around(scene, COUNT)
    taken = camera.shoot(scene, times, offsets=camera.shake(COUNT, rng=2), rng=3)
    files = []
    for number, (image, seconds) in enumerate(zip(taken.images, taken.times, strict=True), 1):
        exif = Image.Exif()
        exposure = {Base.ExposureTime: float(seconds), Base.FNumber: 8.0, Base.ISOSpeedRatings: 100}
        exif.get_ifd(IFD.Exif).update(exposure)
        path = folder / f"photo_{number}.jpg"
        Image.fromarray(image).save(path, quality=95, subsampling=0, exif=exif)
        files.append(path)
    return files


@pytest.fixture
def page(open_page):
    """The page for a reader's photos in a new browser."""
    return open_page(f"{small_site.PHOTOS_PAGE}.html")


def drop(page, paths):
    """Drop files on the page."""
    files = [{"name": path.name, "bytes": list(path.read_bytes())} for path in paths]
    page.evaluate(DROP, [".drop", files])


def times_of(page):
    """Return the exposure times in the list."""
    fields = page.get_by_role("textbox", name="Exposure time of").all()
    return [field.input_value() for field in fields]


def wait_for_map(page, folder):
    """Wait until the map can be downloaded, and return its path."""
    link = page.get_by_role("link", name="Download the radiance map")
    try:
        link.wait_for()
    except Exception as error:
        error.add_note(f"the page says: {page.locator('.own .state').inner_text()}")
        raise
    with page.expect_download() as waiting:
        link.click()
    path = folder / "downloaded.hdr"
    waiting.value.save_as(path)
    return path


def test_dropped_photos_become_the_map_of_the_command(site, page, bracket_files, tmp_path):
    assert not [url for url in page.requests if "/lite/" in url], "Python waits for photos"
    bad = tmp_path / "letter.jpg"
    bad.write_text("this is no photo")
    drop(page, [*bracket_files[:2], bad, *bracket_files[2:]])
    page.get_by_text(f"{COUNT} photos are ready").wait_for()
    problems = page.get_by_role("list", name="Files that were not added")
    assert "letter.jpg: expected a photo" in problems.inner_text()
    assert all(time.endswith(" s") for time in times_of(page))

    page.get_by_role("button", name="Start").click()
    path = wait_for_map(page, tmp_path)
    result = page.get_by_role("region", name="Result")
    summary = result.locator(".summary").inner_text()
    expected = pipeline.assemble(photos.read_bracket(bracket_files))
    verdict = "warning" if expected.warnings else "OK: "
    assert verdict in summary and f"the {COUNT} photos agree" in summary
    expected_path = tmp_path / "expected.hdr"
    radiance.write_radiance(expected_path, expected.E)
    E = radiance.read_radiance(path)
    expected_E = radiance.read_radiance(expected_path)
    assert E.shape == expected_E.shape
    is_lit = np.minimum(E, expected_E) > 0
    assert np.mean((E > 0) == (expected_E > 0)) > COMMON_FRACTION
    difference = np.abs(np.log2(E[is_lit] / expected_E[is_lit]))
    assert np.quantile(difference, COMMON_FRACTION) < MAX_COMMON_DIFFERENCE_STOPS
    assert difference.max() < MAX_DIFFERENCE_STOPS

    first = result.get_by_role("img").get_attribute("src")
    result.get_by_role("button", name="durand").click()
    result.get_by_text("Tone mapping: durand").wait_for()
    assert result.get_by_role("img").get_attribute("src") != first
    result.get_by_role("slider", name="Exposure").press("ArrowLeft")
    result.get_by_text("Without tone mapping").wait_for()
    elsewhere = [url for url in page.requests if not url.startswith((site, "data:", "blob:"))]
    assert elsewhere == [] and page.problems == []


def test_a_time_that_is_missing_can_be_typed_or_is_estimated(page, bracket_files, tmp_path):
    bare = tmp_path / "without_time.jpg"
    with Image.open(bracket_files[1]) as image:
        image.save(bare, quality=95)
    page.locator("input[type=file]").set_input_files([bracket_files[0], bare, *bracket_files[2:]])
    page.get_by_text(f"{COUNT} photos are ready").wait_for()
    page.get_by_text("No exposure time in without_time.jpg").wait_for()
    start = page.get_by_role("button", name="Start")
    start.press("Enter")
    page.get_by_text("relative exposure times").wait_for()

    header = photos.read_header(bracket_files[1])
    field = page.get_by_role("textbox", name="Exposure time of without_time.jpg")
    field.fill(f"{header.exposure.seconds:.6f} s")
    assert page.get_by_text("No exposure time in").count() == 0
    start.press("Enter")
    page.get_by_role("button", name="Stop").wait_for()
    wait_for_map(page, tmp_path)
    assert page.get_by_text("relative exposure times").count() == 0


def test_one_photo_photos_of_two_sizes_and_stop_leave_the_page_usable(
    page, bracket_files, tmp_path
):
    start = page.get_by_role("button", name="Start")
    state = page.get_by_role("status")
    problems = page.get_by_role("list", name="Files that were not added")
    drop(page, bracket_files[:1])
    page.get_by_text("One photo is no bracket").wait_for()
    start.press("Enter")
    assert "One photo is no bracket" in state.inner_text()

    small = tmp_path / "small.jpg"
    with Image.open(bracket_files[1]) as image:
        image.reduce(2).save(small, exif=image.getexif())
    drop(page, [small])
    page.get_by_text("2 photos are ready").wait_for()
    start.press("Enter")
    page.get_by_text("expected frames of one size").wait_for()

    page.get_by_role("button", name="Remove small.jpg").press("Enter")
    drop(page, bracket_files)  # the first is in the list already
    assert "photo_1.jpg: a photo of this name" in problems.inner_text()
    page.get_by_text(f"{COUNT} photos are ready").wait_for()
    start.press("Enter")
    page.get_by_role("button", name="Stop").click()
    assert state.inner_text() == "Stopped."
    start.press("Enter")
    wait_for_map(page, tmp_path)
    assert page.problems == []
