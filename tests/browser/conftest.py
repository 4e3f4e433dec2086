"""Fixtures of `laboratory`: a browser, a page that records errors and requests, a JupyterLab, and
axe-core.
"""

from collections.abc import Callable, Iterator
from importlib.resources import files
from typing import Any

import pytest
from laboratory import PATIENCE, Absent, Lab, chromium, jupyterlab

# What is right stays in the page: sent, it takes longer than to be found. Nothing is asked of code
# that looks like some above it: its words are most of a page, and each has one of a few colours.
RUN = """async (part) => {
    const seen = new Set();
    for (const code of document.querySelectorAll("pre")) {
        const itself = [code.checkVisibility(), code.scrollWidth > code.clientWidth, code.tabIndex];
        const looks = [code, ...code.querySelectorAll("*")].map((word) => {
            const { color, backgroundColor, fontWeight, fontSize } = getComputedStyle(word);
            return [...itself, word.tagName, color, backgroundColor, fontWeight, fontSize].join();
        });
        code.classList.toggle("as-before", looks.every((look) => seen.has(look)));
        looks.forEach((look) => seen.add(look));
    }
    const context = typeof part === "string" ? { include: [part] } : part;
    const exclude = [...(context.exclude ?? []), ".as-before"];
    const options = { preload: false, resultTypes: ["violations"] };
    return (await axe.run({ ...context, exclude }, options)).violations;
}"""


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """The headless Chromium shows the same pages in less than half of the processor time."""
    try:
        with chromium("chromium-headless-shell", "chromium") as started:
            yield started
    except Absent as reason:
        pytest.skip(str(reason))


@pytest.fixture
def page(browser: Any) -> Iterator[Any]:
    """A page at 1280 px that keeps its console errors in `problems` and its requests in `requests`."""
    context = browser.new_context(viewport={"width": 1280, "height": 900}, has_touch=True)
    context.set_default_timeout(PATIENCE)
    page = context.new_page()
    page.problems = []
    page.requests = []
    page.on("pageerror", lambda error: page.problems.append(str(error)))
    page.on(
        "console",
        lambda m: page.problems.append(f"{m.text} {m.location}") if m.type == "error" else None,
    )
    page.on("request", lambda request: page.requests.append(request.url))
    yield page
    context.close()


@pytest.fixture(scope="session")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    """One JupyterLab for each worker."""
    try:
        with jupyterlab(tmp_path_factory.mktemp("lab")) as started:
            yield started
    except Absent as reason:
        pytest.skip(str(reason))


@pytest.fixture(scope="session")
def axe() -> Callable[..., list[str]]:
    """Return a function that lists the violations axe-core finds in a part of a page, or in a context."""
    carrier = pytest.importorskip("axe_playwright_python", reason="axe-core is not installed")
    script = (files(carrier) / "axe.min.js").read_text(encoding="utf8")

    def violations(page: Any, part: str | dict[str, list[str]]) -> list[str]:
        page.evaluate(script)
        report = page.evaluate(RUN, part)
        return [
            f"{violation['id']}: {node['html'][:200]}"
            for violation in report
            for node in violation["nodes"]
        ]

    return violations
