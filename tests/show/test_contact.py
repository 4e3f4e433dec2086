"""The contact sheet: its content, its legibility, and its alt text."""

import re

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image
from support import laws

from hdrlab import pipeline
from hdrlab.core import colour
from hdrlab.core.picture import Statistics, statistics
from hdrlab.pipeline import catalogue
from hdrlab.show.pages import contact
from hdrlab.show.pages.sheet import GAP_WIDTH, Entry, draw, write_sheet
from hdrlab.show.pictures import render
from hdrlab.tonemap import quality

SCENE = np.stack([laws.scene((60, 80), seed) for seed in range(3)], axis=-1)


def entry(name="reinhard", shape=(60, 80, 3), Q=0.9, seed=0):
    picture = np.random.default_rng(seed).integers(0, 256, shape, dtype=np.uint8)
    return Entry(
        name, picture, 0.0123, quality.Quality(Q, 0.8, 0.7), Statistics(0, 1, 255, 127, 7.5)
    )


def texts(figure):
    return [text.get_text() for text in figure.texts]


def test_sheet_shows_every_operator_with_its_name_and_its_statistics():
    sheet = draw(contact.entry_steps(SCENE), title="a scene")
    labels = texts(sheet)
    assert labels[0] == "a scene" and len(sheet.axes) == len(catalogue.names("tonemap"))
    for name in catalogue.names("tonemap"):
        picture = pipeline.develop(SCENE, name)
        under = labels[labels.index(name) + 1]
        assert f"Q {quality.tmqi(colour.luminance(SCENE), picture).Q:.3f}" in under
        assert f"entropy {statistics(picture).entropy:.2f} bits" in under
        assert re.search(r"\d m?s\n", under), "a busy machine may take seconds"


def test_entries_are_the_pictures_of_develop_in_the_requested_order():
    names = ["reinhard", "photograph", "curves"]
    entries = list(contact.entry_steps(SCENE, names))
    assert [entry.name for entry in entries] == names
    for entry in entries:
        assert np.array_equal(entry.picture, pipeline.develop(SCENE, entry.name))


def test_out_of_gamut_colors_are_rendered_as_requested():
    E = SCENE * np.float32([0.02, 0.2, 5.0])  # a blue that no display has
    hue = next(contact.entry_steps(E, ["reinhard"], way="hue")).picture
    ratio = next(contact.entry_steps(E, ["reinhard"], way="ratio")).picture
    assert np.array_equal(hue, pipeline.develop(E, "reinhard", way="hue"))
    assert not np.array_equal(hue, ratio)


def test_measured_time_is_that_of_the_operator_alone(monkeypatch):
    monkeypatch.setattr(contact, "perf_counter", iter([10.0, 10.5, 20.0, 22.0]).__next__)
    entries = contact.entry_steps(SCENE, ["reinhard", "curves"])
    assert [entry.seconds for entry in entries] == [0.5, 2.0]


def test_own_functions_can_be_compared_with_library_operators_under_labels():
    own = {"half": lambda L: np.full_like(L, 0.5), "photographic": "reinhard"}
    half, photographic = contact.entry_steps(SCENE[..., 0], own)
    assert half.name == "half" and np.all(half.picture == 188)
    assert np.array_equal(photographic.picture, pipeline.develop(SCENE[..., 0], "reinhard"))


def test_entries_are_yielded_one_by_one_as_operators_finish():
    ran = []
    own = {name: lambda L, name=name: (ran.append(name), L * 0)[1] for name in "ab"}
    next(contact.entry_steps(SCENE, own))
    assert ran == ["a"]


@pytest.mark.parametrize("shape", [(480, 360), (480, 360, 3), (300, 480, 3)])
def test_picture_of_the_sheets_size_is_not_resampled(shape):
    shown_entry = entry(shape=shape)
    pixels = render(draw([shown_entry]))
    top = 44
    left = GAP_WIDTH
    shown = pixels[top : top + shape[0], left : left + shape[1]]
    picture = (
        shown_entry.picture
        if shown_entry.picture.ndim == 3
        else np.stack([shown_entry.picture] * 3, axis=-1)
    )
    assert np.mean(np.abs(shown.astype(int) - picture) <= 1) > 0.99


@pytest.mark.parametrize("shape", [(60, 80, 3), (30, 500, 3), (768, 512), (1, 1), (900, 20, 3)])
@pytest.mark.parametrize("count", [1, 2, 7])
def test_texts_and_pictures_stay_on_the_sheet_and_do_not_overlap(shape, count):
    figure = draw(
        [entry(f"operator {i}", shape) for i in range(count)],
        title="a_scene_with_a_long_name.hdr, 1024 x 768, 5.2 decades",
    )
    canvas = FigureCanvasAgg(figure)
    boxes = [text.get_window_extent(canvas.get_renderer()) for text in figure.texts]
    boxes += [ax.get_window_extent() for ax in figure.axes]
    width, height = canvas.get_width_height()
    for i, box in enumerate(boxes):
        assert box.x0 >= 0 and box.y0 >= 0 and box.x1 <= width and box.y1 <= height
        assert not any(box.overlaps(other) for other in boxes[i + 1 :])


def test_text_has_at_least_8_points():
    sizes = [text.get_fontsize() for text in draw([entry()]).texts]
    assert min(sizes) >= 8, "points: 11 pixels"


def test_columns_can_be_chosen_and_default_to_a_sheet_wider_than_tall():
    def columns(figure):
        return len({round(ax.get_position().x0, 3) for ax in figure.axes})

    nine = [entry(str(i)) for i in range(9)]
    panoramas = [entry(str(i), (40, 80, 3)) for i in range(4)]
    assert columns(draw(panoramas)) == 2, "two and two, not three and one"
    assert [columns(draw(nine, columns=n)) for n in (1, 2, 20)] == [1, 2, 9]
    width, height = draw(nine).get_size_inches()
    assert 1 < width / height < 3


def test_alt_text_lists_all_statistics_best_operator_first():
    alt = draw([entry("worse", Q=0.5), entry("better", Q=0.95)], title="memorial").get_label()
    assert alt.startswith("Contact sheet of memorial: one scene through 2 ")
    assert alt.index("better: Q 0.950 S 0.800") < alt.index("worse: Q 0.500")
    assert "12 ms" in alt and "entropy 7.50 bits" in alt and "  " not in alt and "\n" not in alt


def test_alt_text_is_stored_in_the_png(tmp_path):
    sheet = draw([entry("café")], title="Χ, 5 × 5")
    write_sheet(tmp_path / "sheet.png", sheet)
    with Image.open(tmp_path / "sheet.png") as file:
        assert file.text["Description"] == sheet.get_label()
        assert file.size == tuple(round(100 * inches) for inches in sheet.get_size_inches())


def test_same_entries_give_the_same_file(tmp_path):
    for name in ("a.png", "b.png"):
        write_sheet(tmp_path / name, draw([entry(), entry("other", seed=1)]))
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_bad_entries_columns_suffix_or_alt_text_are_rejected(tmp_path):
    with pytest.raises(ValueError, match="at least one"):
        draw([])
    with pytest.raises(ValueError, match="columns"):
        draw([entry()], columns=0)
    with pytest.raises(ValueError, match=r"\.png"):
        write_sheet(tmp_path / "sheet.jpg", draw([entry()]))
    sheet = draw([entry()])
    sheet.set_label("")
    with pytest.raises(ValueError, match="alt text"):
        write_sheet(tmp_path / "sheet.png", sheet)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("operators", "message"),
    [(["reinhard", "magic"], "magic"), ([], "none"), ("reinhard", "list of operators")],
)
def test_unknown_operators_are_rejected_before_the_first_one_runs(operators, message, monkeypatch):
    monkeypatch.setattr(
        "hdrlab.tonemap.reinhard.tonemap", lambda L: pytest.fail("the first operator was run")
    )
    with pytest.raises(ValueError, match=message):
        next(contact.entry_steps(SCENE, operators))


def test_negative_radiance_is_rejected():
    with pytest.raises(ValueError, match="negative"):
        next(contact.entry_steps(-SCENE, ["reinhard"]))
