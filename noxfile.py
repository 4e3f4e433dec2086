"""The tests by name: `nox -l` lists them, `nox -s grading` runs one tier, `nox` the quick one.

Each makes an environment of its own; `nox --no-venv` takes the one at hand.
tests/tiers.py says which test is where.
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
# in these tiers a dear fixture is made once: the tests of a module, or of a class in it, stay with
# one worker (in a browser they need not: what is dear there, the site, is one for all workers)
TOGETHER = ("notebooks", "jupyterlab", "grading", "papers", "scenes", "wheel")


def test(session: nox.Session, tier: str, *options: str, under: Sequence[str] = ()) -> None:  # noqa: PT028
    """Run the tests of a tier, `under` a module that watches; what stands behind -- goes to pytest."""
    if session.virtualenv.is_sandboxed:
        session.install("--editable", f".[{EXTRAS.get(session.name, 'test')}]")
    if tier in TOGETHER:
        options = (*options, "--dist=loadscope", "--no-loadscope-reorder")
    if results := os.environ.get("HDRLAB_RESULTS"):
        options = (*options, f"--junitxml={results}/{tier}.xml")
    session.run("python", *under, "-m", "pytest", f"--tier={tier}", *options, *session.posargs)


for tier in TIERS:
    nox.session(lambda session, tier=tier: test(session, tier), name=tier)


@nox.session
def coverage(session: nox.Session) -> None:
    """Run the quick tier, and print which branches of hdrlab it takes, file by file, and in all.

    By slipcover, which stops watching what was seen: coverage.py takes half as long again. Its own
    module is loaded before pytest can rewrite asserts in it, and it reads none of the tests: it
    warns of both.
    """
    watched = (
        "-m",
        "slipcover",
        "--branch",
        "--source",
        "hdrlab",
        "--skip-covered",
        "--dont-wrap-pytest",
    )
    unheard = (
        "-Wignore:Module already imported",
        "-Wignore:Unable to activate pytest:RuntimeWarning",
    )
    test(session, QUICK, *unheard, under=watched)


@nox.session(venv_backend="uv")
def lowest(session: nox.Session) -> None:
    """Run the quick tier with the lowest versions that pyproject.toml names, whose warnings are let be."""
    session.install("--resolution=lowest-direct", "--editable", ".[test]")
    session.run("python", "-m", "pytest", "-W", "default", *session.posargs)
