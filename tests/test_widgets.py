"""play and tune in Python: what they hand to the browser, and what they do when it moves a slider."""

import io
import itertools

import imageio.v3 as iio
import numpy as np
import pytest

from hdrlab.show import plots, widgets
from hdrlab.show.pictures import render


def square(level=100, side=16):
    return np.full((side, side), level, np.uint8)


def same(picture):
    return picture


def level_of(frame):
    return int(iio.imread(io.BytesIO(frame)).mean().round())


def test_play_draws_each_state_once_in_order():
    drawn = []

    def draw(state):
        drawn.append(state)
        return square(50 * state)

    player = widgets.play(range(5), draw, alt="A square")
    assert drawn == [0, 1, 2, 3, 4]
    assert [level_of(frame) for frame in player.frames] == pytest.approx([0, 50, 100, 150, 200], abs=2)


def test_play_takes_any_generator():
    def lighter():
        picture = square(10)
        for _ in range(3):
            yield picture
            picture = picture + 40

    assert [
        level_of(frame) for frame in widgets.play(lighter(), same, alt="A square").frames
    ] == pytest.approx([10, 50, 90], abs=2)


@pytest.mark.parametrize(
    "draw", [lambda k: plots.response(np.arange(256) * (k + 1)), lambda k: plots.axes().figure]
)
def test_play_takes_axes_and_figures(draw):
    player = widgets.play(range(2), draw, alt="A curve")
    assert all(iio.imread(io.BytesIO(frame)).shape == (360, 540, 3) for frame in player.frames)


def test_a_drawing_without_photographs_is_kept_to_the_bit():
    ax = plots.response(np.arange(256))
    (frame,) = widgets.play([ax], same, alt="A curve").frames
    assert np.array_equal(iio.imread(io.BytesIO(frame)), render(ax))


def test_every_frame_has_an_alt_text_of_its_own():
    assert widgets.play(range(3), square, alt="A square", name="level").alts == [
        f"A square, level {k}" for k in (1, 2, 3)
    ]
    assert widgets.play(range(2), square, alt=lambda k: f"Gray {k}").alts == ["Gray 0", "Gray 1"]


def test_the_page_gets_frames_and_scripts_and_nothing_from_elsewhere():
    state = widgets.play(range(2), square, alt="A square").get_state()
    assert len(state["frames"]) == 2 and state["index"] == 0
    for widget in (widgets.Player, widgets.Tuner):
        script = widget._esm
        assert "export default" in str(script) and "http" not in str(script) and "import " not in str(script)


def test_no_states_are_refused():
    with pytest.raises(ValueError, match="expected 1 to 200 states to play, got none"):
        widgets.play([], square, alt="Nothing")


def test_a_generator_that_never_ends_is_refused():
    with pytest.raises(ValueError, match="expected 1 to 200 states to play, got more"):
        widgets.play(itertools.count(), lambda _: square(), alt="For ever")


@pytest.mark.parametrize("alt", ["", lambda state: " "])
def test_play_refuses_pictures_without_alt_text(alt):
    with pytest.raises(ValueError, match="expected an alt text"):
        widgets.play(range(2), square, alt=alt)


def test_play_and_tune_refuse_a_draw_that_returns_something_else():
    for make in (
        lambda: widgets.play([1], lambda _: [1, 2], alt="A list"),
        lambda: widgets.tune(square, lambda _: [1, 2], alt="A list", level=(0, 9)),
    ):
        with pytest.raises(ValueError, match="expected draw to return a uint8 picture .* got list"):
            make()


def test_tune_starts_at_the_functions_defaults():
    tuner = widgets.tune(square, same, alt="A square", level=(0, 255), side=[8, 16, 32])
    assert tuner.parameters == {"level": 100, "side": 16}
    assert tuner.names == ["level", "side"] and tuner.values[1] == ["8", "16", "32"]
    assert level_of(tuner.frame) == 100 and tuner.shown == tuner.at


def test_tune_starts_in_the_middle_where_there_is_no_default():
    tuner = widgets.tune(lambda level: square(level), same, alt="A square", level=(0, 200, 10))
    assert tuner.parameters == {"level": 100}


@pytest.mark.parametrize(
    ("given", "values"),
    [
        ((1, 4), [1, 2, 3, 4]),
        ((0, 1, 0.25), [0, 0.25, 0.5, 0.75, 1]),
        ((0.0, 1.0), np.linspace(0, 1, 101)),
        ((0, 10, 4), [0, 4, 8]),
        ([1, 10, 100], [1, 10, 100]),
        (np.array([2, 4]), [2, 4]),
        (["hat", "flat"], ["hat", "flat"]),
    ],
)
def test_a_range_becomes_the_positions_of_its_slider(given, values):
    tuner = widgets.tune(lambda a: square(), same, alt="A square", a=given)
    at = []
    for k in range(len(tuner.values[0])):
        tuner.at = [k]
        at.append(tuner.parameters["a"])
    assert at == list(values) if isinstance(values[0], str) else np.allclose(at, values)


def test_moving_a_slider_shows_the_picture_of_its_new_position():
    tuner = widgets.tune(square, same, alt="A square", level=(0, 255))
    before = tuner.answers
    tuner.set_state({"at": [200]})  # as the browser's message does
    assert level_of(tuner.frame) == 200 and tuner.shown == [200] and tuner.answers == before + 1


def test_of_a_burst_of_moves_the_last_position_wins():
    tuner = widgets.tune(square, same, alt="A square", level=(0, 255))
    for level in (10, 250, 30, 80, 200, 60):
        tuner.set_state({"at": [level]})
    assert level_of(tuner.frame) == 60 and tuner.shown == tuner.at == [60]


def test_a_function_that_fails_says_so_beside_the_slider_and_recovers():
    def picky(level=100):
        if level > 128:
            raise ZeroDivisionError("too light")
        return square(level)

    tuner = widgets.tune(picky, same, alt="A square", stored=0, level=(0, 255))
    tuner.at = [200]
    assert tuner.problem == "ZeroDivisionError: too light" and level_of(tuner.frame) == 100
    tuner.at = [50]
    assert tuner.problem == "" and level_of(tuner.frame) == 50


def test_tune_stores_a_few_positions_of_each_slider_for_a_page_without_a_kernel():
    tuner = widgets.tune(square, same, alt="A square", stored=3, level=(0, 255), side=[8, 16, 32])
    stored = [tuple(position) for position in tuner.stored_at]
    assert set(stored) == {(100, 1), (0, 1), (128, 1), (255, 1), (100, 0), (100, 2)} and len(stored) == 6
    for (level, side), frame in zip(stored, tuner.stored, strict=True):
        picture = iio.imread(io.BytesIO(frame))
        assert picture.shape[0] == [8, 16, 32][side] and level_of(frame) == pytest.approx(level, abs=1)


def test_tune_stores_the_start_where_nothing_else_is_asked_for():
    assert widgets.tune(square, same, alt="A square", stored=0, level=(0, 255)).stored_at == [[100]]


@pytest.mark.parametrize(
    "given",
    [
        5,
        "hat",
        None,
        (1,),
        (1, 2, 3, 4),
        (5, 5),
        (9, 1),
        (0, 1, 0),
        (0, 1, -1),
        (0, 1, 5),
        (0, np.inf),
        [],
        [1],
    ],
)
def test_a_range_that_is_none_is_refused(given):
    with pytest.raises(ValueError, match="expected level as"):
        widgets.tune(square, same, alt="A square", level=given)


def test_tune_refuses_no_ranges_and_ranges_of_parameters_that_are_not_there():
    with pytest.raises(ValueError, match="expected at least one range"):
        widgets.tune(square, same, alt="A square")
    with pytest.raises(ValueError, match="expected parameters of the function, level, side; got hue"):
        widgets.tune(square, same, alt="A square", hue=(0, 9))


def test_tune_refuses_pictures_without_alt_text():
    with pytest.raises(ValueError, match="expected an alt text"):
        widgets.tune(square, same, alt="", level=(0, 9))
