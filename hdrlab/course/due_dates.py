"""When homeworks are due: in a week of the course, and on a date once the first day of the term is known."""

from collections.abc import Collection
from contextlib import suppress
from datetime import date, datetime, time, timedelta
from itertools import count
from typing import Any, NamedTuple

from hdrlab.errors import InputError

WEEKDAYS = ("Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday", "Sunday")
MAX_WEEK = 60


class DueInWeek(NamedTuple):
    """When a homework is due in a course without dates, such as Friday of week 3, 23:59 UTC.

    Attributes
    ----------
    week : the week of the course, counted from 1
    day : the weekday, such as "Friday"
    time : the time of that day, with its zone
    """

    week: int
    day: str
    time: time


Due = datetime | DueInWeek


def read(value: Any) -> Due:
    """Return when a homework is due, from its entry `due` in a plan.

    Raises
    ------
    InputError
        For anything but a date with time and zone, or a table of week, day and time.

    Examples
    --------
    >>> describe(read({"week": 3, "day": "Friday", "time": "23:59Z"}))
    'Friday of week 3, 23:59 UTC'
    """
    if isinstance(value, datetime) and value.tzinfo is not None:
        return value
    with suppress(TypeError, KeyError, ValueError):
        due = DueInWeek(value["week"], value["day"], time.fromisoformat(value["time"]))
        is_week = type(due.week) is int and 1 <= due.week <= MAX_WEEK
        if is_week and due.day in WEEKDAYS and due.time.tzinfo and len(value) == len(due):
            return due
    raise InputError(
        "expected due as a date with time and zone, or as a table such as "
        f'{{ week = 3, day = "Friday", time = "23:59Z" }}, got {value!s:.80}'
    )


def date_in_term(due: Due, first_day: date | None, holidays: Collection[date] = ()) -> Due:
    """Return the date and time when a homework is due in a term, or what was given without a term.

    Parameters
    ----------
    due : a date stays as it is
    first_day : the first day of the first week of the course
    holidays : dates, any day of each week without a class; these weeks are not counted

    Raises
    ------
    InputError
        For a term after the year 9999.

    Examples
    --------
    >>> friday = DueInWeek(3, "Friday", time.fromisoformat("23:59Z"))
    >>> describe(date_in_term(friday, date(2027, 2, 8)))
    'Friday, 26 February 2027, 23:59 UTC'
    >>> describe(date_in_term(friday, date(2027, 2, 8), [date(2027, 2, 17)]))
    'Friday, 05 March 2027, 23:59 UTC'
    """
    if isinstance(due, datetime) or first_day is None:
        return due
    free_weeks = {(day - first_day).days // 7 for day in holidays}
    class_weeks = (week for week in count() if week not in free_weeks)
    week = [next(class_weeks) for _ in range(due.week)][-1]
    days_into_week = (WEEKDAYS.index(due.day) - first_day.weekday()) % 7
    try:
        day = first_day + timedelta(weeks=week, days=days_into_week)
    except OverflowError:
        raise InputError(f"expected a first day before the year 9999, got {first_day}") from None
    return datetime.combine(day, due.time)


def describe(due: Due) -> str:
    """Return when a homework is due in words."""
    if isinstance(due, DueInWeek):
        return f"{due.day} of week {due.week}, {due.time:%H:%M} {due.time.tzname()}"
    return f"{due:%A, %d %B %Y, %H:%M} {due.tzname()}"
