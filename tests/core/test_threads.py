"""Work in threads gives the results of one thread, in the same order, and raises its errors."""

import threading

import numpy as np
import pytest

from hdrlab.core import colour, threads
from hdrlab.fast import _bands


@pytest.fixture(params=[1, 3], ids=["one processor", "three"], autouse=True)
def count(request, monkeypatch):
    monkeypatch.setattr(threads, "THREADS", request.param)
    return request.param


def test_results_come_in_the_order_of_the_items():
    assert list(threads.map_in_threads(lambda n: n * n, iter(range(50)))) == [
        n * n for n in range(50)
    ]
    assert list(threads.map_in_threads(abs, [])) == []


def test_an_error_is_raised_in_order_and_waiting_items_are_not_started():
    begun = []

    def work(n):
        begun.append(n)
        return 1 // (n - 2)

    answers = threads.map_in_threads(work, range(50))
    assert [next(answers), next(answers)] == [-1, -1]
    with pytest.raises(ZeroDivisionError):
        next(answers)
    assert len(begun) < 10


def test_at_most_one_item_per_thread_is_started_ahead(count):
    taken = []
    answers = threads.map_in_threads(abs, (taken.append(n) or n for n in range(50)))
    next(answers)
    assert len(taken) <= count + 1
    answers.close()


def test_small_images_use_no_threads_and_numpy_error_settings_hold_in_threads(count):
    own = threading.get_ident()
    for pixels, alone in ((100, True), (threads.MIN_PIXELS_FOR_THREAD, count == 1)):
        with np.errstate(divide="raise"), pytest.raises(FloatingPointError):
            list(
                threads.map_in_threads(lambda n: np.float32(1) / n, [np.float32(0)], pixels=pixels)
            )
        used = set(threads.map_in_threads(lambda _: threading.get_ident(), range(9), pixels=pixels))
        assert (used == {own}) == alone


def test_a_large_picture_is_the_same_in_bands(monkeypatch):
    monkeypatch.setattr(threads, "MIN_PIXELS_FOR_THREAD", 1 << 19)
    E = np.random.default_rng(1).uniform(0.01, 9, (820, 650, 3)).astype(np.float32)
    L = colour.luminance(E)
    Ld = _bands.banded(lambda L: L / (1 + L), L)
    assert np.array_equal(Ld, L / (1 + L))
    for way in colour.WAYS:
        halves = [
            colour.render(*(array[part] for array in (E, L, Ld)), way=way)
            for part in (np.s_[:400], np.s_[400:])
        ]
        assert np.array_equal(colour.render(E, L, Ld, way=way), np.concatenate(halves))


def test_background_work_starts_immediately_where_there_are_processors(
    count,
):
    begun = threading.Event()
    answer = threads.run_in_background(lambda: begun.set() or 7)
    assert begun.wait(60 * (count > 1)) == (count > 1)
    assert answer.result() == 7


def test_an_error_in_background_work_is_raised_by_result():
    with pytest.raises(ZeroDivisionError):
        threads.run_in_background(lambda: 1 // 0).result()


def test_work_on_a_small_image_runs_in_the_calling_thread():
    task = threads.run_in_background(threading.get_ident, pixels=threads.MIN_PIXELS_FOR_THREAD - 1)
    assert task.result() == threading.get_ident()


def test_an_abandoned_generator_does_not_wait_for_its_threads(monkeypatch):
    """The garbage collector may close it while another thread starts; waiting then would never end."""
    monkeypatch.setattr(threads, "THREADS", 2)
    may_end = threading.Event()

    def work(item):
        if item:
            may_end.wait(60)
        return item

    results = threads.map_in_threads(work, range(8))
    assert next(results) == 0
    results.close()
    is_waiting = not may_end.is_set()
    may_end.set()
    assert is_waiting
