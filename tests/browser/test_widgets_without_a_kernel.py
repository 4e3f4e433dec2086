"""The scripts of the widgets on a page without a kernel and without network requests."""

import imageio.v3 as iio
import numpy as np
import pytest
from laboratory import PATIENCE, open_widget

from hdrlab.io import web
from hdrlab.show import pictures, plots, widgets
from hdrlab.show.plots import tones

pytestmark = pytest.mark.browser


def square(level=100):
    return np.full((40, 60), level, np.uint8)


def level(page):
    return page.evaluate(
        "document.querySelector('canvas').getContext('2d').getImageData(30, 20, 1, 1).data[0]"
    )


def alt(page):
    return page.get_by_role("img").get_attribute("aria-label")


def until_level(page, expected):
    page.wait_for_function(
        """(expected) => Math.abs(document.querySelector('canvas').getContext('2d')
            .getImageData(30, 20, 1, 1).data[0] - expected) < 3""",
        arg=expected,
        timeout=PATIENCE,
    )


# a clock that is turned by `tick`, and says after how many ms it should have turned by itself
CLOCK = """() => {
    let turned = null;
    window.setInterval = (f, ms) => { [turned, window.every] = [f, ms]; return 1; };
    window.clearInterval = () => { turned = null; };
    window.tick = () => turned?.();
}"""


@pytest.fixture
def player(page):
    open_widget(page, widgets.play(range(0, 250, 50), square, alt="A square"))
    yield page
    assert page.problems == []
    assert [url for url in page.requests if not url.startswith(("blob:", "data:"))] == []


@pytest.fixture
def tuner(page):
    open_widget(
        page,
        widgets.tune(square, lambda picture: picture, alt="A square", stored=3, level=(0, 200)),
    )
    yield page
    assert page.problems == []


def mapped(k):
    """Return a map above its scale, on white paper."""
    return tones.maps({"": np.indices((40, 60))[1] + k}, label="columns", span=(0, 60))


def screenshot(page, selector):
    return iio.imread(page.locator(selector).first.screenshot())[..., :3].astype(int)


@pytest.mark.parametrize("live", [True, False])
def test_a_dark_page_turns_the_paper_around_a_map_to_chalk_and_leaves_the_map_its_colours(
    page, live
):
    widget = widgets.play(range(2), mapped, alt="A map")
    open_widget(page, widget)
    if not live:  # a strip next to a widget, which contains the style
        strip = pictures.strip(mapped, lambda figure: figure, alt="A map", k=[0])
        page.evaluate(
            "html => document.body.insertAdjacentHTML('beforeend', html)", strip._repr_html_()
        )
    look = "canvas" if live else "figure img"
    by_day = screenshot(page, look)
    page.evaluate("document.body.dataset.jpThemeLight = 'false'")
    by_night = screenshot(page, look)
    height, width = by_day.shape[:2]
    (left, top, wide, high), scale = widget.areas
    inside = np.s_[
        int((top + 0.02) * height) : int((top + high - 0.02) * height),
        int(0.1 * width) : int(0.9 * width),
    ]
    below = np.s_[int((scale[1] + scale[3] + 0.02) * height) : int(0.98 * height)]
    assert np.array_equal(by_day[inside], by_night[inside])
    assert by_day[below].max() == 255 and by_day[below].min() < 40
    assert np.median(by_night[below]) < 30 and by_night[below].max() > 200
    assert page.problems == []


def shaded(k):
    """Return a plot without white paper, like a photo."""
    return np.add.outer(np.arange(40), np.arange(60)).astype(np.uint8) + np.uint8(k)


@pytest.mark.parametrize(
    ("draw", "ink"), [(lambda k: plots.response(np.arange(256) * (k + 1)), True), (shaded, False)]
)
def test_jupyterlabs_dark_theme_turns_a_plot_to_chalk_and_leaves_a_photograph(page, draw, ink):
    open_widget(page, widgets.play(range(2), draw, alt="A picture"))
    page.evaluate("document.body.dataset.jpThemeLight = 'false'")
    page.get_by_role("slider").press("ArrowRight")
    canvas = page.locator("canvas")
    page.wait_for_function(
        "document.querySelector('canvas').ariaLabel.endsWith('step 2')", timeout=PATIENCE
    )
    look = "canvas => getComputedStyle(canvas).filter"
    assert (canvas.evaluate(look) != "none") == ink
    page.evaluate("document.body.dataset.jpThemeLight = 'true'")
    assert canvas.evaluate(look) == "none"
    assert page.problems == []


@pytest.mark.parametrize(
    ("draw", "rows"),
    [
        (shaded, {720: [4], 660: [2, 2], 400: [2, 2], 300: [1, 1, 1, 1]}),
        (
            lambda k: plots.response(np.arange(256) * (k + 1)),
            {1320: [4], 960: [2, 2], 700: [2, 2], 400: [1] * 4},
        ),
    ],
)
def test_four_pictures_of_a_strip_stand_in_one_row_or_two_by_two(page, draw, rows):
    page.set_content(pictures.strip(lambda k: k, draw, alt="A picture", k=range(4))._repr_html_())
    tops = "[...document.images].map((image) => Math.round(image.getBoundingClientRect().top))"
    for width, expected in rows.items():
        page.set_viewport_size({"width": width + 16, "height": 900})  # a body has a margin of 8
        positions = page.evaluate(tops)
        assert [positions.count(top) for top in sorted(set(positions))] == expected, width


def test_pictures_side_by_side_are_folded_on_screen_and_open_on_paper(page):
    folded = pictures.side_by_side(lambda k: k, shaded, alt="A picture", k=range(2))
    page.set_content(folded._repr_html_())
    summary = page.get_by_text("Side by side")
    images = page.get_by_role("img")
    assert images.count() == 0 and not page.locator("img").first.is_visible()
    summary.press("Enter")
    assert images.count() == 2 and page.locator("img").first.is_visible()
    summary.press("Enter")
    page.emulate_media(media="print")
    assert all(image.is_visible() for image in page.locator("img").all())
    assert not summary.is_visible()


def test_arrow_keys_move_through_the_steps_and_reach_no_other_key_handler(player):
    slider = player.get_by_role("slider", name="step")
    slider.focus()
    for k in (1, 2, 3):
        player.keyboard.press("ArrowRight")
        until_level(player, 50 * k)
        assert slider.get_attribute("aria-valuetext") == f"{k + 1} of 5"
        assert alt(player) == f"A square, step {k + 1}"
    player.keyboard.press("Home")
    until_level(player, 0)
    assert player.evaluate("window.reached") == []
    assert player.evaluate("window.model.get('index')") == 0


def test_the_button_plays_to_the_last_step_and_then_from_the_start(player):
    """The test advances the page's clock; on a busy machine a step would pass before it can be checked."""
    player.evaluate(CLOCK)
    button = player.get_by_role("button")
    button.press("Space")
    assert button.inner_text() == "Pause" and player.evaluate("window.every") == 125
    for k in range(1, 5):
        player.evaluate("tick()")
        until_level(player, 50 * k)
        assert button.inner_text() == ("Pause" if k < 4 else "Play")
    button.click()
    until_level(player, 0)
    player.evaluate("tick()")
    until_level(player, 50)
    button.click()
    assert button.inner_text() == "Play"
    player.evaluate("tick()")
    assert alt(player) == "A square, step 2" and player.evaluate("window.model.get('index')") == 1


def test_python_moves_the_step_too(player):
    player.evaluate("window.model.set('index', 3)")
    until_level(player, 150)
    assert player.get_by_role("slider").input_value() == "3"


def test_without_a_kernel_the_nearest_stored_picture_is_shown_and_named_where_not_all_are_stored(
    tuner,
):
    slider = tuner.get_by_role("slider", name="level")
    slider.focus()
    tuner.keyboard.press("End")
    until_level(tuner, 200)
    assert alt(tuner) == "A square, level 200"
    for _ in range(9):
        tuner.keyboard.press("ArrowLeft")
    assert slider.get_attribute("aria-valuetext") == "191"
    status = tuner.get_by_role("status").inner_text()
    assert status == "Computed beforehand, at 3 of 201 positions of level; the nearest: level 200."
    assert tuner.evaluate("window.reached") == []


def test_without_a_kernel_every_position_of_two_sliders_is_answered(page):
    def shade(level=100, more=0):
        picture = square(level)
        picture[:, 15:] += (
            more  # the rest is as in the first picture, and so it is not stored again
        )
        return picture

    ranges = {"level": (0, 200, 50), "more": (0, 50, 10)}
    open_widget(page, widgets.tune(shade, lambda drawn: drawn, alt="Gray", **ranges))
    for name, key, expected in (
        ("more", "End", 150),
        ("level", "Home", 50),
        ("more", "ArrowLeft", 40),
    ):
        page.get_by_role("slider", name=name).press(key)
        until_level(page, expected)
        assert page.get_by_role("status").inner_text() == "Computed beforehand."
    assert alt(page) == "Gray, level 0, more 40"
    left = "document.querySelector('canvas').getContext('2d').getImageData(5, 20, 1, 1).data[0]"
    assert page.evaluate(left) == 0


def test_names_are_a_row_of_buttons_and_quantities_a_slider(page, axe):
    shades = {"dark": 50, "middle": 100, "bright": 150}

    def shade(operator="dark", time="1/30 s"):
        return square(shades[operator] + (20 if time == "1/15 s" else 0))

    ranges = {"operator": list(shades), "time": ["1/30 s", "1/15 s"]}
    open_widget(page, widgets.tune(shade, lambda drawn: drawn, alt="Gray", **ranges))
    assert page.get_by_role("slider").count() == 1
    buttons = page.get_by_role("radiogroup", name="operator")
    assert buttons.get_by_role("radio", name="dark").is_checked()
    buttons.get_by_text("bright").click()
    until_level(page, 150)
    page.get_by_role("slider", name="time").press("End")
    until_level(page, 170)
    buttons.get_by_role("radio", name="bright").press("ArrowLeft")
    until_level(page, 120)
    assert alt(page) == "Gray, operator middle, time 1/15 s"
    assert axe(page, ".hdrlab") == []


def test_captions_name_the_sliders_and_give_the_unit_to_screen_readers(page):
    captions = {"level": "gray level {} of 255"}
    open_widget(
        page,
        widgets.tune(square, lambda drawn: drawn, alt="Gray", captions=captions, level=[0, 200]),
    )
    slider = page.get_by_role("slider", name="gray level")
    slider.press("End")
    until_level(page, 200)
    assert slider.get_attribute("aria-valuetext") == "200 of 255"
    assert alt(page) == "Gray, gray level 200 of 255"


def test_a_page_of_the_site_links_to_the_page_with_running_python(tuner):
    tuner.evaluate("window.hdrlab = { running: '../installing.html' }")
    tuner.get_by_role("slider").press("End")
    assert (
        tuner.get_by_role("link", name="Run it yourself").get_attribute("href")
        == "../installing.html"
    )


def answer(page, level, at):
    """Let a simulated kernel answer with a gray square for a slider position."""
    page.evaluate(
        """([runs, at]) => {
            const model = window.model;
            model.set("frame", new DataView(Uint8Array.from(runs).buffer));
            model.set("shown", at);
            model.set("answers", model.get("answers") + 1);
        }""",
        [list(web.encode_runs(square(level))), at],
    )


def test_a_stored_image_is_shown_until_python_answers_and_outdated_answers_are_ignored(
    tuner,
):
    answer(tuner, 120, [100])
    until_level(tuner, 120)
    tuner.get_by_role("slider").press("End")
    until_level(tuner, 200)
    assert alt(tuner) == "A square, level 200" and tuner.get_by_role("status").inner_text() == ""
    answer(tuner, 60, [150])
    assert alt(tuner) == "A square, level 200"
    answer(tuner, 30, [200])
    until_level(tuner, 30)
    tuner.get_by_role("slider").press("ArrowLeft")
    # no picture is stored here, so the answer to the earlier request is shown
    answer(tuner, 90, [150])
    until_level(tuner, 90)
    assert alt(tuner) == "A square, level 150"


def test_an_answer_replaces_the_stored_picture(tuner):
    slider = tuner.get_by_role("slider")
    slider.focus()
    tuner.keyboard.press("End")
    until_level(tuner, 200)
    answer(tuner, 30, [200])
    until_level(tuner, 30)
    assert tuner.get_by_role("status").inner_text() == ""
    before = tuner.evaluate("window.model.saved")
    tuner.keyboard.press("ArrowLeft")
    assert tuner.evaluate("window.model.saved") == before + 1
    # a kernel that has answered is waited for
    assert tuner.get_by_role("status").inner_text() == ""


def test_an_answer_of_runs_is_painted_to_the_bit(tuner):
    picture = (
        np.random.default_rng(1).integers(0, 256, (40, 70, 3), dtype=np.uint8).repeat(9, axis=1)
    )
    tuner.evaluate(
        """(runs) => {
            const model = window.model, larger = new Uint8Array(runs.length + 11);
            larger.set(runs, 7);
            model.set("frame", new DataView(larger.buffer, 7, runs.length));
            model.set("answers", model.get("answers") + 1);
        }""",
        list(web.encode_runs(picture)),
    )
    shown = tuner.evaluate("""() => {
        const canvas = document.querySelector("canvas");
        return Array.from(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data);
    }""")
    assert np.array_equal(np.reshape(shown, (40, 630, 4))[..., :3], picture)


def test_a_press_on_the_picture_moves_both_sliders_of_its_place(page):
    fractions = [0.1, 0.3, 0.5, 0.7, 0.9]

    def shade(down=0.5, right=0.5):
        return square(round(100 * down + 50 * right))

    open_widget(
        page,
        widgets.tune(
            shade,
            lambda drawn: drawn,
            alt="Gray",
            point=("down", "right"),
            down=fractions,
            right=fractions,
        ),
    )
    box = page.locator("canvas").bounding_box()
    page.mouse.click(box["x"] + 0.68 * box["width"], box["y"] + 0.12 * box["height"])
    texts = [slider.get_attribute("aria-valuetext") for slider in page.get_by_role("slider").all()]
    assert texts == ["0.1", "0.7"]
    assert page.evaluate("window.model.get('at')") == [0, 3]


def test_an_error_of_the_function_is_shown_next_to_the_sliders(tuner):
    tuner.evaluate("""() => {
        window.model.set("problem", "ValueError: too light");
        window.model.set("answers", 1);
    }""")
    assert tuner.get_by_role("status").inner_text() == "ValueError: too light"


def test_controls_are_large_enough_and_fit_a_narrow_page(player):
    player.set_viewport_size({"width": 400, "height": 700})
    for role in ("slider", "button"):
        box = player.get_by_role(role).bounding_box()
        assert box["height"] >= 24 and box["x"] >= 0 and box["x"] + box["width"] <= 400


def test_axe_names_a_picture_without_words(page, axe):
    page.set_content(
        '<!DOCTYPE html><html lang="en"><title>A page</title><main><img src="data:,"></main>'
    )
    assert [violation.partition(":")[0] for violation in axe(page, "main")] == ["image-alt"]
