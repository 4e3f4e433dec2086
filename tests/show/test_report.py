"""The report: one page that travels alone, says what was found, and how far to trust it."""

import base64
import re
from dataclasses import replace
from html.parser import HTMLParser

import cv2
import numpy as np
import pytest

from hdrlab import pipeline, scenes
from hdrlab.align.shift import crop
from hdrlab.capture import camera, responses
from hdrlab.core.bracket import bracket
from hdrlab.core.metrics import Truth
from hdrlab.radiance.merge import Quality
from hdrlab.show.pages import wording
from hdrlab.show.pages.report import write_report
from hdrlab.show.plots import figures

VOID = {"meta", "link", "img", "br", "wbr"}


class Page(HTMLParser):
    """A page's pictures, headings and text, and every tag that is not closed where it should be."""

    def __init__(self, path):
        super().__init__()
        self.images, self.text, self.tags, self.headings, self.open, self.wrong = (
            [],
            "",
            [],
            [],
            [],
            [],
        )
        self.source = path.read_text(encoding="utf8")
        self.feed(self.source)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag == "img":
            self.images.append(dict(attrs))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if self.open.pop() != tag:
            self.wrong.append(tag)

    def handle_data(self, data):
        if self.open and self.open[-1] != "style":
            self.text += re.sub(r"\s+", " ", data)
        if self.open and self.open[-1] in ("h1", "h2"):
            self.headings.append(data.strip())


@pytest.fixture(scope="module")
def room():
    """An assembly of hand-held noisy photographs of the room, and the truth."""
    E = scenes.room((160, 240))
    times, moves = (
        camera.times_around(E, 6, stops=2.5),
        np.array([[0, 0], [2, -1], [-3, 2], [0, 0], [1, 4], [0, -2]]),
    )
    photographs = camera.shoot(
        E, times, camera.Camera(full_well=60_000, read_noise=6, hot=1e-4), offsets=moves, rng=4
    )
    found = pipeline.assemble(photographs)
    seen = camera.views(E, moves)[3][crop(found.offsets, photographs.images.shape[1:3])]
    return found, Truth(seen, responses.true_g("film"), moves)


@pytest.fixture(scope="module")
def page(room, tmp_path_factory):
    found, truth = room
    recipe = {"tonemap": "reinhard", "seed": 4}
    folder = tmp_path_factory.mktemp("report")
    return Page(write_report(folder, found, pipeline.develop(found.E), recipe=recipe, truth=truth))


def flat(channels=(3,), dtype=np.uint8, names=None, linear=False):
    """Return the assembly of a ramp in two exposures."""
    top = np.iinfo(dtype).max
    ramp = np.linspace(0.02, 0.45, 40 * 60).reshape(40, 60, *[1] * len(channels)) * np.ones(
        channels
    )
    images = (np.stack([ramp, 2 * ramp]) * top).astype(dtype)
    return pipeline.assemble(
        bracket(images, [1, 2], names, linear=linear), align="none", response="linear"
    )


def report(folder, assembly, **knobs):
    return Page(write_report(folder, assembly, pipeline.develop(assembly.E), **knobs))


def test_the_page_is_well_formed_and_says_its_language_and_title(page):
    assert page.source.startswith("<!DOCTYPE html>")
    assert page.wrong == [] and page.open == []
    assert ("html", {"lang": "en"}) in page.tags
    assert re.search(r"<title>6 photographs, one radiance map", page.source)


def test_the_page_fetches_nothing_and_runs_nothing(page):
    addresses = re.findall(
        r"""(?:src|href|action|data|poster)=["']?([^"'\s>]{0,20})""", page.source
    )
    assert addresses and all(address.startswith("data:") for address in addresses)
    assert not re.search(r"url\(|@import|<script|<iframe|<object|\son\w+=", page.source)


def test_how_sure_each_pixel_is_stands_there_where_it_was_asked(room, tmp_path):
    found = pipeline.measure_deviation(room[0])
    page = report(tmp_path, found)
    assert (
        "How sure each pixel is" in page.headings
        and wording.certainty(found.E, found.s) in page.text
    )
    (picture,) = (one for one in page.images if one["alt"].startswith("How sure each pixel is"))
    assert re.search(r"from ± 0\.\d+ to ± 0\.\d+ stops", picture["alt"])
    assert "How sure each pixel is" not in report(tmp_path, room[0]).headings


def test_where_no_pixel_is_sure_the_page_says_so_without_a_picture(tmp_path):
    state = flat()
    page = report(tmp_path, replace(state, s=np.full_like(state.E, np.inf)))
    assert "not known" in page.text
    assert not any("How sure" in one["alt"] for one in page.images)


def test_what_the_deviation_of_a_pixel_is_in_stops():
    E, s = np.full((1, 2, 3), 2.0, np.float32), np.full((1, 2, 3), 0.2, np.float32)
    s[0, 1, 2] = np.inf
    assert wording.deviation(E, s)[0] == pytest.approx([0.1 / np.log(2), np.inf], rel=1e-5)
    assert wording.certainty(E, s).count("± 0.14") == 2  # of half of the pixels, and of 95 %


def test_every_picture_has_alt_text_and_a_size_and_is_inside_the_page(page):
    assert (
        len(page.images) == 1 + 6 + 1 + 1 + 1 + 1
    )  # picture, frames, response, radiance, known, errors
    for image in page.images:
        assert len(image["alt"]) > 10 and int(image["width"]) > 0 and int(image["height"]) > 0
        assert len(base64.b64decode(image["src"].partition("base64,")[2], validate=True)) > 100


def test_the_pictures_decode_to_the_size_that_the_page_says(page):
    for image in page.images:
        kind, _, data = image["src"].partition(";base64,")
        if kind == "data:image/webp":
            decoded = cv2.imdecode(
                np.frombuffer(base64.b64decode(data), np.uint8), cv2.IMREAD_COLOR
            )
            assert decoded.shape[:2] == (int(image["height"]), int(image["width"]))


def test_the_sections_stand_in_order(page):
    assert [heading for heading in page.headings if heading] == [
        "6 photographs, one radiance map",
        "Good to know",
        "The bracket",
        "The response",
        "The radiance map",
        "How each pixel is known",
        "Does the map explain its photographs?",
        "Against the truth",
        "The recipe",
    ]


def test_the_frames_stand_with_names_times_and_offsets(page, room):
    for name, offset in zip(room[0].bracket.names, room[0].offsets, strict=True):
        assert name in page.text and f"moved by {wording.offset(offset)}" in page.text
    assert re.search(r"1/\d+ s", page.text)


def test_the_spread_stands_in_the_report(page, room):
    assert f"{room[0].spread:.3f} stops" in page.text and "they agree" in page.text


def test_the_errors_in_the_report_are_those_of_the_map(page, room):
    found, truth = room
    rows = dict(
        re.findall(
            r'<th scope="row">(red|green|blue)</th><td class="right">([\d.]+) %', page.source
        )
    )
    assert list(rows) == ["red", "green", "blue"] and all(
        0 < float(one) < 1 for one in rows.values()
    )
    median = float(re.search(r"<dt>([\d.]+) %</dt><dd>median error of radiance", page.source)[1])
    ratio = found.E / truth.E
    assert median == pytest.approx(100 * np.median(np.abs(ratio / np.median(ratio) - 1)), abs=0.1)
    assert "all found" in page.text


def test_the_recipe_names_knobs_times_and_versions(page):
    for word in ("tonemap", "reinhard", "seed", "hdrlab", np.__version__, "times, s"):
        assert word in page.text


def test_without_a_truth_no_errors_are_claimed(tmp_path):
    shown = report(tmp_path, flat())
    assert "Against the truth" not in shown.text and "median error" not in shown.text


def test_pixels_that_were_not_measured_are_counted_and_shown(tmp_path):
    found = flat()
    quality = found.quality.copy()
    quality[0, :7], quality[5, 5], quality[9, :3], quality[10, 1] = (
        Quality.CLIPPED,
        Quality.STUCK,
        Quality.DARK,
        Quality.UNSEEN,
    )
    quality[20, 20] = Quality.CLIPPED | Quality.DARK
    shown = report(tmp_path, replace(found, quality=quality))
    counts = dict(
        re.findall(
            r"<b>([\w ]+)</b> <span.{0,120}?</th><td class=\"right\">([\d,]+)</td>", shown.source
        )
    )
    assert counts == {
        "measured": "2,387",
        "clipped in every frame": "7",
        "dark in every frame": "3",
        "clipped or dark in every frame": "1",
        "stuck": "1",
        "shown by no frame": "1",
    }
    assert any("dots" in image["alt"] for image in shown.images)


def test_a_map_that_is_measured_everywhere_needs_no_picture_of_it(tmp_path):
    shown = report(tmp_path, flat())
    assert "100 %" in shown.text and not any("dots" in image["alt"] for image in shown.images)


def test_doubts_stand_before_the_picture_and_notes_are_told(tmp_path):
    shown = report(
        tmp_path, replace(flat(), doubts=("the times are wrong",), notes=("a frame is dark",))
    )
    assert shown.source.index("the times are wrong") < shown.source.index("<img")
    assert "What is doubtful about this map" in shown.text and "a frame is dark" in shown.text


def test_without_doubts_and_notes_none_are_raised(tmp_path):
    shown = report(tmp_path, replace(flat(), doubts=(), notes=()))
    assert "doubtful" not in shown.text and "Good to know" not in shown.text


def test_names_and_notes_cannot_write_into_the_page(tmp_path):
    evil = ['<script>alert("x")</script>.jpg', "\" onerror='alert(1)'&amp;.jpg"]
    found = replace(flat(names=evil), doubts=("<b>bold</b>",), notes=("<img src=x>",))
    shown = report(tmp_path, found, recipe={"<i>": "</style>"})
    assert shown.wrong == [] and shown.open == []
    assert not {"script", "i"} & {tag for tag, attrs in shown.tags if "style" not in attrs}
    assert all(
        image["src"].startswith("data:") and "onerror" not in image for image in shown.images
    )
    for name in evil:
        assert f"Photograph {name}, exposed for" in shown.images[1 + evil.index(name)]["alt"]


@pytest.mark.parametrize("channels", [(), (3,)])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("linear", [True, False])
def test_gray_and_colour_of_8_and_16_bits_linear_or_not_are_reported(
    channels, dtype, linear, tmp_path
):
    shown = report(tmp_path, flat(channels, dtype, linear=linear))
    assert shown.wrong == [] and len(shown.images) == 5
    assert f"{'RGB' if channels else 'gray'}, {8 * np.dtype(dtype).itemsize} bits" in shown.text
    assert ("linear" in shown.text) == linear


def test_the_thumbnails_of_linear_photographs_are_encoded_for_a_screen(tmp_path):
    def brightness(linear):
        shown = report(tmp_path, flat(linear=linear)).images[1]["src"].partition("base64,")[2]
        return cv2.imdecode(
            np.frombuffer(base64.b64decode(shown), np.uint8), cv2.IMREAD_COLOR
        ).mean()

    assert brightness(True) > 1.5 * brightness(False)


def test_the_same_assembly_gives_the_same_page_byte_for_byte(room, page, tmp_path):
    found, truth = room
    recipe = {"tonemap": "reinhard", "seed": 4}
    again = write_report(tmp_path, found, pipeline.develop(found.E), recipe=recipe, truth=truth)
    assert again.read_text(encoding="utf8") == page.source


def test_the_folder_is_made_and_the_page_replaces_an_older_one(tmp_path):
    folder = tmp_path / "a" / "b"
    report(folder, flat())
    first = (folder / "report.html").read_text(encoding="utf8")
    report(folder, flat(), recipe="made by hand")
    assert [file.name for file in folder.iterdir()] == ["report.html"]
    assert "made by hand" not in first and "made by hand" in (folder / "report.html").read_text(
        encoding="utf8"
    )


def test_a_report_that_fails_leaves_the_older_one(room, tmp_path):
    found, truth = room
    (tmp_path / "report.html").write_text("older")
    picture = pipeline.develop(found.E)
    with pytest.raises(ValueError, match="one shape"):
        write_report(tmp_path, found, picture, truth=truth._replace(E=truth.E[1:]))
    assert [(file.name, file.read_text()) for file in tmp_path.iterdir()] == [
        ("report.html", "older")
    ]


def test_an_assembly_that_is_not_finished_is_refused(tmp_path):
    with pytest.raises(ValueError, match="finished assembly.*one after the stage 'merge'"):
        write_report(
            tmp_path, replace(flat(), stage="merge", medians=None), np.zeros((40, 60), np.uint8)
        )


@pytest.mark.parametrize(
    "picture", [np.zeros((40, 59), np.uint8), np.zeros((40, 60)), np.zeros((40, 60, 4), np.uint8)]
)
def test_a_picture_that_does_not_fit_is_refused(picture, tmp_path):
    with pytest.raises(ValueError, match=r"uint8 picture of \(40, 60\) pixels"):
        write_report(tmp_path, flat(), picture)


def test_a_large_picture_is_brought_down_by_whole_pixels_to_their_means():
    ramp = np.arange(40 * 60, dtype=np.float64).reshape(40, 60)
    small = figures.fit(ramp, 30)
    assert small.shape == (20, 30) and small[0, 0] == ramp[:2, :2].mean()
    assert figures.fit(ramp, 60) is ramp
    assert figures.fit(np.ones((1, 100, 3), np.uint8), 10).shape == (1, 10, 3)


def test_false_colour_runs_from_end_to_end_and_what_is_not_known_is_gray():
    below, low, high, above, missing = figures.false_colour(
        np.array([[-9.0, -2, 2, 9, np.nan]]), -2, 2
    )[0].astype(int)
    first, last = (list(bytes.fromhex(figures.scale(-2, 2).colours[end][1:])) for end in (0, -1))
    assert np.all(abs(low - first) <= 1) and np.all(abs(high - last) <= 1)  # one code of rounding
    assert (
        np.array_equal(below, low) and np.array_equal(above, high) and missing.tolist() == [128] * 3
    )


@pytest.mark.parametrize(("low", "high"), [(-10, 9), (-4, 6), (0, 1), (-0.05, 0.05)])
def test_the_ticks_of_a_scale_stand_where_their_numbers_say(low, high):
    ticks = figures.scale(low, high, digits=3).ticks
    assert 2 <= len(ticks) <= 8
    for place, label in ticks:
        assert low + place / 100 * (high - low) == pytest.approx(
            float(label.replace("−", "-")), abs=1e-3
        )


@pytest.mark.parametrize(
    ("value", "up"), [(0.003, 0.01), (0.02, 0.02), (0.034, 0.05), (0.7, 1), (1.2, 2)]
)
def test_the_error_scale_ends_on_a_round_number(value, up):
    assert figures.round_up(value) == pytest.approx(up)


def test_a_map_without_light_is_refused():
    with pytest.raises(ValueError, match="some light"):
        figures.stops(np.zeros((4, 4)))


@pytest.mark.parametrize(
    ("spread", "says"), [(0.03, "they agree"), (0.1, "they agree roughly"), (0.3, "contradict")]
)
def test_a_spread_is_judged_in_words(spread, says):
    assert says in wording.verdict(spread)


def test_frames_that_share_no_level_are_not_said_to_agree(tmp_path):
    found = flat()
    shown = report(tmp_path, replace(found, medians=np.full_like(found.medians, np.nan)))
    assert (
        "not known" in shown.text and "they agree" not in shown.text and "0.000" not in shown.text
    )


def luminance_of(colour):
    """Return the relative luminance of #RRGGBB [WCAG 2.2]."""
    c = np.frombuffer(bytes.fromhex(colour[1:]), np.uint8) / 255
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4) @ [
        0.2126,
        0.7152,
        0.0722,
    ]


def test_the_kinds_of_unmeasured_pixels_differ_in_lightness_too():
    light = sorted(luminance_of(colour) for colour in figures.KNOWN.values())
    assert min((b + 0.05) / (a + 0.05) for a, b in zip(light, light[1:], strict=False)) > 1.1
