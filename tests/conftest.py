"""What the tests share: real photographs where they are at hand, small simulated ones everywhere."""

import csv
import os
import signal
import tempfile
import threading
from functools import cache
from pathlib import Path
from random import Random

import numpy as np
import pytest
import threadpoolctl
from hypothesis import settings
from hypothesis.configuration import set_hypothesis_home_dir
from PIL import Image
from tiers import ALL, QUICK, TIERS, may_hold, start_order, tier_of
from xdist.scheduler import LoadScopeScheduling

from hdrlab.capture import camera
from hdrlab.core.bracket import bracket

pytest.register_assert_rewrite("support.laws", "hdrlab.course.checks.laws")
settings.register_profile("hdrlab", derandomize=True, database=None, deadline=None, max_examples=50)
settings.load_profile("hdrlab")
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
SCRATCH = tempfile.TemporaryDirectory(
    prefix="hypothesis-"
)  # it keeps notes of its own, even without a database
set_hypothesis_home_dir(SCRATCH.name)


def pytest_addoption(parser):
    parser.addoption(
        "--tier",
        choices=[*TIERS, ALL],
        help="run the tests of this tier, see tests/tiers.py (quick; all where files are named)",
    )
    parser.addoption(
        "--shuffle",
        type=int,
        metavar="SEED",
        help="run the tests in a random order: files, and the tests of each, by this seed",
    )


def pytest_configure(config):
    """Register the tiers and choose one; let Ctrl-C reach what tests start; use one core a worker."""
    for tier, description in TIERS.items():
        config.addinivalue_line("markers", f"{tier}: {description}")
    if config.option.tier is None:
        named = config.args_source is pytest.Config.ArgsSource.ARGS
        config.option.tier = ALL if named else QUICK
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.default_int_handler)
    # a worker has a core: had it threads for all, they would wait for one another, and such waiting
    # computes
    threadpoolctl.threadpool_limits(1)
    for name in THREADS:
        os.environ.setdefault(
            name, "1"
        )  # for the workers, which begin after this, and for all that a test starts


def pytest_ignore_collect(collection_path, config):
    """Do not import files that hold no test of the tier."""
    return None if may_hold(collection_path, config.option.tier) else True


def pytest_collection_modifyitems(config, items):
    """Leave out the tests of other tiers, and begin with the long ones."""
    if config.option.tier != ALL:
        own = []
        others = []
        for item in items:
            selected = own if tier_of(item) == config.option.tier else others
            selected.append(item)
        config.hook.pytest_deselected(items=others)
        items[:] = own
    if config.option.shuffle is None:
        items.sort(key=lambda item: start_order(item.nodeid))
    else:
        items[:] = shuffle(items, config.option.shuffle)


def shuffle(items, seed):
    """Return tests in a random order; those of a file stay together, which share what they made."""
    random = Random(seed)
    items_of_file = {}
    for item in items:
        items_of_file.setdefault(item.path, []).append(item)
    files = list(items_of_file.values())
    random.shuffle(files)
    for tests in files:
        random.shuffle(tests)
    return [item for tests in files for item in tests]


class ByNotebook(LoadScopeScheduling):
    """Where the tests of a module stay together, those of one notebook do: a module of them takes long."""

    def _split_scope(self, nodeid):
        own = nodeid.startswith("tests/test_notebooks_run.py")
        return nodeid.partition("[")[2] if own else super()._split_scope(nodeid)


def pytest_xdist_make_scheduler(config, log):
    """Keep together what --dist=loadscope does, but for notebooks."""
    return ByNotebook(config, log) if config.option.dist == "loadscope" else None


def pytest_unconfigure():
    """Leave nothing behind."""
    SCRATCH.cleanup()


DATA = (
    Path(__file__).resolve().parents[2] / "shared" / "data"
)  # beside the repository, not part of it


@pytest.fixture(scope="session")
def shared():
    """shared(name) -> the folder of a real data set, or the test is skipped."""

    def folder(name):
        if not (DATA / name).is_dir():
            pytest.skip(f"the real photographs of ../shared/data/{name} are not here")
        return DATA / name

    return folder


@pytest.fixture(scope="session")
def measured_curves(shared):
    """Exposure and brightness of the 201 measured responses of DoRF, (201, n) each."""
    with np.load(shared("crf_curves") / "dorf_201.npz") as file:
        return file["irradiance"].astype(np.float64), file["brightness"].astype(np.float64)


@pytest.fixture(scope="session")
def photographs(shared):
    """photographs(name) -> the Bracket of a real data set, with the times of its exposures.csv."""

    @cache
    def read(name):
        folder = shared(name)
        with open(folder / "exposures.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        images = np.stack(
            [np.asarray(Image.open(folder / row["file"]).convert("RGB")) for row in rows]
        )
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

    A well of 50 000 electrons and 5 electrons of noise: at a middling level 0.6 % of shot noise,
    beside the rounding to 8 bits.
    """

    @cache
    def shoot(response, shape=(120, 160), bits=8):
        E = decades(shape)
        times = camera.times_around(E, 7, stops=2)
        return E, camera.shoot(
            E,
            times,
            camera.Camera(response=response, bits=bits, full_well=50_000, read_noise=5),
            rng=7,
        )

    return shoot


@pytest.fixture(scope="session")
def kept(tmp_path_factory):
    """Where executed notebooks are kept: in the folder HDRLAB_EXECUTED, or in one of these tests alone."""
    base = tmp_path_factory.getbasetemp()
    shared_by_workers = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    return Path(os.environ.get("HDRLAB_EXECUTED") or shared_by_workers / "notebooks-that-were-run")


@pytest.fixture(scope="session")
def executed(kept):
    """executed(path) -> the notebook as it was run from the top: its file, and its untrue sentences."""
    from support import executed_notebooks  # it loads what runs notebooks, which takes a second

    return lambda path: executed_notebooks.run_once(path, kept)
