"""Run the tiers of tests: `nox -l` lists them, `nox -s grading` runs one tier, `nox` the quick tier.

Each session creates its own environment; `nox --no-venv` uses the active one. tests/tiers.py describes
the tiers.
"""

import os
import sys
from collections.abc import Sequence
from pathlib import Path

import nox

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "tests"))
from tiers import QUICK, TIERS  # noqa: E402

nox.options.sessions = [QUICK]
EXTRAS = {"scenes": "test,scenes", "papers": "test,bench", "coverage": "test,cover"}
# In these tiers, all tests of a module or class run in the same worker, so that slow fixtures are made
# only once. The tier "browser" does not need it: all workers share its slowest fixture, the site.
TIERS_BY_MODULE = ("notebooks", "jupyterlab", "grading", "papers", "scenes", "wheel")


def test(session: nox.Session, tier: str, *options: str, under: Sequence[str] = ()) -> None:  # noqa: PT028
    """Run the tests of a tier.

    Parameters
    ----------
    tier : see tests/tiers.py
    options : options of pytest; the words after -- on nox's command line are added
    under : options of Python that run pytest inside another module, such as a coverage tool
    """
    if session.virtualenv.is_sandboxed:
        session.install("--editable", f".[{EXTRAS.get(session.name, 'test')}]")
    if tier in TIERS_BY_MODULE:
        options = (*options, "--dist=loadscope", "--no-loadscope-reorder")
    if results := os.environ.get("HDRLAB_RESULTS"):
        options = (*options, f"--junitxml={results}/{tier}.xml")
    session.run("python", *under, "-m", "pytest", f"--tier={tier}", *options, *session.posargs)


for tier in TIERS:
    nox.session(lambda session, tier=tier: test(session, tier), name=tier)


@nox.session
def coverage(session: nox.Session) -> None:
    """Run the quick tier and print which branches of hdrlab it covers, for each file and in total.

    slipcover stops observing code that it has seen; coverage.py would take half as long again.
    """
    slipcover = (
        "-m",
        "slipcover",
        "--branch",
        "--source",
        "hdrlab",
        "--skip-covered",
        "--dont-wrap-pytest",
    )
    # slipcover is imported before pytest can rewrite its asserts, and it does not observe the tests
    ignored_warnings = (
        "-Wignore:Module already imported",
        "-Wignore:Unable to activate pytest:RuntimeWarning",
    )
    test(session, QUICK, *ignored_warnings, under=slipcover)


@nox.session(venv_backend="uv")
def lowest(session: nox.Session) -> None:
    """Run the quick tier with the lowest versions that pyproject.toml allows; warnings are not errors."""
    session.install("--resolution=lowest-direct", "--editable", ".[test]")
    session.run("python", "-m", "pytest", "-W", "default", *session.posargs)
