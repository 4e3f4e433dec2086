"""Find out which sandbox tiers this machine can run, and what the others need.

Each tier is tried: its sandbox is started, and a function in it tries to break out, harmlessly, by
calls past Python's own checks: it tries to read a file of hdrlab, to start a process, and to make a
socket and a file. A tier for credit works if all of this fails.
"""

import contextlib
import time
import tomllib
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.sandbox import practice, tiers
from hdrlab.course.sandbox.session import Unavailable

MAX_ATTEMPTS = 3  # a sandbox that does not start may have been killed by something else
BREAK_OUT_SOURCE = Path(__file__).with_name("break_out.py").read_text("utf8")
READY_SOURCE = "def ready(): return True"
REMEDIES: dict[str, Any] = tomllib.loads(
    Path(__file__).with_name("remedies.toml").read_text("utf8")
)
CONTAINER_MARKS = ("/.dockerenv", "/run/.containerenv")


class Finding(NamedTuple):
    """What was found out about a tier.

    Attributes
    ----------
    tier : "strict", "container" or "practice"
    works : whether it starts, and nothing gets out of it
    credit : whether its scores may count
    says : how long it took to start, or what is missing
    remedy : what would help, or ""
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
    """Try a tier, and return what was found out."""
    for_credit = tier != "practice"
    try:
        possible, seconds = _try_repeatedly(tier)
    except (Unavailable, NoAnswer, OSError) as error:
        reason = str(error)
        return Finding(tier, False, for_credit, reason, remedy(reason))
    if not for_credit:
        not_stopped = "; ".join(practice.DOES_NOT_STOP)
        says = f"started in {seconds:.2f} s. It does not stop: {not_stopped}"
        return Finding(tier, True, False, says, "")
    if possible:
        says = f"it started, but {' and '.join(possible)}"
        advice = "do not grade on this machine, and please report this"
        return Finding(tier, False, True, says, advice)
    says = f"started in {seconds:.2f} s, and nothing got out"
    return Finding(tier, True, True, says, "")


def _try_repeatedly(tier: str) -> tuple[list[str], float]:
    """Return what `_try_once` returns; it fails if every attempt fails."""
    for _ in range(MAX_ATTEMPTS - 1):
        with contextlib.suppress(Unavailable, NoAnswer):
            return _try_once(tier)
    return _try_once(tier)


def _try_once(tier: str) -> tuple[list[str], float]:
    """Return the forbidden things that were possible, and the seconds until the first answer."""
    secret = bytes(Path(__file__).resolve())
    target = b"/tmp/hdrlab-doctor"
    started = time.perf_counter()
    sources = {"ready": READY_SOURCE, "break_out": BREAK_OUT_SOURCE}
    with Subject(sources, tiers.choose(tier)) as subject:
        subject.ready()
        seconds = time.perf_counter() - started
        if tier == "practice":
            return [], seconds
        return subject.break_out(secret, target), seconds


def remedy(reason: str) -> str:
    """Return what would help, as far as the reason and the system's switches tell.

    Examples
    --------
    >>> remedy("the strict tier needs bubblewrap, and there is no bwrap on the path").partition(" (")[0]
    'install bubblewrap 0.8 or later'
    """
    first_line = reason.partition("\n")[0]
    if "did not start" not in reason:
        for word, advice in REMEDIES["install"].items():
            if word in first_line:
                return str(advice)
    if "strict" not in reason:  # the others need no namespaces
        return ""
    for switch in REMEDIES["switches"]:
        file = Path("/proc/sys") / switch["file"]
        if file.is_file() and file.read_text().strip() == switch["keeps"]:
            return str(switch["help"])
    if any(Path(mark).exists() for mark in CONTAINER_MARKS):
        return "namespaces rarely nest in containers: use the container tier, as root"
    return ""
