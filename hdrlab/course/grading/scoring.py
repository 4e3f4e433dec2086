"""One mistake costs once: a task's points among its promises, and the failures that follow from another.

broken   a check that does not hold for the solution either: it costs nothing
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

# outcomes that cost no points
COSTLESS_OUTCOMES = ("holds", "broken")


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
    # the largest remainder first
    by_remainder = sorted(range(len(weights)), key=lambda k: whole_halves[k] - exact_halves[k])
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
    needs : name of a check -> name of the main check; without that one, the check earns nothing
    named : whether a known mistake explains the failures
    once : whether that mistake costs at most half of the points
    """
    failures = {
        check.name: check
        for check in checks
        if check.outcome not in COSTLESS_OUTCOMES and not check.hidden
    }
    max_loss = None
    if once:
        max_loss = Fraction(floor(sum(check.max_points for check in checks)), 2)
    attributed = []
    for check in checks:
        missing = None if once else failures.get(needs.get(check.name, ""))
        lost = Fraction()
        if check.outcome not in COSTLESS_OUTCOMES or missing:
            lost = check.max_points
        if max_loss is not None:
            lost = min(lost, max_loss)
            max_loss -= lost
        if check.name in failures and not check.hidden:
            root = next(iter(failures.values())) if named else _root(check, failures, needs)
            check = replace(check, follows="" if root.name == check.name else root.promise)
        elif check.outcome == "holds" and missing:
            message = (
                "This check passes, but it only earns points if this one passes, too: "
                f"{missing.promise}"
            )
            check = replace(check, message=message)
        attributed.append(replace(check, points=check.max_points - lost))
    return attributed


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
