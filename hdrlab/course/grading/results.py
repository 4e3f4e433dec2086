"""What checking a submission comes to: promise by promise, and as JSON, which is the source of all reports.

The JSON of one submission under the same checks is the same to the byte: no times of day, no
durations.
"""

import base64
import json
from fractions import Fraction
from typing import Any, Literal, NamedTuple

from hdrlab.errors import InputError

VERSION = 1
CREDIT = ("strict", "container")  # tiers that count
DERIVED = ("for_credit", "score", "max_score")  # what the JSON says beside a Result's fields
# what a team's copy holds, and nothing else: of the whole, of a check, of a hidden one
TEAM_SEES = (
    *(
        "version",
        "student",
        "homework",
        "title",
        "tier",
        "for_credit",
        "score",
        "max_score",
        "problems",
    ),
    *("misconceptions", "checks", "submission", "specification", "seed", "versions"),
)
OF_HIDDEN = ("task", "promise", "points", "max_points", "outcome", "hidden")
OF_OWN = (*OF_HIDDEN, "name", "message", "hints", "drawing", "said", "follows")
Outcome = Literal["holds", "fails", "no answer"]


class Drawing(NamedTuple):
    """Pictures of a difference: bytes of WebP, what they show in words, and what stands below them."""

    frames: tuple[bytes, ...] = ()
    alts: tuple[str, ...] = ()
    captions: tuple[str, ...] = ()


class Check(NamedTuple):
    """One promise of a task, and whether it holds.

    Attributes
    ----------
    task : id of the task
    name : of the test function
    promise : the same in words
    points, max_points : earned, and to be earned
    outcome : "holds", "fails", or "no answer" where the function raised, took too long or is
        missing
    message : why not, in words
    hints : from vague to plain
    drawing : expected, came, difference
    said : what the function printed meanwhile
    hidden : whether it is one of the instructor's own, of which a student sees the outcome alone
    kind : of no answer: "missing", "raised", "late", "died", "refused", "damaged", or "killed" from
        outside
    follows : of a failure that follows from another one of its task: the promise that failed there
    """

    task: str
    name: str
    promise: str
    points: Fraction
    max_points: Fraction
    outcome: Outcome
    message: str = ""
    hints: tuple[str, ...] = ()
    drawing: Drawing = Drawing()
    said: str = ""
    hidden: bool = False
    kind: str = ""
    follows: str = ""


class Result(NamedTuple):
    """A submission's checks, in the order of the homework, and what one must know to run them again."""

    student: str
    homework: str
    title: str
    tier: str
    checks: tuple[Check, ...]
    misconceptions: dict[str, str]
    problems: tuple[str, ...]
    submission: str
    specification: str
    seed: str
    versions: dict[str, str]
    at_most: float | None = None

    @property
    def score(self) -> float:
        """Points earned, of which no more count than the sheet is worth."""
        return self._counted(points(self.checks)[0])

    @property
    def max_score(self) -> float:
        """Points to be earned."""
        return self._counted(points(self.checks)[1])

    def _counted(self, earned: float) -> float:
        return earned if self.at_most is None else min(earned, self.at_most)

    @property
    def why_practice(self) -> str:
        """Why the score is not for credit, in a sentence, or ""."""
        if self.tier not in CREDIT:
            return "Your submission ran without a sandbox, so this score is not for credit."
        if not self.seed:
            return "The inputs were drawn without a secret, so this score is not for credit."
        return ""

    @property
    def for_credit(self) -> bool:
        """Whether the tier keeps a hostile submission from its own score, and the inputs were not public."""
        return not self.why_practice

    def of(self, task: str) -> tuple[Check, ...]:
        """Return the checks of one task."""
        return tuple(one for one in self.checks if one.task == task)

    @property
    def tasks(self) -> tuple[str, ...]:
        """The ids of the tasks, in order."""
        return tuple(dict.fromkeys(one.task for one in self.checks))


def points(checks: tuple[Check, ...]) -> tuple[float, float]:
    """Return what some checks earned, and what they could."""
    earned = sum((one.points for one in checks), Fraction())
    return _number(earned), _number(sum((one.max_points for one in checks), Fraction()))


def _number(value: Fraction) -> float:
    return round(float(value), 4)


def to_json(result: Result) -> bytes:
    """Return a Result as JSON: the score, the tier and every check; pictures as base64.

    Examples
    --------
    >>> result = Result("ada", "hw2", "The response curve", "strict", (), {}, (), "", "", "", {})
    >>> from_json(to_json(result)) == result
    True
    """
    whole = {
        "version": VERSION,
        **result._asdict(),
        **{name: getattr(result, name) for name in DERIVED},
    }
    whole["checks"] = [_check_to_json(one) for one in result.checks]
    return (json.dumps(whole, indent=1, ensure_ascii=True) + "\n").encode()


def for_team(data: bytes) -> bytes:
    """Return what a team may see of a Result's JSON: of hidden checks the promise and the points alone."""
    whole = json.loads(data)
    shown = {name: whole[name] for name in TEAM_SEES}
    shown["checks"] = [
        {name: one[name] for name in (OF_HIDDEN if one["hidden"] else OF_OWN)}
        for one in whole["checks"]
    ]
    return (json.dumps(shown, indent=1, ensure_ascii=True) + "\n").encode()


def _check_to_json(check: Check) -> dict[str, Any]:
    return {
        **check._asdict(),
        "points": _number(check.points),
        "max_points": _number(check.max_points),
        "exact": {"points": str(check.points), "max_points": str(check.max_points)},
        "drawing": drawing_to_json(check.drawing),
    }


def drawing_to_json(drawing: Drawing) -> list[dict[str, str]]:
    """Return pictures as JSON holds them."""
    texts = [base64.b64encode(frame).decode() for frame in drawing.frames]
    each = zip(texts, drawing.alts, drawing.captions, strict=True)
    return [{"webp": text, "alt": alt, "caption": caption} for text, alt, caption in each]


def drawing_from_json(read: list[dict[str, str]]) -> Drawing:
    """Return the pictures that `drawing_to_json` wrote."""
    frames = tuple(base64.b64decode(one["webp"]) for one in read)
    return Drawing(frames, tuple(one["alt"] for one in read), tuple(one["caption"] for one in read))


def from_json(data: bytes) -> Result:
    """Return the Result that `to_json` wrote.

    Raises
    ------
    ValueError
        For anything else, and for a version of another hdrlab.
    """
    try:
        read = json.loads(data)
    except (RecursionError, ValueError):
        read = None
    if not isinstance(read, dict) or read.get("version") != VERSION:
        raise InputError(f"expected a result of version {VERSION}, written by hdrlab grade")
    try:
        checks = tuple(_check_from_json(one) for one in read["checks"])
        early = {"at_most": None}  # which a result of an early version lacks
        rest = early | {name: read[name] for name in Result._fields if name in read}
        rest |= {"checks": checks, "problems": tuple(read["problems"])}
        return Result(**rest)
    except (KeyError, TypeError, ValueError, ArithmeticError, AttributeError) as error:
        raise InputError(
            f"expected a result written by hdrlab grade, {error!r:.200} is wrong"
        ) from None


def _check_from_json(read: dict[str, Any]) -> Check:
    early = {"kind": "", "follows": ""}  # which a result of an early version lacks
    own = early | {name: read[name] for name in Check._fields if name not in early or name in read}
    own |= {name: Fraction(read["exact"][name]) for name in ("points", "max_points")}
    return Check(
        **{**own, "hints": tuple(read["hints"]), "drawing": drawing_from_json(read["drawing"])}
    )
