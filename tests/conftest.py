"""What the tests share: real photographs where they are at hand, small simulated ones everywhere."""

import csv
import tempfile
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings
from hypothesis.configuration import set_hypothesis_home_dir
from PIL import Image

from hdrlab.capture import camera
from hdrlab.core.bracket import bracket

pytest.register_assert_rewrite("laws", "hdrlab.course.checks.laws")
settings.register_profile("hdrlab", derandomize=True, database=None, deadline=None, max_examples=50)
settings.load_profile("hdrlab")
SCRATCH = tempfile.TemporaryDirectory(
    prefix="hypothesis-"
)  # it keeps notes of its own, even without a database
set_hypothesis_home_dir(SCRATCH.name)


def pytest_unconfigure():
    """Leave nothing behind."""
    SCRATCH.cleanup()


DATA = Path(__file__).resolve().parents[2] / "shared" / "data"  # beside the repository, not part of it


@pytest.fixture(scope="session")
def shared():
    """shared(name) -> the folder of a real data set, or the test is skipped."""

    def folder(name):
        if not (DATA / name).is_dir():
            pytest.skip(f"the real photographs of ../shared/data/{name} are not here")
        return DATA / name

    return folder


@pytest.fixture(scope="session")
def photographs(shared):
    """photographs(name) -> the Bracket of a real data set, with the times of its exposures.csv."""

    @cache
    def read(name):
        folder = shared(name)
        with open(folder / "exposures.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        images = np.stack([np.asarray(Image.open(folder / row["file"]).convert("RGB")) for row in rows])
        times = [float(row["exposure_time_s"]) for row in rows]
        return bracket(images, times, [row["file"] for row in rows])

    return read


@pytest.fixture(scope="session")
def decades():
    """decades(shape, seed) -> radiance (H, W[, 3]), its logarithms even over five decades."""

    def make(shape=(120, 160), seed=0):
        return (10.0 ** np.random.default_rng(seed).uniform(-2.5, 2.5, shape)).astype(np.float32)

    return make


@pytest.fixture(scope="session")
def seven_frames(decades):
    """seven_frames(response) -> (E, Bracket): 7 frames, 2 stops apart, noise of a large sensor.

    A well of 50 000 electrons and 5 electrons of noise: at a middling level 0.6 % of shot noise, beside the
    rounding to 8 bits.
    """

    @cache
    def shoot(response, shape=(120, 160), bits=8):
        E = decades(shape)
        times = camera.times_around(E, 7, stops=2)
        return E, camera.shoot(
            E, times, camera.Camera(response=response, bits=bits, full_well=50_000, read_noise=5), rng=7
        )

    return shoot
