"""Does the grader understand real student code?

<task>/<answer>.py  the structure and the faults of a public student implementation, in our own words
due.toml            what each answer must get: full marks or not, and the known mistakes in it

An answer with several faults may have one mistake named or all of them. A name that is not in
`due.toml` is wrong. An empty list says that no known mistake describes the fault, so no name is due.
`python -m benchmarks corpus` grades every answer as `fairness` does, for SEEDS students.
"""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.experiments import Experiment, Hold, at_least, at_most
from benchmarks.fairness import SEEDS, Score, scores

HERE = Path(__file__).parent
MIN_NAMED_PERCENT = 60


@dataclass(frozen=True, kw_only=True)
class Due:
    """What an answer must get: full marks, or the names of its mistakes."""

    full_marks: bool
    mistakes: tuple[str, ...]


def answers() -> dict[str, dict[str, str]]:
    """Return the answers in the form that `fairness.scores` takes: task -> name -> source."""
    found: dict[str, dict[str, str]] = {}
    for path in sorted(HERE.glob("*/*.py")):
        found.setdefault(path.parent.name, {})[path.stem] = path.read_text(encoding="utf8")
    return found


def due() -> dict[tuple[str, str], Due]:
    """Return what each answer must get, by its task and its name."""
    table = tomllib.loads((HERE / "due.toml").read_text(encoding="utf8"))
    return {
        (task, name): Due(full_marks=entry["full_marks"], mistakes=tuple(entry["mistakes"]))
        for task, entries in table.items()
        for name, entry in entries.items()
    }


def line(score: Score, expected: Due) -> str:
    """Return a line of the table: task, answer, points, names given, names due."""
    given = ", ".join(score.named) or "-"
    wanted = ", ".join(expected.mistakes) or "-"
    return f"  {score.task:<20}{score.way:<34}{score.share:>5.0%}  {given}  (due: {wanted})"


def named(_: Path) -> dict[str, Any]:
    """Return how many losses are named, and how many names and refusals are wrong."""
    expected = due()
    graded = [(score, expected[score.task, score.way]) for score in scores(answers(), SEEDS)]
    print("\n".join(line(score, wanted) for score, wanted in graded))
    losses = [(score, wanted) for score, wanted in graded if score.share < 1]
    wrong_names = [score for score, wanted in graded if set(score.named) - set(wanted.mistakes)]
    return {
        "answers": len(expected),
        "tasks": len({task for task, _ in expected}),
        "losses": len(losses),
        "losses named, %": 100 * sum(bool(score.named) for score, _ in losses) / len(losses),
        "answers named wrongly": len(wrong_names),
        "right answers refused": sum(wanted.full_marks for _, wanted in losses),
        "wrong answers with full marks": sum(
            score.share == 1 and not wanted.full_marks for score, wanted in graded
        ),
    }


NONE_REFUSED: Hold = at_most("right answers refused", 0)
ROWS = (
    Experiment(
        "student-code",
        "answers as real students write them",
        named,
        (
            NONE_REFUSED,
            at_most("answers named wrongly", 0),
            at_least("losses named, %", MIN_NAMED_PERCENT),
        ),
    ),
)
