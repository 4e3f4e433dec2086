"""Late days: ten free days, then one point a day; each team member has their own."""

from dataclasses import replace
from datetime import datetime, timedelta

import pytest
from hypothesis import given, strategies as st

from hdrlab.course.students.late_days import LateRecord, charge_late_days, days_late, what_if

ANNA = "anna"
BEN = "ben"
CY = "cy"
days = st.integers(0, 40)
points = st.floats(0, 100)
terms = st.lists(
    st.tuples(days, st.sampled_from([(ANNA,), (BEN,), (ANNA, BEN), (ANNA, CY)]), points), max_size=6
).map(lambda rows: [LateRecord(f"hw{k}", *row) for k, row in enumerate(rows)])


def costs(handed, **knobs):
    return {
        (charge.student, charge.project): charge for charge in charge_late_days(handed, **knobs)
    }


def test_ten_days_in_all_are_free_and_the_eleventh_costs_a_point():
    charges = costs(
        [
            LateRecord("hw1", 4, (ANNA,), 100),
            LateRecord("hw2", 6, (ANNA,), 100),
            LateRecord("hw3", 1, (ANNA,), 100),
        ]
    )
    assert [charges[ANNA, f"hw{k}"].penalty for k in (1, 2, 3)] == [0, 0, 1]
    assert [charges[ANNA, f"hw{k}"].left for k in (1, 2, 3)] == [6, 0, 0]


def test_a_project_costs_no_more_than_it_is_worth():
    charge = costs([LateRecord("hw1", 500, (ANNA,), 87.5)])[ANNA, "hw1"]
    assert (charge.penalty, charge.score) == (87.5, 0)


def test_a_project_without_points_loses_none_and_takes_none_from_another():
    charges = costs([LateRecord("hw1", 500, (ANNA,), 80), LateRecord("hw2", 3, (ANNA,), 90)])
    assert (charges[ANNA, "hw1"].score, charges[ANNA, "hw2"].score) == (0, 87)


def test_each_member_of_a_late_team_pays_with_their_own_free_days():
    charges = costs(
        [LateRecord("hw1", 9, (ANNA,), 100), LateRecord("project", 3, (ANNA, BEN), 100)]
    )
    assert (charges[ANNA, "project"].penalty, charges[BEN, "project"].penalty) == (2, 0)
    assert (charges[ANNA, "project"].left, charges[BEN, "project"].left) == (0, 7)


@given(terms)
def test_free_days_that_a_partner_used_elsewhere_do_not_change_a_students_score(term):
    alone = [replace(record, students=(ANNA,)) for record in term if ANNA in record.students]
    together = {key: record for key, record in costs(term).items() if key[0] == ANNA}
    assert together == costs(alone)


@given(terms, st.integers(0, 12))
def test_free_days_are_limited_and_every_late_day_beyond_them_costs(term, grace):
    charges = costs(term, grace=grace)
    for student in (ANNA, BEN, CY):
        mine = [charge for (who, _), charge in charges.items() if who == student]
        assert sum(charge.excused for charge in mine) <= grace
        assert all(charge.score >= 0 and 0 <= charge.excused <= charge.late for charge in mine)
        assert all(
            charge.penalty == min(charge.penalty + charge.score, charge.late - charge.excused)
            for charge in mine
        )


@given(terms, days, points)
def test_a_later_project_does_not_change_an_earlier_one(term, late, worth):
    before = costs(term)
    after = costs([*term, LateRecord("last", late, (ANNA, BEN), worth)])
    assert {key: after[key] for key in before} == before


@given(terms, days)
def test_another_day_late_never_raises_a_score(term, late):
    if term:
        term = [replace(record, project=f"hw{k}") for k, record in enumerate(term)]
        rows = what_if(term, "hw0", (late, late + 1))
        assert all(
            rows[1][1][student].score <= record.score for student, record in rows[0][1].items()
        )


def test_the_what_if_table_equals_the_charge_for_each_number_of_late_days():
    term = [LateRecord("hw1", 7, (ANNA,), 100), LateRecord("project", 0, (ANNA, BEN), 90)]
    for late, rows in what_if(term, "project"):
        assert rows == {
            who: costs([term[0], replace(term[1], late=late)])[who, "project"]
            for who in (ANNA, BEN)
        }
    assert [rows[ANNA].penalty for _, rows in what_if(term, "project", (3, 4, 99))] == [0, 1, 90]


def test_a_started_day_counts_as_a_late_day_in_every_time_zone():
    due = datetime.fromisoformat("2026-03-28T23:59:00+01:00")  # the clocks change in this night
    received = datetime.fromisoformat("2026-03-29T23:59:00+02:00")  # 23 hours later
    assert days_late(due, received) == 1
    assert days_late(due, due - timedelta(days=3)) == 0
    assert days_late(due, due + timedelta(days=2, seconds=1)) == 3


def test_times_without_a_zone_are_refused():
    with pytest.raises(ValueError, match="zone"):
        days_late(datetime(2026, 3, 1), datetime(2026, 3, 2))


@pytest.mark.parametrize(
    ("handed", "message"),
    [
        ([LateRecord("hw1", -1, (ANNA,), 9)], "late days"),
        ([LateRecord("hw1", 0, (ANNA, ANNA), 9)], "twice"),
        ([LateRecord("hw1", 0, (ANNA,), 9), LateRecord("hw1", 1, (ANNA,), 9)], "twice"),
    ],
)
def test_meaningless_late_records_are_refused(handed, message):
    with pytest.raises(ValueError, match=message):
        list(charge_late_days(handed))
    with pytest.raises(ValueError, match="handed in"):
        what_if([], "hw1")


@pytest.mark.parametrize("terms", [{"grace": -1}, {"per_day": -0.5}])
def test_negative_days_and_points_are_refused_and_zero_is_accepted(terms):
    handed = [LateRecord("hw1", 2, (ANNA,), 9)]
    with pytest.raises(ValueError, match="at least 0"):
        list(charge_late_days(handed, **terms))
    (account,) = charge_late_days(handed, **dict.fromkeys(terms, 0))
    assert account.score == (7 if "grace" in terms else 9)
