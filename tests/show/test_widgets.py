"""Widgets in Python: what they send to the browser, and how they react to a moved slider."""

import base64
import gc
import io
import itertools
import re

import imageio.v3 as iio
import numpy as np
import pytest
import threadpoolctl
from matplotlib.figure import Figure
from support.half_floats import decode_half_floats

from hdrlab import errors, scenes
from hdrlab.calibration import matching
from hdrlab.capture.sensor import Sensor
from hdrlab.io import web
from hdrlab.show import plots, widgets
from hdrlab.show.pictures import render
from hdrlab.show.plots import reuse, tones


def square(level=100, side=16):
    return np.full((side, side), level, np.uint8)


def same(picture):
    return picture


def unrolled(frame):
    """Return the image of run-length encoded colors, decoded run by run as a script would."""
    width, height = np.frombuffer(frame[:8], "<u4")
    rest = frame[8:]
    rows = [
        pixel
        for at in range(0, len(rest), 4)
        for pixel in [tuple(rest[at : at + 3])] * rest[at + 3]
    ]
    return np.array(rows, np.uint8).reshape(height, width, 3)


def level_of(frame):
    picture = (
        iio.imread(io.BytesIO(frame)) if frame[:2] in (b"\xff\xd8", b"RI") else unrolled(frame)
    )
    return int(picture.mean().round())


def test_play_draws_each_state_once_and_in_order():
    drawn = []

    def draw(state):
        drawn.append(state)
        return square(50 * state)

    player = widgets.play(range(5), draw, alt="A square")
    assert drawn == [0, 1, 2, 3, 4]
    assert [level_of(frame) for frame in player.frames] == pytest.approx(
        [0, 50, 100, 150, 200], abs=2
    )


def test_play_accepts_generators():
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
def test_play_accepts_axes_and_figures(draw):
    player = widgets.play(range(2), draw, alt="A curve")
    assert all(iio.imread(io.BytesIO(frame)).shape == (360, 540, 3) for frame in player.frames)


def test_frames_of_plots_are_lossless():
    ax = plots.response(np.arange(256))
    (frame,) = widgets.play([ax], same, alt="A curve").frames
    assert np.array_equal(iio.imread(io.BytesIO(frame)), render(ax))


def test_every_frame_has_its_own_alt_text():
    assert widgets.play(range(3), square, alt="A square", name="level").alts == [
        f"A square, level {k}" for k in (1, 2, 3)
    ]
    assert widgets.play(range(2), square, alt=lambda k: f"Gray {k}").alts == ["Gray 0", "Gray 1"]


def test_scripts_of_widgets_load_nothing_from_elsewhere():
    state = widgets.play(range(2), square, alt="A square").get_state()
    assert len(state["frames"]) == 2 and state["index"] == 0
    kinds = [widgets.Player, widgets.Tuner, widgets.Wiper, widgets.Blinker, widgets.Brush]
    kinds += [widgets.BilateralKernel, widgets.GradientLine]
    kinds += [widgets.ScreenMatch]
    kinds += [widgets.GainScreen, widgets.PixelMean, widgets.ExposureWindow, widgets.ZoneScale]
    for widget in kinds:
        script = widget._esm
        assert str(script).count("export default") == 1 and "http" not in str(script)
        assert "import " not in str(script) and "import(" not in str(script)


def test_saved_notebooks_contain_scripts_without_comments_and_indentation():
    lines = str(widgets.Player._esm).splitlines()
    assert "export default { render };" in lines
    assert not any(line.startswith(("//", " ")) for line in lines)


def test_play_rejects_no_states():
    with pytest.raises(ValueError, match="1 to 200 states to play.*none"):
        widgets.play([], square, alt="Nothing")


def test_play_rejects_endless_generators():
    with pytest.raises(ValueError, match="1 to 200 states to play.*more"):
        widgets.play(itertools.count(), lambda _: square(), alt="For ever")


@pytest.mark.parametrize("alt", ["", lambda state: " "])
def test_play_rejects_empty_alt_texts(alt):
    with pytest.raises(ValueError, match="alt text"):
        widgets.play(range(2), square, alt=alt)


def test_play_and_tune_reject_a_draw_that_returns_another_type():
    for make in (
        lambda: widgets.play([1], lambda _: [1, 2], alt="A list"),
        lambda: widgets.tune(square, lambda _: [1, 2], alt="A list", level=(0, 9)),
    ):
        with pytest.raises(ValueError, match="draw.*list"):
            make()


def test_sliders_start_at_the_functions_defaults():
    tuner = widgets.tune(square, same, alt="A square", level=(0, 255), side=[8, 16, 32])
    assert tuner.parameters == {"level": 100, "side": 16}
    assert tuner.names == ["level", "side"] and tuner.values[1] == ["8", "16", "32"]
    assert level_of(tuner.frame) == 100 and tuner.shown == tuner.at


def test_sliders_without_a_default_start_in_the_middle():
    tuner = widgets.tune(lambda level: square(level), same, alt="A square", level=(0, 200, 10))
    assert tuner.parameters == {"level": 100}


@pytest.mark.parametrize(
    ("positions", "values"),
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
def test_slider_has_the_positions_of_its_range_or_list(positions, values):
    tuner = widgets.tune(lambda a: square(), same, alt="A square", a=positions)
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


def test_tune_calls_function_and_draw_with_one_blas_thread():
    seen = []

    def note(_):
        seen.extend(pool["num_threads"] for pool in widgets.BLAS_THREADS.info())
        return square()

    with widgets.BLAS_THREADS.limit(limits=2):
        widgets.tune(lambda level: note(level), note, alt="A square", level=[1, 2])
    assert set(seen) == {1}


def test_last_position_of_a_burst_of_moves_is_shown():
    tuner = widgets.tune(square, same, alt="A square", level=(0, 255))
    for level in (10, 250, 30, 80, 200, 60):
        tuner.set_state({"at": [level]})
    assert level_of(tuner.frame) == 60 and tuner.shown == tuner.at == [60]


def test_tuner_shows_the_functions_error_and_recovers():
    def picky(level=100):
        if level > 128:
            raise ZeroDivisionError("too light")
        return square(level)

    tuner = widgets.tune(picky, same, alt="A square", stored=0, level=(0, 255))
    tuner.at = [200]
    assert tuner.problem == "ZeroDivisionError: too light" and level_of(tuner.frame) == 100
    tuner.at = [50]
    assert tuner.problem == "" and level_of(tuner.frame) == 50


def test_tune_stores_all_positions_for_pages_without_a_kernel_start_first():
    tuner = widgets.tune(square, same, alt="A square", level=(0, 150, 10), side=[8, 16, 32])
    assert tuner.stored_at[0] == [10, 1]
    assert sorted(tuner.stored_at) == [[level, side] for level in range(16) for side in range(3)]
    for (level, side), frame in zip(tuner.stored_at, tuner.stored, strict=True):
        picture = iio.imread(io.BytesIO(frame))
        assert picture.shape[0] == [8, 16, 32][side]
        assert level_of(frame) == pytest.approx(10 * level, abs=1)


def test_tune_stores_an_even_grid_of_many_positions_with_ends_and_start():
    tuner = widgets.tune(square, same, alt="A square", stored=12, level=(0, 255), side=[8, 16, 32])
    positions = [[0, 100, 170, 255], [0, 1, 2]]
    assert sorted(tuner.stored_at) == [
        [level, side] for level in positions[0] for side in positions[1]
    ]


def test_stored_positions_of_words_are_thinned_out_last():
    def shade(colour="red", level=0):
        return square(level)

    tuner = widgets.tune(
        shade, same, alt="Gray", stored=20, colour=["red", "green", "blue"], level=(0, 9)
    )
    assert {position[0] for position in tuner.stored_at} == {0, 1, 2} and len(tuner.stored_at) == 18


def test_slider_of_words_can_have_a_single_stored_picture():
    tuner = widgets.tune(
        lambda colour, a: square(), same, alt="Gray", stored=1, colour=["red", "blue"], a=[1, 2]
    )
    assert tuner.stored_at == [tuner.at] and len(tuner.stored) == 1


def test_environment_variable_sets_the_number_of_stored_pictures(monkeypatch):
    monkeypatch.setenv("HDRLAB_STORED", "256")
    assert len(widgets.tune(square, same, alt="A square", level=(0, 255)).stored) == 256
    monkeypatch.delenv("HDRLAB_STORED")
    assert len(widgets.tune(square, same, alt="A square", level=(0, 255)).stored) == 48


def test_total_size_of_stored_pictures_is_limited():
    noise = np.random.default_rng(1).integers(0, 256, (300, 350, 3), dtype=np.uint8)
    tuner = widgets.tune(lambda level: noise, same, alt="Noise", stored=400, level=(0, 15))
    size = len(tuner.stored[0])
    assert 1 < len(tuner.stored) < 16
    assert len(tuner.stored) * size <= widgets.MAX_STORED_BYTES < (len(tuner.stored) + 1) * size


def test_positions_at_which_the_function_fails_are_not_stored():
    def picky(level=4):
        return square(60 // abs(level - 6))

    tuner = widgets.tune(picky, same, alt="A square", level=(4, 9))
    assert sorted(tuner.stored_at) == [[k] for k in (0, 1, 3, 4, 5)] and tuner.problem == ""


def painted(first, over):
    """Return the image that a page shows: the second one painted over the first, transparent where
    equal.
    """
    over = iio.imread(io.BytesIO(over))
    if over.shape[2] == 3:
        return over
    return np.where(over[..., 3:] == 255, over[..., :3], iio.imread(io.BytesIO(first))[..., :3])


def test_stored_plots_are_lossless_changes_of_the_first():
    def draw(k):
        return plots.response(np.arange(256.0) * (k + 1), span=(0, 1000))

    tuner = widgets.tune(lambda k: k, draw, alt="A curve", k=(0, 3))
    for (k,), frame in zip(tuner.stored_at, tuner.stored, strict=True):
        assert np.array_equal(painted(tuner.stored[0], frame), render(draw(k)))
    assert max(map(len, tuner.stored[1:])) < len(tuner.stored[0])


def test_tune_always_stores_the_start():
    assert widgets.tune(square, same, alt="A square", stored=0, level=(0, 255)).stored_at == [[100]]


@pytest.mark.parametrize(
    "positions",
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
def test_tune_rejects_bad_ranges(positions):
    with pytest.raises(ValueError, match="level as"):
        widgets.tune(square, same, alt="A square", level=positions)


def test_tune_rejects_no_ranges_and_unknown_parameters():
    with pytest.raises(ValueError, match="one range"):
        widgets.tune(square, same, alt="A square")
    with pytest.raises(ValueError, match="parameters .*function, level, side; got hue"):
        widgets.tune(square, same, alt="A square", hue=(0, 9))


@pytest.mark.papers
def test_tuner_knows_the_area_of_the_axes_in_which_clicks_count():
    def dotted(down=0.5, right=0.5):
        return down, right

    def draw(at):
        figure = Figure(figsize=(4, 2), dpi=50)
        figure.add_axes((0.1, 0.25, 0.8, 0.5))
        return figure

    tuner = widgets.tune(
        dotted, draw, alt="A place", point=("down", "right"), down=(0.0, 1.0), right=(0.0, 1.0)
    )
    assert np.allclose(tuner.areas[0], [0.1, 0.25, 0.8, 0.5]) and tuner.point == ["down", "right"]


@pytest.mark.parametrize("point", [("level",), ("level", "level", "level"), ("level", "none")])
def test_tune_rejects_a_point_that_is_not_two_parameters(point):
    with pytest.raises(ValueError, match="point of two parameters out of level"):
        widgets.tune(lambda level=1: level, square, alt="A square", point=point, level=(0, 9))


def test_captions_put_words_and_units_beside_the_sliders():
    tuner = widgets.tune(
        square,
        same,
        alt="A square",
        captions={"level": "gray level {:g}", "side": "side of {} pixels"},
        level=[0.5, 100.0],
        side=[8, 16],
    )
    assert tuner.labels == ["gray level", "side of"]
    assert tuner.values == [["0.5", "100"], ["8 pixels", "16 pixels"]]
    assert tuner.parameters == {"level": 100.0, "side": 16}


def test_a_parameter_without_a_caption_is_shown_by_its_name():
    tuner = widgets.tune(square, same, alt="A square", level=[0, 100])
    assert tuner.labels == ["level"] and tuner.values == [["0", "100"]]


def test_tune_rejects_captions_of_other_parameters():
    with pytest.raises(ValueError, match="captions of level, got one of hue"):
        widgets.tune(square, same, alt="A square", captions={"hue": "hue {}"}, level=[0, 100])


@pytest.mark.parametrize("caption", ["gray level", "{} levels", "{} of {}", ""])
def test_tune_rejects_captions_without_words_before_one_value(caption):
    with pytest.raises(ValueError, match="caption of level with words before the value"):
        widgets.tune(square, same, alt="A square", captions={"level": caption}, level=[0, 100])


def test_tune_rejects_empty_alt_texts():
    with pytest.raises(ValueError, match="alt text"):
        widgets.tune(square, same, alt="", level=(0, 9))


def curve(k=1):
    return plots.response(k * np.linspace(-4, 4, 256), label=f"{k}", span=(-5, 5))


def test_plot_on_reused_axes_equals_the_plot_on_new_axes():
    """To the pixel: nothing of the earlier image remains."""

    def crowded(k):
        ax = curve(k)
        ax.text(0, 128, "here")
        ax.axhspan(10, 20)
        ax.set_title("A title")
        return ax

    tuner = widgets.tune(
        lambda k=1: k, lambda k: crowded(k) if k == 2 else curve(k), alt="A curve", k=(1, 4)
    )
    for k in (2, 3, 1):
        tuner.at = [k - 1]
        expected = web.encode_runs(render(crowded(k) if k == 2 else curve(k)))
        assert tuner.frame == expected


@pytest.mark.parametrize(
    "change",
    [
        lambda ax: ax.set(yscale="symlog"),
        lambda ax: ax.tick_params(labelsize=20),
        lambda ax: ax.grid(False),
        lambda ax: ax.set_axis_off(),
        lambda ax: ax.set_xticks([0, 1], ["no", "yes"]),
        lambda ax: ax.set_aspect("equal"),
        lambda ax: ax.set_position([0.3, 0.3, 0.3, 0.3]),
        lambda ax: ax.spines["top"].set_visible(False),
        lambda ax: ax.set_title("A title", fontsize=30),
        lambda ax: ax.figure.add_axes((0.9, 0.1, 0.05, 0.5)),
        lambda ax: ax.twinx(),
        lambda ax: ax.figure.text(0, 0, "a note"),
        lambda ax: ax.set_facecolor("black"),
    ],
)
def test_axes_with_changes_that_wipe_cannot_undo_are_not_reused(change):
    def draw(k):
        ax = curve(k)
        if k == 2:
            change(ax)
        ax.set_title("The same")
        return ax

    kept = reuse.Kept()
    reuse.draw_reusing(draw, 2, lambda drawn: web.encode_jpeg(render(drawn)), kept)
    assert reuse.draw_reusing(
        draw, 1, lambda drawn: web.encode_jpeg(render(drawn)), kept
    ) == web.encode_jpeg(render(draw(1)))


def test_axes_are_reused_for_the_next_plot():
    kept = reuse.Kept()
    seen = []
    for k in (1, 2, 3):
        reuse.draw_reusing(lambda k: seen.append(curve(k)) or seen[-1], k, lambda drawn: b"", kept)
    assert seen[0] is seen[1] is seen[2] and curve() is not seen[0]


def test_two_plots_of_one_picture_get_different_axes():
    kept = reuse.Kept()
    reuse.draw_reusing(curve, 1, lambda drawn: b"", kept)
    pairs = []
    reuse.draw_reusing(
        lambda k: pairs.extend([curve(k), curve(k)]) or pairs[0], 2, lambda drawn: b"", kept
    )
    assert pairs[0] is not pairs[1]


def noise(*shape):
    return np.random.default_rng(1).integers(0, 256, shape, dtype=np.uint8)


@pytest.mark.parametrize(
    "picture",
    [
        np.full((300, 400), 7, np.uint8),
        noise(20, 30, 3),
        noise(1, 1),
        render(curve()),
        np.eye(256, dtype=np.uint8),
    ],
    ids=["one colour", "noise", "a pixel", "a plot", "a diagonal"],
)
def test_runs_of_one_color_are_lossless(picture):
    expected = picture if picture.ndim == 3 else np.repeat(picture[..., None], 3, axis=-1)
    assert np.array_equal(unrolled(web.encode_runs(picture)), expected)


def test_encode_frame_uses_runs_for_plots_and_jpeg_for_photos():
    assert web.encode_frame(render(curve())) == web.encode_runs(render(curve()))
    photograph = noise(60, 80, 3)
    assert web.encode_frame(photograph) == web.encode_jpeg(photograph)
    assert len(web.encode_frame(photograph)) < len(web.encode_runs(photograph))


def test_plots_of_a_tuner_are_lossless():
    tuner = widgets.tune(lambda k=2: k, curve, alt="A curve", k=(1, 4))
    assert np.array_equal(unrolled(tuner.frame), render(curve(2)))
    tuner.at = [3]
    assert np.array_equal(unrolled(tuner.frame), render(curve(4)))


@pytest.mark.parametrize("top", [1e-20, 3.0, 65504.0, 1e9, 3e38])
def test_half_floats_keep_eight_decades_of_any_radiance(top):
    E = np.geomspace(top / 1e8, top, 200).reshape(10, 20)
    seen = decode_half_floats(*web.encode_halves(E), E.shape)
    assert np.abs(seen / E - 1).max() < 2**-11 and np.isfinite(seen).all()


def test_half_floats_of_zeros_are_zeros():
    assert not np.any(decode_half_floats(*web.encode_halves(np.zeros((2, 3, 3))), (2, 3, 3)))


def test_deflate_reduces_half_floats_of_a_scene_to_two_thirds():
    E = scenes.workshop((128, 192))
    data, scale = web.encode_halves(E)
    assert len(data) < 2 * E.size * 2 / 3
    assert np.abs(decode_half_floats(data, scale, E.shape) / E - 1)[E > 0].max() < 2**-11


ROOM = np.arange(24 * 36 * 3, dtype=np.uint8).reshape(24, 36, 3)


def test_pictures_of_wipe_and_blink_are_lossless():
    for widget in (
        widgets.wipe(ROOM, 255 - ROOM, alt="A room"),
        widgets.blink(ROOM, 255 - ROOM, alt="A room"),
    ):
        decoded = [iio.imread(io.BytesIO(picture)) for picture in widget.pictures]
        assert np.array_equal(decoded, [ROOM, 255 - ROOM])


def test_wipe_accepts_gray_with_color_and_plots():
    assert len(widgets.wipe(ROOM, ROOM[..., 0], alt="A room").pictures) == 2
    assert len(widgets.wipe(curve(1), curve(2), alt="Two curves").pictures) == 2


def test_blink_accepts_several_pictures_and_names_them():
    blinker = widgets.blink(ROOM, ROOM, ROOM, alt="A room")
    assert blinker.labels == ["A", "B", "C"] and len(blinker.pictures) == 3 and blinker.index == 0


@pytest.mark.parametrize("shape", [(24, 36), (24, 36, 3)])
def test_values_of_a_comparison_keep_three_digits(shape):
    E = np.geomspace(1e-3, 1e5, np.prod(shape)).reshape(shape)
    widget = widgets.wipe(ROOM, ROOM, alt="A room", values=[E, 2 * E])
    for k, values in enumerate((E, 2 * E)):
        assert np.allclose(
            decode_half_floats(widget.values[k], widget.scales[k], shape), values, rtol=5e-4
        )
    assert widget.channels == [len(shape) * 2 - 3] * 2
    assert len(widgets.blink(ROOM, ROOM, alt="A room", values=E).values) == 1


def test_large_pictures_and_values_are_reduced_to_means():
    large = np.zeros((30, 4100), np.uint8)
    widget = widgets.wipe(large, large, alt="A wide room", values=large)
    height, width = iio.imread(io.BytesIO(widget.pictures[0])).shape[:2]
    assert height < 30 and width < 4100
    assert width / height == pytest.approx(4100 / 30, rel=0.05)
    assert not np.any(decode_half_floats(widget.values[0], widget.scales[0], (height, width)))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"b": ROOM[:9]}, r"expected pictures of one size, got \(24, 36\), \(9, 36\)"),
        ({"labels": ["one"]}, "expected a label for each of 2 pictures"),
        ({"labels": "ab"}, "expected a label for each of 2 pictures"),
        ({"labels": ["a", ""]}, "expected a label for each of 2 pictures"),
        ({"values": np.ones((9, 9))}, "expected finite values"),
        ({"values": np.full((24, 36), np.nan)}, "expected finite values"),
        (
            {"values": [np.ones((24, 36))] * 3},
            "expected values for each of 2 pictures, or one array, got 3",
        ),
        ({"alt": ""}, "expected an alt text"),
        ({"a": np.zeros((24, 36))}, "draw.*float64"),
    ],
)
@pytest.mark.parametrize("compare", [widgets.wipe, widgets.blink])
def test_wipe_and_blink_reject_pictures_labels_or_values_that_do_not_fit(
    compare, arguments, message
):
    arguments = {"a": ROOM, "b": ROOM, "alt": "A room"} | arguments
    with pytest.raises(ValueError, match=message):
        compare(arguments.pop("a"), arguments.pop("b"), **arguments)


@pytest.mark.parametrize("period", [0.1, np.nan, np.inf])
def test_blink_rejects_periods_that_can_cause_seizures(period):
    with pytest.raises(ValueError, match="faster flashes can cause seizures"):
        widgets.blink(ROOM, ROOM, alt="A room", period=period)


@pytest.mark.parametrize("shape", [(40, 60), (40, 60, 3)])
def test_brush_has_the_radiance_map_and_starts_at_its_center(shape):
    E = np.geomspace(1e-2, 1e6, np.prod(shape)).reshape(shape)
    brush = widgets.brush(E, alt="A wedge", size=64)
    assert brush.shape == [40, 60, len(shape) * 2 - 3] and brush.centre == [20, 30]
    assert np.allclose(decode_half_floats(brush.radiance, brush.scale, shape), E, rtol=5e-4)
    assert iio.imread(io.BytesIO(brush.picture)).shape == (40, 60, 3)


def test_brush_reduces_a_large_map_to_means():
    assert widgets.brush(np.ones((30, 1600)), alt="A wide wall").shape == [15, 800, 1]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"alt": " "}, "expected an alt text"),
        ({"size": 63}, "expected size from 64 to 512, got 63"),
        ({"magnification": 9}, "expected magnification from 1 to 8"),
        ({"limit": 0.5}, "expected limit from 1 to 16"),
        ({"picture": ROOM}, "expected a picture of the size of E"),
        ({"E": -np.ones((9, 9))}, "expected"),
    ],
)
def test_brush_rejects_parameters_out_of_range_and_bad_maps(arguments, message):
    arguments = {"E": np.ones((9, 9)), "alt": "A wall"} | arguments
    with pytest.raises(ValueError, match=message):
        widgets.brush(arguments.pop("E"), **arguments)


def test_tune_uses_one_blas_thread_if_more_are_enabled():
    """The widget answers at once, even if JupyterLab was started without limits on BLAS threads."""
    seen = []

    def f(k=1):
        seen.extend(pool["num_threads"] for pool in widgets.BLAS_THREADS.info())
        return np.full((4, 4), k, np.uint8)

    with threadpoolctl.threadpool_limits(2):
        # a library that was built without threads keeps to one
        assert 2 in {pool["num_threads"] for pool in widgets.BLAS_THREADS.info()}
        widgets.tune(f, lambda picture: picture, alt="A gray square", k=(0, 3))
    assert seen and set(seen) == {1}


def test_garbage_collector_is_paused_during_an_answer():
    seen = []

    def f(k=1):
        seen.append(gc.isenabled())
        return square(k // divisor["value"])

    divisor = {"value": 1}
    tuner = widgets.tune(f, lambda picture: picture, alt="A gray square", stored=2, k=(0, 3))
    seen.clear()
    tuner.at = [2]
    assert seen == [False] and gc.isenabled()
    divisor["value"] = 0
    tuner.at = [3]
    assert "ZeroDivisionError" in tuner.problem and gc.isenabled()


def fixed(k):
    """Draw a curve on axes that do not change, with a legend and a title of two lines."""
    ax = plots.response(np.arange(256) * (k + 1) / 100, span=(0, 8), label=f"number {k}")
    ax.annotate("here", (k, 40 * k))
    ax.set_title(f"number {k}\nof some, gently", fontsize=9 + k)
    return ax


def running(k):
    """Draw on axes whose limits, scales and colors change."""
    ax = plots.axes()
    ax.plot([1, 10 + 100 * k], [1, 2 + k])
    ax.set(
        xscale="log" if k % 2 else "linear",
        xlabel=f"number {k}",
        facecolor="#E6E6E6" if k > 1 else "w",
    )
    return ax


def beneath(k):
    """Draw an image, which is below the grid."""
    ax = plots.axes()
    ax.imshow(np.full((4, 4), k), vmin=0, vmax=4, aspect="auto")
    return ax


def bare(k):
    """Draw a picture in Axes without ticks, under a title."""
    ax = plots.picture_axes(3, 2, (0, 0, 1, 0.8))
    ax.imshow(np.full((4, 4), k), vmin=0, vmax=4, aspect="auto")
    ax.set_title(f"gently {k}")
    return ax


def mapped(k):
    """Draw two named maps above a scale that changes in the last frame."""
    v = np.sin(np.arange(600.0).reshape(20, 30) / (k + 9))
    return tones.maps({f"number {k}": v, "": -v}, label="sines", span=(-1, 1 + k // 2))


def named(k):
    """Draw a map of classes."""
    return tones.maps(
        {"": np.arange(600).reshape(20, 30) % (k + 1)},
        label="case",
        names=["one", "two", "three", "four"],
    )


def covering(k):
    """Draw lines that a legend partly covers, the same ones twice and then others."""
    ax = plots.response(np.arange(256) / 100 - k // 2, span=(-2, 3), label="g", ax=plots.axes())
    ax.plot([-2, 3], [200 + k // 2, 0], "s:", label="a line")
    ax.axvspan(-1, k // 2, alpha=0.3, label="an area")
    return plots.with_legend(ax, "upper left")


def renamed(k):
    """Draw one line with another label, another marker, and at another place."""
    ax = plots.axes()
    ax.plot([0, 1], [0, 1], "osD"[k % 3], label=f"line {k // 2}")
    ax.legend(loc=k % 2 + 1, title="what it is", fontsize=8 + k, labelcolor=["red", "blue"][k % 2])
    return ax


def crowned(k):
    """Draw a line and a text above a legend, and a legend of points."""
    ax = plots.axes()
    ax.scatter([0, 1], [0, k], marker="osD"[k % 3], label="points")
    ax.text(0, k, "above", zorder=9 if k == 2 else 3)
    return plots.with_legend(ax, "upper left")


@pytest.mark.papers
@pytest.mark.parametrize(
    "draw", [fixed, running, beneath, bare, mapped, named, covering, renamed, crowned]
)
def test_plot_with_a_copied_background_equals_the_plot_drawn_from_scratch(draw):
    kept = reuse.Kept()
    for k in (0, 1, 1, 3, 2, 0):
        assert np.array_equal(reuse.draw_reusing(draw, k, render, kept), render(draw(k)))


def test_background_is_copied_only_if_the_axes_are_unchanged():
    for draw, stays in ((fixed, True), (mapped, True), (named, True), (running, False)):
        kept = reuse.Kept()
        reuse.draw_reusing(draw, 0, render, kept)
        ((_, before),) = kept.background.values()
        reuse.draw_reusing(draw, 1, render, kept)
        ((_, after),) = kept.background.values()
        assert (before is after) == stays


STILLS = {
    "play": lambda: widgets.play(range(3), lambda k: square(80 * k + 20), alt="A square"),
    "tune": lambda: widgets.tune(square, same, alt="A square", level=(0, 255)),
    "wipe": lambda: widgets.wipe(square(20), square(200), alt="A square", labels=["dark", "light"]),
    "blink": lambda: widgets.blink(square(20), square(100), square(200), alt="A square"),
    "brush": lambda: widgets.brush(
        np.full((32, 32), 1.0), alt="A square", picture=square(20, 32), size=64
    ),
}
SHOWN = {"play": [20], "tune": [100], "wipe": [20, 200], "blink": [20, 100, 200], "brush": [20]}


@pytest.mark.papers
@pytest.mark.parametrize("name", STILLS)
def test_saved_notebook_without_widget_models_shows_still_pictures_with_alt_texts(name):
    nbformat = pytest.importorskip("nbformat")
    nbconvert = pytest.importorskip("nbconvert")
    data, metadata = STILLS[name]()._repr_mimebundle_()
    output = nbformat.v4.new_output("display_data", data=data, metadata=metadata)
    notebook = nbformat.v4.new_notebook(
        cells=[nbformat.v4.new_code_cell("widget", outputs=[output])]
    )
    page, _ = nbconvert.HTMLExporter(template_name="basic").from_notebook_node(notebook)
    frames = re.findall(r'<img alt="A square[^"]*" src="data:image/webp;base64,([^"]+)"', page)
    levels = [int(web.decode_picture(base64.b64decode(frame)).mean().round()) for frame in frames]
    assert levels == pytest.approx(SHOWN[name], abs=2)


@pytest.mark.parametrize("name", STILLS)
def test_plain_text_of_a_widget_is_its_alt_text(name):
    data, _ = STILLS[name]()._repr_mimebundle_()
    assert "application/vnd.jupyter.widget-view+json" in data
    assert data["text/plain"].startswith("A square")


@pytest.mark.papers
def test_still_pictures_mark_plots_for_dark_pages():
    plot = widgets.play([1], curve, alt="A")
    photograph = widgets.play([1], square, alt="A")
    assert [
        "data-ink" in widget._repr_mimebundle_()[0]["text/html"] for widget in (plot, photograph)
    ] == [
        True,
        False,
    ]


def test_still_pictures_of_large_comparisons_are_small():
    large = np.zeros((1200, 1960, 3), np.uint8)
    data, _ = widgets.wipe(large, large, alt="Night")._repr_mimebundle_()
    frame = re.search(r"base64,([^\"]+)", data["text/html"]).group(1)
    height, width, _ = web.decode_picture(base64.b64decode(frame)).shape
    assert width <= 1000 and width / height == pytest.approx(1960 / 1200, rel=0.01)


def test_a_pixels_mean_rejects_what_it_cannot_show():
    images = np.full((2, 4, 6), [[[40]], [[80]]], np.uint8)
    g = np.log(np.maximum(np.arange(256), 0.5) / 128)
    for changed in ({"images": images.astype(np.uint16)}, {"at": (0.5, 1.0)}, {"alt": ""}):
        arguments = {"images": images, "times": [1, 2], "g": g, "alt": "Gray"} | changed
        with pytest.raises(errors.InputError):
            widgets.pixel_mean(**arguments)


def test_a_pixels_mean_falls_back_to_a_plot_with_alt_text():
    images = np.full((2, 4, 6), [[[40]], [[80]]], np.uint8)
    g = np.log(np.maximum(np.arange(256), 0.5) / 128)
    html, text = widgets.pixel_mean(images, [1, 2], g, alt="A gray wall").fallback()
    assert "<img" in html and 'alt="A gray wall"' in html and text == "A gray wall"


def test_an_exposure_window_rejects_what_it_cannot_show():
    for changed in ({"E": np.zeros((4, 6))}, {"time": 0.0}, {"alt": ""}):
        arguments = {"E": np.ones((4, 6)), "time": 0.1, "alt": "Gray"} | changed
        with pytest.raises(errors.InputError):
            widgets.exposure_window(arguments.pop("E"), Sensor(), **arguments)


def test_an_exposure_window_falls_back_to_a_photo_and_a_plot_with_alt_text():
    E = np.geomspace(1, 2.0**16, 60)[None] * np.ones((40, 1))
    html, _ = widgets.exposure_window(E, Sensor(), alt="A wedge", time=1e-3).fallback()
    assert html.count("<img") == 2 and 'alt="A wedge"' in html


def test_a_bitmap_difference_rejects_photos_that_it_cannot_compare():
    photo = np.tile(np.array([20, 200], np.uint8), (32, 16))
    wrong = (
        {"moving": photo[1:]},
        {"moving": photo / 255},
        {"max_offset": 0},
        {"alt": ""},
        {"fixed": np.zeros((8, 641), np.uint8), "moving": np.zeros((8, 641), np.uint8)},
    )
    for changed in wrong:
        arguments = {"fixed": photo, "moving": photo, "alt": "Stripes"} | changed
        with pytest.raises(errors.InputError):
            widgets.bitmap_difference(**arguments)


def test_a_bitmap_difference_falls_back_to_a_picture_with_alt_text():
    photo = np.tile(np.array([20, 200], np.uint8), (32, 16))
    html, text = widgets.bitmap_difference(photo, photo, alt="Stripes").fallback()
    assert "<img" in html and 'alt="Stripes"' in html and text == "Stripes"


def test_a_zone_scale_rejects_what_it_cannot_show():
    for changed in ({"E": np.zeros((4, 6))}, {"key": 0.0}, {"white": -1.0}, {"alt": ""}):
        arguments = {"E": np.ones((4, 6)), "alt": "Gray"} | changed
        with pytest.raises(errors.InputError):
            widgets.zone_scale(arguments.pop("E"), **arguments)


def test_a_zone_scale_falls_back_to_a_picture_with_alt_text():
    html, text = widgets.zone_scale(np.ones((4, 6)), alt="A gray wall").fallback()
    assert "<img" in html and 'alt="A gray wall"' in html and text == "A gray wall"


def test_a_gain_screen_rejects_what_it_cannot_show():
    base = np.full((4, 6, 3), 90, np.uint8)
    g = np.ones((4, 6, 3))
    wrong = ({"base": base[1:]}, {"base": base / 255}, {"g": 2 * g}, {"headroom": 1.0}, {"alt": ""})
    for changed in (*wrong, {"screen": 0.5}):
        arguments = {"base": base, "g": g, "low": [0] * 3, "high": [2] * 3, "alt": "Gray"} | changed
        with pytest.raises(errors.InputError):
            widgets.gain_screen(**arguments)


def test_a_gain_screen_falls_back_to_a_picture_with_alt_text():
    base = np.full((4, 6, 3), 90, np.uint8)
    g = np.ones((4, 6, 3))
    figure = widgets.gain_screen(base, g, [0] * 3, [2] * 3, alt="A gray wall")
    html, text = figure.fallback()
    assert "<img" in html and 'alt="A gray wall"' in html and text == "A gray wall"


def test_a_bilateral_kernel_rejects_what_it_cannot_show():
    step = np.repeat([0.0, 2.0], 10)
    wrong = (
        {"v": step[None]},
        {"v": step[:4]},
        {"v": np.full(20, np.nan)},
        {"v": np.ones(20)},
        {"at": 20},
        {"sigma_s": 0.0},
        {"sigma_r": -1.0},
        {"alt": ""},
    )
    for changed in wrong:
        arguments = {"v": step, "alt": "A step"} | changed
        with pytest.raises(errors.InputError):
            widgets.bilateral_kernel(arguments.pop("v"), **arguments)


def test_a_bilateral_kernel_falls_back_to_a_picture_with_alt_text():
    html, text = widgets.bilateral_kernel(np.repeat([0.0, 2.0], 10), alt="A step").fallback()
    assert "<img" in html and 'alt="A step"' in html and "A step" in text


def test_a_gradient_line_rejects_what_it_cannot_show():
    ramp = np.linspace(0, 5, 20)
    wrong = (
        {"lL": ramp[None]},
        {"lL": ramp[:4]},
        {"lL": np.full(20, np.inf)},
        {"lL": np.ones(20)},
        {"alpha": 2.0},
        {"beta": 0.0},
        {"alt": ""},
    )
    for changed in wrong:
        arguments = {"lL": ramp, "alt": "A ramp"} | changed
        with pytest.raises(errors.InputError):
            widgets.gradient_line(arguments.pop("lL"), **arguments)


def test_a_gradient_line_falls_back_to_a_picture_with_alt_text():
    html, text = widgets.gradient_line(np.linspace(0, 5, 20), alt="A ramp").fallback()
    assert "<img" in html and 'alt="A ramp"' in html and "A ramp" in text


def test_gsolve_by_hand_rejects_photos_from_which_nothing_can_be_solved():
    images = np.array([10, 40, 160], np.uint8)[:, None, None] * np.ones((1, 4, 6), np.uint8)
    wrong = (
        {"images": images.astype(np.uint16)},
        {"times": [1, 1, 1]},
        {"pixels": 1},
        {"alt": ""},
        {"images": np.zeros_like(images)},
    )
    for changed in wrong:
        arguments = {"images": images, "times": [1, 4, 16], "alt": "Gray"} | changed
        with pytest.raises(errors.InputError):
            widgets.gsolve_by_hand(**arguments)


def test_gsolve_by_hand_falls_back_to_a_plot_with_alt_text():
    ramp = np.linspace(1, 60, 64).reshape(8, 8)
    images = np.stack([ramp, 4 * ramp]).astype(np.uint8)
    html, text = widgets.gsolve_by_hand(images, [1, 4], alt="A ramp of gray").fallback()
    assert "<img" in html and 'alt="A ramp of gray"' in html and text == "A ramp of gray"


def test_a_screen_match_measures_the_screen_of_its_sliders():
    figure = widgets.screen_match(scenes.chapel((20, 30)), alt="A chapel")
    figure.set_state({"gray": 186 / 255, "dark": 8 / 255})  # as the browser's message does
    assert figure.screen == matching.measure(186 / 255, 8 / 255)


def test_a_screen_match_falls_back_to_a_picture_with_alt_text():
    still = widgets.screen_match(scenes.chapel((20, 30)), alt="A chapel").still()
    assert still.alts == ("A chapel",) and still.captions == ("for any screen",)
    assert iio.imread(io.BytesIO(still.frames[0])).shape == (20, 30, 3)


@pytest.mark.parametrize(
    ("E", "arguments", "named"),
    [
        (np.zeros((4, 6)), {"alt": "Night"}, "with light"),
        (np.ones((4, 6)), {"alt": "Gray", "gray": 1.0}, "gray"),
        (np.ones((4, 6)), {"alt": "Gray", "dark": 0.0}, "dark"),
        (np.ones((4, 6)), {"alt": ""}, "alt text"),
    ],
)
def test_a_screen_match_rejects_what_it_cannot_show(E, arguments, named):
    with pytest.raises(errors.InputError, match=named):
        widgets.screen_match(E, **arguments)
