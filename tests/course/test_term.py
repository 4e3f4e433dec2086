"""A plan is moved to another term: weeks, weekdays and times stay, and weeks without a class are left out."""

from datetime import date

import pytest
from click.testing import CliRunner

from hdrlab import cli
from hdrlab.course import plan
from hdrlab.course.authoring import term
from hdrlab.errors import InputError

TEXT = plan.PLAN.read_text(encoding="utf8")
MONDAY = date(2031, 2, 10)


def week(day, first_day):
    return (day - first_day).days // 7


def test_each_due_date_keeps_its_week_its_weekday_and_its_time(tmp_path):
    path = tmp_path / "plan.toml"
    path.write_text(term.move(TEXT, MONDAY).text, encoding="utf8")
    old, new = plan.read(), plan.read(path)
    assert new.first_day == MONDAY
    for name, homework in new.homeworks.items():
        due = old.homeworks[name].due
        assert homework.due.timetz() == due.timetz()
        assert homework.due.weekday() == due.weekday()
        assert week(homework.due.date(), MONDAY) == week(due.date(), old.first_day)


def test_nothing_but_dates_changes_and_the_way_back_gives_the_same_text():
    there = term.move(TEXT, MONDAY).text
    assert there != TEXT
    assert term.move(there, plan.read().first_day).text == TEXT


def test_dates_from_a_week_without_a_class_on_come_a_week_later():
    plain = term.move(TEXT, MONDAY).after
    free = date(2031, 3, 12)  # a Wednesday of the fifth week
    moved = term.move(TEXT, MONDAY, [free]).after
    assert {(b - a).days for a, b in zip(plain, moved, strict=True)} == {0, 7}
    for due, later in zip(plain, moved, strict=True):
        assert (later > due) == (week(due, MONDAY) >= week(free, MONDAY))
        assert week(later, MONDAY) != week(free, MONDAY)


def test_two_holidays_in_a_week_cost_one_week():
    one = term.move(TEXT, MONDAY, [date(2031, 3, 10)]).after
    assert term.move(TEXT, MONDAY, [date(2031, 3, 10), date(2031, 3, 16)]).after == one


@pytest.mark.parametrize(
    ("text", "first_day", "message"),
    [
        (TEXT, date(2031, 2, 11), "expected a Monday.*2031-02-11, a Tuesday"),
        (TEXT.replace("first_day", "# first_day"), MONDAY, "add a line such as first_day"),
        ("first_day = 2026-09-21\n[a]\ndue = 2026-09-20T12:00:00Z\n", MONDAY, "2026-09-20"),
    ],
)
def test_what_cannot_be_moved_is_said(text, first_day, message):
    with pytest.raises(InputError, match=message):
        term.move(text, first_day)


def test_a_line_of_the_holidays_that_is_no_date_is_named(tmp_path):
    path = tmp_path / "free.txt"
    path.write_text("2031-03-10  # spring break\n\n10.3.2031\n", encoding="utf8")
    with pytest.raises(InputError, match=r"free\.txt, line 3: expected a date.*10\.3\.2031"):
        term.read_holidays(path)


def test_the_command_writes_a_plan_of_its_own_and_lists_the_dates(tmp_path):
    out = tmp_path / "our-plan.toml"
    result = CliRunner().invoke(cli.main, ["course", "move", "2031-02-10", "-o", str(out)])
    assert result.exit_code == 0, result.output
    due = plan.read(out).homeworks["hw1"].due
    assert f"-> {due:%a %d %b %Y}" in result.output
    assert plan.read(out).first_day == MONDAY
    text = out.read_text(encoding="utf8")
    again = ["course", "move", "2031-02-17", "--plan", str(out), "-o", str(out)]
    assert CliRunner().invoke(cli.main, again).exit_code != 0
    assert out.read_text(encoding="utf8") == text
