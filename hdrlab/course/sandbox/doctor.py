"""What this machine can give: each tier is tried, and what is missing is said, with what would help.

A trial starts the sandbox and asks a function in it to break out, harmlessly, past Python's own
refusals: to read a file of hdrlab, to start a process, to make a socket and a file. A tier for
credit works if all of it fails.
"""

import time
import tomllib
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.sandbox import practice, running, tiers

TRIES = 3  # of a tier that does not start: somebody may have ended it
BREAK_OUT = Path(__file__).with_name("break_out.txt").read_text("utf8")  # a function that tries
REMEDIES: dict[str, Any] = tomllib.loads(
    Path(__file__).with_name("remedies.toml").read_text("utf8")
)


class Finding(NamedTuple):
    """What was found of a tier.

    Attributes
    ----------
    tier : "strict", "container" or "practice"
    works : whether it can be had, and holds
    credit : whether what is scored in it may count
    says : how long its start took, or what is missing
    remedy : what would help, or nothing
    """

    tier: str
    works: bool
    credit: bool
    says: str
    remedy: str


def report() -> list[Finding]:
    """Return what each tier can give on this machine, the strictest first.

    Examples
    --------
    >>> [finding.tier for finding in report()]
    ['strict', 'container', 'practice']
    """
    return [examine(tier) for tier in tiers.TIERS]


def examine(tier: str) -> Finding:
    """Return what was found of a tier when it was tried."""
    credit = tier != "practice"
    try:
        broken, start = _tried(tier)
    except (running.Unavailable, NoAnswer, OSError) as error:
        return Finding(tier, False, credit, str(error), remedy(str(error)))
    if not credit:
        stops = "; ".join(practice.DOES_NOT_STOP)
        return Finding(
            tier, True, False, f"started in {start:.2f} s. It does not stop: {stops}", ""
        )
    if broken:
        says = f"it started, but {' and '.join(broken)}"
        return Finding(
            tier, False, True, says, "do not grade on this machine, and please report this"
        )
    return Finding(tier, True, True, f"started in {start:.2f} s, and nothing got out", "")


def _tried(tier: str) -> tuple[list[str], float]:
    """Return what `_trial` does; it fails where no answer comes again and again."""
    for _ in range(TRIES - 1):
        with suppress(running.Unavailable, NoAnswer):
            return _trial(tier)
    return _trial(tier)


def _trial(tier: str) -> tuple[list[str], float]:
    """Return what could be done from inside that should not be, and the seconds until the first answer."""
    secret, target = bytes(Path(__file__).resolve()), b"/tmp/hdrlab-doctor"
    began, sources = time.perf_counter(), {"ready": "def ready(): return True", "tried": BREAK_OUT}
    with Subject(sources, tiers.choose(tier)) as subject:
        subject.ready()
        start = time.perf_counter() - began
        return (subject.tried(secret, target) if tier != "practice" else []), start


def remedy(reason: str) -> str:
    """Return what would help, as far as the reason and the system's switches tell.

    Examples
    --------
    >>> remedy("the strict tier needs bubblewrap, and there is no bwrap on the path").partition(" (")[0]
    'install bubblewrap 0.8 or later'
    """
    known = [
        help for word, help in REMEDIES["install"].items() if word in reason.partition("\n")[0]
    ]
    if known and "did not start" not in reason:
        return known[0]
    if "strict" not in reason:  # the others need no namespaces
        return ""
    for switch in REMEDIES["switches"]:
        file = Path("/proc/sys") / switch["file"]
        if file.is_file() and file.read_text().strip() == switch["keeps"]:
            return str(switch["help"])
    if any(Path(mark).exists() for mark in ("/.dockerenv", "/run/.containerenv")):
        return "namespaces rarely nest in containers: use the container tier, as root"
    return ""
