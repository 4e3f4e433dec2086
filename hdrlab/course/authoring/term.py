"""Move a course plan to a term: write the first day and the weeks without a class into its text."""

import re
from collections.abc import Collection
from datetime import date
from pathlib import Path

from hdrlab.errors import InputError

# the dates of a term, with the comment behind them; a list of holidays may take several lines
DATES_OF_TERM = re.compile(r"^(first_day\s*=|holidays\s*=\s*\[[^\]]*\]).*\n", re.MULTILINE)
COMMENTS_AT_TOP = re.compile(r"(#.*\n|\s*\n)*")


def move(text: str, first_day: date, holidays: Collection[date] = ()) -> str:
    r"""Return a plan's text for the term that begins on a day.

    Parameters
    ----------
    text : str
        The plan in TOML. Its entries `first_day` and `holidays`, if there are any, are replaced.
    first_day : date
        The first day of the first week of the course.
    holidays : dates
        Any day of each week without a class.

    Examples
    --------
    >>> print(move("# Our plan.\n[hw1]\n", date(2027, 2, 8), [date(2027, 2, 17)]))
    # Our plan.
    first_day = 2027-02-08
    holidays = [2027-02-17]
    [hw1]
    <BLANKLINE>
    """
    without = DATES_OF_TERM.sub("", text)
    lines = f"first_day = {first_day.isoformat()}\n"
    if holidays:
        lines += f"holidays = [{', '.join(day.isoformat() for day in sorted(set(holidays)))}]\n"
    end_of_comments = COMMENTS_AT_TOP.match(without).end()  # type: ignore[union-attr]
    return without[:end_of_comments] + lines + without[end_of_comments:]


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
