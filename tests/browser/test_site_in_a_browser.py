"""The course's site as a reader sees it: opened from its folder, with no kernel and no server.

It shows the notebooks as they were run for the tests of notebooks, where these are executed_folder (see
`executed_folder`).
"""

import functools
import http.server
import os
import re
import subprocess
import sys
import threading
from importlib.util import find_spec
from pathlib import Path

import pytest
from laboratory import PATIENCE, SHOW_ALL_ANSWERS

from hdrlab.course.site.pages import cache_of

NOTEBOOKS = sorted(path.stem for path in (Path(__file__).parents[2] / "notebooks").glob("*.ipynb"))
OTHERS = [
    *("index", "photographs", "verdicts", "instructors", "map", "commands", "assignments/hw2"),
    *("reference/index", "reference/tonemap", "reference/tonemap.durand"),
    *("reference/capture.planning", "reference/show.widgets"),
    *("teachers_sheets", "teachers_sheets/10_radiance_map"),
]
MINOR = "empty-table-header"  # the empty corner of a table with names on two sides
NEEDS = ("sphinx", "myst_nb", "numpydoc", "ziamath")
pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(
        any(find_spec(name) is None for name in NEEDS),
        reason='the site needs pip install ".[site]"',
    ),
]


def make_site(folder, executed_folder):
    """Make the site of all notebooks in a folder."""
    cache = cache_of(folder / "site")
    cache.mkdir()
    (executed_folder / "executed").mkdir(parents=True, exist_ok=True)
    (cache / "executed").symlink_to(executed_folder / "executed")
    command = [sys.executable, "-m", "hdrlab", "site", "--out", str(folder / "site"), "--jobs", "2"]
    ran = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert ran.returncode == 0 and ran.stderr == "", ran.stderr


@pytest.fixture(scope="session")
def site(browser, executed_folder, tmp_path_factory):
    """The site of all notebooks, made once for all workers: one makes it, and who comes meanwhile waits."""
    fcntl = pytest.importorskip("fcntl", reason="a lock between the workers is one of POSIX")
    base = tmp_path_factory.getbasetemp()
    folder = (
        base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    ) / "site-of-all-notebooks"
    folder.mkdir(exist_ok=True)
    with open(folder / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "made").exists():
            make_site(folder, executed_folder)
            (folder / "made").touch()
    return folder / "site"


@pytest.fixture
def opened(site, page):
    """Open a page with all answers shown; what questions cover is tested elsewhere."""
    page.add_init_script(SHOW_ALL_ANSWERS)

    def open_(name, width=1280):
        page.set_viewport_size({"width": width, "height": 900})
        page.goto((site / f"{name}.html").as_uri())
        return page

    yield open_
    assert page.problems == []
    assert [
        url for url in page.requests if not url.startswith((site.as_uri(), "data:", "blob:"))
    ] == []


def open_widget(page, place):
    """Scroll to a widget, wait until it has replaced its still picture, and return it."""
    place.scroll_into_view_if_needed()
    page.wait_for_function(
        "el => el.dataset.state === 'open'", arg=place.element_handle(), timeout=PATIENCE
    )
    return place.locator(".hdrlab")


def move(page, widget):
    """Move one control of a widget: a slider to its other end, or to the last of some pictures."""
    kind = widget.get_attribute("data-kind")
    if kind == "blink":
        return widget.get_by_role("radio").last.check()
    if kind in ("pixel", "bitmaps", "gsolve"):
        widget.get_by_role("application").press("Shift+ArrowRight")
        return
    if kind in ("exposure", "zones", "gains", "kernel", "gradients"):
        # the screen of the gain map is the dimmest at first
        arrow = "ArrowRight" if kind == "gains" else "ArrowLeft"
        return widget.get_by_role("slider").first.press(f"Shift+{arrow}")
    if widget.get_by_role("slider").count() == 0:
        return widget.get_by_role("radio", checked=False).first.check()
    slider = widget.get_by_role("slider").first
    at_end = slider.input_value() == slider.get_attribute("max")
    slider.press("Home" if at_end else "End")


def seen(page, canvas):
    """Return the pixels of a picture on the screen as it is now, without waiting until it stops
    changing.
    """
    return page.screenshot(clip=canvas.bounding_box(), caret="initial")


def changed_by(page, widget, move):
    """Move a control and wait until the screen has changed; scripts cannot read a canvas of a file:
    page.
    """
    canvas = widget.locator("canvas, .hdrlab-levels").first
    canvas.scroll_into_view_if_needed()
    before = seen(page, canvas)
    move()
    for _ in range(PATIENCE // 20):
        if seen(page, canvas) != before:
            return
        page.wait_for_timeout(20)
    raise AssertionError("the picture is as it was")


def assert_it_fits(page, axe):
    """Check a page on a wide and on a narrow screen, and leave it wide."""
    # axe finds the same wherever it is wide, and in code, half of all elements, the same where it
    # is narrow
    for width, part in (
        (400, "html"),
        (1440, None),
        (1280, {"include": ["html"], "exclude": ["pre"]}),
    ):
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        violations = (
            [violation for violation in axe(page, part) if not violation.startswith(MINOR)]
            if part
            else []
        )
        assert violations == [], width


@pytest.mark.parametrize("name", ["story", "screen", *(f"notebooks/{name}" for name in NOTEBOOKS)])
def test_the_widgets_of_a_page_fit_any_screen_pass_axe_and_answer_with_no_kernel(opened, axe, name):
    page = opened(name)
    places = page.locator(".live").all()
    assert places, "the page shows no widget"
    widgets = [open_widget(page, place) for place in places]
    assert_it_fits(page, axe)
    for widget in widgets:
        if widget.get_attribute("data-kind") == "predict":
            widget.get_by_role("button", name="Show", exact=True).click()
            assert widget.get_by_role("status").last.inner_text().startswith("The truth: ")
        else:
            changed_by(page, widget, lambda widget=widget: move(page, widget))
            if widget.get_attribute("data-kind") == "tune":
                assert widget.get_by_role("status").inner_text().startswith("Computed beforehand")
                there = widget.get_by_role("link", name="Run it yourself").get_attribute("href")
                assert there == "../installing.html"


@pytest.mark.parametrize("name", OTHERS)
def test_a_page_fits_a_wide_and_a_narrow_screen_and_axe_finds_nothing_wrong(opened, axe, name):
    page = opened(name)
    for place in page.locator(".live").all():
        open_widget(page, place)
    assert_it_fits(page, axe)


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_teachers_sheet_prints_on_one_page(opened, name):
    page = opened(f"teachers_sheets/{name}")
    printed = page.pdf(prefer_css_page_size=True)
    assert len(re.findall(rb"/Type\s*/Page\b", printed)) == 1


@pytest.mark.parametrize(
    "name",
    [
        "index",
        "story",
        "screen",
        "notebooks/04_response_gsolve",
        "verdicts",
        "reference/tonemap.chiu",
    ],
)
def test_a_page_is_dark_where_the_reader_likes_it_dark_and_axe_finds_nothing_wrong(
    opened, axe, name
):
    page = opened(name)
    page.emulate_media(color_scheme="dark")
    for place in page.locator(".live").all():
        open_widget(page, place)
    light = "Number(getComputedStyle(document.body).backgroundColor.match(/\\d+/)[0])"
    assert page.evaluate(light) < 40
    assert_it_fits(page, axe)
    page.emulate_media(media="print")
    assert page.evaluate(light) == 255


@pytest.mark.parametrize("width", [1440, 1280, 390])
def test_the_story_has_ten_screens_which_begin_with_a_claim_and_fill_the_window(opened, width):
    page = opened("story", width)
    header = page.locator("header").bounding_box()
    assert header["width"] == width and header["height"] < 80
    screens = page.locator("main section section").filter(has_text="Guess.")
    assert screens.count() == 10
    for number, screen in enumerate(screens.all(), 1):
        assert screen.get_by_role("heading").inner_text().startswith(f"{number} · ")
        assert screen.locator(".live").count() == 1
        assert screen.bounding_box()["height"] > 800
    answer = screens.first.locator("details")
    assert not answer.get_by_role("paragraph").is_visible()
    answer.locator("summary").press("Enter")
    assert answer.get_by_role("paragraph").is_visible()
    page.get_by_role("link", name="00 · Welcome").first.click()
    assert "notebooks/00_welcome" in page.url


def test_the_photos_in_figures_keep_their_colors_on_a_dark_page(opened):
    page = opened("story")
    page.emulate_media(color_scheme="dark")
    for kind, photo in (("gsolve", ".hdrlab-picked canvas"), ("pixel", "canvas")):
        for place in page.locator(".live").all():
            open_widget(page, place)
        canvas = page.locator(f"[data-kind={kind}]").locator(photo)
        assert "invert" not in canvas.evaluate("canvas => getComputedStyle(canvas).filter")


def test_the_brush_follows_the_pointer_and_the_keys(opened, site):
    values = [
        file.stem
        for file in (site / "_widgets").glob("*-?*.js")
        if file.stem[:5] != "code-" and '"bins": ' in file.read_text("utf-16")
    ]
    assert values, "no notebook has a Detail Brush"
    page = opened(f"notebooks/{values[0].rpartition('-')[0]}")
    widget = open_widget(page, page.locator(f'[data-name="{values[0]}"]'))
    changed_by(page, widget, lambda: widget.get_by_role("application").press("ArrowLeft"))
    box = widget.locator("canvas").bounding_box()
    changed_by(
        page,
        widget,
        lambda: page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 0.3 * box["height"]),
    )


@pytest.mark.parametrize("name", ["index", "notebooks/00_welcome"])
def test_the_menu_of_a_narrow_page_opens_and_closes_by_the_keyboard(opened, name):
    page = opened(name, 400)
    menu = page.get_by_role("navigation", name="All pages")
    assert not menu.is_visible()
    page.get_by_role("button", name="Menu").press("Enter")
    assert menu.is_visible()
    page.keyboard.press("Escape")
    assert not menu.is_visible()


def test_the_first_tab_stop_skips_the_menu(opened):
    page = opened("notebooks/00_welcome")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "main"


@pytest.mark.parametrize("words", ["lambda", "λ", "g(z)", "gsolve least squares"])
def test_the_search_finds_the_response_curve_by_its_words_and_its_letters(opened, words):
    page = opened("index")
    page.get_by_role("searchbox", name="Search").fill(words)
    page.keyboard.press("Enter")
    first = page.locator("#search-results li a").first
    first.wait_for(timeout=PATIENCE)
    results = page.locator("#search-results li").all_inner_texts()
    assert "04 · The response curve: gsolve" in results and len(results) < 30


def test_a_page_has_its_contents_at_the_right_and_leads_on(opened):
    page = opened("notebooks/04_response_gsolve", 1440)
    contents = page.get_by_role("navigation", name="On this page")
    assert contents.bounding_box()["x"] > 1100
    contents.get_by_role("link", name="Many pixels").click()
    assert page.evaluate("location.hash") == "#many-pixels"
    assert page.get_by_role("heading", name="Many pixels").bounding_box()["y"] < 200
    page.locator("footer").get_by_role("link", name="Next").click()
    assert "notebooks/05" in page.url


def test_a_cell_is_copied_and_an_example_without_its_prompts(opened):
    page = opened("notebooks/00_welcome")
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    for name, copied in (
        ("notebooks/00_welcome", "photograph("),
        ("reference/tonemap.chiu", "tonemap("),
    ):
        page = opened(name)
        page.get_by_role("button", name="Copy").first.click()
        page.get_by_role("button", name="Copied").wait_for(timeout=PATIENCE)
        text = page.evaluate("navigator.clipboard.readText()")
        assert copied in text and ">>>" not in text


def test_cells_that_only_draw_are_folded_and_one_switch_opens_them_on_this_page_and_the_next(
    opened,
):
    page = opened("notebooks/04_response_gsolve")
    folds = page.locator("main details.hide")
    assert folds.count() > 5 and page.locator("main details.hide[open]").count() == 0
    # the lesson itself is not folded
    assert page.get_by_text("debevec.system(Z[:20], B, 30").is_visible()
    first = folds.first.locator("summary")
    assert first.inner_text() == "Show the code" and first.get_attribute("aria-label") is None
    first.press("Enter")
    assert page.locator("main details.hide[open]").count() == 1
    page.get_by_role("button", name="Show all code").click()
    assert page.locator("main details.hide:not([open])").count() == 0
    page = opened("notebooks/03_alignment_mtb")
    assert page.locator("main details.hide:not([open])").count() == 0
    page.get_by_role("button", name="Fold the code of pictures").click()
    assert page.locator("main details.hide[open]").count() == 0
    page.reload()
    assert page.locator("main details.hide[open]").count() == 0


def are_shown(page, part):
    """Return for each cell whether its covered answers are shown."""
    return page.locator(part).evaluate_all("(all) => all.map((el) => el.checkVisibility())")


COVERED_OUTPUT = ".tag_covered .cell_output, details.covered"


def test_no_file_of_the_site_has_an_answer_to_an_exercise(site):
    assert (site / "notebooks" / "04_response_gsolve.html").exists()
    files = [path for path in site.rglob("*") if path.is_file()]
    heading = b"Answers to the exercises of notebook"  # the first line of each file with answers
    assert [path for path in files if heading in path.read_bytes()] == []


@pytest.fixture
def asking(site, page):
    """The page of the first notebook, with no question answered."""
    page.goto((site / "notebooks" / "00_welcome.html").as_uri())
    return page


def test_a_question_covers_what_follows_until_it_is_answered_by_keys_and_after_a_reload(asking):
    page = asking
    before = are_shown(page, COVERED_OUTPUT)
    assert len(before) >= 6 and not any(before)
    place = page.locator(".live[data-asks]").first
    widget = open_widget(page, place)
    widget.get_by_role("radio").first.press("Space")
    widget.get_by_role("button", name="Check my answer").press("Enter")
    assert widget.get_by_role("status").last.evaluate("(el) => el === document.activeElement")
    left = are_shown(page, COVERED_OUTPUT)
    assert 0 < len(left) < len(before) and not any(left)
    page.reload()
    assert len(are_shown(page, COVERED_OUTPUT)) == len(left)
    widget = open_widget(page, place)
    assert widget.get_by_role("radio").first.is_checked()
    page.get_by_role("button", name="Ask me again").click()
    page.wait_for_load_state()
    assert are_shown(page, COVERED_OUTPUT) == before


def test_one_switch_shows_all_answers_and_is_remembered_and_paper_shows_them_too(asking):
    page = asking
    page.emulate_media(media="print")
    assert all(are_shown(page, COVERED_OUTPUT))
    page.emulate_media(media="screen")
    page.get_by_role("button", name="Show all answers").click()
    assert all(are_shown(page, COVERED_OUTPUT))
    page.reload()
    assert all(are_shown(page, COVERED_OUTPUT))
    page.get_by_role("button", name="Cover the answers").click()
    assert not any(are_shown(page, COVERED_OUTPUT))


def test_without_scripts_nothing_is_covered(site, browser):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto((site / "notebooks" / "00_welcome.html").as_uri())
    parts = page.locator(COVERED_OUTPUT).all()
    assert len(parts) >= 6 and all(part.is_visible() for part in parts)
    context.close()


def test_on_paper_answers_are_unfolded_and_no_line_is_cut(opened):
    page = opened("notebooks/04_response_gsolve", 700)
    folded = page.locator("main details:not(.hide):not([open])")
    before = folded.count()
    page.emulate_media(media="print")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert before > 0 and folded.count() == 0
    cut = "(all) => all.filter((el) => el.scrollWidth > el.clientWidth + 1).length"
    assert page.locator("main pre").evaluate_all(cut) == 0
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert folded.count() == before


def test_the_site_works_from_a_server_too(site, page):
    handler = functools.partial(_Quiet, directory=str(site))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        address = f"http://127.0.0.1:{server.server_port}"
        page.goto(f"{address}/index.html")
        widget = open_widget(page, page.locator(".live").first)
        changed_by(page, widget, lambda: move(page, widget))
        server.shutdown()
    assert page.problems == []
    assert [url for url in page.requests if not url.startswith((address, "data:", "blob:"))] == []


class _Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *words):
        pass
