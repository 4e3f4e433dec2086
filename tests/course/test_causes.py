"""One mistake costs once, in whole and half points."""

from fractions import Fraction

import pytest
import scoring

from hdrlab.course import plan
from hdrlab.course.reports import causes, feedback
from hdrlab.course.reports.results import Check, Result


def checks(*outcomes, points=4, **more):
    """Return checks a, b, c ... of a task."""
    return [
        Check("hat", name, f"Promise {name}", Fraction(), Fraction(points), outcome, **more)
        for name, outcome in zip("abcdef", outcomes, strict=False)
    ]


def earned(found):
    return [float(one.points) for one in found]


@pytest.mark.parametrize("points", ["10", "7.5", "1", "7.25", "0"])
@pytest.mark.parametrize("weights", [(1, 4, 3, 3), (1, 1, 1), (14, 6, 6, 2, 3, 1), (5,)])
def test_shares_sum_to_the_points_and_are_whole_or_half_where_these_are(points, weights):
    shares = causes.in_halves(Fraction(points), [Fraction(one) for one in weights])
    assert sum(shares) == Fraction(points) and min(shares) >= 0
    assert sum(2 * one != int(2 * one) for one in shares) <= (points == "7.25")


def test_every_promise_of_the_plan_is_worth_something():
    for homework in plan.read().homeworks.values():
        for task in homework.tasks:
            weights = [Fraction(points) for _, _, points, *_ in scoring.checks(task.id)]
            assert min(causes.in_halves(Fraction(task.points), weights)) >= Fraction(1, 2), task.id


def test_a_named_mistake_costs_half_at_most_and_the_rest_follows_from_the_first():
    found = causes.traced(checks("holds", "fails", "fails", "fails"), {}, named=True, once=True)
    assert earned(found) == [4, 0, 0, 4]
    assert [one.follows for one in found] == ["", "", "Promise b", "Promise b"]


def test_one_that_misses_what_the_task_is_about_costs_all_that_fails():
    found = causes.traced(checks("holds", "fails", "fails"), {}, named=True)
    assert earned(found) == [4, 0, 0] and found[2].follows == "Promise b"


def test_half_of_an_odd_number_of_points_is_half_a_point():
    found = causes.traced(checks("fails", "fails", "fails", points=5), {}, named=True, once=True)
    assert sum(earned(found)) == 7.5


def test_what_needs_a_failed_promise_follows_from_it_or_holds_without_points():
    found = causes.traced(checks("fails", "fails", "holds", "fails"), {"b": "a", "c": "a", "d": "b"})
    assert [one.follows for one in found] == ["", "Promise a", "", "Promise a"]
    assert earned(found) == [0, 0, 0, 0] and "where this holds, too: Promise a" in found[2].message


def test_calls_that_end_in_the_same_words_are_told_once():
    said = [{"kind": "raised", "message": one} for one in ("IndexError", "IndexError", "KeyError")]
    each = [one._replace(**words) for one, words in zip(checks(*3 * ["no answer"]), said, strict=True)]
    assert [one.follows for one in causes.traced(each, {})] == ["", "Promise a", ""]


def test_failures_without_a_common_cause_are_told_each():
    assert not any(one.follows for one in causes.traced(checks("fails", "fails"), {}))


def test_the_page_shows_what_follows_below_its_cause_and_a_terminal_in_a_line():
    found = causes.traced(checks("fails", "fails", message="It is 3"), {}, named=True, once=True)
    result = Result("", "hw2", "", "practice", tuple(found), {"hat": "A wrong hat."}, (), "", "", "", {})
    page, text = feedback.fragment(result), feedback.text(result)
    assert page.index("Promise a") < page.index("Follows from this: 1 more") < page.index("Promise b")
    assert page.count("It is 3") == 2 and page.count("<details") == page.count("</details>")
    assert "✗ Promise b (follows from: Promise a)" in text and text.count("It is 3") == 1
