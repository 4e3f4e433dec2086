"""Options, tiers and order of the tests; real photos where they exist, and small simulated ones."""

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
THREAD_COUNT_VARIABLES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
# Hypothesis writes some files even without a database.
HYPOTHESIS_FOLDER = tempfile.TemporaryDirectory(prefix="hypothesis-")
set_hypothesis_home_dir(HYPOTHESIS_FOLDER.name)
# Real photos are next to the repository and not part of it.
DATA = Path(__file__).resolve().parents[2] / "shared" / "data"


def pytest_addoption(parser):
    parser.addoption(
        "--tier",
        choices=[*TIERS, ALL],
        help="Run the tests of this tier, see tests/tiers.py. [default: quick; all if files are named]",
    )
    parser.addoption(
        "--shuffle",
        type=int,
        metavar="SEED",
        help="Seed of a random order: of the files, and of the tests in each file.",
    )


def pytest_configure(config):
    """Register the tiers and choose one, let Ctrl-C reach child processes, and use one core per worker."""
    for tier, description in TIERS.items():
        config.addinivalue_line("markers", f"{tier}: {description}")
    if config.option.tier is None:
        has_named_files = config.args_source is pytest.Config.ArgsSource.ARGS
        config.option.tier = ALL if has_named_files else QUICK
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.default_int_handler)
    # Each worker has one core. More threads would wait for one another, and waiting threads keep a
    # core busy. The variables are for the workers, which start later, and for child processes.
    threadpoolctl.threadpool_limits(1)
    for name in THREAD_COUNT_VARIABLES:
        os.environ.setdefault(name, "1")


def pytest_ignore_collect(collection_path, config):
    """Skip files without a test of the tier, so that pytest need not import them."""
    return None if may_hold(collection_path, config.option.tier) else True


def pytest_collection_modifyitems(config, items):
    """Deselect the tests of other tiers and start with the long tests."""
    if config.option.tier != ALL:
        selected = []
        deselected = []
        for item in items:
            if tier_of(item) == config.option.tier:
                selected.append(item)
            else:
                deselected.append(item)
        config.hook.pytest_deselected(items=deselected)
        items[:] = selected
    if config.option.shuffle is None:
        items.sort(key=lambda item: start_order(item.nodeid))
    else:
        items[:] = shuffle(items, config.option.shuffle)


def shuffle(items, seed):
    """Return the tests in a random order; those of a file stay together because they share fixtures."""
    random = Random(seed)
    items_of_file = {}
    for item in items:
        items_of_file.setdefault(item.path, []).append(item)
    files = list(items_of_file.values())
    random.shuffle(files)
    for tests in files:
        random.shuffle(tests)
    return [item for tests in files for item in tests]


class NotebookScheduling(LoadScopeScheduling):
    """Give each worker all tests of a module, but of test_notebooks_run.py all tests of a notebook."""

    def _split_scope(self, nodeid):
        if nodeid.startswith("tests/test_notebooks_run.py"):
            return nodeid.partition("[")[2]
        return super()._split_scope(nodeid)


def pytest_xdist_make_scheduler(config, log):
    """Replace the scheduler of --dist=loadscope."""
    return NotebookScheduling(config, log) if config.option.dist == "loadscope" else None


def pytest_unconfigure():
    """Delete the folder of Hypothesis."""
    HYPOTHESIS_FOLDER.cleanup()


@pytest.fixture(scope="session")
def shared():
    """shared(name) -> the folder of a real data set; without it, the test is skipped."""

    def folder(name):
        if not (DATA / name).is_dir():
            pytest.skip(f"there are no real photos in ../shared/data/{name}")
        return DATA / name

    return folder


@pytest.fixture(scope="session")
def measured_curves(shared):
    """Return exposure and brightness of the 201 measured responses of DoRF, (201, n) each."""
    with np.load(shared("crf_curves") / "dorf_201.npz") as file:
        return file["irradiance"].astype(np.float64), file["brightness"].astype(np.float64)


@pytest.fixture(scope="session")
def photographs(shared):
    """photographs(name) -> the Bracket of a real data set, with the exposure times of exposures.csv."""

    @cache
    def read(name):
        folder = shared(name)
        with open(folder / "exposures.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        photos = [np.asarray(Image.open(folder / row["file"]).convert("RGB")) for row in rows]
        times = [float(row["exposure_time_s"]) for row in rows]
        return bracket(np.stack(photos), times, [row["file"] for row in rows])

    return read


@pytest.fixture(scope="session")
def decades():
    """decades(shape, seed) -> radiance (H, W[, 3]), log-uniform over five decades."""

    def make(shape=(120, 160), seed=0):
        return (10.0 ** np.random.default_rng(seed).uniform(-2.5, 2.5, shape)).astype(np.float32)

    return make


@pytest.fixture(scope="session")
def seven_frames(decades):
    """seven_frames(response) -> (E, Bracket): 7 photos, 2 stops apart, with the noise of a large sensor.

    The full well is 50 000 electrons and the read noise 5 electrons. At a medium exposure, the shot
    noise is 0.6 %, in addition to rounding to 8 bits.
    """

    @cache
    def shoot(response, shape=(120, 160), bits=8):
        E = decades(shape)
        times = camera.times_around(E, 7, stops=2)
        large_sensor = camera.Camera(response=response, bits=bits, full_well=50_000, read_noise=5)
        return E, camera.shoot(E, times, large_sensor, rng=7)

    return shoot


@pytest.fixture(scope="session")
def executed_folder(tmp_path_factory):
    """Return the folder for executed notebooks: HDRLAB_EXECUTED, or one that all workers share."""
    if os.environ.get("HDRLAB_EXECUTED"):
        return Path(os.environ["HDRLAB_EXECUTED"])
    base = tmp_path_factory.getbasetemp()
    shared_by_workers = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    return shared_by_workers / "executed-notebooks"


@pytest.fixture(scope="session")
def execute_notebook(executed_folder):
    """execute_notebook(path) -> the NotebookRun of a notebook; each notebook runs only once."""
    from support import executed_notebooks  # here, because it imports Jupyter, which takes a second

    return lambda path: executed_notebooks.run_once(path, executed_folder)
