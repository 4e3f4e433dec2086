"""Find out which sandbox tiers this machine can run, and what the others need.

hdrlab tries each tier: it starts the tier's sandbox and runs a function in it that tries, harmlessly,
to break out. The function calls the C library directly, which Python's own checks cannot stop, to read
a file of hdrlab, start a process, create a socket, and write a file. A tier for credit works if all
of this fails.
"""

import contextlib
import time
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.sandbox import in_process, practice, tiers
from hdrlab.course.sandbox.session import Unavailable

# a sandbox that does not start may have been killed by something else
MAX_ATTEMPTS = 3
BREAK_OUT_SOURCE = Path(__file__).with_name("break_out.py").read_text("utf8")
READY_SOURCE = "def ready(): return True"
REMEDIES: dict[str, Any] = tomllib.loads(
    Path(__file__).with_name("remedies.toml").read_text("utf8")
)
# files that Docker and Podman put into a container
CONTAINER_MARKS = ("/.dockerenv", "/run/.containerenv")
PROBE_FILE = b"/tmp/hdrlab-doctor"


@dataclass(frozen=True, kw_only=True)
class TierReport:
    """What hdrlab found out about a sandbox tier.

    Attributes
    ----------
    tier : "strict", "container" or "practice"
    works : whether the tier starts, and its sandbox holds
    credit : whether scores from this tier may count
    details : how long it took to start, or what is missing
    remedy : what to do if it does not work, or ""
    """

    tier: str
    works: bool
    credit: bool
    details: str
    remedy: str = ""


def examine_tiers() -> list[TierReport]:
    """Try each tier that grades submissions on this machine, the strictest first.

    Examples
    --------
    >>> [report.tier for report in examine_tiers()]
    ['strict', 'container', 'practice']
    """
    return [examine(tier) for tier in tiers.TIERS if tier != in_process.TIER]


def examine(tier: str) -> TierReport:
    """Try a tier on this machine."""
    credit = tier != "practice"
    try:
        possible_actions, seconds = _try_repeatedly(tier)
    except (Unavailable, NoAnswer, OSError) as error:
        reason = str(error)
        return TierReport(
            tier=tier, works=False, credit=credit, details=reason, remedy=find_remedy(reason)
        )
    start = f"started in {seconds:.2f} s"
    if not credit:
        not_stopped = "; ".join(practice.DOES_NOT_STOP)
        details = f"{start}. It does not stop: {not_stopped}"
        return TierReport(tier=tier, works=True, credit=False, details=details)
    if possible_actions:
        return TierReport(
            tier=tier,
            works=False,
            credit=True,
            details=f"it started, but {' and '.join(possible_actions)}",
            remedy="do not grade on this machine, and please report this",
        )
    return TierReport(tier=tier, works=True, credit=True, details=f"{start}, and nothing got out")


def _try_repeatedly(tier: str) -> tuple[list[str], float]:
    """Try a tier up to MAX_ATTEMPTS times; return what `_try_once` returns at its first success."""
    for _ in range(MAX_ATTEMPTS - 1):
        with contextlib.suppress(Unavailable, NoAnswer):
            return _try_once(tier)
    return _try_once(tier)


def _try_once(tier: str) -> tuple[list[str], float]:
    """Return the forbidden things that were possible, and the seconds until the first answer."""
    secret = bytes(Path(__file__).resolve())
    started = time.perf_counter()
    sources = {"ready": READY_SOURCE, "break_out": BREAK_OUT_SOURCE}
    with Subject(sources, tiers.choose(tier)) as subject:
        subject.ready()
        seconds = time.perf_counter() - started
        if tier == "practice":
            return [], seconds
        return subject.break_out(secret, PROBE_FILE), seconds


def find_remedy(reason: str) -> str:
    """Return what to do about a tier that does not work, or "" if hdrlab does not know.

    Parameters
    ----------
    reason : str
        Why the tier does not work. The settings of this system are looked up, too.

    Examples
    --------
    >>> find_remedy("the strict tier needs bubblewrap, and there is no bwrap on the path").partition(" (")[0]
    'install bubblewrap 0.8 or later'
    """
    first_line = reason.partition("\n")[0]
    if "did not start" not in reason:
        for word, advice in REMEDIES["install"].items():
            if word in first_line:
                return str(advice)
    # the other tiers need no namespaces
    if "strict" not in reason:
        return ""
    for setting in REMEDIES["kernel_settings"]:
        file = Path("/proc/sys") / setting["file"]
        if file.is_file() and file.read_text().strip() == setting["blocking_value"]:
            return str(setting["help"])
    if any(Path(mark).exists() for mark in CONTAINER_MARKS):
        return "namespaces rarely nest in containers: use the container tier, as root"
    return ""
