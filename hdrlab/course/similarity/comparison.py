"""Compare the code of all submissions of a class (Schleimer, Wilkerson and Aiken, 2003).

copydetect turns Python into tokens: every name becomes V, every string S, and comments and spaces
are dropped. Each run of `RUN_TOKENS` tokens gets a fingerprint, and passages are similar where
fingerprints agree. All fingerprints count: winnowing would select some by Python's hash, which
differs from process to process.

tokens    of a submission: those in a fingerprint that neither the handout nor the library has
covered   (n, n): tokens of submission a in fingerprints that b has, too
fraction  covered / tokens: (n, n), of a in b, so not symmetric
"""

import copy
import io
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set as AbstractSet
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from copydetect import CodeFingerprint, compare_files
from copydetect.utils import get_token_coverage
from scipy.sparse import csr_array

from hdrlab.course.similarity.student_code import TeamCode

RUN_TOKENS = 25  # length of the shortest passage that counts
MIN_TASK_TOKENS = 100  # a shorter function is not compared
MIN_COUNTED_TOKENS = (
    250  # one task, or all tasks together, must be this long to make a pair similar
)
MIN_LISTED_FRACTION = 0.6  # pairs from this fraction on are listed
HISTOGRAM_BINS = 10


class FingerprintedCode(NamedTuple):
    """The code of one team, and the fingerprints of each of its tasks."""

    code: TeamCode
    tasks: dict[str, CodeFingerprint]


@dataclass(frozen=True)
class Pair:
    """Two submissions by their indices, and how much of each is also in the other.

    Attributes
    ----------
    first, second : indices of the submissions
    fraction : the larger of the two fractions
    first_in_second, second_in_first : fractions, -1 where too little could be compared
    """

    first: int
    second: int
    fraction: float
    first_in_second: float
    second_in_first: float


@dataclass(frozen=True)
class SimilarityReport:
    """The result of comparing a class.

    Attributes
    ----------
    pairs : the listed pairs, the most similar first
    counts : (HISTOGRAM_BINS,) number of pairs in each bin of the fraction
    own : for each task, the fingerprints of the submissions that have enough code of their own, by
        index
    short : for each task, the number of submissions that have less
    library : for each task, the fraction of each submission that is also in the library, by index
    """

    pairs: list[Pair]
    counts: np.ndarray
    own: dict[str, dict[int, CodeFingerprint]]
    short: dict[str, int]
    library: dict[str, dict[int, float]]


def fingerprint(text: str) -> CodeFingerprint:
    r"""Return the fingerprints of Python source.

    Examples
    --------
    >>> text = "def f(Z):\n    return [2 * Z[k] for k in Z]  # twice"
    >>> first, second = fingerprint(text), fingerprint(text.replace("Z", "pixels"))
    >>> first.filtered_code, first.hashes == second.hashes
    ('defF(V):return[2*V[V]forVinV]', True)
    """
    return CodeFingerprint("work.py", RUN_TOKENS, 1, fp=io.StringIO(text), language="python")


def without(prints: CodeFingerprint, removed: AbstractSet[int]) -> CodeFingerprint:
    """Return fingerprints without the removed ones.

    copydetect can remove them itself, but loses the first of two places of a repeated passage.
    """
    rest = copy.copy(prints)
    rest.hashes = prints.hashes - removed
    rest.hash_idx = {mark: at for mark, at in prints.hash_idx.items() if mark not in removed}
    length = len(prints.filtered_code)
    rest.token_coverage = int(get_token_coverage(rest.hash_idx, RUN_TOKENS, length))
    return rest


def fingerprint_steps(codes: Iterable[TeamCode]) -> Iterator[FingerprintedCode]:
    """Yield the code of each team with its fingerprints; equal texts share theirs."""
    known: dict[str, CodeFingerprint] = {}
    for code in codes:
        for text in code.texts.values():
            if text not in known:
                known[text] = fingerprint(text)
        yield FingerprintedCode(code, {task: known[text] for task, text in code.texts.items()})


def compare(
    submissions: Sequence[FingerprintedCode], given: Sequence[str] = (), library: str = ""
) -> SimilarityReport:
    r"""Compare all submissions with each other, those of one team aside.

    Parameters
    ----------
    submissions : the code of each team
    given : texts that every student was given
    library : hdrlab's own source of the tasks, which every student can read

    Examples
    --------
    >>> text = "def f(Z):\n    total = 0\n" + "".join(f"    total += {k} * Z[{k}]\n" for k in range(30))
    >>> codes = [TeamCode("a", {"f": text}), TeamCode("b", {"f": text.replace("Z", "levels")})]
    >>> [pair] = compare(list(fingerprint_steps(codes))).pairs
    >>> pair.first, pair.second, pair.fraction
    (0, 1, 1.0)
    """
    handout = {mark for text in given for mark in fingerprint(text).hashes}
    library_prints = without(fingerprint(library), handout)
    prints_by_text = {
        prints.raw_code: prints for code in submissions for prints in code.tasks.values()
    }
    in_library: dict[str, float] = {}
    own_prints: dict[str, CodeFingerprint] = {}
    for text, prints in prints_by_text.items():
        written = without(prints, handout)
        if written.token_coverage >= MIN_TASK_TOKENS:
            _, fractions, _ = compare_files(written, library_prints)
            in_library[text] = float(fractions[0])
            own_prints[text] = without(written, library_prints.hashes)

    own: dict[str, dict[int, CodeFingerprint]] = {}
    short: dict[str, int] = {}
    copied: dict[str, dict[int, float]] = {}
    for task in dict.fromkeys(task for code in submissions for task in code.tasks):
        own[task] = {}
        short[task] = 0
        copied[task] = {}
        for index, code in enumerate(submissions):
            if task not in code.tasks:
                continue
            text = code.tasks[task].raw_code
            if text in in_library:
                copied[task][index] = in_library[text]
            if text in own_prints and own_prints[text].token_coverage >= MIN_TASK_TOKENS:
                own[task][index] = own_prints[text]
            else:
                short[task] += 1
    teams = [code.code.team for code in submissions]
    pairs, counts = _list_pairs(teams, similar_fractions(len(submissions), own))
    return SimilarityReport(pairs, counts, own, short, copied)


def similar_fractions(n: int, own: Mapping[str, Mapping[int, CodeFingerprint]]) -> np.ndarray:
    """Return (n, n), the largest fraction of each submission in each other; -1 where both are short.

    It is the fraction of all tasks together that both have, or of one task that is long by itself.
    """
    covered_tokens = np.zeros((n, n))
    all_tokens = np.zeros((n, n))
    best = np.full((n, n), -1.0)
    for prints in own.values():
        if not prints:
            continue
        block = np.ix_(list(prints), list(prints))
        task_covered = covered(list(prints.values()))
        task_tokens = np.array([item.token_coverage for item in prints.values()])[:, None]
        covered_tokens[block] += task_covered
        all_tokens[block] += task_tokens
        is_long = task_tokens >= MIN_COUNTED_TOKENS
        best[block] = np.maximum(best[block], np.where(is_long, task_covered / task_tokens, -1))
    is_long = all_tokens >= MIN_COUNTED_TOKENS
    together = np.where(is_long, covered_tokens / np.maximum(all_tokens, 1), -1)
    return np.maximum(best, together)


def covered(prints: Sequence[CodeFingerprint]) -> np.ndarray:
    """Return (n, n): for each pair, the tokens of the first that lie in fingerprints of both.

    `copydetect.compare_files` counts the same for one pair; this counts one with all others.
    """
    places = []  # for each submission the start of each of its fingerprints
    marks = []  # and the fingerprints themselves
    for item in prints:
        starts = [
            (mark, start) for mark, all_starts in item.hash_idx.items() for start in all_starts
        ]
        marks.append(np.array([mark for mark, _ in starts], int))
        places.append(np.array([start for _, start in starts], int))
    sizes = [len(item) for item in marks]
    known, column = np.unique(np.concatenate(marks), return_inverse=True)
    holder = np.repeat(np.arange(len(prints)), sizes)
    shape = (len(known), len(prints))
    has = csr_array((np.ones(len(column), bool), (column, holder)), shape=shape)
    result = np.zeros((len(prints), len(prints)))
    columns = np.split(column, np.cumsum(sizes)[:-1])
    for index, (start, own_columns) in enumerate(zip(places, columns, strict=True)):
        held = has[own_columns].toarray().astype(np.int8)
        change = np.zeros((len(prints[index].filtered_code) + 1, len(prints)), np.int8)
        change[start] = held
        change[start + RUN_TOKENS] -= held
        # at most RUN_TOKENS fingerprints cover a token, which fits into int8
        result[index] = (np.cumsum(change, axis=0, dtype=np.int8) > 0).sum(axis=0)
    return result


def _list_pairs(teams: Sequence[str], fractions: np.ndarray) -> tuple[list[Pair], np.ndarray]:
    """Return the pairs from MIN_LISTED_FRACTION on, the most similar first, and the histogram of all."""
    first, second = np.triu_indices(len(teams), 1)
    names = np.array(teams)
    largest = np.maximum(fractions, fractions.T)[first, second]
    is_compared = (names[first] != names[second]) & (largest >= 0)
    listed = np.flatnonzero(is_compared & (largest >= MIN_LISTED_FRACTION))
    listed = listed[np.argsort(-largest[listed], kind="stable")]
    pairs = [
        Pair(
            first=int(a),
            second=int(b),
            fraction=float(largest[index]),
            first_in_second=float(fractions[a, b]),
            second_in_first=float(fractions[b, a]),
        )
        for index, a, b in zip(listed, first[listed], second[listed], strict=True)
    ]
    counts, _ = np.histogram(largest[is_compared], HISTOGRAM_BINS, (0, 1))
    return pairs, counts
