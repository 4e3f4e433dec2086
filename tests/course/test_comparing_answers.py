"""Comparison of an answer with the expected one: all verdicts and messages."""

import numpy as np
import pytest

from hdrlab.course.checks import compare
from hdrlab.course.checks.compare import AnswerMismatch, finite, numbers, parts, plain, same, states


@pytest.fixture(autouse=True)
def notes():
    """The notes of a check; there are none at its start."""
    compare.notes.clear()
    yield compare.notes
    compare.notes.clear()


def refused(ask, *arguments, **named):
    """Return the message of a refusal, after checking that the same message is stored."""
    with pytest.raises(AnswerMismatch) as raised:
        ask(*arguments, **named)
    assert str(raised.value) == raised.value.message
    return str(raised.value)


def test_require_raises_a_mismatch_with_its_message_and_details():
    compare.require(True, "it holds")
    compare.require([0], "something is there")
    with pytest.raises(AnswerMismatch, match="^it does not hold$") as raised:
        compare.require(0, "it does not hold", answer=np.ones(2))
    assert (raised.value.kind, raised.value.expected, raised.value.answer.tolist()) == (
        "values",
        None,
        [1, 1],
    )


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (None, "the answer: expected numbers, got None; return the result"),
        ("abc", "the answer: expected one array of numbers, got str of 3"),
        (b"ab", "the answer: expected one array of numbers, got bytes of 2"),
        ({"a": 1}, "the answer: expected one array of numbers, got something else"),
        ([], "the answer: expected one array of numbers, got list of 0"),
        ((), "the answer: expected one array of numbers, got tuple of 0"),
        ([[1, 2], [3]], "the answer: expected one array of numbers, got list of 2"),
        (["a"], "the answer: expected one array of numbers, got list of 1"),
        ([1j], "the answer: expected one array of numbers, got list of 1"),
        (np.array(1j), "the answer: expected real numbers, got dtype complex128"),
        (np.array(["a"]), "the answer: expected real numbers, got dtype <U1"),
    ],
)
def test_an_answer_that_is_not_an_array_of_real_numbers_is_refused(answer, message, notes):
    assert refused(numbers, answer) == message and not notes
    assert refused(numbers, answer, what="w") == message.replace("the answer", "w", 1)


@pytest.mark.parametrize(
    "answer", [True, 3, 2.5, np.uint8(7), np.arange(3), np.zeros((0, 2)), np.array(True)]
)
def test_real_numbers_of_any_type_are_accepted(answer, notes):
    assert np.array_equal(numbers(answer), answer) and not notes


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        ([1, 2.5], ("list of 2", "(2,)")),
        (((1, 2), (3, 4), (5, 6)), ("tuple of 3", "(3, 2)")),
        ([[True]], ("list of 1", "(1, 1)")),
    ],
)
def test_a_list_of_numbers_is_accepted_as_an_array_with_a_note(answer, message, notes):
    assert np.array_equal(numbers(answer, what="w"), np.array(answer))
    (note,) = notes
    assert note.startswith("w: ") and all(part in note for part in message)


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        ((3,), (3, 1)),
        ((1, 3, 1), (3,)),
        ((2, 1, 3), (2, 3)),
        ((1, 1), ()),
        ((), (1,)),
        ((2, 3), (1, 2, 1, 3)),
    ],
)
def test_axes_of_length_one_are_added_or_removed_with_a_note(shape, expected, notes):
    values = np.arange(np.prod(shape, dtype=int)).reshape(shape)
    reshaped = compare.as_shape(values, expected)
    assert reshaped.shape == expected and reshaped.ravel().tolist() == values.ravel().tolist()
    (note,) = notes
    assert str(shape) in note and str(expected) in note


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        ((3, 2), (2, 3)),
        ((6,), (2, 3)),
        ((2,), (3,)),
        ((2, 2), (2,)),
        ((2,), (2, 2)),
        ((0, 1), (0,)),
        ((1,), (2,)),
    ],
)
def test_a_wrong_shape_is_refused_with_both_shapes(shape, expected, notes):
    message = refused(compare.as_shape, np.zeros(shape), expected)
    assert str(expected) in message and str(shape) in message and not notes


def test_an_array_of_the_right_shape_is_returned_without_a_note(notes):
    array = np.zeros((0, 1))
    assert compare.as_shape(array, (0, 1)) is array and not notes


def test_the_expected_number_of_parts_is_required():
    assert parts((1, 2, 3), 2) == (1, 2) and parts([1, 2], 2) == (1, 2)
    for answer, named in (((1,), "tuple of 1"), ("abc", "str of 3"), (None, "None")):
        message = refused(parts, answer, 2)
        assert "2 parts" in message and named in message
    message = refused(parts, np.ones(3), 2, what="w")
    assert message.startswith("w: ") and "2 parts" in message and "array" in message


def test_an_array_with_a_row_for_each_part_is_accepted_with_a_note(notes):
    first, second = parts(np.array([[1.0, 2], [3, 4]]), 2, what="mean and sd")
    assert first.tolist() == [1, 2] and second.tolist() == [3, 4]
    assert len(notes) == 1 and "mean and sd" in notes[0]
    refused(parts, np.array(2.0), 2)


def test_at_least_one_state_is_required():
    assert states((1, 2)) == [1, 2] and states([0]) == [0]
    for answer, named in (
        ([], "list of 0"),
        ("abc", "str of 3"),
        (np.ones(3), "one array"),
        (7, "one array"),
    ):
        message = refused(states, answer)
        assert "states" in message and named in message


@pytest.mark.parametrize(
    ("answer", "expected", "tolerance", "message"),
    [
        (1.5, 1, 0.5, ""),
        (1.5, 1, 0.25, "expected 1, got 1.5; the difference may be 0.25"),
        (-1, 1, 1, "expected 1, got -1; the difference may be 1"),
        (1, 2, 0, "expected 2, got 1"),
        (
            [1, 2, 9],
            [1, 2, 3],
            1,
            "expected 3 at (2,), got 9; the difference may be 1; 1 of 3 values are off",
        ),
        (
            [0, 5, 9],
            [1, 2, 3],
            1,
            "expected 3 at (2,), got 9; the difference may be 1; 2 of 3 values are off",
        ),
        (
            [[1, 2], [3, 5]],
            [[1, 2], [3, 4]],
            0,
            "expected 4 at (1, 1), got 5; 1 of 4 values are off",
        ),
        ([np.nan, 1], [1, 1], 9, "expected finite numbers, got 1 NaN or infinite ones"),
        ([-np.inf, np.nan], [1, 1], 9, "expected finite numbers, got 2 NaN or infinite ones"),
        ([np.nan, 1], [np.nan, 1], 0, ""),
        ([2, 1], [np.nan, 1], 9, "expected NaN where nothing is known, got numbers at 1 places"),
        (
            [2, np.inf],
            [np.nan, np.nan],
            9,
            "expected NaN where nothing is known, got numbers at 2 places",
        ),
        (np.zeros((0, 2)), np.zeros((0, 2)), 0, ""),
        (
            np.uint8([1]),
            [-1],
            1,
            "expected -1 at (0,), got 1; the difference may be 1; 1 of 1 values are off",
        ),
    ],
)
def test_values_within_the_tolerance_pass_and_the_largest_error_is_reported(
    answer, expected, tolerance, message
):
    answer = np.array(answer)
    if message:
        assert refused(same, answer, expected, tolerance, what="w") == f"w: {message}"
    else:
        assert same(answer, expected, tolerance) is answer


@pytest.mark.parametrize(
    ("where", "answer", "message"),
    [
        ([True, False], [1, 7], ""),
        ([True, False], [1, np.nan], ""),
        ([False, True], [1, 7], "expected 2 at (1,), got 7; 1 of 2 values are off"),
        (False, [np.nan, 7], ""),
        (True, [3, 2], "expected 1 at (0,), got 3; 1 of 2 values are off"),
        (
            np.array([True, False]),
            [np.inf, 2],
            "expected finite numbers, got 1 NaN or infinite ones",
        ),
    ],
)
def test_values_outside_the_mask_are_ignored(where, answer, message):
    if message:
        assert refused(same, np.array(answer), [1, 2], 0, where=where) == f"the answer: {message}"
    else:
        assert same(np.array(answer), [1, 2], 0, where=where).shape == (2,)


def test_an_expected_nan_outside_the_mask_is_ignored():
    assert same(np.array([5.0, 1]), [np.nan, 1], 0, where=[False, True]).tolist() == [5, 1]
    assert "at 1 places" in refused(same, np.array([5.0, 1]), [np.nan, 1], 0, where=[True, False])


@pytest.mark.parametrize(
    ("shape", "named", "kind"),
    [
        ((8,), {}, "values"),
        ((9,), {}, "curve"),
        ((9, 9), {}, "values"),
        ((), {}, "values"),
        ((9, 9), {"picture": True}, "image"),
        ((9,), {"picture": True, "kind": "curve"}, "image"),
        ((9,), {"kind": "values"}, "values"),
        ((3, 3), {"kind": "curve"}, "curve"),
    ],
)
def test_a_mismatch_keeps_both_arrays_and_how_to_draw_them(shape, named, kind):
    with pytest.raises(AnswerMismatch) as raised:
        same(np.ones(shape), np.zeros(shape), 0.5, **named)
    assert raised.value.kind == kind
    assert not raised.value.expected.any() and raised.value.answer.all()
    assert raised.value.expected.shape == raised.value.answer.shape == shape


def test_finite_requires_the_shape_and_finite_numbers():
    assert finite([[1, 2]], (2,)).tolist() == [1, 2]
    message = refused(finite, np.ones(3), (2,))
    assert "(2,)" in message and "(3,)" in message
    text = refused(finite, np.array([1, np.nan, np.inf]), (3,), what="w")
    assert text.startswith("w: ") and "2 NaN" in text


def test_answers_of_trusted_code_have_the_types_that_the_channel_gives():
    assert plain(None) is None and plain("ab") == "ab" and plain(b"ab") == b"ab"
    plain_answer = plain(([1, 2.5], iter([3]), (4,), 5))
    assert isinstance(plain_answer, tuple)
    assert [type(item) for item in plain_answer] == [
        list,
        list,
        tuple,
        np.ndarray,
    ]
    assert plain_answer[3].shape == ()
    assert plain_answer[3] == 5
    assert plain_answer[0][1] == 2.5
    assert plain_answer[1] == [3]


@pytest.mark.parametrize(
    ("answer", "named"),
    [
        (None, "nothing (None)"),
        (np.float32(1), "one array"),
        (1.5, "one array"),
        ({}, "something else"),
    ],
)
def test_the_message_names_the_type_of_the_answer(answer, named):
    assert refused(parts, answer, 1).endswith(f"got {named}")


def test_points_marks_a_check_with_its_points_and_optional_requirement():
    assert compare.points(4).mark.args == (4,) and compare.points(4).mark.kwargs == {"needs": ""}
    assert compare.points(1, needs="other").mark.kwargs == {"needs": "other"}
