"""`hdrlab doctor`: what it tries for each tier, how often, and what it reports."""

import pytest

from hdrlab.course.checks.subject import NoAnswer
from hdrlab.course.grading import doctor
from hdrlab.course.sandbox import practice, tiers
from hdrlab.course.sandbox.session import Unavailable


class Trial:
    """A sandbox to try: `ends` says how its starts end, and `broken` what escapes from it."""

    def __init__(self, ends=(), broken=()):
        self.ends = list(ends)
        self.broken = list(broken)
        self.starts = 0
        self.tried_to_break_out = False

    def __call__(self, sources, sandbox):
        return self

    def __enter__(self):
        self.starts += 1
        error = self.ends.pop(0) if self.ends else None
        if error is not None:
            raise error
        return self

    def __exit__(self, *error):
        pass

    def ready(self):
        pass

    def break_out(self, secret, target):
        self.tried_to_break_out = True
        return self.broken


@pytest.fixture
def examine(monkeypatch):
    """examine(tier, trial) -> the doctor's findings about a tier whose sandbox is a Trial."""

    def examine(tier, trial):
        monkeypatch.setattr(doctor, "Subject", trial)
        monkeypatch.setattr(tiers, "choose", lambda tier: f"{tier} sandbox")
        return doctor.examine(tier)

    return examine


def test_a_tier_that_starts_and_holds_works(examine):
    finding = examine("strict", Trial())
    assert finding.tier == "strict" and finding.works and finding.credit


def test_a_tier_that_something_breaks_out_of_does_not_work_and_each_breach_is_named(examine):
    finding = examine("strict", Trial(broken=["read a secret", "wrote a file"]))
    assert not finding.works
    assert "read a secret" in finding.details and "wrote a file" in finding.details
    assert "report this" in finding.remedy


def test_the_practice_tier_gives_no_credit_and_says_what_it_does_not_stop(examine, monkeypatch):
    monkeypatch.setattr(practice, "DOES_NOT_STOP", ["reading files"])
    trial = Trial()
    finding = examine("practice", trial)
    assert finding.works and not finding.credit and "reading files" in finding.details
    assert not trial.tried_to_break_out


@pytest.mark.parametrize(
    "error", [OSError("no room"), NoAnswer("it was late", "late"), Unavailable("needs more")]
)
def test_a_tier_that_never_starts_is_reported_with_the_reason(error, examine):
    finding = examine("container", Trial(ends=[error] * 10))
    assert not finding.works and str(error) in finding.details


@pytest.mark.parametrize("error", [NoAnswer("ended", "killed"), Unavailable("no memory")])
def test_a_tier_that_fails_once_is_tried_again(error, examine):
    trial = Trial(ends=[error])
    assert examine("strict", trial).works and trial.starts == 2


def test_the_remedy_depends_on_the_reason_and_on_system_settings(monkeypatch, tmp_path):
    words = {"no bwrap": "install it", "libseccomp": "install that"}
    switches = [
        {"file": "a/b", "blocking_value": "0", "help": "switch it"},
        {"file": "a/c", "blocking_value": "1", "help": "switch that"},
    ]
    monkeypatch.setattr(doctor, "REMEDIES", {"install": words, "kernel_settings": switches})
    monkeypatch.setattr(
        doctor, "Path", lambda *parts: tmp_path.joinpath(*(part.lstrip("/") for part in parts))
    )
    assert doctor.find_remedy("there is no bwrap, no libseccomp") == "install it"
    assert doctor.find_remedy("container: no\nlibseccomp") == ""
    assert doctor.find_remedy("strict: no") == ""
    (tmp_path / ".dockerenv").touch()
    nested = "namespaces rarely nest in containers: use the container tier, as root"
    assert doctor.find_remedy("the strict sandbox did not start: libseccomp") == nested
    assert doctor.find_remedy("container did not start: libseccomp") == ""
    (tmp_path / "proc/sys/a").mkdir(parents=True)
    (tmp_path / "proc/sys/a/b").write_text("1\n")
    assert doctor.find_remedy("strict") == nested
    (tmp_path / "proc/sys/a/c").write_text("1\n")
    assert doctor.find_remedy("strict") == "switch that"
    (tmp_path / "proc/sys/a/b").write_text("0\n")
    assert doctor.find_remedy("strict") == "switch it"
