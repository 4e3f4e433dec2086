"""Plots and pictures: their content, their alt texts, and rejected input."""

import io
import re

import imageio.v3 as iio
import matplotlib
import numpy as np
import pytest
from skimage.color import rgb2lab

from hdrlab.core.bracket import bracket
from hdrlab.io import web
from hdrlab.show import pictures, plots

LINEAR = np.log(np.arange(1, 257) / 129)


def three(g):
    return np.stack([g, 1.1 * g, 0.9 * g], axis=-1)


def small_bracket(dtype=np.uint8, channels=(3,)):
    rng = np.random.default_rng(1)
    images = rng.integers(
        0, np.iinfo(dtype).max, (3, 20, 30, *channels), dtype=dtype, endpoint=True
    )
    return bracket(images, [1 / 60, 1 / 15, 2])


@pytest.mark.parametrize(
    ("time", "text"),
    [
        (1 / 60, "1/60 s"),
        (1 / 1024, "1/1024 s"),
        (0.0166, "1/60 s"),
        (0.3, "0.3 s"),
        (0.5, "1/2 s"),
        (2, "2 s"),
        (2.5, "2.5 s"),
        (30, "30 s"),
    ],
)
def test_seconds_formats_exposure_times_as_cameras_do(time, text):
    assert plots.seconds(time) == text


def test_response_has_labels_and_a_color_and_line_style_for_each_channel():
    ax = plots.response(three(LINEAR))
    assert "ln exposure" in ax.get_xlabel() and ax.get_ylabel()
    assert (
        len({line.get_color() for line in ax.lines})
        == len({line.get_linestyle() for line in ax.lines})
        == 3
    )
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["red", "green", "blue"]


def test_response_has_exposure_on_x_and_pixel_values_on_y():
    (line,) = plots.response(LINEAR).lines
    assert np.array_equal(line.get_xdata(), LINEAR)
    assert np.array_equal(line.get_ydata(), np.arange(256))


def test_two_responses_on_the_same_axes_have_two_labels():
    ax = plots.response(LINEAR, label="recovered")
    assert plots.response(2 * LINEAR, label="true", ax=ax) is ax
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["recovered", "true"]


def test_colors_of_the_channels_differ_for_color_blind_readers():
    """A dichromat sees a projection of linear RGB [Vienot99]; a difference of 10 CIELAB units is
    clearly visible.
    """
    colours = [matplotlib.colors.to_rgb(colour) for _, colour, _ in plots.CHANNELS]
    protan = np.array([[0.11238, 0.88762, 0], [0.11238, 0.88762, 0], [0.00401, -0.00401, 1]])
    deutan = np.array([[0.29275, 0.70725, 0], [0.29275, 0.70725, 0], [-0.02234, 0.02234, 1]])
    for dichromat in (protan, deutan):
        seen = np.clip(np.array(colours) ** 2.2 @ dichromat.T, 0, 1) ** (1 / 2.2)
        lab = rgb2lab(seen[None])[0]
        assert min(np.linalg.norm(lab[i] - lab[j]) for i, j in ((0, 1), (0, 2), (1, 2))) > 10


@pytest.mark.parametrize("shape", [(256, 2), (4, 4, 4), ()])
def test_response_rejects_arrays_of_another_shape(shape):
    with pytest.raises(ValueError, match=r"response \(n,\) or \(n, 3\).*shape"):
        plots.response(np.zeros(shape))


def test_samples_are_at_ln_irradiance_plus_ln_time():
    Z = np.array([[10, 20, 40], [30, 60, 120]])
    lE = np.array([0.5, 1.6])
    B = np.log([1, 2, 4])
    lines = plots.samples(Z, lE, B).lines
    assert all(np.allclose(line.get_xdata(), lE[i] + B) for i, line in enumerate(lines))
    assert all(np.array_equal(line.get_ydata(), Z[i]) for i, line in enumerate(lines))
    assert len({line.get_marker() for line in lines}) == 2


def test_many_samples_have_one_style_and_a_count():
    ax = plots.samples(np.zeros((50, 3), int), np.zeros(50), np.zeros(3), g=LINEAR, span=(-5, 3))
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["g", "50 pixels"]
    assert ax.get_xlim() == (-5, 3)


def test_samples_rejects_arrays_of_different_lengths():
    with pytest.raises(ValueError, match=r"Z \(N, P\), lE \(N,\) and B \(P,\)"):
        plots.samples(np.zeros((5, 3), int), np.zeros(4), np.zeros(3))


def test_radiance_map_has_one_scale_in_stops_and_decades():
    E = 2.0 ** np.linspace(-10, 10, 30 * 40).reshape(30, 40)
    shown = pictures.radiance(E, alt="A wedge")
    (alt,) = shown.alts
    assert alt.startswith("A wedge") and "20.0 stops" in alt
    frame = iio.imread(io.BytesIO(shown.frames[0])).astype(int)
    ends = [
        np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)])
        for colour in ("#440154", "#fde725")
    ]
    assert np.abs(frame[0, 0] - ends[0]).max() < 20 and np.abs(frame[-1, -1] - ends[1]).max() < 20
    page = shown._repr_html_()
    assert page.count("linear-gradient") == 1
    for tick in ("−10", "+5", "−2", "+2"):
        assert f">{tick} <" in page


def test_ticks_of_a_scale_of_few_stops_differ():
    page = pictures.radiance(
        2.0 ** np.linspace(-1, 1, 400).reshape(20, 20), alt="A wedge"
    )._repr_html_()
    ticks = re.findall(r">([^<>]+) </span>", page)
    assert len(ticks) == len(set(ticks)) + 1 >= 8  # zero stands in both scales


def test_pixels_without_light_are_gray_in_a_radiance_map_figure():
    E = np.ones((24, 24), np.float32)
    E[:12] = 0
    (frame,) = pictures.radiance(E, alt="A wall").frames
    assert np.abs(iio.imread(io.BytesIO(frame))[4, 4].astype(int) - 0x80).max() < 4


@pytest.mark.parametrize(
    ("E", "alt", "message"), [(0, "A wall", "some light in it"), (1, "", "an alt text")]
)
def test_radiance_rejects_maps_without_light_and_empty_alt_texts(E, alt, message):
    with pytest.raises(ValueError, match=message):
        pictures.radiance(np.full((4, 4, 3), E, float), alt=alt)


@pytest.mark.parametrize("channels", [(), (3,)])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_thumbnails_have_times_and_offsets_as_titles(dtype, channels):
    figure = plots.thumbnails(small_bracket(dtype, channels), offsets=[(0, 0), (3, -2), (-1, 5)])
    titles = [ax.get_title() for ax in figure.axes]
    assert titles == ["1/60 s\ndy +0, dx +0 px", "1/15 s\ndy +3, dx -2 px", "2 s\ndy -1, dx +5 px"]
    assert all(ax.images[0].get_array().max() <= 255 for ax in figure.axes)


def test_rendering_axes_and_their_figure_gives_the_same_pixels():
    ax = plots.response(LINEAR)
    first = pictures.render(ax)
    second = pictures.render(ax.figure)
    assert first.shape == (360, 540, 3) and first.dtype == np.uint8
    assert np.array_equal(first, second)


def test_render_uses_the_resolution_of_the_figure():
    figure = plots.axes().figure
    figure.set_dpi(150)
    assert pictures.render(figure).shape == (540, 810, 3)


def test_render_closes_figures_of_pyplot():
    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    figure, ax = plt.subplots(figsize=(3, 2), dpi=100)
    ax.plot([0, 1])
    assert pictures.render(ax).shape == (200, 300, 3)
    assert not plt.fignum_exists(figure.number)


def test_html_of_a_picture_has_its_escaped_alt_text_and_caption():
    shown = pictures.picture(
        np.zeros((4, 5), np.uint8), alt='A "black" square', caption="black < gray"
    )
    page = shown._repr_html_()
    assert 'alt="A &#34;black&#34; square"' in page and "black &lt; gray" in page
    assert 'src="data:image/webp;base64,' in page and repr(shown) == 'A "black" square'


@pytest.mark.parametrize("alt", ["", "  ", None])
def test_picture_rejects_empty_alt_texts(alt):
    with pytest.raises(ValueError, match="alt text"):
        pictures.picture(np.zeros((4, 5), np.uint8), alt=alt)


@pytest.mark.parametrize(
    ("drawn", "description"),
    [
        (None, "NoneType"),
        (np.zeros((4, 4)), "dtype float64"),
        (np.zeros((4, 4), bool), "dtype bool"),
        (np.zeros((4, 4, 2), np.uint8), r"shape \(4, 4, 2\)"),
        (np.zeros((0, 4), np.uint8), r"shape \(0, 4\)"),
    ],
)
def test_render_rejects_other_types_and_arrays_that_are_no_images(drawn, description):
    with pytest.raises(ValueError, match=f"draw.*{description}"):
        pictures.render(drawn)


def test_plots_have_two_pixels_per_css_pixel():
    def curve(part=1.0):
        return plots.response(part * np.arange(256.0))

    shown = pictures.picture(curve(), alt="A curve")
    strip = pictures.strip(curve, lambda ax: ax, alt="A curve", part=[0.5, 1.0])
    for frame in (*shown.frames, *strip.frames):
        assert web.decode_picture(frame).shape == (720, 1080, 3)
    assert strip._repr_html_().count("max-width:min(640px,") == 2
    ax = curve()
    assert pictures.render(ax, 2).shape == (720, 1080, 3)
    assert pictures.render(ax).shape == (
        360,
        540,
        3,
    )


@pytest.mark.parametrize(
    ("size", "width"), [((256, 384), 640), ((384, 256), 427), ((600, 900), 900), ((900, 600), 600)]
)
def test_small_photos_fill_the_column_and_large_ones_keep_their_size(size, width):
    html = pictures.picture(np.zeros(size, np.uint8), alt="Night")._repr_html_()
    assert f"width:100%;max-width:min({width}px," in html and "pixelated" not in html


def test_strip_has_an_image_a_caption_and_an_alt_text_for_each_value():
    def square(level, side=4):
        return np.full((side, side), level, np.uint8)

    strip = pictures.strip(square, lambda drawn: drawn, alt="A square", level=[0, 100, 255])
    assert strip.captions == ("level 0", "level 100", "level 255")
    assert strip.alts == tuple(f"A square, {caption}" for caption in strip.captions)
    assert len(set(strip.frames)) == 3 and strip._repr_html_().count("<img ") == 3


def test_a_caption_of_a_strip_can_be_written_with_words_and_units():
    def square(width):
        return np.zeros((width, width), np.uint8)

    strip = pictures.strip(
        square, lambda drawn: drawn, alt="A square", caption="{:g} pixels wide", width=[4, 8]
    )
    assert strip.captions == ("4 pixels wide", "8 pixels wide")


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({}, "expected one parameter with its values, got 0"),
        ({"a": [1], "b": [2]}, "got 2: a, b"),
        ({"a": []}, "at least one value for a"),
    ],
)
def test_strip_rejects_no_values_and_several_parameters(values, message):
    with pytest.raises(ValueError, match=message):
        pictures.strip(lambda **_: None, lambda drawn: drawn, alt="Nothing", **values)
