"""The report on a radiance map: one HTML page without outside parts."""

import base64
import hashlib
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
    """A page's images, headings and text, and the tags that are closed at the wrong place."""

    def __init__(self, path):
        super().__init__()
        self.images = []
        self.text = ""
        self.tags = []
        self.headings = []
        self.open = []
        self.wrong = []
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
        if self.open and self.open[-1] not in ("style", "script"):
            self.text += re.sub(r"\s+", " ", data)
        if self.open and self.open[-1] in ("h1", "h2"):
            self.headings.append(data.strip())


@pytest.fixture(scope="module")
def room():
    """An assembly of hand-held noisy photos of the room, and the truth."""
    E = scenes.room((160, 240))
    times = camera.times_around(E, 6, stops=2.5)
    offsets = np.array([[0, 0], [2, -1], [-3, 2], [0, 0], [1, 4], [0, -2]])
    noisy = camera.Camera(full_well=60_000, read_noise=6, hot=1e-4)
    bracket = camera.shoot(E, times, noisy, offsets=offsets, rng=4)
    assembly = pipeline.assemble(bracket)
    E_true = camera.views(E, offsets)[3][crop(assembly.offsets, bracket.images.shape[1:3])]
    return assembly, Truth(E_true, responses.true_g("film"), offsets)


@pytest.fixture(scope="module")
def page(room, tmp_path_factory):
    assembly, truth = room
    recipe = {"tonemap": "reinhard", "seed": 4}
    folder = tmp_path_factory.mktemp("report")
    picture = pipeline.develop(assembly.E)
    return Page(write_report(folder, assembly, picture, recipe=recipe, truth=truth))


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


def test_report_is_well_formed_html_with_a_language_and_a_title(page):
    assert page.source.startswith("<!DOCTYPE html>")
    assert page.wrong == [] and page.open == []
    assert ("html", {"lang": "en"}) in page.tags
    assert re.search(r"<title>6 photos, ", page.source)


def test_report_fetches_nothing_and_runs_no_script_but_its_own(page):
    addresses = re.findall(
        r"""(?:src|href|action|data|poster)=["']?([^"'\s>]{0,20})""", page.source
    )
    assert addresses and all(address.startswith("data:") for address in addresses)
    scripts = re.findall(r"<script>(.*?)</script>", page.source, re.DOTALL)
    others = re.sub(r"<script.*?</script>", "", page.source, flags=re.DOTALL)
    assert not re.search(r"url\(|@import|<script|<iframe|<object|\son\w+=", others)
    assert len(scripts) == 1
    assert not re.search(r"fetch\(|XMLHttpRequest|import\(|https?:|innerHTML", scripts[0])


def test_the_report_allows_its_own_script_by_its_hash_and_no_other(page):
    policy = next(attrs["content"] for tag, attrs in page.tags if "http-equiv" in attrs)
    script = re.search(r"<script>(.*?)</script>", page.source, re.DOTALL)[1]
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert policy.endswith(f"; script-src 'sha256-{digest}'")
    assert policy.startswith("default-src 'none'; ")


def test_the_report_explains_one_pixel_without_its_script(room, tmp_path):
    assembly = room[0]
    shown = report(tmp_path, assembly)
    pixel = re.search(r"Pixel x (\d+), y (\d+)", shown.text)
    explanation = assembly.why(int(pixel[2]), int(pixel[1]))
    assert explanation.sentence in shown.text
    for photo in explanation.photos:
        assert photo.name in shown.text and photo.claim in shown.text


def test_the_report_of_a_map_without_its_record_has_no_pixels_to_press(room, tmp_path):
    shown = report(tmp_path, replace(room[0], record=None))
    assert "<script" not in shown.source and "script-src" not in shown.source


def test_report_states_relative_exposures_in_stops_and_never_in_seconds(room, tmp_path):
    assembly = room[0]
    relative = replace(assembly.bracket, has_relative_times=True)
    page = report(tmp_path, replace(assembly, bracket=relative))
    assert not re.search(r"\d s\b|times, s\b", page.text)
    assert "relative" in page.text and "+2.5 stops" in page.text
    assert not any(re.search(r"\d s\b", image["alt"]) for image in page.images)
    stated = report(tmp_path, assembly)
    assert re.search(r"\d s\b", stated.text) and "relative times" not in stated.text


def test_report_lists_the_details(tmp_path):
    page = report(tmp_path, flat().with_detail("the fifth photo was the reference"))
    assert "the fifth photo was the reference" in page.text


def test_report_shows_the_uncertainty_of_the_pixels_if_it_was_estimated(room, tmp_path):
    assembly = pipeline.measure_deviation(room[0])
    page = report(tmp_path, assembly)
    assert "Uncertainty" in page.headings
    assert wording.certainty(assembly.E, assembly.s) in page.text
    alts = [image["alt"] for image in page.images if image["alt"].startswith("Uncertainty")]
    assert len(alts) == 1
    assert re.search(r"from ± 0\.\d+ to ± 0\.\d+ stops", alts[0])
    assert "Uncertainty" not in report(tmp_path, room[0]).headings


def test_report_has_no_figure_of_the_uncertainty_if_it_is_unknown_everywhere(tmp_path):
    state = flat()
    page = report(tmp_path, replace(state, s=np.full_like(state.E, np.inf)))
    assert "is not known" in page.text
    assert not any("Uncertainty" in image["alt"] for image in page.images)


def test_deviation_in_stops_is_the_relative_deviation_over_ln_2():
    E = np.full((1, 2, 3), 2.0, np.float32)
    s = np.full((1, 2, 3), 0.2, np.float32)
    s[0, 1, 2] = np.inf
    assert wording.deviation(E, s)[0] == pytest.approx([0.1 / np.log(2), np.inf], rel=1e-5)
    assert wording.certainty(E, s).count("± 0.14") == 2


def test_every_image_of_the_report_is_embedded_and_has_alt_text_and_a_size(page):
    # The picture, six frames, response, radiance, pixel quality and errors.
    assert len(page.images) == 1 + 6 + 1 + 1 + 1 + 1
    for image in page.images:
        assert len(image["alt"]) > 10 and int(image["width"]) > 0 and int(image["height"]) > 0
        assert len(base64.b64decode(image["src"].partition("base64,")[2], validate=True)) > 100


def test_images_of_the_report_have_the_size_that_the_page_states(page):
    for image in page.images:
        kind, _, data = image["src"].partition(";base64,")
        if kind == "data:image/webp":
            decoded = cv2.imdecode(
                np.frombuffer(base64.b64decode(data), np.uint8), cv2.IMREAD_COLOR
            )
            assert decoded.shape[:2] == (int(image["height"]), int(image["width"]))


def test_report_lists_each_frame_with_name_time_and_offset(page, room):
    for name, offset in zip(room[0].bracket.names, room[0].offsets, strict=True):
        assert name in page.text and f"moved by {wording.offset(offset)}" in page.text
    assert re.search(r"1/\d+ s", page.text)


def test_report_states_the_spread_between_the_frames(page, room):
    assert f"{room[0].spread:.3f} stops" in page.text and "they agree" in page.text


def test_report_states_the_errors_of_the_map_and_the_response(page, room):
    assembly, truth = room
    rows = dict(
        re.findall(
            r'<th scope="row">(red|green|blue)</th><td class="right">([\d.]+) %', page.source
        )
    )
    assert list(rows) == ["red", "green", "blue"]
    assert all(0 < float(percent) < 1 for percent in rows.values())
    median = float(re.search(r"<dt>([\d.]+) %</dt><dd>median error of radiance", page.source)[1])
    ratio = assembly.E / truth.E
    assert median == pytest.approx(100 * np.median(np.abs(ratio / np.median(ratio) - 1)), abs=0.1)
    assert "all correct" in page.text


def test_report_lists_parameters_times_and_versions(page):
    for word in ("tonemap", "reinhard", "seed", "hdrlab", np.__version__, "times, s"):
        assert word in page.text


def test_report_without_a_truth_states_no_errors(tmp_path):
    shown = report(tmp_path, flat())
    assert "Errors" not in shown.headings and "median error" not in shown.text


def test_report_counts_and_shows_pixels_that_were_not_measured(tmp_path):
    assembly = flat()
    quality = assembly.quality.copy()
    quality[0, :7] = Quality.CLIPPED
    quality[5, 5] = Quality.STUCK
    quality[9, :3] = Quality.DARK
    quality[10, 1] = Quality.UNSEEN
    quality[20, 20] = Quality.CLIPPED | Quality.DARK
    shown = report(tmp_path, replace(assembly, quality=quality))
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
        "outside every frame": "1",
    }
    assert any("dots" in image["alt"] for image in shown.images)


def test_report_has_no_figure_of_pixel_quality_if_all_pixels_were_measured(tmp_path):
    shown = report(tmp_path, flat())
    assert "100 %" in shown.text and not any("dots" in image["alt"] for image in shown.images)


def test_report_shows_warnings_above_the_first_image_and_notes(tmp_path):
    shown = report(
        tmp_path, replace(flat(), warnings=("the times are wrong",), notes=("a frame is dark",))
    )
    assert shown.source.index("the times are wrong") < shown.source.index("<img")
    assert "Warnings" in shown.headings and "a frame is dark" in shown.text


def test_report_has_no_empty_sections_for_warnings_and_notes(tmp_path):
    shown = report(tmp_path, replace(flat(), warnings=(), notes=()))
    assert not {"Warnings", "Notes"} & set(shown.headings)


def test_file_names_and_notes_cannot_inject_html(tmp_path):
    evil = ['<script>alert("x")</script>.jpg', "\" onerror='alert(1)'&amp;.jpg"]
    assembly = replace(flat(names=evil), warnings=("<b>bold</b>",), notes=("<img src=x>",))
    shown = report(tmp_path, assembly, recipe={"<i>": "</style>"})
    assert shown.wrong == [] and shown.open == []
    assert not [attrs for tag, attrs in shown.tags if tag == "i" and not attrs]
    # the data of the pixels, and the page's own script
    assert [tag for tag, _ in shown.tags].count("script") == 2
    assert all(
        image["src"].startswith("data:") and "onerror" not in image for image in shown.images
    )
    for name in evil:
        assert name in shown.images[1 + evil.index(name)]["alt"]


@pytest.mark.parametrize("channels", [(), (3,)])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("linear", [True, False])
def test_report_works_for_gray_and_color_brackets_of_8_and_16_bits_linear_or_not(
    channels, dtype, linear, tmp_path
):
    shown = report(tmp_path, flat(channels, dtype, linear=linear))
    assert shown.wrong == [] and len(shown.images) == 5
    assert f"{'RGB' if channels else 'gray'}, {8 * np.dtype(dtype).itemsize} bits" in shown.text
    assert ("linear" in shown.text) == linear


def test_thumbnails_of_linear_photos_are_gamma_encoded(tmp_path):
    def brightness(linear):
        shown = report(tmp_path, flat(linear=linear)).images[1]["src"].partition("base64,")[2]
        return cv2.imdecode(
            np.frombuffer(base64.b64decode(shown), np.uint8), cv2.IMREAD_COLOR
        ).mean()

    assert brightness(True) > 1.5 * brightness(False)


def test_same_assembly_gives_the_same_report_byte_for_byte(room, page, tmp_path):
    assembly, truth = room
    recipe = {"tonemap": "reinhard", "seed": 4}
    again = write_report(
        tmp_path, assembly, pipeline.develop(assembly.E), recipe=recipe, truth=truth
    )
    assert again.read_text(encoding="utf8") == page.source


def test_write_report_creates_the_folder_and_replaces_an_older_report(tmp_path):
    folder = tmp_path / "a" / "b"
    report(folder, flat())
    first = (folder / "report.html").read_text(encoding="utf8")
    report(folder, flat(), recipe="made by hand")
    assert [file.name for file in folder.iterdir()] == ["report.html"]
    assert "made by hand" not in first
    assert "made by hand" in (folder / "report.html").read_text(encoding="utf8")


def test_failing_write_report_keeps_the_older_report(room, tmp_path):
    assembly, truth = room
    (tmp_path / "report.html").write_text("older")
    picture = pipeline.develop(assembly.E)
    with pytest.raises(ValueError, match="one shape"):
        write_report(tmp_path, assembly, picture, truth=truth._replace(E=truth.E[1:]))
    assert [(file.name, file.read_text()) for file in tmp_path.iterdir()] == [
        ("report.html", "older")
    ]


def test_write_report_rejects_an_unfinished_assembly(tmp_path):
    with pytest.raises(ValueError, match="stage 'merge'"):
        write_report(
            tmp_path, replace(flat(), stage="merge", medians=None), np.zeros((40, 60), np.uint8)
        )


@pytest.mark.parametrize(
    "picture", [np.zeros((40, 59), np.uint8), np.zeros((40, 60)), np.zeros((40, 60, 4), np.uint8)]
)
def test_write_report_rejects_a_picture_of_another_size_or_type(picture, tmp_path):
    with pytest.raises(ValueError, match=r"\(40, 60\) pixels"):
        write_report(tmp_path, flat(), picture)


def test_fit_reduces_a_large_image_to_the_means_of_pixel_blocks():
    ramp = np.arange(40 * 60, dtype=np.float64).reshape(40, 60)
    small = figures.fit(ramp, 30)
    assert small.shape == (20, 30) and small[0, 0] == ramp[:2, :2].mean()
    assert figures.fit(ramp, 60) is ramp
    assert figures.fit(np.ones((1, 100, 3), np.uint8), 10).shape == (1, 10, 3)


def test_false_color_runs_from_the_low_to_the_high_end_and_nan_is_gray():
    below, low, high, above, missing = figures.false_colour(
        np.array([[-9.0, -2, 2, 9, np.nan]]), -2, 2
    )[0].astype(int)
    first = list(bytes.fromhex(figures.scale(-2, 2).colours[0][1:]))
    last = list(bytes.fromhex(figures.scale(-2, 2).colours[-1][1:]))
    assert np.all(abs(low - first) <= 1) and np.all(abs(high - last) <= 1)  # one code of rounding
    assert np.array_equal(below, low)
    assert np.array_equal(above, high)
    assert missing.tolist() == [128] * 3


@pytest.mark.parametrize(("low", "high"), [(-10, 9), (-4, 6), (0, 1), (-0.05, 0.05)])
def test_ticks_of_a_scale_are_at_the_place_of_their_numbers(low, high):
    ticks = figures.scale(low, high, digits=3).ticks
    assert 2 <= len(ticks) <= 8
    for place, label in ticks:
        assert low + place / 100 * (high - low) == pytest.approx(
            float(label.replace("−", "-")), abs=1e-3
        )


@pytest.mark.parametrize(
    ("value", "up"), [(0.003, 0.01), (0.02, 0.02), (0.034, 0.05), (0.7, 1), (1.2, 2)]
)
def test_error_scale_ends_on_a_round_number(value, up):
    assert figures.round_up(value) == pytest.approx(up)


def test_stops_rejects_a_map_without_light():
    with pytest.raises(ValueError, match="some light"):
        figures.stops(np.zeros((4, 4)))


@pytest.mark.parametrize(
    ("spread", "says"), [(0.03, "they agree"), (0.1, "they agree roughly"), (0.3, "contradict")]
)
def test_verdict_says_whether_frames_with_a_spread_agree(spread, says):
    assert says in wording.verdict(spread)


def test_report_does_not_claim_agreement_of_frames_without_common_pixel_values(tmp_path):
    assembly = flat()
    shown = report(tmp_path, replace(assembly, medians=np.full_like(assembly.medians, np.nan)))
    assert "not known" in shown.text
    assert "they agree" not in shown.text
    assert "0.000" not in shown.text


def luminance_of(colour):
    """Return the relative luminance of #RRGGBB [WCAG 2.2]."""
    c = np.frombuffer(bytes.fromhex(colour[1:]), np.uint8) / 255
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4) @ [
        0.2126,
        0.7152,
        0.0722,
    ]


def test_colors_of_pixel_quality_flags_differ_in_lightness():
    light = sorted(luminance_of(colour) for colour in figures.FLAG_COLORS.values())
    assert min((b + 0.05) / (a + 0.05) for a, b in zip(light, light[1:], strict=False)) > 1.1
