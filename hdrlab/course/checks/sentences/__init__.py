"""The sentences of the assignments: which checks and which wrong answers belong to each of them.

`<homework>.toml` lists all sentences of each task's text. `demands` are those that a correct answer
must obey: each has wrong answers that break it, and the check at which they lose points. `advice`
are sentences that no check can test. `explains` has the first words of all others.

The tests hold the table against the assignments and the checks. The tutor quotes from it.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from hdrlab.course import plan
from hdrlab.course.variants import rewording


@dataclass(frozen=True, kw_only=True)
class Demand:
    """A sentence that a correct answer must obey.

    Attributes
    ----------
    sentence : the sentence, in Markdown with formulas
    wrong : by the name of a wrong answer, the checks at which it loses points
    """

    sentence: str
    wrong: Mapping[str, tuple[str, ...]]

    @property
    def checks(self) -> frozenset[str]:
        """The names of the checks that test the sentence."""
        return frozenset(check for checks in self.wrong.values() for check in checks)


@cache
def table() -> dict[str, dict[str, Any]]:
    """Return what the tables say of each task, by its id."""
    entries = {}
    for path in sorted(Path(__file__).parent.glob("*.toml")):
        entries.update(tomllib.loads(path.read_text(encoding="utf8")))
    return entries


def demands_of(task: plan.Task) -> list[Demand]:
    """Return the demands of a task in the words of its variant; none for an instructor's own task."""
    if task.own is not None:
        return []
    demands = []
    for entry in table().get(task.id, {}).get("demands", []):
        sentence = entry["sentence"]
        if task.variant:
            sentence = rewording.reword(task.id, task.variant, sentence)
        wrong = {name: tuple(checks) for name, checks in entry["wrong"].items()}
        demands.append(Demand(sentence=sentence, wrong=wrong))
    return demands
