"""The result of grading one submission: its checks with their points, and JSON, the source of all reports.

The JSON of one submission with the same checks is always the same, byte for byte: it has no times.
"""

import base64
import json
import math
import re
from collections.abc import Collection
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from typing import Any, Literal, NamedTuple

from hdrlab.errors import InputError

VERSION = 1
TIERS_FOR_CREDIT = ("strict", "container")
# computed properties of a Result that its JSON has in addition to its fields
COMPUTED_FIELDS = ("for_credit", "score", "max_score")
# the fields that a team's copy of its result has: of the result, of a hidden check, of a public one
TEAM_FIELDS = (
    "version",
    "student",
    "homework",
    "title",
    "tier",
    "for_credit",
    "score",
    "max_score",
    "problems",
    "misconceptions",
    "checks",
    "submission",
    "specification",
    "seed",
    "versions",
)
HIDDEN_CHECK_FIELDS = ("task", "promise", "points", "max_points", "outcome", "hidden")
PUBLIC_CHECK_FIELDS = (
    *HIDDEN_CHECK_FIELDS,
    "name",
    "message",
    "hints",
    "drawing",
    "printed",
    "follows",
    "counterexample",
)
# exact points, as str() writes a Fraction
EXACT_POINTS = re.compile(r"-?\d{1,30}(/\d{1,30})?", re.ASCII)
# fields that results of early versions of hdrlab do not have
EARLY_RESULT = {"at_most": None}
EARLY_CHECK = {"kind": "", "follows": "", "counterexample": None}
# names of a check's fields in results of early versions, and their present names
EARLY_CHECK_NAMES = {"said": "printed"}
Outcome = Literal["holds", "fails", "no answer", "broken"]


class Drawing(NamedTuple):
    """Images of a difference as WebP, with their alternative texts and their captions."""

    frames: tuple[bytes, ...] = ()
    alts: tuple[str, ...] = ()
    captions: tuple[str, ...] = ()


class Counterexample(NamedTuple):
    """The smallest input that was found for which the answer is wrong, and both answers, as text."""

    code: str
    yours: str
    correct: str


@dataclass(frozen=True)
class Check:
    """One check of a task, and whether it holds.

    Attributes
    ----------
    task : id of the task
    name : of the test function
    promise : what the check tests, in words
    points, max_points : earned, and possible
    outcome : "holds", "fails", or "no answer" if the function raised an error, took too long or is
        missing; "broken" if the check itself broke, which costs no points
    message : why it does not hold, in words
    hints : from vague to clear
    drawing : images of the expected array, the returned array and their difference
    printed : what the function printed
    hidden : whether it is one of the instructor's hidden checks, of which students see only the
        outcome
    kind : why there is no answer: "missing", "raised", "late", "died", "refused", "damaged", or
        "killed" if something outside ended the sandbox
    follows : the promise of the check of the same task whose failure explains this one
    counterexample : the smallest input that was found for which the answer is wrong, or None
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
    printed: str = ""
    hidden: bool = False
    kind: str = ""
    follows: str = ""
    counterexample: Counterexample | None = None


@dataclass(frozen=True)
class Result:
    """The result of grading one submission.

    Attributes
    ----------
    student : id, "" if unknown
    homework, title : its name and its title
    tier : of the sandbox
    checks : in the order of the homework
    misconceptions : by task, the sentence about the known mistake that explains its failures
    problems : what was wrong with the submission itself, as sentences
    submission, specification, seed : digests of the file, of the checks and of the inputs
    versions : of hdrlab, NumPy, SciPy and Python
    at_most : points that count at most, None if all count
    """

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
        """Points earned, at most as many as count."""
        return self._limit(points(self.checks)[0])

    @property
    def max_score(self) -> float:
        """Points that can be earned."""
        return self._limit(points(self.checks)[1])

    def _limit(self, value: float) -> float:
        return value if self.at_most is None else min(value, self.at_most)

    @property
    def why_practice(self) -> str:
        """Why the score is not for credit, in a sentence, or ""."""
        if self.tier == "in-process":
            return (
                "Your submission ran in the same program as the checks, "
                "so this score is not for credit."
            )
        if self.tier not in TIERS_FOR_CREDIT:
            return "Your submission ran without a sandbox, so this score is not for credit."
        if not self.seed:
            return "The inputs were drawn without a secret, so this score is not for credit."
        return ""

    @property
    def for_credit(self) -> bool:
        """Whether the tier protects the score from the submission, and the inputs were not public."""
        return not self.why_practice

    def of(self, task: str) -> tuple[Check, ...]:
        """Return the checks of one task."""
        return tuple(check for check in self.checks if check.task == task)

    @property
    def tasks(self) -> tuple[str, ...]:
        """The ids of the tasks, in order."""
        return tuple(dict.fromkeys(check.task for check in self.checks))


def points(checks: tuple[Check, ...]) -> tuple[float, float]:
    """Return the points that some checks earned, and those that they could earn."""
    earned = sum((check.points for check in checks), Fraction())
    possible = sum((check.max_points for check in checks), Fraction())
    return _number(earned), _number(possible)


def _number(value: Fraction) -> float:
    return round(float(value), 4)


def to_json(result: Result) -> bytes:
    """Return a Result as JSON, with images in base64.

    Examples
    --------
    >>> result = Result("ada", "hw2", "The response curve", "strict", (), {}, (), "", "", "", {})
    >>> from_json(to_json(result)) == result
    True
    """
    written: dict[str, Any] = {"version": VERSION}
    written |= _as_dict(result)
    written |= {name: getattr(result, name) for name in COMPUTED_FIELDS}
    written["checks"] = [_check_to_json(check) for check in result.checks]
    return _dump(written)


def for_team(data: bytes) -> bytes:
    """Return the part of a Result's JSON that a team may see: of hidden checks only a summary."""
    result = json.loads(data)
    shown = {name: result[name] for name in TEAM_FIELDS}
    shown["checks"] = [_shown_fields(check) for check in result["checks"]]
    return _dump(shown)


def reveal_hidden_checks(data: bytes) -> bytes:
    """Return a Result's JSON in which hidden checks say as much as public ones."""
    result = from_json(data)
    checks = tuple(replace(check, hidden=False) for check in result.checks)
    return to_json(replace(result, checks=checks))


def _shown_fields(check: dict[str, Any]) -> dict[str, Any]:
    """Return the fields of a check's JSON that its team may see."""
    names = HIDDEN_CHECK_FIELDS if check["hidden"] else PUBLIC_CHECK_FIELDS
    present = _with_present_names(check)
    return {name: present[name] for name in names}


def _with_present_names(check: dict[str, Any]) -> dict[str, Any]:
    """Return the fields of a check's JSON, which an early version may have written, by present names."""
    return {EARLY_CHECK_NAMES.get(name, name): value for name, value in check.items()}


def _dump(written: dict[str, Any]) -> bytes:
    return (json.dumps(written, indent=1, ensure_ascii=True) + "\n").encode()


def _as_dict(record: Result | Check) -> dict[str, Any]:
    """Return the fields of a Result or a Check, as they are."""
    return {field.name: getattr(record, field.name) for field in fields(record)}


def _check_to_json(check: Check) -> dict[str, Any]:
    return {
        **_as_dict(check),
        "points": _number(check.points),
        "max_points": _number(check.max_points),
        "exact": {"points": str(check.points), "max_points": str(check.max_points)},
        "drawing": drawing_to_json(check.drawing),
        "counterexample": check.counterexample and check.counterexample._asdict(),
    }


def drawing_to_json(drawing: Drawing) -> list[dict[str, str]]:
    """Return the images of a difference as JSON holds them."""
    written = []
    for frame, alt, caption in zip(drawing.frames, drawing.alts, drawing.captions, strict=True):
        text = base64.b64encode(frame).decode()
        written.append({"webp": text, "alt": alt, "caption": caption})
    return written


def drawing_from_json(images: list[dict[str, str]]) -> Drawing:
    """Return the images that `drawing_to_json` wrote."""
    return Drawing(
        frames=tuple(base64.b64decode(image["webp"]) for image in images),
        alts=tuple(image["alt"] for image in images),
        captions=tuple(image["caption"] for image in images),
    )


def from_json(data: bytes) -> Result:
    """Return the Result that `to_json` wrote, of this or an early version.

    Raises
    ------
    InputError
        For anything else, and for a result of a later version.
    """
    try:
        written = json.loads(data)
    except (RecursionError, ValueError):
        written = None
    if not isinstance(written, dict) or written.get("version") != VERSION:
        raise InputError(f"expected a result of version {VERSION}, written by hdrlab grade")
    try:
        return _result_from_json(written)
    except (KeyError, TypeError, ValueError, ArithmeticError, AttributeError) as error:
        raise InputError(
            f"expected a result written by hdrlab grade, {error!r:.200} is wrong"
        ) from None


def _result_from_json(written: dict[str, Any]) -> Result:
    values: dict[str, Any] = dict(EARLY_RESULT)
    values |= {field.name: written[field.name] for field in fields(Result) if field.name in written}
    values["checks"] = tuple(_check_from_json(check) for check in written["checks"])
    values["problems"] = _require_texts("problems", written["problems"])
    for name in ("student", "homework", "title", "tier", "submission", "specification", "seed"):
        _require_texts(name, [values[name]])
    for name in ("misconceptions", "versions"):
        _require_texts(name, values[name].values())
    at_most = values["at_most"]
    if at_most is not None and not (isinstance(at_most, int | float) and math.isfinite(at_most)):
        raise ValueError(f"at_most {at_most!r:.40}")
    return Result(**values)


def _check_from_json(check: dict[str, Any]) -> Check:
    written = _with_present_names(check)
    values: dict[str, Any] = dict(EARLY_CHECK)
    for field in fields(Check):
        if field.name in written or field.name not in EARLY_CHECK:
            values[field.name] = written[field.name]
    values["points"] = _read_points(written["exact"]["points"])
    values["max_points"] = _read_points(written["exact"]["max_points"])
    values["hints"] = _require_texts("hints", written["hints"])
    values["drawing"] = drawing_from_json(written["drawing"])
    if values["counterexample"] is not None:
        example = Counterexample(**values["counterexample"])
        values["counterexample"] = Counterexample(*_require_texts("counterexample", example))
    for name in ("task", "name", "promise", "outcome", "message", "printed", "kind", "follows"):
        _require_texts(name, [values[name]])
    if not isinstance(values["hidden"], bool):
        raise TypeError(f"hidden {values['hidden']!r:.40}")
    return Check(**values)


def _read_points(text: object) -> Fraction:
    """Return points such as "3/2". Fraction itself would compute the digits of "1e99999999"."""
    if not isinstance(text, str) or not EXACT_POINTS.fullmatch(text):
        raise ValueError(f"points {text!r:.40}")
    return Fraction(text)


def _require_texts(name: str, values: Collection[object]) -> tuple[str, ...]:
    """Return values as texts, or raise a TypeError if one of them is something else."""
    texts = tuple(value for value in values if isinstance(value, str))
    if len(texts) != len(values) or isinstance(values, str):
        raise TypeError(f"{name} is no text")
    return texts
