"""Questions that readers answer before they see the result."""

import numpy as np
import pytest

from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.show.widgets import predict

RAMP = np.repeat(np.arange(0, 240, 2, dtype=np.uint8)[None], 40, axis=0)


def test_choice_has_its_pictures_and_the_true_answer():
    pictures = [np.full((30, 40), level, np.uint8) for level in (50, 150)]
    question = predict.choice("Which is brighter?", 1, ["left", "right"], pictures=pictures)
    assert (question.truth, question.told) == (1, "right.")
    assert [int(web.decode_picture(picture).mean().round()) for picture in question.pictures] == [
        50,
        150,
    ]


def test_the_slider_for_an_integer_has_whole_steps():
    assert predict.number("How many?", 3, (0, 7)).scale == [0, 7, 1]


@pytest.mark.parametrize(("truth", "between"), [(11.4, (0, 20)), (0.02, (0, 0.1))])
def test_the_slider_for_another_number_has_steps_of_at_most_two_percent(truth, between):
    low, high, step = predict.number("How much?", truth, between).scale
    assert (low, high) == between
    assert 0 < step <= 0.02 * (high - low)


def test_curve_has_margins_and_at_most_257_points():
    x = np.arange(65536)
    question = predict.curve("Draw it.", x, np.sqrt(x), names=("level", "light"))
    xs, ys = question.truth
    assert question.scale[:2] == [0, 65535] and question.scale[2] < 0 and question.scale[3] > 256
    assert len(xs) == 257 and np.allclose(ys, np.sqrt(xs))


@pytest.mark.parametrize(
    ("y", "ends"),
    [
        ([0, 0.243], [-0.04, 0.28]),
        ([-3, 40], [-8, 46]),
        ([1e6, 9e6], [200_000, 9_800_000]),
        ([5, 5], [4.8, 5.2]),
    ],
)
def test_scale_of_a_curve_ends_on_round_numbers_beyond_the_curve(y, ends):
    low, high = predict.curve("Draw it.", [0, 1], y, names=("x", "y")).scale[2:]
    assert [low, high] == pytest.approx(ends) and low < min(y) <= max(y) < high


@pytest.mark.parametrize("size", [(40, 120), (1200, 1950), (7, 5)])
def test_mask_of_a_place_has_the_size_of_its_picture_and_keeps_single_pixels(size):
    mask = np.zeros(size, bool)
    mask[size[0] // 2, size[1] // 2] = True
    question = predict.place("Where?", mask, np.zeros(size, np.uint8), alt="Night")
    picture, right = map(web.decode_picture, question.pictures)
    assert picture.shape == right.shape and max(picture.shape) <= 960
    assert np.count_nonzero(right[..., 0]) == 1


REFUSED = {
    "one label": lambda: predict.choice("?", 0, ["alone"]),
    "a truth that is no label": lambda: predict.choice("?", 2, ["a", "b"]),
    "a picture too few": lambda: predict.choice("?", 0, ["a", "b"], pictures=[RAMP]),
    "a truth off the scale": lambda: predict.number("?", 30, (0, 20)),
    "an empty scale": lambda: predict.number("?", 0, (0, 0)),
    "x that falls": lambda: predict.curve("?", [1, 0], [0, 1], names=("x", "y")),
    "y that is not finite": lambda: predict.curve("?", [0, 1], [0, np.nan], names=("x", "y")),
    "a mask of another size": lambda: predict.place("?", RAMP[1:] > 9, RAMP, alt="A ramp"),
    "an empty mask": lambda: predict.place("?", RAMP > 250, RAMP, alt="A ramp"),
    "no question": lambda: predict.number(" ", 1, (0, 2)),
}


@pytest.mark.parametrize("what", REFUSED)
def test_questions_with_bad_answers_are_rejected(what):
    with pytest.raises(InputError):
        REFUSED[what]()


def test_question_without_a_widget_has_an_answer_that_opens_on_a_click():
    question = predict.number(
        "How many stops?", 11.4, (0, 20), unit="stops", because="A photograph holds <8."
    )
    data, _ = question._repr_mimebundle_()
    assert data["text/plain"] == "How many stops?"
    assert (
        "<summary>Answer</summary>11.4 stops. A photograph holds &lt;8.</details>"
        in data["text/html"]
    )
