"""Validation of brackets, and their order from the shortest exposure to the longest."""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from hdrlab.core.bracket import Bracket, bracket, short_to_long
from hdrlab.core.steps import last

IMAGES = np.random.default_rng(0).integers(0, 256, (3, 4, 5), np.uint8)


@pytest.mark.parametrize("order", list(permutations(range(3))))
def test_frames_in_any_order_give_the_same_bracket(order):
    order = list(order)
    masks = IMAGES > 20
    made = bracket(
        IMAGES[order], np.array([1.0, 2, 4])[order], [f"{j}.jpg" for j in order], valid=masks[order]
    )
    assert np.array_equal(made.images, IMAGES) and np.array_equal(made.valid, masks)
    assert made.times.tolist() == [1, 2, 4] and made.names == ("0.jpg", "1.jpg", "2.jpg")


@pytest.mark.parametrize("order", list(permutations(range(3))))
def test_frames_of_equal_times_are_sorted_independently_of_their_order(order):
    images = IMAGES[list(order)]
    times = np.array([1.0, 1, 1])
    assert np.array_equal(
        images[short_to_long(images, times)], IMAGES[short_to_long(IMAGES, times)]
    )


def test_frames_without_names_are_numbered():
    assert bracket(IMAGES, [4, 2, 1]).names == ("frame 3", "frame 2", "frame 1")


def test_a_sorted_bracket_does_not_copy_the_images():
    assert np.shares_memory(bracket(IMAGES, [1, 2, 4]).images, IMAGES)


def test_a_bracket_keeps_its_times_when_the_callers_array_changes():
    times = np.array([1.0, 2, 4])
    taken = bracket(IMAGES, times)
    times[0] = 3
    assert taken.times.tolist() == [1, 2, 4]


def test_bracket_does_not_change_its_arguments():
    images = IMAGES.copy()
    times = np.array([4.0, 2, 1])
    bracket(images, times)
    assert np.array_equal(images, IMAGES) and times.tolist() == [4, 2, 1]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"times": [1, 2]}, "expected 3 exposure times"),
        ({"times": [1, 2, 0]}, "positive exposure times"),
        ({"names": ["a"]}, "expected 3 names, one per image, got 1"),
        ({"valid": np.ones((3, 4, 4))}, r"mask of shape \(3, 4, 5\), got"),
        ({"images": IMAGES.astype(float)}, "uint8 or uint16"),
    ],
)
def test_arguments_that_do_not_fit_together_raise_an_error(changes, message):
    with pytest.raises(ValueError, match=message):
        bracket(**({"images": IMAGES, "times": [1, 2, 3]} | changes))


def test_a_bracket_is_made_by_keywords_and_cannot_be_changed():
    made = bracket(IMAGES, [1, 2, 4])
    with pytest.raises(AttributeError):
        made.times = np.ones(3)
    with pytest.raises(TypeError):
        Bracket(IMAGES, np.ones(3), ("a", "b", "c"))
    assert replace(made, linear=True).linear and not made.linear


def test_old_code_may_still_unpack_a_bracket_but_is_warned():
    made = bracket(IMAGES, [1, 2, 4])
    with pytest.warns(DeprecationWarning, match="Bracket"):
        images, times, names, valid, linear = made
    assert images is made.images and times is made.times and names is made.names
    assert valid is None and not linear
    with pytest.warns(DeprecationWarning, match="Bracket"):
        images, times = made[:2]
    assert images is made.images and times is made.times
    with pytest.warns(DeprecationWarning, match="dataclasses.replace"):
        assert made._replace(linear=True).linear


def test_last_returns_the_last_state_and_raises_an_error_if_there_is_none():
    assert last(iter("abc")) == "c"
    with pytest.raises(ValueError, match="at least one state"):
        last([])
