"""A small site with Python for the browser, and a browser that opens its pages."""

import sys
from pathlib import Path

import pytest
import small_site
import testbed

ROOT = Path(__file__).parents[2]
sys.path.append(str(ROOT / "tests" / "browser"))
from laboratory import Absent, chromium  # noqa: E402

PATIENCE_MS = 200_000  # a limit for what hangs; a machine may be busy


@pytest.fixture(scope="session")
def site(tmp_path_factory):
    """The address of the small site."""
    bed = testbed.find()
    if bed is None:
        pytest.skip(f"no test bed: see tests/wasm/testbed.py, and set {testbed.VARIABLE}")
    html = small_site.write(tmp_path_factory.mktemp("small_site"), bed / "pyodide")
    with small_site.serve(html) as address:
        yield address


@pytest.fixture
def open_page(site):
    """A function that opens a page of the site in a new browser, which keeps its requests and errors."""
    try:
        with chromium("chromium-headless-shell", "chromium") as browser:
            context = browser.new_context(viewport={"width": 1280, "height": 900})
            context.set_default_timeout(PATIENCE_MS)

            def open_in_tab(path):
                page = context.new_page()
                page.requests = []
                page.problems = []
                context.on("request", lambda request: page.requests.append(request.url))
                page.on("pageerror", lambda error: page.problems.append(str(error)))
                page.goto(f"{site}/{path}")
                return page

            yield open_in_tab
    except Absent as reason:
        pytest.skip(str(reason))
