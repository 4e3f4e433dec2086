"""Ask voters which of two artifacts is better, and collect the answers.

The gallery asks each voter about one pair after another, in an order that the gallery's secret
draws for the voter. It accepts an answer only about the pair that it asks, or a new answer about an
earlier pair, so nobody can choose which artifacts they judge. The pairs are a cyclic design: after a
random order a_0, a_1, ... come the pairs (a_i, a_i+1), then (a_i, a_i+2), and so on. So each voter
sees all artifacts about equally often.
"""

import sqlite3
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from hdrlab.core.arrays import F64
from hdrlab.course.gallery import bradley_terry, store, tokens
from hdrlab.course.gallery.ballots import NotAccepted

GRADEBOOK_COLUMNS = (
    "student",
    "name",
    "team",
    "pairs judged",
    "artifact",
    "votes for it",
    "votes on it",
    "percent",
    "percent from",
    "percent to",
)
METHOD = (
    "Each voter judged up to {pairs} pairs of artifacts of other teams. The percentages are the chance to be "
    "preferred to an average artifact of this gallery, in the model of Bradley and Terry, with 95 % "
    "intervals. Where two intervals overlap, other votes could have changed the order. The intervals "
    "assume that all voters have the same taste."
)


@dataclass(frozen=True)
class Question:
    """The pair that a voter is asked about, and how many pairs the voter has judged."""

    pair: tuple[str, str]
    judged: int
    total: int


@dataclass(frozen=True)
class PairStanding:
    """The result of an artifact.

    Attributes
    ----------
    artifact : its id
    won : number of votes for it
    votes : number of votes on pairs with it
    chance : the estimated probability that a voter prefers it to an average artifact
    low, high : the 95 % interval of `chance`
    """

    artifact: str
    won: int
    votes: int
    chance: float
    low: float
    high: float


def cyclic_pairs(ids: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield all pairs, each once, so that every artifact occurs about equally often from the first on.

    Examples
    --------
    >>> [a + b for a, b in cyclic_pairs("abcd")]
    ['ab', 'cd', 'bc', 'da', 'ac', 'bd']
    """
    count = len(ids)
    for offset in range(1, count // 2 + 1):
        starts = range(count)
        if 2 * offset == count:  # the second half of the circle has the same pairs
            starts = range(offset)
        # first the pairs that have no artifact in common with their neighbors
        for start in sorted(starts, key=lambda start: start // offset % 2):
            yield ids[start], ids[(start + offset) % count]


def read_answers(db: sqlite3.Connection, voter: str) -> dict[frozenset[str], str]:
    """Return the winner of each pair that a voter has judged, if both artifacts are on the wall.

    The pairs are in the order of the answers.
    """
    query = (
        "SELECT first, second, winner FROM comparisons WHERE voter = ? "
        "AND first IN (SELECT id FROM artifacts WHERE hangs) "
        "AND second IN (SELECT id FROM artifacts WHERE hangs) ORDER BY cast_at"
    )
    rows = db.execute(query, (voter,))
    return {frozenset((first, second)): winner for first, second, winner in rows}


def next_question(db: sqlite3.Connection, voter: store.Voter) -> Question | None:
    """Return the pair that a voter is asked about next, or None if there is none."""
    settings = store.settings(db)
    answers = read_answers(db, voter.id)
    others = [id for id, artifact in store.artifacts(db).items() if artifact.team != voter.team]
    total = max_questions(db, voter)
    if len(answers) >= total:
        return None
    for pair in cyclic_pairs(tokens.shuffled(others, settings.secret, voter.id)):
        if frozenset(pair) not in answers:
            return Question(pair=pair, judged=len(answers), total=total)
    return None


def last_question(db: sqlite3.Connection, voter: store.Voter) -> Question | None:
    """Return the pair that a voter has judged last, to judge it again, or None if there is none."""
    answers = list(read_answers(db, voter.id))
    if not answers:
        return None
    first, second = sorted(answers[-1])
    judged = len(answers) - 1
    return Question(pair=(first, second), judged=judged, total=max_questions(db, voter))


def max_questions(db: sqlite3.Connection, voter: store.Voter) -> int:
    """Return how many pairs a voter is asked about."""
    artifacts = store.artifacts(db).values()
    count = sum(artifact.team != voter.team for artifact in artifacts)
    return min(store.settings(db).pairs, count * (count - 1) // 2)


def cast(
    db: sqlite3.Connection, voter: store.Voter, pair: Sequence[str], winner: str, now: float
) -> None:
    """Store a voter's answer about a pair; an answer about the same pair replaces the earlier one.

    Call this within a transaction.

    Raises
    ------
    NotAccepted
        After the end of the vote, for a pair that the gallery did not ask about, and for a winner
        that is not in the pair.
    """
    if not store.settings(db).is_open(now):
        raise NotAccepted("The vote is closed. Your earlier answers count.")
    if len(set(pair)) != 2 or winner not in pair:
        raise NotAccepted("Choose one of the two artifacts.")
    question = next_question(db, voter)
    is_asked = question is not None and set(question.pair) == set(pair)
    if not is_asked and frozenset(pair) not in read_answers(db, voter.id):
        raise NotAccepted("The gallery does not ask you about this pair.")
    first, second = sorted(pair)
    insert = (
        "INSERT INTO comparisons VALUES (?, ?, ?, ?, ?) ON CONFLICT (voter, first, second) "
        "DO UPDATE SET winner = excluded.winner, cast_at = excluded.cast_at"
    )
    try:
        db.execute(insert, (voter.id, first, second, winner, now))
    except sqlite3.IntegrityError:  # the database has the same rules
        raise NotAccepted("The gallery does not ask you about this pair.") from None


def count_wins(db: sqlite3.Connection) -> tuple[list[str], F64]:
    """Return the artifacts on the wall, and how often each was preferred to each other."""
    ids = list(store.artifacts(db))
    index = {id: k for k, id in enumerate(ids)}
    wins = np.zeros((len(ids), len(ids)))
    for first, second, winner in db.execute("SELECT first, second, winner FROM comparisons"):
        if first in index and second in index:
            loser = second if winner == first else first
            wins[index[winner], index[loser]] += 1
    return ids, wins


def standings(ids: Sequence[str], wins: F64) -> list[PairStanding]:
    """Return the results of the artifacts, the strongest first."""
    strengths = bradley_terry.fit(wins)
    low, high = strengths.interval
    rows = [
        PairStanding(
            artifact=id,
            won=int(wins[k].sum()),
            votes=int(wins[k].sum() + wins[:, k].sum()),
            chance=float(strengths.chance[k]),
            low=float(low[k]),
            high=float(high[k]),
        )
        for k, id in enumerate(ids)
    ]
    return sorted(rows, key=lambda row: (-row.chance, row.artifact))


def count_voters(db: sqlite3.Connection) -> int:
    """Return how many voters have judged a pair."""
    (count,) = db.execute("SELECT count(DISTINCT voter) FROM comparisons").fetchone()
    return int(count)


def gradebook(db: sqlite3.Connection) -> Iterator[tuple[str | int, ...]]:
    """Yield a row for each voter: how many pairs they judged, but not how, and their artifact's result."""
    artifacts = store.artifacts(db)
    by_team = {artifacts[row.artifact].team: row for row in standings(*count_wins(db))}
    for voter in store.voters(db):
        result: tuple[str | int, ...] = ("",) * 6
        row = by_team.get(voter.team)
        if row is not None:
            percents = [round(100 * value) for value in (row.chance, row.low, row.high)]
            result = (artifacts[row.artifact].title, row.won, row.votes, *percents)
        yield (voter.id, voter.name, voter.team, len(read_answers(db, voter.id)), *result)
