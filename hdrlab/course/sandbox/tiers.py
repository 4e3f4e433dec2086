"""Choose a sandbox tier. There is no fallback: if this machine cannot run the tier, that is an error."""

from hdrlab.course.sandbox import container, in_process, practice, strict
from hdrlab.course.sandbox.session import Sandbox, Unavailable
from hdrlab.errors import InputError

__all__ = ["TIERS", "Unavailable", "choose"]

TIERS = {
    "strict": strict.sandbox,
    "container": container.sandbox,
    "practice": practice.sandbox,
    in_process.TIER: in_process.sandbox,
}


def choose(tier: str) -> Sandbox:
    """Return the sandbox of a tier: "strict", "container", "practice" or "in-process".

    Raises
    ------
    Unavailable
        If this machine cannot run the tier. No other tier takes its place.
    InputError
        If there is no such tier.

    Examples
    --------
    >>> choose("practice").credit
    False
    """
    if tier not in TIERS:
        raise InputError(f"expected one of the tiers {', '.join(TIERS)}, got {tier!r}")
    if in_process.IS_BROWSER and tier != in_process.TIER:
        raise Unavailable(
            f"the {tier} tier needs processes, which a page in a browser does not have"
        )
    return TIERS[tier]()
