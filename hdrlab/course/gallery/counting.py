"""How ballots become places: approval voting, in which nobody's order of their favourites is asked.

b   ballots   a set of artifacts each: those that the voter marks, at most so many, none of the own team
v   votes     v_a = the number of ballots that mark a
p   places    p_a = 1 + the number of artifacts with more votes than a

Equal votes share a place, and ties are not broken: 1, 2, 2, 4. With marks of one weight nobody gains by
marking a favourite lower than it is liked, and who marks fewer gives away nothing.
"""

from collections import Counter
from collections.abc import Iterable, Set
from typing import NamedTuple

METHOD = (
    "Each voter marks up to {marks} artifacts of other teams, and every mark is one vote. "
    "Equal votes share a place, and the place after them counts them all: 1, 2, 2, 4. Ties are not broken."
)


class Standing(NamedTuple):
    """An artifact's votes and place, and with how many others it shares that place."""

    artifact: str
    votes: int
    place: int
    shared: int


def standings(artifacts: Iterable[str], ballots: Iterable[Set[str]]) -> list[Standing]:
    """Return the artifacts from the first place to the last; those of one place in the order of their ids.

    Examples
    --------
    >>> [(row.artifact, row.votes, row.place) for row in standings("abcd", [{"a", "b"}, {"b", "c"}, set()])]
    [('b', 2, 1), ('a', 1, 2), ('c', 1, 2), ('d', 0, 4)]
    """
    votes = Counter(dict.fromkeys(artifacts, 0))
    for ballot in ballots:
        votes.update(ballot & votes.keys())
    ranks = Counter(votes.values())
    place = {v: 1 + sum(count for more, count in ranks.items() if more > v) for v in ranks}
    rows = [Standing(one, v, place[v], ranks[v] - 1) for one, v in votes.items()]
    return sorted(rows, key=lambda row: (row.place, row.artifact))
