"""Checks as pytest has them, and a Checking whose lines can be read: what the tests of the plugin share."""

import json
from pathlib import Path
from types import SimpleNamespace

from hdrlab.course.checks.plugin import GradingPlugin
from hdrlab.course.checks.subject import Call, Subject

PLACE = Path("/checks")


def item(name="test_a_promise", task="hat", *, folder=PLACE, subject=None, mark=None, check=None):
    """A check as pytest has it."""
    made = SimpleNamespace(
        name=name, path=folder / f"test_{task}.py", get_closest_marker=lambda which: mark
    )
    if subject is not None:
        made.funcargs = {"subject": subject}
    if check is not None:
        made.function = check
    return made


class Asked(Subject):
    """A Subject that was asked something already, without a sandbox."""

    def __init__(self, *answers, said=""):
        super().__init__({"hat": ""}, None)
        self.calls = [Call("hat", (k,), {}, answer) for k, answer in enumerate(answers)]
        self.printed, self.begun = said, 0

    def fresh(self, **sources):
        self.begun += 1


def checking(folder):
    """Return a Checking that writes into a folder; `lines` reads what it has written."""
    job = {
        "sources": {"hat": "def hat(): ..."},
        "modules": ["numpy"],
        "tier": "practice",
        "timeout": 3.0,
        "seeds": {"hat": "7"},
        "draw": True,
        "hidden": "/hidden",
        "tasks": [["hat", "core.weights.hat", 1.0], ["gsolve", "response.debevec.gsolve", 1.0]],
        "out": str(folder / "lines"),
        "grader": 1,
    }
    made = GradingPlugin(job)
    (folder / "lines").touch()
    made.lines = lambda: [
        json.loads(one) for one in (folder / "lines").read_text("utf8").splitlines()
    ]
    return made
