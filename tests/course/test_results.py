"""Results of a hostile submission, in all formats."""

import csv
import io
import json
from dataclasses import replace
from fractions import Fraction
from xml.etree import ElementTree

import numpy as np
import pytest

from hdrlab.course.grading import results
from hdrlab.course.grading.results import Check, Drawing, Result
from hdrlab.course.reports import feedback, gradebook
from hdrlab.errors import InputError
from hdrlab.io import web

HOSTILE = '<script>alert("x")</script><img src=x onerror=alert(1)>\x1b[31m\x00 =cmd|"/c calc"!A1 ]]> & \ud7ff'
CHECK = Check("gsolve", "test_a", "It holds", Fraction(1, 3), Fraction(1, 3), "holds")


@pytest.fixture
def hostile():
    """A Result in which everything that a student can write is hostile."""
    picture = Drawing((web.encode_webp(np.zeros((4, 4), np.uint8)),), (HOSTILE,), (HOSTILE,))
    bad = Check(
        "gsolve",
        "test_b",
        "It does not",
        Fraction(),
        Fraction(2, 3),
        "fails",
        HOSTILE,
        (HOSTILE,) * 3,
        picture,
        HOSTILE,
    )
    hidden = replace(
        bad, name="test_c", promise="The hidden one", hidden=True, message="the secret", printed=""
    )
    return Result(
        student=HOSTILE,
        homework="hw2",
        title="The response curve",
        tier="strict",
        checks=(CHECK, bad, replace(hidden, drawing=Drawing(), hints=())),
        misconceptions={"gsolve": HOSTILE},
        problems=(HOSTILE,),
        submission="0" * 64,
        specification="1" * 64,
        seed="2" * 16,
        versions={"hdrlab": "1"},
    )


def test_a_result_survives_the_round_trip_through_json(hostile):
    data = results.to_json(hostile)
    assert results.from_json(data) == hostile
    read = json.loads(data)
    assert {"score", "max_score", "tier", "checks"} <= set(read)
    assert read["version"] == results.VERSION
    assert data.isascii()


@pytest.mark.parametrize("data", [b"{}", b"[]", b'{"version": 99}', b'{"version": 1}', b"no json"])
def test_other_data_is_refused_as_a_result(data):
    with pytest.raises((InputError, json.JSONDecodeError)):
        results.from_json(data)


def test_thirds_of_a_point_sum_to_a_point():
    three = tuple(replace(CHECK, name=str(k)) for k in range(3))
    assert results.points(three) == (1.0, 1.0)


def test_a_practice_score_is_never_for_credit(hostile):
    assert hostile.for_credit and not replace(hostile, tier="practice").for_credit
    assert replace(hostile, tier="container").for_credit
    practice = replace(hostile, tier="practice")
    assert "not for credit" in feedback.page(practice)
    assert "not for credit" in gradebook.gradescope(practice).decode()
    assert json.loads(results.to_json(practice))["for_credit"] is False


def test_without_a_secret_a_score_is_for_practice_whatever_the_tier(hostile):
    public = replace(hostile, seed="")
    assert not public.for_credit and "without a secret" in public.why_practice
    assert "without a secret" in feedback.page(public) and "For practice" in feedback.page(public)
    assert "without a secret" in gradebook.gradescope(public).decode()
    assert json.loads(results.to_json(public))["for_credit"] is False


def values(read):
    """All texts of a JSON."""
    if isinstance(read, dict | list):
        return [
            text
            for item in (read.values() if isinstance(read, dict) else read)
            for text in values(item)
        ]
    return [str(read)]


SECRETS = ("the message", "first hint", "expected 0.25", "what it printed", "test_hidden_name")


def test_a_teams_copy_shows_only_the_name_and_points_of_a_hidden_check(hostile):
    picture = Drawing(
        (web.encode_webp(np.zeros((4, 4), np.uint8)),), ("expected 0.25",), ("expected 0.25",)
    )
    hidden = Check(
        "gsolve", "test_hidden_name", "It is kept", Fraction(), Fraction(1), "fails", *SECRETS[:1]
    )
    hidden = replace(
        hidden, hints=("first hint",), drawing=picture, printed="what it printed", hidden=True
    )
    own = replace(hostile.checks[1], message="yours to read")
    whole = results.to_json(replace(hostile, checks=(own, hidden)))
    shown = json.loads(results.for_team(whole))
    assert not [text for text in values(shown) if any(secret in text for secret in SECRETS)]
    assert set(shown["checks"][1]) == {
        "task",
        "promise",
        "points",
        "max_points",
        "outcome",
        "hidden",
    }
    assert shown["checks"][0]["message"] == "yours to read" and shown["score"] == 0


def test_unknown_fields_of_a_result_are_not_in_a_teams_copy(hostile):
    whole = json.loads(results.to_json(hostile))
    whole["answers"] = "expected 0.25"
    whole["checks"][0]["answer"] = "expected 0.25"
    whole["checks"][2]["answer"] = "expected 0.25"
    assert "expected 0.25" not in results.for_team(json.dumps(whole).encode()).decode()


def test_written_results_are_readable_by_their_owner_only(hostile, tmp_path):
    for file in gradebook.write_results(tmp_path / "new" / "out", hostile):
        assert file.stat().st_mode & 0o077 == 0
    assert (tmp_path / "new" / "out").stat().st_mode & 0o077 == 0


def test_a_passed_check_without_points_says_why(hostile):
    held = replace(CHECK, points=Fraction(), message="It only earns points if this passes, too: B")
    result = replace(hostile, checks=(held,))
    assert "if this passes, too: B" in feedback.text(result)
    assert "if this passes, too: B" in feedback.page(result)


def test_the_gradescope_file_follows_its_schema(hostile):
    """The keys, types and values of Gradescope's specification of results.json."""
    read = json.loads(gradebook.gradescope(hostile))
    assert {"score", "output", "visibility", "stdout_visibility", "tests"} <= set(read)
    visibilities = {"hidden", "after_due_date", "after_published", "visible"}
    assert read["visibility"] in visibilities and read["stdout_visibility"] in visibilities
    assert read["output_format"] in {"text", "html", "simple_format", "md", "ansi"}
    assert 0 <= read["score"] <= sum(test["max_score"] for test in read["tests"])
    for test in read["tests"]:
        assert isinstance(test["score"], float) and isinstance(test["max_score"], float)
        assert test["status"] in {"passed", "failed"} and test["visibility"] in visibilities
        assert isinstance(test["name"], str)
        assert isinstance(test["output"], str)
        assert test["output_format"] == "text"
    assert sum(test["score"] for test in read["tests"]) == pytest.approx(read["score"])
    assert "the secret" not in json.dumps(read)


def test_gradescope_shows_which_checks_passed_and_which_failed(hostile):
    shown = [test["status"] for test in json.loads(gradebook.gradescope(hostile))["tests"]]
    expected = {"holds": "passed", "fails": "failed", "no answer": "failed"}
    assert shown == [expected[check.outcome] for check in hostile.checks]
    assert {"passed", "failed"} == set(shown)


def test_the_junit_file_is_valid_xml_for_hostile_text(hostile):
    root = ElementTree.fromstring(gradebook.junit(hostile))
    assert root.get("tests") == "3" and root.get("failures") == "2"
    failures = [failure.text or "" for failure in root.iter("failure")]
    assert "<script>" in failures[0] and "\x00" not in failures[0] and failures[1] == ""


def test_a_spreadsheet_does_not_take_a_cell_of_the_table_for_a_formula(hostile):
    for student in ('=HYPERLINK("http://x")', "ada"):
        table = gradebook.table(replace(hostile, student=student))
        (row,) = csv.DictReader(io.StringIO(table))
        assert row["score"] == "0.3333" and "gsolve" in row
        assert not any(cell.startswith(("=", "+", "@", "\t")) for cell in row.values())


def test_the_feedback_page_escapes_hostile_text(hostile):
    page = feedback.page(hostile)
    assert "<script" not in page and "<img src=x" not in page and "default-src 'none'" in page
    assert "&lt;script&gt;" in page and "the secret" not in page
    assert "the secret" in feedback.page(hostile, private=True)


def test_the_hints_are_three_steps_each_within_the_one_before(hostile):
    check = replace(hostile.checks[1], hints=("first", "second", "third"))
    page = feedback.fragment(replace(hostile, checks=(check,)))
    assert (
        page.index("first")
        < page.index("Another hint")
        < page.index("second")
        < page.index("The last hint")
    )
    assert page.count("<details") == page.count("</details>")


def test_all_formats_of_a_result_are_written_to_one_folder(hostile, tmp_path):
    files = gradebook.write_results(tmp_path / "out", hostile)
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == sorted(gradebook.FILES)
    assert all(file.stat().st_size for file in files)


def test_the_terminal_shows_hints_only_on_request(hostile):
    check = replace(hostile.checks[1], hints=("first", "second", "third"))
    result = replace(hostile, checks=(check,))
    assert "first" not in feedback.text(result)
    assert "first" in feedback.text(result, hints=1)
    assert "second" not in feedback.text(result, hints=1)
    assert "third" in feedback.text(result, hints=3)


def chosen(earned, at_most):
    """A Result of three tasks of 40 points each, of which only so many points count."""
    checks = [
        Check(
            f"task{n}",
            "test_a",
            "It holds",
            Fraction(points),
            Fraction(40),
            "holds" if points else "fails",
        )
        for n, points in enumerate(earned)
    ]
    rest = dict.fromkeys(("submission", "specification", "seed", "tier", "student"), "x")
    # fmt: skip
    return Result(
        homework="hw4",
        title="",
        checks=tuple(checks),
        misconceptions={},
        problems=(),
        versions={},
        at_most=at_most,
        **rest,
    )


@pytest.mark.parametrize(
    ("earned", "at_most", "score"),
    [((40, 40, 0), 80, 80), ((40, 40, 40), 80, 80), ((40, 20, 0), 80, 60)],
)
def test_a_score_never_exceeds_the_maximum_of_a_homework_with_chosen_tasks(earned, at_most, score):
    result = chosen(earned, at_most)
    assert (result.score, result.max_score) == (score, 80)
    assert json.loads(gradebook.gradescope(result))["score"] == score
    assert f"hw4: {score} of 80 points" in feedback.text(result)
    (row,) = csv.DictReader(io.StringIO(gradebook.table(result)))
    assert (float(row["score"]), float(row["max_score"]), float(row["task1"])) == (
        score,
        80,
        earned[1],
    )
    assert results.from_json(results.to_json(result)) == result


@pytest.mark.parametrize("value", [None, 7, 1e300, "1e99999999", "9" * 5000, [], {"a": 1}, [3]])
def test_a_result_with_any_wrong_value_is_read_or_refused_at_once(hostile, value):
    """Every result that can be read can be written again, with its score."""

    def try_reading(whole):
        try:
            read = results.from_json(json.dumps(whole).encode())
        except InputError:
            return
        assert np.isfinite(read.score)
        assert results.to_json(read)

    text = results.to_json(hostile).decode()
    whole = json.loads(text)
    for name in whole:
        try_reading(whole | {name: value})
    for name in whole["checks"][1]:
        changed = json.loads(text)
        changed["checks"][1][name] = value
        try_reading(changed)
    for name in ("points", "max_points"):
        changed = json.loads(text)
        changed["checks"][1]["exact"][name] = value
        try_reading(changed)


def test_a_result_of_an_earlier_version_counts_all_of_its_points():
    whole = json.loads(results.to_json(chosen((40, 40, 40), None)))
    del whole["at_most"]
    assert results.from_json(json.dumps(whole).encode()).score == 120
