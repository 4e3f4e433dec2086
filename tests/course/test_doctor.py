"""What the doctor finds of a tier: what is tried and how often, and in which words it is told."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from hdrlab.course.checks.subject import NoAnswer
from hdrlab.course.grading import doctor
from hdrlab.course.sandbox import practice, tiers
from hdrlab.course.sandbox.session import Unavailable


@pytest.mark.parametrize(
    ("tier", "tried", "finding"),
    [
        ("strict", ([], 0.126), (True, True, "started in 0.13 s, and nothing got out")),
        ("strict", (["a", "b"], 0.1), (False, True, "it started, but a and b")),
        ("practice", (["a"], 1.0), (True, False, "started in 1.00 s. It does not stop: x; y")),
        ("practice", OSError("no room"), (False, False, "no room")),
        ("container", NoAnswer("late", "late"), (False, True, "late")),
        ("strict", Unavailable("needs more"), (False, True, "needs more")),
    ],
)
def test_a_finding_says_whether_a_tier_works_and_is_for_credit(tier, tried, finding, monkeypatch):
    def trial(asked):
        if isinstance(tried, Exception):
            raise tried
        return tried

    monkeypatch.setattr(doctor, "_try_repeatedly", trial)
    monkeypatch.setattr(practice, "DOES_NOT_STOP", ["x", "y"])
    found = doctor.examine(tier)
    assert (found.tier, found.works, found.credit, found.says) == (tier, *finding)
    assert ("report this" in found.remedy) is ("it started, but" in found.says)


@pytest.mark.parametrize(
    ("failures", "tries", "works"), [(0, 1, True), (2, 3, True), (3, 3, False)]
)
def test_a_tier_is_tried_three_times(failures, tries, works, monkeypatch):
    asked = []

    def trial(tier):
        asked.append(tier)
        if len(asked) <= failures:
            raise NoAnswer("ended", "killed")
        return [], 0.0

    monkeypatch.setattr(doctor, "_try_once", trial)
    if works:
        assert doctor._try_repeatedly("strict") == ([], 0.0)
    else:
        with pytest.raises(NoAnswer):
            doctor._try_repeatedly("strict")
    assert asked == ["strict"] * tries


@pytest.mark.parametrize(("tier", "broken"), [("strict", ["a wall"]), ("practice", [])])
def test_a_trial_tries_to_break_out_of_a_sandbox(tier, broken, monkeypatch):
    asked = []
    clock = iter((3.0, 4.5))

    class Asked:
        def __init__(self, sources, sandbox):
            asked.append((set(sources), sandbox))

        def __enter__(self):
            return self

        def __exit__(self, *error):
            asked.append("closed")

        def ready(self):
            asked.append("ready")

        def break_out(self, secret, target):
            asked.append((secret, target))
            return ["a wall"]

    monkeypatch.setattr(doctor, "Subject", Asked)
    monkeypatch.setattr(doctor, "time", SimpleNamespace(perf_counter=lambda: next(clock)))
    monkeypatch.setattr(tiers, "choose", lambda tier: f"{tier} sandbox")
    assert doctor._try_once(tier) == (broken, 1.5)
    file = bytes(Path(doctor.__file__).resolve())
    tried = [(file, b"/tmp/hdrlab-doctor")] if broken else []
    assert asked == [({"ready", "break_out"}, f"{tier} sandbox"), "ready", *tried, "closed"]


def test_the_remedy_depends_on_the_reason_and_on_system_settings(monkeypatch, tmp_path):
    words = {"no bwrap": "install it", "libseccomp": "install that"}
    switches = [
        {"file": "a/b", "keeps": "0", "help": "switch it"},
        {"file": "a/c", "keeps": "1", "help": "switch that"},
    ]
    monkeypatch.setattr(doctor, "REMEDIES", {"install": words, "switches": switches})
    monkeypatch.setattr(
        doctor, "Path", lambda *parts: tmp_path.joinpath(*(part.lstrip("/") for part in parts))
    )
    assert doctor.remedy("there is no bwrap, no libseccomp") == "install it"
    assert doctor.remedy("container: no\nlibseccomp") == "" and doctor.remedy("strict: no") == ""
    (tmp_path / ".dockerenv").touch()
    nested = "namespaces rarely nest in containers: use the container tier, as root"
    assert doctor.remedy("the strict sandbox did not start: libseccomp") == nested
    assert doctor.remedy("container did not start: libseccomp") == ""
    (tmp_path / "proc/sys/a").mkdir(parents=True)
    (tmp_path / "proc/sys/a/b").write_text("1\n")
    assert doctor.remedy("strict") == nested
    (tmp_path / "proc/sys/a/c").write_text("1\n")
    assert doctor.remedy("strict") == "switch that"
    (tmp_path / "proc/sys/a/b").write_text("0\n")
    assert doctor.remedy("strict") == "switch it"
