"""Checks as pytest collects them, a Subject without a sandbox, and a GradingPlugin with readable output."""

import json
from pathlib import Path
from types import SimpleNamespace

from hdrlab.course.checks.plugin import GradingPlugin
from hdrlab.course.checks.subject import Call, Subject

CHECKS_FOLDER = Path("/checks")


def make_item(
    name="test_a_promise",
    task="hat",
    *,
    folder=CHECKS_FOLDER,
    subject=None,
    mark=None,
    check=None,
):
    """Return a check as pytest collects it.

    Parameters
    ----------
    name, task, folder : the name of the test function, its task, and the folder of its file
    subject : the Subject that the check uses
    mark : its nearest marker
    check : the test function
    """
    item = SimpleNamespace(
        name=name,
        path=folder / f"test_{task}.py",
        get_closest_marker=lambda which: mark,
    )
    if subject is not None:
        item.funcargs = {"subject": subject}
    if check is not None:
        item.function = check
    return item


class CalledSubject(Subject):
    """A Subject without a sandbox that has been called before.

    Parameters
    ----------
    answers : the answer of each call of `hat`; the first call was `hat(0)`, the next `hat(1)`
    printed : what the student's code printed
    """

    def __init__(self, *answers, printed=""):
        super().__init__({"hat": ""}, None)
        self.calls = [Call("hat", (k,), {}, answer) for k, answer in enumerate(answers)]
        self.printed = printed
        self.fresh_count = 0

    def fresh(self, **sources):
        self.fresh_count += 1


def make_plugin(folder):
    """Return a GradingPlugin that writes into a folder; its method `lines` reads what it has written."""
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
    plugin = GradingPlugin(job)
    output = folder / "lines"
    output.touch()
    plugin.lines = lambda: [json.loads(line) for line in output.read_text("utf8").splitlines()]
    return plugin
