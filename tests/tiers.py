"""The tiers of tests: `python -m pytest` runs the quick one, `--tier=papers` another, `--tier=all` all.

A test belongs to the tier of its nearest marker: `@pytest.mark.papers` on the test, on its class, or
`pytestmark` of its file. A test without a marker belongs to the quick tier and takes about a second
at most.
"""

import re
from functools import cache
from pathlib import Path

QUICK = "quick"
ALL = "all"
TIERS = {
    QUICK: "units, laws, the specification, the handouts, the sandbox and one assignment in it",
    "notebooks": "every notebook, executed once, and the site that contains them",
    "browser": "JupyterLab on three notebooks, the site and the gallery in Chromium",
    "jupyterlab": "the other notebooks in JupyterLab; .ci/run runs it on request only",
    "grading": "attacks, killed runs, clusters, whole classes, similarity, points of tasks",
    "papers": "published experiments, real brackets, films, tethered cameras, 12 megapixels",
    "scenes": "the embedded scenes, rendered and computed from their models",
    "wasm": "notebooks and checks in WebAssembly, as a browser runs them; needs a test bed",
    "wheel": "the wheel in an empty environment, and side effects of importing hdrlab",
}
# Files with long tests start first, in this order; otherwise one worker would run them while the
# others have nothing left to do.
LONG_FILES = (
    "tests/course/test_site.py",
    "tests/browser/test_site_in_a_browser.py",
    "tests/course/test_killed.py",
    "tests/cli/test_disturbed_commands.py",
    "tests/course/test_toy.py",
    "tests/course/test_viva.py",
    "tests/course/test_regrade.py",
    "tests/course/test_variants.py",
    "tests/course/test_exports.py",
    "tests/course/test_hostile_class.py",
    "tests/course/test_attacks_class.py",
    "tests/course/test_cluster.py",
    "tests/course/test_traps_in_a_class.py",
    "tests/course/test_windows.py",
    "tests/course/test_hostile_code.py",
    "tests/course/test_fairness.py",
    "tests/course/test_misconceptions.py",
    "tests/course/test_gaming.py",
    "tests/test_papers.py",
    "tests/pipeline/test_pipeline.py",
    "tests/pipeline/test_real_brackets.py",
    "tests/diagnostics/test_times_estimate.py",
    "tests/cli/test_faults.py",
)
FILE_MARK = re.compile(r"^pytestmark = \[?\s*pytest\.mark\.(\w+)", re.MULTILINE)


def start_order(address: str) -> int:
    """Return the sort key of a test by its address: files with long tests come first."""
    file = address.partition("::")[0]
    return LONG_FILES.index(file) if file in LONG_FILES else len(LONG_FILES)


def tier_of(item) -> str:
    """Return the tier of a collected test: that of its nearest marker."""
    names = (marker.name for marker in item.iter_markers())
    return next((name for name in names if name in TIERS), QUICK)


@cache
def may_hold(path: Path, tier: str) -> bool:
    """Return whether a file can hold tests of a tier, so that pytest need not import the others."""
    if tier == ALL or path.is_dir() or not path.name.startswith("test_"):
        return True
    text = path.read_text(encoding="utf8")
    mark = FILE_MARK.search(text)
    file_tier = mark[1] if mark and mark[1] in TIERS else QUICK
    return file_tier == tier or f"mark.{tier}" in text
