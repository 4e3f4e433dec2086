"""The JSON of a Result and the numbers of its page do not change between versions."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest

from hdrlab.course.grading import results
from hdrlab.course.grading.results import Check, Drawing, Result
from hdrlab.course.reports import feedback, gradebook

CHECK = Check("a", "n", "It \u00e9s", Fraction(1, 3), Fraction(2), "fails")
RESULT = Result("ada", "hw2", "T", "strict", (CHECK,), {}, (), "d", "s", "x", {})
TEXT = """{
 "version": 1,
 "student": "ada",
 "homework": "hw2",
 "title": "T",
 "tier": "strict",
 "checks": [
  {
   "task": "a",
   "name": "n",
   "promise": "It \\\\u00e9s",
   "points": 0.3333,
   "max_points": 2.0,
   "outcome": "fails",
   "message": "",
   "hints": [],
   "drawing": [],
   "printed": "",
   "hidden": false,
   "kind": "",
   "follows": "",
   "counterexample": null,
   "exact": {
    "points": "1/3",
    "max_points": "2"
   }
  }
 ],
 "misconceptions": {},
 "problems": [],
 "submission": "d",
 "specification": "s",
 "seed": "x",
 "versions": {},
 "at_most": null,
 "for_credit": true,
 "score": 0.3333,
 "max_score": 2.0
}
"""


def test_the_json_of_a_result_has_the_documented_form():
    assert results.to_json(RESULT).decode() == TEXT.replace("\\\\", "\\")
    assert results.from_json(TEXT.replace("\\\\", "\\").encode()) == RESULT


def test_a_teams_copy_equals_the_result_without_hidden_parts():
    hidden = replace(
        RESULT, checks=(CHECK, replace(CHECK, hidden=True, message="secret", printed="s"))
    )
    shown = results.for_team(results.to_json(hidden))
    assert shown.startswith(b'{\n "version": 1,\n "student": "ada",') and shown.endswith(b"}\n")
    read = json.loads(shown)
    assert set(read["checks"][0]) == set(results.PUBLIC_CHECK_FIELDS)
    assert set(read["checks"][1]) == set(results.HIDDEN_CHECK_FIELDS)
    assert b"\\u00e9" in shown and b"secret" not in shown and "at_most" not in read


@pytest.mark.parametrize("version", [0, 2, "1", None])
def test_another_version_is_refused(version):
    with pytest.raises(ValueError, match="result of version 1, written by hdrlab grade"):
        results.from_json(
            json.dumps(json.loads(results.to_json(RESULT)) | {"version": version}).encode()
        )
    with pytest.raises(ValueError, match="result of version 1"):
        results.from_json(b"[1]")


@pytest.mark.parametrize(
    ("at_most", "score", "most"),
    [(None, 3.3333, 6), (3.0, 3, 3), (3.3333, 3.3333, 3.3333), (7.0, 3.3333, 6)],
)
def test_a_score_is_the_points_up_to_the_maximum(at_most, score, most):
    checks = (
        CHECK,
        replace(CHECK, task="b", points=Fraction(2)),
        replace(CHECK, points=Fraction(1)),
    )
    changed = replace(RESULT, checks=checks, at_most=at_most)
    assert (changed.score, changed.max_score, changed.tasks) == (score, most, ("a", "b"))
    assert changed.of("a") == (checks[0], checks[2]) and results.points(changed.of("b")) == (2, 2)


@pytest.mark.parametrize(
    ("tier", "seed", "credit"),
    [
        ("strict", "x", True),
        ("container", "x", True),
        ("practice", "x", False),
        ("strict", "", False),
    ],
)
def test_a_score_for_credit_needs_a_sandbox_and_secret_inputs(tier, seed, credit):
    changed = replace(RESULT, tier=tier, seed=seed)
    assert changed.for_credit is credit and bool(changed.why_practice) is not credit
    assert ("without a sandbox" in changed.why_practice) is (tier == "practice")


def test_a_result_of_an_earlier_version_has_defaults_for_later_fields():
    read = json.loads(results.to_json(RESULT))
    del read["at_most"], read["checks"][0]["kind"], read["checks"][0]["follows"]
    del read["checks"][0]["counterexample"]
    assert results.from_json(json.dumps(read).encode()) == RESULT
    for name in ("student", "checks", "problems"):
        with pytest.raises(ValueError, match="result written by hdrlab grade"):
            results.from_json(
                json.dumps({key: value for key, value in read.items() if key != name}).encode()
            )
    del read["checks"][0]["printed"]
    with pytest.raises(ValueError, match="'printed'"):
        results.from_json(json.dumps(read).encode())


def test_a_result_of_an_earlier_version_may_call_the_printed_text_said():
    result = replace(RESULT, checks=(replace(CHECK, printed="what it printed"),))
    written = json.loads(results.to_json(result))
    written["checks"][0]["said"] = written["checks"][0].pop("printed")
    early = json.dumps(written).encode()
    assert results.from_json(early) == result
    assert json.loads(results.for_team(early))["checks"][0]["printed"] == "what it printed"


def test_images_of_a_result_are_stored_as_text():
    drawing = Drawing((b"RIFF", b"2"), ("a", "b"), ("c", "d"))
    drawings = [
        {"webp": "UklGRg==", "alt": "a", "caption": "c"},
        {"webp": "Mg==", "alt": "b", "caption": "d"},
    ]
    assert results.drawing_to_json(drawing) == drawings
    assert results.drawing_from_json(drawings) == drawing
    with pytest.raises(ValueError, match="zip"):
        results.drawing_to_json(drawing._replace(alts=("a",)))


@pytest.mark.parametrize(
    ("value", "text"),
    [(7, "7"), (7.5, "7.5"), (1 / 3, "0.33"), (10, "10"), (0.004, "0")],
)
def test_points_are_shown_in_hundredths_at_most(value, text):
    assert feedback.number(value) == text


def test_the_page_shows_private_parts_and_the_terminal_shows_hints_on_request():
    changed = replace(RESULT, checks=(replace(CHECK, hints=("first", "second"), message="no"),))
    assert feedback.text(changed) == feedback.text(changed, hints=0, private=False)
    assert "first" not in feedback.text(changed) and "second" not in feedback.text(changed, hints=1)
    assert "first" in feedback.text(changed, hints=1)
    assert "second" in feedback.text(changed, hints=2)
    secret = replace(changed, checks=(replace(CHECK, hidden=True, message="the reason"),))
    for shown in (feedback.page, feedback.fragment, feedback.text):
        assert "the reason" in shown(secret, private=True) and "the reason" not in shown(secret)


def test_all_formats_are_readable_by_their_owner_only(tmp_path):
    folder = tmp_path / "a" / "b"
    for shown, expected in ((None, results.to_json(RESULT)), (b"shown", b"shown")):
        files = gradebook.write_results(folder, RESULT, shown)
        assert files == [folder / name for name in gradebook.FILES]
        assert {file.stat().st_mode & 0o777 for file in files} == {0o600}
        assert folder.stat().st_mode & 0o777 == 0o700
        assert (folder / "result.json").read_bytes() == expected
    assert (
        gradebook.table(RESULT)
        == "student,homework,tier,score,max_score,a\r\nada,hw2,strict,0.3333,2.0,0.3333\r\n"
    )
