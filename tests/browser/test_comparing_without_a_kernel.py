"""wipe, blink and the Detail Brush on a page without a kernel, with mouse, finger and keyboard."""

import base64

import numpy as np
import pytest
from laboratory import open_widget
from support.half_floats import decode_half_floats

from hdrlab import scenes
from hdrlab.core import colour
from hdrlab.show import widgets
from hdrlab.tonemap import brush

pytestmark = pytest.mark.browser

E = scenes.room((240, 320))
SHADES = np.arange(0, 240, 10, np.uint8).reshape(4, 6).repeat(100, axis=0).repeat(100, axis=1)
LIGHT = np.linspace(0.001, 1000, SHADES.size).reshape(SHADES.shape)


def frames(page, count=2):
    """Wait until the browser has painted the requested frame."""
    for _ in range(count):
        page.evaluate("new Promise(requestAnimationFrame)")


def pixels(page):
    """Return the canvas as (H, W, 3)."""
    frames(page)
    width, height, data = page.evaluate(
        """() => {
            const canvas = document.querySelector("canvas");
            const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            const parts = Array.from({ length: Math.ceil(data.length / 8192) }, (_, k) =>
                String.fromCharCode(...data.slice(8192 * k, 8192 * (k + 1))));
            return [canvas.width, canvas.height, btoa(parts.join(""))];
        }"""
    )
    return np.frombuffer(base64.b64decode(data), np.uint8).reshape(height, width, 4)[..., :3]


def alt(page):
    frames(page)
    return page.locator("canvas").get_attribute("aria-label")


def read_status(page):
    frames(page)
    return page.get_by_role("status").inner_text()


def point(page, across, down):
    """Move the pointer to a position, in fractions of the picture's width and height."""
    box = page.locator("canvas").bounding_box()
    page.mouse.move(box["x"] + across * box["width"], box["y"] + down * box["height"])


def fingers(page, kind, *places):
    """Put fingers on the picture, move them, or lift them."""
    box = page.locator("canvas").bounding_box()
    points = [
        {"x": box["x"] + x * box["width"], "y": box["y"] + y * box["height"]} for x, y in places
    ]
    page.touch.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": points})


@pytest.fixture
def open_(page):
    def opened(widget):
        page.touch = page.context.new_cdp_session(page)
        open_widget(page, widget)
        return page

    yield opened
    assert page.problems == []
    assert [url for url in page.requests if not url.startswith(("blob:", "data:"))] == []
    assert page.evaluate("window.reached") == []  # no key leaves the widget


@pytest.fixture
def wiper(open_):
    return open_(
        widgets.wipe(
            SHADES, 255 - SHADES, alt="Shades", labels=["positive", "negative"], values=LIGHT
        )
    )


@pytest.fixture
def blinker(open_):
    return open_(
        widgets.blink(
            SHADES, 255 - SHADES, alt="Shades", labels=["positive", "negative"], period=0.2
        )
    )


@pytest.fixture
def brushed(open_):
    return open_(widgets.brush(E, alt="The room", size=64))


def test_each_side_of_the_edge_is_its_own_picture(wiper):
    shown = pixels(wiper)[..., 0]
    assert shown.shape == SHADES.shape
    assert np.array_equal(shown[:, :290], SHADES[:, :290])
    assert np.array_equal(shown[:, 310:], 255 - SHADES[:, 310:])
    assert alt(wiper) == "Shades, positive left of the edge at 50 %, negative right of it"


def test_the_edge_follows_its_slider_the_pointer_and_a_finger(wiper):
    slider = wiper.get_by_role("slider", name="edge")
    slider.press("ArrowRight")
    assert slider.get_attribute("aria-valuetext") == "51 %"
    point(wiper, 0.2, 0.5)
    wiper.mouse.down()
    point(wiper, 0.25, 0.6)
    wiper.mouse.up()
    assert slider.get_attribute("aria-valuetext") == "25 %" and "edge at 25 %" in alt(wiper)
    point(wiper, 0.8, 0.5)
    assert slider.get_attribute("aria-valuetext") == "25 %"
    fingers(wiper, "Start", (0.25, 0.5))
    fingers(wiper, "Move", (0.75, 0.5))
    fingers(wiper, "End")
    assert slider.get_attribute("aria-valuetext") == "75 %"
    assert np.array_equal(pixels(wiper)[:, :440, 0], SHADES[:, :440])


def test_the_pixel_under_the_pointer_is_read_out(wiper):
    point(wiper, 0.25, 0.375)  # 150.0, 150.0
    assert (
        read_status(wiper)
        == f"x 150, y 150: positive 70; negative 185; radiance {LIGHT[150, 150]:.3g}"
    )


def test_the_arrow_keys_read_pixels_aloud_and_zoom_keeps_the_cross(wiper):
    stage = wiper.get_by_role("application")
    stage.press("ArrowRight")
    assert read_status(wiper).startswith("x 300, y 200: positive 150; negative 105; radiance ")
    stage.press("Shift+ArrowRight")
    assert read_status(wiper).startswith("x 372, y 200: ")
    assert wiper.get_by_role("status").get_attribute("aria-live") == "polite"
    for _ in range(5):
        stage.press("+")
    assert "zoom 32" in alt(wiper) and wiper.get_by_role("slider", name="zoom").input_value() == "5"
    stage.press("ArrowLeft")
    assert read_status(wiper).startswith("x 371, y 200: ")
    stage.press("0")
    assert "zoom" not in alt(wiper)


def test_a_single_pixel_is_a_square_of_one_shade_at_high_zoom(open_):
    noise = np.random.default_rng(0).integers(0, 256, (480, 480), np.uint8)
    page = open_(widgets.blink(noise, 255 - noise, alt="Noise"))
    page.get_by_role("slider", name="zoom").press("End")
    # half a pixel at each edge, for the middle stays in the middle
    shown = pixels(page)[32:-32, 32:-32, 0]
    assert np.array_equal(shown, noise[233:247, 233:247].repeat(64, axis=0).repeat(64, axis=1))


@pytest.mark.parametrize(("width", "shown"), [(200, 960), (384, 960), (1200, 1200)])
def test_a_small_picture_is_shown_as_wide_as_a_column(open_, width, shown):
    picture = np.full((90, width), 100, np.uint8)
    page = open_(widgets.wipe(picture, picture, alt="Gray"))
    assert page.locator("canvas").bounding_box()["width"] == shown
    page.set_viewport_size({"width": 390, "height": 800})
    assert page.locator("canvas").bounding_box()["width"] < 390


def test_an_upright_picture_is_enlarged_no_further_than_the_screen_is_high(open_):
    picture = np.full((500, 375), 100, np.uint8)
    page = open_(widgets.wipe(picture, picture, alt="Gray"))
    assert page.locator("canvas").bounding_box()["height"] == pytest.approx(0.75 * 900, abs=2)


def test_the_wheel_zooms_after_a_click_and_scrolls_the_page_before_it(wiper):
    point(wiper, 0.25, 0.25)
    wiper.mouse.wheel(0, -100)
    assert "zoom" not in alt(wiper)
    wiper.get_by_role("application").focus()
    before = read_status(wiper)
    wiper.mouse.wheel(0, -100)
    wiper.wait_for_function(
        "document.querySelector('canvas').getAttribute('aria-label').includes('zoom 2.0')"
    )
    point(wiper, 0.25, 0.25)
    assert read_status(wiper) == before  # what was under the pointer stays there


def test_two_fingers_zoom_about_their_middle_and_a_zoomed_picture_is_dragged(blinker):
    fingers(blinker, "Start", (0.4, 0.5), (0.6, 0.5))
    fingers(blinker, "Move", (0.3, 0.5), (0.7, 0.5))
    fingers(blinker, "End")
    assert "zoom 2.0" in alt(blinker)
    point(blinker, 0.5, 0.5)
    assert read_status(blinker).startswith("x 300, y 200")
    blinker.mouse.down()
    point(blinker, 0.25, 0.5)
    blinker.mouse.up()
    point(blinker, 0.5, 0.5)
    assert read_status(blinker).startswith("x 375, y 200")


def test_pictures_change_by_their_names_by_space_and_by_themselves(blinker):
    assert np.array_equal(pixels(blinker)[..., 0], SHADES) and alt(blinker) == "Shades, positive"
    blinker.get_by_role("radio", name="negative").check()
    assert np.array_equal(pixels(blinker)[..., 0], 255 - SHADES)
    assert alt(blinker) == "Shades, negative"
    blinker.get_by_role("application").press("Space")
    assert alt(blinker) == "Shades, positive"
    assert blinker.get_by_role("radio", name="positive").is_checked()
    button = blinker.get_by_role("button", name="Blink")
    button.press("Enter")
    for name in ("negative", "positive", "negative"):
        blinker.wait_for_function(
            "(name) => document.querySelector('canvas').getAttribute('aria-label').endsWith(name)",
            arg=name,
        )
    blinker.get_by_role("button", name="Stop").click()
    stopped = blinker.evaluate("window.model.get('index')")
    blinker.wait_for_timeout(500)
    assert blinker.evaluate("window.model.get('index')") == stopped


@pytest.mark.parametrize("gray", [False, True])
@pytest.mark.parametrize(
    ("centre", "size", "magnification", "limit"),
    [
        ((120, 160), 64, 1, 4),
        ((100, 90), 128, 1, 1),
        ((60, 250), 96, 3, 16),
        ((0, 0), 128, 2, 4),
        ((239, 319), 64, 1, 4),
        ((120, 160), 512, 1, 4),
    ],
)
def test_the_brush_shows_what_python_computes(open_, gray, centre, size, magnification, limit):
    """Within one pixel value, because a float32 may round to the next one."""
    map_ = colour.luminance(E) if gray else E
    widget = widgets.brush(
        map_, alt="The room", size=size, magnification=magnification, limit=limit
    )
    page = open_(widget)
    page.evaluate("(centre) => window.model.set('centre', centre)", list(centre))
    shown = pixels(page)

    seen = decode_half_floats(widget.radiance, widget.scale, map_.shape)
    L = colour.luminance(seen)
    Ld = brush.lens(L, centre, size=size, magnification=magnification, limit=limit)
    window = brush.place_window(L.shape, centre, -(-size // magnification))
    large = [
        image[window].repeat(magnification, 0).repeat(magnification, 1)[:size, :size]
        for image in (seen, L)
    ]
    expected = colour.to_8bit(colour.recolour(*large, Ld))
    off = shown[brush.place_window(L.shape, centre, size)].astype(int) - expected.reshape(
        *Ld.shape, -1
    )
    assert np.abs(off[3:-3, 3:-3]).max() <= 1  # its frame lies on the edge


def test_around_the_brush_the_picture_is_left_alone(brushed):
    before = pixels(brushed)
    point(brushed, 0.2, 0.2)
    after = pixels(brushed)
    changed = np.argwhere(np.any(before != after, axis=-1))
    assert brushed.evaluate("window.model.get('centre')") == [48, 64]
    moved = np.zeros(before.shape[:2], bool)
    for y, x in ((120, 160), (48, 64)):
        moved[y - 34 : y + 34, x - 34 : x + 34] = True
    assert len(changed) > 1000 and moved[tuple(changed.T)].all()


def test_keys_move_the_brush_and_change_it(brushed):
    stage = brushed.get_by_role("application")
    for key in ("ArrowRight", "Shift+ArrowUp", "]", "+"):
        stage.press(key)
    assert alt(brushed) == "The room, the brush at x 176, y 56, size 96, magnification 2"
    assert brushed.get_by_role("status").get_attribute("aria-live") == "polite"
    assert read_status(brushed).startswith("x 176, y 56, size 96, magnification 2: ")
    for key in ("[", "-"):
        stage.press(key)
    assert alt(brushed) == "The room, the brush at x 176, y 56, size 64"
    for _ in range(9):
        stage.press("Shift+ArrowLeft")
    assert "x 0, y 56" in alt(brushed)


def test_the_brush_follows_a_finger_and_the_page_stays(brushed):
    brushed.set_viewport_size({"width": 400, "height": 200})
    fingers(brushed, "Start", (0.5, 0.3))
    for k in range(5):
        fingers(brushed, "Move", (0.5, 0.3 + 0.1 * k))
    fingers(brushed, "End")
    frames(brushed)
    row, column = brushed.evaluate("window.model.get('centre')")
    assert abs(row - 0.7 * 240) <= 1 and abs(column - 160) <= 1
    assert brushed.evaluate("window.scrollY") == 0


def test_its_sliders_change_the_brush(brushed):
    for name, text in (("size", "96"), ("magnification", "2"), ("limit", "8")):
        before = pixels(brushed)
        slider = brushed.get_by_role("slider", name=name)
        slider.press("ArrowRight")
        assert slider.get_attribute("aria-valuetext") == text
        assert np.any(pixels(brushed) != before)


ALL = {
    "play": lambda: widgets.play([SHADES, 255 - SHADES], lambda one: one, alt="Shades"),
    "tune": lambda: widgets.tune(
        lambda k=0: SHADES // (k + 1), lambda one: one, alt="Shades", k=(0, 3)
    ),
    "wipe": lambda: widgets.wipe(
        SHADES, 255 - SHADES, alt="Shades", labels=["one", "the other"], values=LIGHT
    ),
    "blink": lambda: widgets.blink(SHADES, 255 - SHADES, alt="Shades", values=LIGHT),
    "brush": lambda: widgets.brush(E, alt="The room", size=64),
}


@pytest.mark.parametrize("width", [1280, 400])
@pytest.mark.parametrize("kind", ALL)
def test_every_widget_fits_the_screen_with_controls_large_enough_to_touch(open_, page, kind, width):
    page.set_viewport_size({"width": width, "height": 900})
    open_(ALL[kind]())
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    controls = [*page.get_by_role("slider").all(), *page.get_by_role("button").all()]
    for control in [*controls, *page.locator(".hdrlab-choice label").all()]:
        box = control.bounding_box()
        assert box["height"] >= 24 and box["x"] >= 0 and box["x"] + box["width"] <= width


@pytest.mark.parametrize("width", [1280, 400])
@pytest.mark.parametrize("kind", ALL)
def test_axe_finds_nothing_wrong_with_a_widget(open_, page, axe, kind, width):
    page.set_viewport_size({"width": width, "height": 900})
    open_(ALL[kind]())
    assert axe(page, "#at") == []
