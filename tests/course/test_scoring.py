"""One mistake costs once, in whole and half points."""

from dataclasses import replace
from fractions import Fraction

import pytest
import scoring

from hdrlab.course import plan
from hdrlab.course.grading.results import Check, Result
from hdrlab.course.grading.scoring import attribute_failures, split_points
from hdrlab.course.reports import feedback


def checks(*outcomes, points=4, **more):
    """Return checks a, b, c ... of a task."""
    return [
        Check("hat", name, f"Promise {name}", Fraction(), Fraction(points), outcome, **more)
        for name, outcome in zip("abcdef", outcomes, strict=False)
    ]


def earned(scored):
    return [float(check.points) for check in scored]


@pytest.mark.parametrize("points", ["10", "7.5", "1", "7.25", "0"])
@pytest.mark.parametrize("weights", [(1, 4, 3, 3), (1, 1, 1), (14, 6, 6, 2, 3, 1), (5,)])
def test_shares_sum_to_the_points_and_are_whole_or_half_where_these_are(points, weights):
    shares = split_points(Fraction(points), [Fraction(weight) for weight in weights])
    assert sum(shares) == Fraction(points) and min(shares) >= 0
    assert sum(2 * weight != int(2 * weight) for weight in shares) <= (points == "7.25")


def test_every_promise_of_the_plan_is_worth_something():
    for homework in plan.read().homeworks.values():
        for task in homework.tasks:
            weights = [Fraction(points) for _, _, points, *_ in scoring.checks(task.id)]
            assert min(split_points(Fraction(task.points), weights)) >= Fraction(1, 2), task.id


def test_a_named_mistake_costs_half_at_most_and_the_rest_follows_from_the_first():
    scored = attribute_failures(
        checks("holds", "fails", "fails", "fails"), {}, named=True, once=True
    )
    assert earned(scored) == [4, 0, 0, 4]
    assert [check.follows for check in scored] == ["", "", "Promise b", "Promise b"]


def test_a_mistake_that_misses_the_method_costs_all_failed_checks():
    scored = attribute_failures(checks("holds", "fails", "fails"), {}, named=True)
    assert earned(scored) == [4, 0, 0] and scored[2].follows == "Promise b"


def test_half_of_an_odd_number_of_points_is_half_a_point():
    scored = attribute_failures(
        checks("fails", "fails", "fails", points=5), {}, named=True, once=True
    )
    assert sum(earned(scored)) == 7.5


def test_a_check_that_needs_a_failed_check_earns_nothing():
    scored = attribute_failures(
        checks("fails", "fails", "holds", "fails"), {"b": "a", "c": "a", "d": "b"}
    )
    assert [check.follows for check in scored] == ["", "Promise a", "", "Promise a"]
    assert earned(scored) == [0, 0, 0, 0] and "too: Promise a" in scored[2].message


def test_failures_with_the_same_message_are_reported_once():
    errors = [
        {"kind": "raised", "message": kind} for kind in ("IndexError", "IndexError", "KeyError")
    ]
    failures = [
        replace(kind, **words)
        for kind, words in zip(checks(*3 * ["no answer"]), errors, strict=True)
    ]
    assert [kind.follows for kind in attribute_failures(failures, {})] == ["", "Promise a", ""]


def test_failures_without_a_common_cause_are_reported_separately():
    assert not any(check.follows for check in attribute_failures(checks("fails", "fails"), {}))


def test_the_page_shows_what_follows_below_its_cause_and_a_terminal_in_a_line():
    scored = attribute_failures(
        checks("fails", "fails", message="It is 3"), {}, named=True, once=True
    )
    result = Result(
        "", "hw2", "", "practice", tuple(scored), {"hat": "A wrong hat."}, (), "", "", "", {}
    )
    page = feedback.fragment(result)
    text = feedback.text(result)
    assert (
        page.index("Promise a") < page.index("Follows from this: 1 more") < page.index("Promise b")
    )
    assert page.count("It is 3") == 2 and page.count("<details") == page.count("</details>")
    assert "✗ Promise b (follows from: Promise a)" in text and text.count("It is 3") == 1


@pytest.mark.parametrize(
    ("points", "weights", "shares"),
    [
        (10, (1, 4, 3, 3), (1, 3.5, 3, 2.5)),
        (10, (1, 1, 1), (3.5, 3.5, 3)),
        (1, (1, 1, 1), (0.5, 0.5, 0)),
        (2, (5, 1), (1.5, 0.5)),
        (7.25, (1, 1), (3.75, 3.5)),
        (0, (1, 2), (0, 0)),
        (4, (0, 0), (3.5, 0.5)),
        (3, (2,), (3,)),
        (5, (0.5, 2), (1, 4)),
    ],
)
def test_left_over_half_points_go_to_the_largest_remainders(points, weights, shares):
    parts = split_points(Fraction(points), [Fraction(weight) for weight in weights])
    assert [float(weight) for weight in parts] == list(shares)


@pytest.mark.parametrize(
    ("outcomes", "knobs", "earnings", "follows"),
    [
        ("hff", {}, (4, 0, 0), ("", "", "")),
        ("hff", {"named": True}, (4, 0, 0), ("", "", "b")),
        ("hff", {"once": True}, (4, 0, 2), ("", "", "")),
        ("fff", {"named": True, "once": True}, (0, 2, 4), ("", "a", "a")),
        ("hhh", {"named": True, "once": True}, (4, 4, 4), ("", "", "")),
    ],
)
def test_failed_checks_earn_nothing_and_follow_from_a_named_mistake(
    outcomes, knobs, earnings, follows
):
    words = {"h": "holds", "f": "fails"}
    scored = attribute_failures(checks(*(words[outcome] for outcome in outcomes)), {}, **knobs)
    assert tuple(earned(scored)) == earnings
    assert tuple(outcome.follows.removeprefix("Promise ") for outcome in scored) == follows


def test_a_hidden_check_is_never_a_cause_or_a_consequence():
    a, b, c = checks("fails", "fails", "holds")
    hidden = [replace(a, hidden=True), b, c]
    scored = attribute_failures(hidden, {"c": "a", "b": "a"}, named=True)
    assert [scored_check.follows for scored_check in scored] == ["", "", ""]
    assert earned(scored) == [
        0,
        0,
        4,
    ]
    assert scored[2].message == ""
    same = [replace(check, kind="late") for check in (replace(a, hidden=True), b)]
    assert [scored_check.follows for scored_check in attribute_failures(same, {})] == ["", ""]


@pytest.mark.parametrize(
    ("first", "second", "follows"),
    [
        (("late", "x"), ("late", "y"), True),
        (("raised", "x"), ("raised", "x"), True),
        (("raised", "x"), ("raised", "y"), False),
        (("raised", "x"), ("died", "x"), False),
        (("", "x"), ("", "x"), False),
        (("late", "x"), ("raised", "x"), False),
    ],
)
def test_two_failures_share_a_cause_if_both_timed_out_or_have_the_same_message(
    first, second, follows
):
    failures = [
        replace(scored_check, kind=kind, message=message)
        for scored_check, (kind, message) in zip(
            checks("fails", "fails"), (first, second), strict=True
        )
    ]
    assert [scored_check.follows for scored_check in attribute_failures(failures, {})] == [
        "",
        "Promise a" if follows else "",
    ]
