"""Move a course plan to another term: all due dates keep their week of the course and their weekday."""

import re
from collections.abc import Collection, Sequence
from datetime import date, timedelta
from itertools import count
from pathlib import Path
from typing import NamedTuple

from hdrlab.errors import InputError

# A line of a plan with a date. Other lines, and comments, stay as they are.
FIRST_DAY = re.compile(r"^(?P<key>first_day\s*=\s*)(?P<date>\d{4}-\d\d-\d\d)", re.MULTILINE)
DUE = re.compile(r"^(?P<key>due\s*=\s*)(?P<date>\d{4}-\d\d-\d\d)", re.MULTILINE)
DAYS_PER_WEEK = 7


class MovedDates(NamedTuple):
    """A plan's text for another term, and its due dates before and after, in the order of the text."""

    text: str
    before: Sequence[date]
    after: Sequence[date]


def move(text: str, first_day: date, holidays: Collection[date] = ()) -> MovedDates:
    r"""Move all dates of a plan to a term that begins on another day.

    A date in week k of the old term is afterwards in the k-th week of the new term that has a class.

    Parameters
    ----------
    text : str
        The plan in TOML. `first_day` is the first day of its first week.
    first_day : date
        The first day of the new term, on the same weekday as the old one.
    holidays : dates
        Any day of each week without a class.

    Raises
    ------
    InputError
        For a plan without `first_day`, a first day on another weekday, and a date before the term.

    Examples
    --------
    >>> plan = "first_day = 2026-09-21\n[hw1]\ndue = 2026-10-09T23:59:00Z\n"
    >>> print(move(plan, date(2027, 2, 8), [date(2027, 2, 17)]).text)
    first_day = 2027-02-08
    [hw1]
    due = 2027-03-05T23:59:00Z
    <BLANKLINE>
    """
    found = FIRST_DAY.search(text)
    if found is None:
        raise InputError(
            "the plan does not say when its first week begins; add a line such as "
            "first_day = 2026-09-21 above its first homework"
        )
    old_first_day = date.fromisoformat(found["date"])
    if first_day.weekday() != old_first_day.weekday():
        raise InputError(
            f"expected a {old_first_day:%A}, like the plan's first day {old_first_day}, "
            f"got {first_day}, a {first_day:%A}"
        )
    before = [date.fromisoformat(due["date"]) for due in DUE.finditer(text)]
    if before and min(before) < old_first_day:
        raise InputError(
            f"expected due dates from the plan's first day {old_first_day} on, got {min(before)}"
        )
    last_week = max((_week_of(due, old_first_day) for due in before), default=0)
    weeks = _list_class_weeks(first_day, holidays, last_week + 1)

    def move_date(day: date) -> date:
        week = _week_of(day, old_first_day)
        days_into_week = (day - old_first_day).days % DAYS_PER_WEEK
        return weeks[week] + timedelta(days_into_week)

    def move_line(line: re.Match[str]) -> str:
        return line["key"] + move_date(date.fromisoformat(line["date"])).isoformat()

    moved = DUE.sub(move_line, text)
    moved = FIRST_DAY.sub(rf"\g<key>{first_day.isoformat()}", moved)
    return MovedDates(text=moved, before=before, after=[move_date(due) for due in before])


def read_holidays(path: Path) -> list[date]:
    """Read a list of dates: one a line, such as 2027-03-29, and text after # is ignored.

    Raises
    ------
    InputError
        For a line that is no date; the message has the file and the line.
    """
    holidays = []
    for number, line in enumerate(path.read_text(encoding="utf8").splitlines(), 1):
        text = line.partition("#")[0].strip()
        if not text:
            continue
        try:
            holidays.append(date.fromisoformat(text))
        except ValueError:
            raise InputError(
                f"{path}, line {number}: expected a date such as 2027-03-29, got {text:.40}"
            ) from None
    return holidays


def _week_of(day: date, first_day: date) -> int:
    """Return the number of a day's week, counted from 0."""
    return (day - first_day).days // DAYS_PER_WEEK


def _list_class_weeks(first_day: date, holidays: Collection[date], number: int) -> list[date]:
    """Return the first days of so many weeks with a class."""
    free_weeks = {_week_of(day, first_day) for day in holidays}
    weeks: list[date] = []
    for week in count():
        if len(weeks) == number:
            break
        if week not in free_weeks:
            weeks.append(first_day + timedelta(weeks=week))
    return weeks
