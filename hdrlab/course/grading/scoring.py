"""One mistake costs once: a task's points among its promises, and the failures that follow from another.

root     the failure that the others of its task follow from: the first where a well-known mistake is named,
         the promise that another one `needs`, or the first call that was too late, or ended in the
         same words
once     whether one well-known mistake explains all that was answered, and is not what the task is about: it
         costs half of the task's points at most

There is one rule of rounding: a promise is worth whole or half points, and so is what a mistake
costs.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import floor

from hdrlab.course.grading.results import Check


def split_points(points: Fraction, weights: Sequence[Fraction]) -> list[Fraction]:
    """Split points by weights into whole and half points whose sum is the points.

    The halves that are left over go to the largest remainders, and what is less than a half to the
    largest share.

    Examples
    --------
    >>> [float(one) for one in split_points(Fraction(10), [Fraction(n) for n in (1, 4, 3, 3)])]
    [1.0, 3.5, 3.0, 2.5]
    """
    total_weight = sum(weights) or 1
    exact_halves = [2 * points * weight / total_weight for weight in weights]
    whole_halves = [floor(halves) for halves in exact_halves]
    by_remainder = sorted(
        range(len(weights)), key=lambda k: whole_halves[k] - exact_halves[k]
    )  # the largest remainder first
    left_over = floor(2 * points) - sum(whole_halves)
    for k in by_remainder[:left_over]:
        whole_halves[k] += 1
    shares = [Fraction(halves, 2) for halves in whole_halves]
    shares[shares.index(max(shares))] += points - sum(shares)
    return shares


def attribute_failures(
    checks: Sequence[Check], needs: Mapping[str, str], *, named: bool = False, once: bool = False
) -> list[Check]:
    """Return a task's checks with what they earn, and what each failure follows from.

    Parameters
    ----------
    checks : of one task, each with its max_points and its outcome
    needs : name of a check -> name of the one about the substance without which it earns nothing
    named : whether a well-known mistake explains the answers
    once : whether that one costs half at most
    """
    broken = {one.name: one for one in checks if one.outcome != "holds" and not one.hidden}
    left = Fraction(floor(sum(one.max_points for one in checks)), 2) if once else None
    found = []
    for check in checks:
        missing = broken.get(needs.get(check.name, "")) if not once else None
        lost = check.max_points if check.outcome != "holds" or missing else Fraction()
        if left is not None:
            lost = min(lost, left)
            left -= lost
        if check.name in broken and not check.hidden:
            root = next(iter(broken.values())) if named else _root(check, broken, needs)
            check = replace(check, follows="" if root.name == check.name else root.promise)
        elif check.outcome == "holds" and missing:
            says = f"This check passes, but it only earns points if this one passes, too: {missing.promise}"
            check = replace(check, message=says)
        found.append(replace(check, points=check.max_points - lost))
    return found


def _root(check: Check, broken: Mapping[str, Check], needs: Mapping[str, str]) -> Check:
    """Return the failure that a failure follows from, or the failure itself."""
    needed = needs.get(check.name, "")
    if needed in broken:
        return _root(broken[needed], broken, needs)
    for failure in broken.values():
        if failure.name == check.name or _ends_alike(failure, check):
            return failure
    return check


def _ends_alike(check: Check, other: Check) -> bool:
    """Return whether two checks had no answer for the same reason."""
    if not check.kind or check.kind != other.kind:
        return False
    return check.kind == "late" or check.message == other.message
