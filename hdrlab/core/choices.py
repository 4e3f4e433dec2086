"""Check an option against the values that it may have."""

from collections.abc import Iterable

from hdrlab.errors import InputError


def require_choice(name: str, value: object, choices: Iterable[str]) -> None:
    """Raise an InputError unless `value` is one of `choices`; the message lists them.

    Examples
    --------
    >>> require_choice("weight", "hat", ["hat", "gaussian"])
    >>> require_choice("weight", "heavy", ["hat", "gaussian"])
    Traceback (most recent call last):
    hdrlab.errors.InputError: weight must be one of hat, gaussian; got 'heavy'
    """
    choices = tuple(choices)
    if value not in choices:
        raise InputError(f"{name} must be one of {', '.join(choices)}; got {value!r}")
