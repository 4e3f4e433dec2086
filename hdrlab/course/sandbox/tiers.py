"""Choose a sandbox tier. There is no fallback: if this machine cannot run the tier, that is an error."""

from hdrlab.course.sandbox import container, practice, strict
from hdrlab.course.sandbox.session import Sandbox, Unavailable
from hdrlab.errors import InputError

__all__ = ["TIERS", "Unavailable", "choose"]

TIERS = {"strict": strict.sandbox, "container": container.sandbox, "practice": practice.sandbox}


def choose(tier: str) -> Sandbox:
    """Return the sandbox of a tier: "strict", "container" or "practice".

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
    return TIERS[tier]()
