"""The gallery for students: with the keyboard alone, on a phone, and without scripts."""

import sys
from contextlib import closing
from datetime import UTC, datetime, timedelta
from importlib.util import find_spec
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[1]))

from support import small_gallery as small

from hdrlab.course.gallery import ballots, store

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(
        any(find_spec(name) is None for name in ("starlette", "uvicorn")),
        reason='the gallery needs pip install ".[class]"',
    ),
]
TEAMS = {f"team{k}": (f"ann{k}", f"ben{k}") for k in range(1, 9)}


@pytest.fixture(scope="module")
def served(browser, tmp_path_factory):
    """A gallery of eight teams, and its address."""
    from benchmarks import gallery as bench

    closes = datetime.now(UTC) + timedelta(days=1)
    caption = (
        "Seven photographs from a tripod, two stops apart; averylongwordwithoutaplacetobreakit" * 2
    )
    room = small.make_gallery(
        tmp_path_factory.mktemp("class"), TEAMS, closes=closes, caption=caption[:200]
    )
    server, address = bench.start(room.folder)
    yield room, address
    server.terminate()
    server.wait()


def fresh_link(served, who):
    """Return a personal link that has not been used."""
    from hdrlab.course.gallery import tokens

    room, address = served
    with store.writing(room.folder) as db:
        return f"{address}/enter/{tokens.new_link(db, who)}"


def saved(served, who):
    with closing(store.connect(served[0].folder)) as db:
        return ballots.read_ballot(db, who)[1]


def enter(page, served, who):
    page.goto(fresh_link(served, who))
    page.get_by_role("button", name="Open the gallery").click()
    page.locator(".wall").wait_for()


def focused(page):
    return page.evaluate(
        "(({tagName, type, name, textContent}) => [tagName, type ?? '', name ?? '', textContent.trim()])"
        "(document.activeElement)"
    )


def tab_to(page, locator):
    """Press Tab until the focus is on the element that `locator` accepts."""
    for _ in range(200):
        page.keyboard.press("Tab")
        if locator(focused(page)):
            return
    raise AssertionError("the keyboard does not reach it")


def test_a_ballot_is_cast_with_the_keyboard_alone(served, page):
    page.goto(fresh_link(served, "ann1"))
    tab_to(page, lambda on: on[0] == "BUTTON")
    page.keyboard.press("Enter")
    page.locator(".wall").wait_for()
    for k in range(2):
        tab_to(page, lambda on: on[2] == "mark")
        page.keyboard.press("Space")
        page.get_by_text(f"{k + 1} of 2 votes saved at").wait_for()
    assert len(saved(served, "ann1")) == 2
    page.keyboard.press("Space")  # and one is taken back
    page.get_by_text("1 of 2 votes saved at").wait_for()
    assert len(saved(served, "ann1")) == 1
    for _ in range(2):
        tab_to(page, lambda on: on[2] == "with")
        page.keyboard.press("Space")
    tab_to(page, lambda on: on[3] == "Compare two")
    page.keyboard.press("Enter")
    page.get_by_role("group", name="Zoom").wait_for()  # shown by the script that reads the keys
    page.keyboard.press("+")
    page.get_by_text("125 %").wait_for()
    page.keyboard.press("0")
    page.keyboard.press("Escape")
    page.locator(".wall").wait_for()
    assert page.get_by_role("status").text_content() == "1 of 2 votes saved."
    assert page.problems == []


def test_the_first_tab_stop_skips_to_the_ballot(served, page):
    enter(page, served, "ann2")
    page.keyboard.press("Tab")
    assert focused(page)[3] == "To your ballot"
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "bar"


@pytest.mark.parametrize("width", [1280, 400])
def test_every_page_fits_the_screen_and_names_its_parts(served, page, axe, width):
    page.set_viewport_size({"width": width, "height": 900})
    page.goto(fresh_link(served, "ann3"))
    assert axe(page, "html") == []
    page.get_by_role("button", name="Open the gallery").click()
    page.locator(".wall").wait_for()
    marks = page.locator("input[name=mark]")
    page.locator("input[name=with]").first.focus()
    ids = [marks.nth(k).get_attribute("value") for k in range(2)]
    for path in ("/", f"/look/{ids[0]}", f"/compare?with={ids[0]}&with={ids[1]}"):
        page.goto(served[1] + path)
        assert page.evaluate("document.documentElement.scrollWidth") <= width, path
        assert axe(page, "html") == [], path
        sizes = page.evaluate(
            "[...document.querySelectorAll('.panes img')].map((one) => one.naturalWidth)"
        )
        assert all(sizes)
    assert page.problems == []
    assert all(url.startswith(served[1]) for url in page.requests)


def test_on_a_telephone_a_finger_finds_every_control(served, page):
    page.set_viewport_size({"width": 400, "height": 800})
    enter(page, served, "ann4")
    # The page's script hides this button when it has come; only then do the controls stay as they are.
    page.locator("#save").wait_for(state="hidden")
    targets = page.locator(".acts label > span, .bar button:visible")
    boxes = [target.bounding_box() for target in targets.all()]
    assert len(boxes) > 15 and all(box["height"] >= 44 and box["width"] >= 44 for box in boxes)
    page.locator(".vote").first.tap()
    page.get_by_text("1 of 2 votes saved at").wait_for()
    assert len(saved(served, "ann4")) == 1


def test_a_full_ballot_takes_no_more_and_says_why(served, page):
    enter(page, served, "ann5")
    marks = page.locator("input[name=mark]")
    for k in range(2):
        marks.nth(k).check(force=True)
        page.get_by_text(f"{k + 1} of 2 votes saved at").wait_for()
    assert page.locator("input[name=mark]:disabled").count() == marks.count() - 2
    page.get_by_text("Remove one").wait_for()


def test_a_vote_that_is_not_saved_is_taken_back_on_the_page(served, page):
    enter(page, served, "ann6")
    page.route("**/ballot", lambda route: route.abort())
    page.locator("input[name=mark]").first.click(force=True)
    page.get_by_text("Not saved").wait_for()
    assert page.locator("input[name=mark]:checked").count() == 0 and saved(served, "ann6") == set()


def test_a_vote_given_before_the_script_has_come_is_saved_too(served, page):
    held = []
    page.route("**/wall.js", lambda route: held.append(route))
    page.goto(fresh_link(served, "ben6"))
    page.get_by_role("button", name="Open the gallery").click(no_wait_after=True)
    page.locator("input[name=mark]").first.check(force=True)
    held[0].continue_()
    page.get_by_text("1 of 2 votes saved at").wait_for()
    assert len(saved(served, "ben6")) == 1


def test_without_scripts_a_ballot_is_saved_by_its_button(served, browser):
    context = browser.new_context(
        java_script_enabled=False, viewport={"width": 1280, "height": 900}
    )
    page = context.new_page()
    enter(page, served, "ann7")
    page.locator("input[name=mark]").first.check(force=True)
    page.get_by_role("button", name="Save ballot").click()
    page.get_by_text("1 of 2 votes saved.").wait_for()
    assert len(saved(served, "ann7")) == 1
    context.close()


def test_two_pictures_are_moved_as_one(served, page):
    enter(page, served, "ann8")
    ids = [page.locator("input[name=mark]").nth(k).get_attribute("value") for k in range(2)]
    page.goto(f"{served[1]}/compare?with={ids[0]}&with={ids[1]}")
    # small pictures are larger than these panes
    page.set_viewport_size({"width": 300, "height": 500})
    for _ in range(9):
        page.keyboard.press("+")
    page.locator(".pane").first.focus()
    part = "[...document.querySelectorAll('.pane')].map((one) => one.scrollLeft / one.scrollWidth)"
    before = page.evaluate(part)
    page.keyboard.press("ArrowRight")
    page.wait_for_function(f"(before) => {part}[1] > before + 0.01", arg=before[1])
    page.wait_for_function(
        f"() => {{ const [one, other] = {part}; return Math.abs(one - other) < 0.02; }}"
    )
    assert 0 < before[0] < page.evaluate(part)[0]


def test_the_results_are_shown_after_the_end_of_the_vote(served, page, axe, tmp_path):
    room = small.make_gallery(tmp_path, TEAMS, closes=datetime.now(UTC) + timedelta(seconds=3600))
    from benchmarks import gallery as bench

    server, address = bench.start(room.folder)
    try:
        with store.writing(room.folder) as db:
            for who, team in (
                ("ann1", "team3"),
                ("ann2", "team3"),
                ("ann4", "team5"),
                ("ann5", "team6"),
            ):
                ballots.cast(db, who, [room.artifacts[team]], now=datetime.now(UTC).timestamp())
            store.close(db, datetime.now(UTC))
        page.goto(f"{address}/enter/{room.links['ann7']}")
        page.get_by_role("button").click()
        page.get_by_role("link", name="See the results").click()
        places = page.locator(".standings li")
        assert places.first.get_by_role("heading").text_content() == "team3's view"
        assert "shared by 2" in places.nth(1).text_content()
        assert "Ties are not broken" in page.locator(".method").text_content()
        for width in (1280, 400):
            page.set_viewport_size({"width": width, "height": 900})
            assert page.evaluate("document.documentElement.scrollWidth") <= width
            assert axe(page, "html") == []
    finally:
        server.terminate()
        server.wait()
    assert page.problems == []


@pytest.mark.parametrize("width", [1280, 390])
def test_pairs_are_judged_with_the_keyboard_and_their_results_fit_the_screen(
    browser, page, axe, tmp_path, width
):
    from benchmarks import gallery as bench

    now = datetime.now(UTC)
    room = small.make_gallery(tmp_path, TEAMS, pairs=3, closes=now + timedelta(days=1))
    with store.writing(room.folder) as db:
        for k, id in enumerate(room.artifacts.values()):
            db.execute("INSERT INTO scores VALUES (?, ?, ?)", (id, k / 10, -k / 10))
    server, address = bench.start(room.folder)
    try:
        page.set_viewport_size({"width": width, "height": 844})
        page.goto(fresh_link((room, address), "ann1"))
        page.get_by_role("button", name="Open the gallery").click()
        for number in range(1, 4):
            page.get_by_text(f"Pair {number} of 3").wait_for()
            assert axe(page, "html") == []
            boxes = [button.bounding_box() for button in page.get_by_role("button").all()]
            assert len(boxes) == 2
            assert all(box["height"] >= 44 and box["y"] + box["height"] <= 844 for box in boxes)
            tab_to(page, lambda on: on[0] == "BUTTON")
            page.keyboard.press("Enter")
        page.get_by_text("You have judged 3 pairs").wait_for()
        assert axe(page, "html") == []
        with store.writing(room.folder) as db:
            assert db.execute("SELECT count(*) FROM comparisons").fetchone() == (3,)
            store.close(db, now)
        page.goto(f"{address}/results")
        page.get_by_role("heading", name="The class against the metrics").wait_for()
        assert page.locator(".interval").count() == len(TEAMS) + 3
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert axe(page, "html") == []
        assert page.problems == []
    finally:
        server.terminate()
        server.wait()
