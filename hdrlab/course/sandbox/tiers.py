"""Which tier a machine can give. It fails closed: a tier that was asked for and cannot be had is an error."""

from hdrlab.course.sandbox import container, practice, strict
from hdrlab.course.sandbox.running import Sandbox, Unavailable
from hdrlab.errors import InputError

__all__ = ["TIERS", "Unavailable", "choose"]

TIERS = {"strict": strict.sandbox, "container": container.sandbox, "practice": practice.sandbox}


def choose(tier: str) -> Sandbox:
    """Return the sandbox of a tier: "strict", "container" or "practice".

    Raises
    ------
    Unavailable
        Where this machine cannot give it, with the reason. No other tier is put in its place.
    ValueError
        For a tier that there is not.

    Examples
    --------
    >>> choose("practice").credit
    False
    """
    if tier not in TIERS:
        raise InputError(f"expected one of the tiers {', '.join(TIERS)}, got {tier!r}")
    return TIERS[tier]()
