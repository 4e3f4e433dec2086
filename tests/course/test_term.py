"""The weeks of a course plan become dates when the first day of the term is known."""

from datetime import date, datetime, timedelta

import pytest
from click.testing import CliRunner

from hdrlab import cli
from hdrlab.course import due_dates, plan
from hdrlab.course.authoring import term
from hdrlab.course.due_dates import DueInWeek
from hdrlab.errors import InputError

TEXT = plan.PLAN.read_text(encoding="utf8")
MONDAY = date(2031, 2, 10)


@pytest.fixture
def in_term(tmp_path):
    """Return a function that returns the homeworks of the course plan for a term."""

    def read(first_day, holidays=()):
        path = tmp_path / "plan.toml"
        path.write_text(term.move(TEXT, first_day, holidays), encoding="utf8")
        return plan.read(path).homeworks

    return read


def test_the_plan_of_hdrlab_has_weeks_and_no_date_that_could_pass():
    assert all(isinstance(homework.due, DueInWeek) for homework in plan.read().homeworks.values())


@pytest.mark.parametrize("first_day", [MONDAY, MONDAY + timedelta(2), MONDAY + timedelta(6)])
def test_a_date_is_on_the_weekday_and_in_the_week_of_the_plan(first_day, in_term):
    homeworks = in_term(first_day)
    for name, homework in plan.read().homeworks.items():
        date_and_time = homeworks[name].due
        days = (date_and_time.date() - first_day).days
        assert days // 7 == homework.due.week - 1
        assert f"{date_and_time:%A}" == homework.due.day
        assert date_and_time.timetz() == homework.due.time


def test_dates_from_a_week_without_a_class_on_come_a_week_later(in_term):
    free = date(2031, 3, 12)  # a Wednesday of the fifth week
    plain = in_term(MONDAY)
    moved = in_term(MONDAY, [free])
    for name, homework in plan.read().homeworks.items():
        later = moved[name].due - plain[name].due
        assert later == timedelta(weeks=1 if homework.due.week >= 5 else 0)


def test_two_holidays_in_a_week_cost_one_week(in_term):
    with_a_holiday = in_term(MONDAY, [date(2031, 3, 10)])
    assert in_term(MONDAY, [date(2031, 3, 10), date(2031, 3, 16)]) == with_a_holiday


def test_only_the_lines_of_the_term_change_when_a_plan_is_moved_again():
    moved = term.move(TEXT, MONDAY, [date(2031, 3, 10)])
    again = term.move(moved, date(2032, 9, 20))
    assert set(moved.splitlines()) - set(TEXT.splitlines()) == {
        "first_day = 2031-02-10",
        "holidays = [2031-03-10]",
    }
    assert set(again.splitlines()) - set(TEXT.splitlines()) == {"first_day = 2032-09-20"}
    assert term.move(moved, MONDAY, [date(2031, 3, 10)]) == moved


def test_holidays_on_several_lines_are_replaced_whole():
    text = "holidays = [\n  2030-12-24, # a feast\n  2030-12-31,\n]\n[hw1]\n"
    assert term.move(text, MONDAY) == "first_day = 2031-02-10\n[hw1]\n"


def test_a_term_after_the_last_year_of_the_calendar_is_refused():
    week = DueInWeek(10, "Friday", datetime.fromisoformat("2031-01-01T12:00Z").timetz())
    with pytest.raises(InputError, match="before the year 9999, got 9999-12-27"):
        due_dates.date_in_term(week, date(9999, 12, 27))


@pytest.mark.parametrize(
    "due",
    [
        {"week": 0, "day": "Friday", "time": "23:59Z"},
        {"week": 10**9, "day": "Friday", "time": "23:59Z"},
        {"week": 3, "day": "Freitag", "time": "23:59Z"},
        {"week": 3, "day": "Friday", "time": "23:59"},
        {"week": 3, "day": "Friday"},
        {"week": 3, "day": "Friday", "time": "23:59Z", "weak": 1},
        "Friday",
    ],
)
def test_an_invalid_due_date_is_refused_with_an_example(due):
    with pytest.raises(InputError, match=r"expected due as .* week = 3, day = "):
        due_dates.read(due)


def test_a_fixed_date_stays_in_every_term():
    fixed = datetime.fromisoformat("2027-02-26T23:59:00Z")
    assert due_dates.date_in_term(fixed, MONDAY) == fixed


@pytest.mark.parametrize(
    "line", ["first_day = 7", "holidays = 2031-03-10", "holidays = ['Easter']"]
)
def test_a_term_that_is_no_date_is_refused(line, tmp_path):
    path = tmp_path / "plan.toml"
    path.write_text(f"{line}\n{TEXT}", encoding="utf8")
    with pytest.raises(InputError, match=r"plan\.toml: expected .*dates"):
        plan.read(path)


def test_a_line_of_the_holidays_that_is_no_date_is_named(tmp_path):
    path = tmp_path / "free.txt"
    path.write_text("2031-03-10  # spring break\n\n10.3.2031\n", encoding="utf8")
    with pytest.raises(InputError, match=r"free\.txt, line 3: expected a date.*10\.3\.2031"):
        term.read_holidays(path)


def test_the_command_writes_a_plan_of_its_own_and_lists_the_dates(tmp_path):
    out = tmp_path / "our-plan.toml"
    result = CliRunner().invoke(cli.main, ["course", "move", "2031-02-10", "-o", str(out)])
    assert result.exit_code == 0, result.output
    assert "hw1: Friday, 28 February 2031, 23:59 UTC" in result.output
    assert plan.read(out).first_day == MONDAY
    text = out.read_text(encoding="utf8")
    again = ["course", "move", "2031-02-17", "--plan", str(out), "-o", str(out)]
    assert CliRunner().invoke(cli.main, again).exit_code != 0
    assert out.read_text(encoding="utf8") == text


def test_the_command_says_which_dates_it_did_not_change(tmp_path):
    own = tmp_path / "own.toml"
    out = tmp_path / "moved.toml"
    own.write_text(
        TEXT.replace('{ week = 3, day = "Friday", time = "23:59Z" }', "2031-03-01T12:00:00Z")
    )
    words = ["course", "move", "2031-02-17", "--plan", str(own), "-o", str(out)]
    result = CliRunner().invoke(cli.main, words)
    assert "the date of hw1 did not change" in result.stderr


def test_a_plan_with_holidays_keeps_them_unless_others_are_given(tmp_path):
    first = tmp_path / "first.toml"
    second = tmp_path / "second.toml"
    first.write_text(term.move(TEXT, MONDAY, [date(2031, 3, 10)]), encoding="utf8")
    words = ["course", "move", "2031-02-17", "--plan", str(first), "-o", str(second)]
    assert CliRunner().invoke(cli.main, words).exit_code == 0
    assert plan.read(second).holidays == (date(2031, 3, 10),)
