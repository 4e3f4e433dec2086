"""A student without any installation opens an assignment on the site and runs it in the browser."""

import os
import subprocess
import sys
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from importlib.util import find_spec
from pathlib import Path

import jinja2
import nbformat
import pytest
import testbed

from hdrlab.course.grading import results
from hdrlab.course.site.lite import build

ROOT = Path(__file__).parents[2]
sys.path.append(str(ROOT / "tests" / "browser"))
from laboratory import Absent, chromium  # noqa: E402

pytestmark = [
    pytest.mark.wasm,
    pytest.mark.skipif(
        find_spec("jupyterlite_pyodide_kernel") is None,
        reason='JupyterLite needs pip install ".[lite]"',
    ),
]
THEME = Path(build.__file__).parents[1] / "theme"
PATIENCE_MS = 400_000  # a limit for what hangs; a machine may be busy
ANSWER = """def hat(n=256):
    z = np.arange(n)
    return np.minimum(z, n - 1 - z) / ((n - 1) // 2)"""
SLIDER = """from hdrlab.show import widgets
squares = [np.full((40, 60), 50 * k, np.uint8) for k in range(5)]
widgets.play(squares, lambda square: square, alt="A square, ever lighter")"""
TASK_CELLS = ("task-hat", "check-hat")
# whether the browser's storage has a notebook with the answer
SAVED = """() => new Promise((resolve) => {
    const opened = indexedDB.open("hdrlab notebooks");
    opened.onsuccess = () => {
        const all = opened.result.transaction("files").objectStore("files").getAll();
        all.onsuccess = () => resolve(JSON.stringify(all.result).includes("np.minimum"));
    };
})"""
PAGE = """<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>Homework 2</title>
<link rel="stylesheet" href="../_static/site.css"><main><h1>Homework 2</h1>{run}</main>
<script src="../_static/lite.js"></script></html>"""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """A site with one assignment, as (its address, the edition of the assignment)."""
    bed = testbed.find()
    if bed is None:
        pytest.skip(f"no test bed: see tests/wasm/testbed.py, and set {testbed.VARIABLE}")
    folder = tmp_path_factory.mktemp("lite")
    sheet = nbformat.read(ROOT / "assignments" / "hw2.ipynb", 4)
    first = next(cell for cell in sheet.cells if cell.cell_type == "code")
    task_cells = [cell for cell in sheet.cells if cell.id in TASK_CELLS]
    sheet.cells = [first, *task_cells, nbformat.v4.new_code_cell(SLIDER, id="slider")]
    nbformat.write(sheet, folder / "hw2.ipynb")
    out = folder / "site"
    out.mkdir()
    build.build(out, folder, [], [folder / "hw2.ipynb"], build.find_pyodide(str(bed / "pyodide")))
    edition = build.edition_of([], [folder / "hw2.ipynb"])
    (out / "_static").symlink_to(THEME / "static")
    write_page(out, "hw2", edition)
    write_page(out, "next_week", "00000000")
    handler = partial(SimpleHTTPRequestHandler, directory=str(out))
    handler.func.log_message = lambda *_: None
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}", edition
        server.shutdown()


def write_page(out, name, edition):
    """Write a page of the site for the assignment in an edition."""
    template = jinja2.Template((THEME / "run.html").read_text("utf-8"))
    run = template.render(edition=edition, pagename="assignments/hw2", content_root="../")
    (out / "assignments").mkdir(exist_ok=True)
    (out / "assignments" / f"{name}.html").write_text(PAGE.format(run=run), "utf-8")


@pytest.fixture
def page():
    """A page that keeps its requests in `requests`."""
    try:
        with chromium("chromium-headless-shell", "chromium") as browser:
            context = browser.new_context(viewport={"width": 1280, "height": 720})
            context.set_default_timeout(PATIENCE_MS)
            page = context.new_page()
            page.requests = []
            context.on("request", lambda request: page.requests.append(request.url))
            yield page
    except Absent as reason:
        pytest.skip(str(reason))


def write_answer(page):
    """Replace the cell of the task by the answer."""
    cell = page.locator(".jp-CodeCell", has_text="def hat(")
    cell.locator(".cm-content").click()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text(ANSWER)


def test_a_student_edits_checks_and_downloads_what_grade_gives_full_points(site, page, tmp_path):
    address, _ = site
    page.goto(f"{address}/assignments/hw2.html")
    page.get_by_text("Run this page here").click()
    write_answer(page)
    page.get_by_text("Run", exact=True).click()
    page.locator(".lm-Menu").get_by_text("Run All Cells", exact=True).click()
    page.get_by_text("10 of 10 points").first.wait_for()

    slider = page.locator("input[type=range]").first
    before = slider.input_value()
    slider.press("ArrowRight")
    assert slider.input_value() != before

    with page.expect_download() as started:
        page.get_by_text("Download my notebook").first.click()
    assert started.value.suggested_filename == "hw2.ipynb", "its name tells grade the homework"
    started.value.save_as(tmp_path / "hw2.ipynb")
    command = [sys.executable, "-m", "hdrlab", "grade", "hw2.ipynb", "--tier", "practice"]
    subprocess.run(command, cwd=tmp_path, env=os.environ, check=True, capture_output=True)
    result = results.from_json((tmp_path / "results" / "result.json").read_bytes())
    assert result.of("hat") and all(check.outcome == "holds" for check in result.of("hat"))

    elsewhere = [url for url in page.requests if not url.startswith((address, "data:", "blob:"))]
    assert elsewhere == []


def test_work_in_an_earlier_edition_is_offered_next_to_the_new_one(site, page, tmp_path):
    address, edition = site
    page.goto(f"{address}/lite/notebooks/index.html?path={edition}/assignments/hw2.ipynb")
    write_answer(page)
    page.keyboard.press("Control+s")
    page.wait_for_function(SAVED)

    page.goto(f"{address}/assignments/next_week.html")
    link = page.get_by_role("link", name="continue")
    link.wait_for()
    assert "path=00000000/" in page.locator(".start").get_attribute("href")
    assert f"path={edition}/" in link.get_attribute("href")
    with page.expect_download() as started:
        page.get_by_role("button", name="Download it").click()
    assert ANSWER in [cell.source for cell in nbformat.read(started.value.path(), 4).cells]

    page.goto(f"{address}/assignments/hw2.html")
    page.get_by_text("Continue your work").click()
    page.locator(".jp-CodeCell", has_text="np.minimum").wait_for()
