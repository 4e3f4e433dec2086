"""How alike the works of a class are: what of one stands in another (Schleimer, Wilkerson and Aiken, 2003).

copydetect reads Python as signs: every name is V, every string S, comments and spaces are nothing.
It takes a
fingerprint of each run of `RUN` signs. A passage is alike where these are the same. All fingerprints count:
winnowing would choose some of them by Python's hash, which is another one in each process.

signs    of a work: those that lie in a fingerprint which neither the handout nor the library has
covered  (n, n): signs of work a that lie in fingerprints which b has, too
share    covered / signs: (n, n), of a in b, so not symmetric
"""

import copy
import io
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set as AbstractSet
from typing import NamedTuple

import numpy as np
from copydetect import CodeFingerprint, compare_files
from copydetect.utils import get_token_coverage
from scipy.sparse import csr_array

from hdrlab.course.overlap.authored import Work

RUN = 25  # signs of the shortest passage that counts
SHORT = 100  # signs of a task, below which it is not compared
LONG = 250  # signs, from which a task counts by itself, and all that are compared together
THRESHOLD = 0.6  # of the share, from which a pair is looked at
BINS = 10  # of the shares of all pairs


class Printed(NamedTuple):
    """A work, and the fingerprints of each of its tasks."""

    work: Work
    tasks: dict[str, CodeFingerprint]


class Pair(NamedTuple):
    """Two works by their places, the largest share between them, and that of each in the other."""

    one: int
    other: int
    share: float
    forth: float
    back: float


class Likeness(NamedTuple):
    """What was found in a class.

    Attributes
    ----------
    pairs : at or above the threshold, the most alike first
    counts : (BINS,) how many pairs have such a share
    own : of each task, the fingerprints of those works that have enough of their own, by their
        places
    short : of each task, how many works have less
    library : of each task, the works by their places, and what of each stands in the library
    """

    pairs: list[Pair]
    counts: np.ndarray
    own: dict[str, dict[int, CodeFingerprint]]
    short: dict[str, int]
    library: dict[str, dict[int, float]]


def fingerprint(text: str) -> CodeFingerprint:
    r"""Return the fingerprints of a text of Python.

    Examples
    --------
    >>> text = "def f(Z):\n    return [2 * Z[k] for k in Z]  # twice"
    >>> one, other = fingerprint(text), fingerprint(text.replace("Z", "pixels"))
    >>> one.filtered_code, one.hashes == other.hashes
    ('defF(V):return[2*V[V]forVinV]', True)
    """
    return CodeFingerprint("work.py", RUN, 1, fp=io.StringIO(text), language="python")


def without(one: CodeFingerprint, given: AbstractSet[int]) -> CodeFingerprint:
    """Return fingerprints without those that were given.

    copydetect can do so itself, but loses the first of two places where a passage stands twice.
    """
    left = copy.copy(one)
    left.hashes = one.hashes - given
    left.hash_idx = {each: places for each, places in one.hash_idx.items() if each not in given}
    left.token_coverage = int(get_token_coverage(left.hash_idx, RUN, len(one.filtered_code)))
    return left


def printed_steps(works: Iterable[Work]) -> Iterator[Printed]:
    """Yield each work with its fingerprints, which are made once of what several hold."""
    known: dict[str, CodeFingerprint] = {}
    for work in works:
        for text in work.texts.values():
            if text not in known:
                known[text] = fingerprint(text)
        yield Printed(work, {task: known[text] for task, text in work.texts.items()})


def compare(each: Sequence[Printed], given: Sequence[str] = (), library: str = "") -> Likeness:
    r"""Return how alike works are; those of one team are not compared with each other.

    Parameters
    ----------
    each : the works
    given : texts that everybody was given
    library : the library's own text of the tasks, which is open to everybody

    Examples
    --------
    >>> text = "def f(Z):\n    total = 0\n" + "".join(f"    total += {k} * Z[{k}]\n" for k in range(30))
    >>> works = [Work("a", {"f": text}), Work("b", {"f": text.replace("Z", "levels")})]
    >>> compare(list(printed_steps(works))).pairs
    [Pair(one=0, other=1, share=1.0, forth=1.0, back=1.0)]
    """
    handout = {one for text in given for one in fingerprint(text).hashes}
    shared = without(fingerprint(library), handout)
    texts = {one.raw_code: one for printed in each for one in printed.tasks.values()}
    whole = {text: without(one, handout) for text, one in texts.items()}
    long = {text for text, one in whole.items() if one.token_coverage >= SHORT}
    in_library = {text: float(compare_files(whole[text], shared)[1][0]) for text in long}
    mine = {text: without(whole[text], shared.hashes) for text in long}
    own: dict[str, dict[int, CodeFingerprint]] = {}
    short = {}
    copied = {}
    for task in dict.fromkeys(task for printed in each for task in printed.tasks):
        has = {
            n: printed.tasks[task].raw_code
            for n, printed in enumerate(each)
            if task in printed.tasks
        }
        copied[task] = {n: in_library[text] for n, text in has.items() if text in long}
        enough = {n: mine[text] for n, text in has.items() if text in long}
        own[task] = {n: one for n, one in enough.items() if one.token_coverage >= SHORT}
        short[task] = len(has) - len(own[task])
    return Likeness(
        *_pairs([one.work.team for one in each], shares(len(each), own)), own, short, copied
    )


def shares(n: int, own: Mapping[str, Mapping[int, CodeFingerprint]]) -> np.ndarray:
    """Return (n, n), the largest share of each work in each other; -1 where there is too little to compare.

    It is that of all tasks together that both have, or of one of them that is long by itself.
    """
    together = np.zeros((n, n))
    signs = np.zeros((n, n))
    best = np.full((n, n), -1.0)
    for prints in filter(None, own.values()):
        at = np.ix_(list(prints), list(prints))
        each = covered(list(prints.values()))
        size = np.array([one.token_coverage for one in prints.values()])[:, None]
        together[at] += each
        signs[at] += size
        best[at] = np.maximum(best[at], np.where(size >= LONG, each / size, -1))
    return np.maximum(best, np.where(signs >= LONG, together / np.maximum(signs, 1), -1))


def covered(prints: Sequence[CodeFingerprint]) -> np.ndarray:
    """Return (n, n): of each pair, the signs of the first that lie in fingerprints of both.

    It is what `compare_files` counts, of one and all others at once.
    """
    places = [np.array([at for all in one.hash_idx.values() for at in all], int) for one in prints]
    marks = [
        np.array([each for each, all in one.hash_idx.items() for _ in all], int) for one in prints
    ]
    known, column = np.unique(np.concatenate(marks), return_inverse=True)
    sizes = [len(one) for one in marks]
    holder = np.repeat(np.arange(len(prints)), sizes)
    has = csr_array((np.ones(len(column), bool), (column, holder)), shape=(len(known), len(prints)))
    result = np.zeros((len(prints), len(prints)))
    for a, (at, of) in enumerate(zip(places, np.split(column, np.cumsum(sizes)[:-1]), strict=True)):
        held = has[of].toarray().astype(np.int8)
        step = np.zeros((len(prints[a].filtered_code) + 1, len(prints)), np.int8)
        step[at] = held
        step[at + RUN] -= held  # at most RUN fingerprints lie over a sign, which int8 holds
        result[a] = (np.cumsum(step, axis=0, dtype=np.int8) > 0).sum(axis=0)
    return result


def _pairs(teams: Sequence[str], best: np.ndarray) -> tuple[list[Pair], np.ndarray]:
    """Return the pairs from the threshold on, the most alike first, and how many have which share."""
    one, other = np.triu_indices(len(teams), 1)
    names = np.array(teams)
    largest = np.maximum(best, best.T)[one, other]
    counted = (names[one] != names[other]) & (largest >= 0)
    kept = np.flatnonzero(counted & (largest >= THRESHOLD))
    kept = kept[np.argsort(-largest[kept], kind="stable")]
    a = one[kept]
    b = other[kept]
    columns = (each.tolist() for each in (a, b, largest[kept], best[a, b], best[b, a]))
    return [*map(Pair, *columns)], np.histogram(largest[counted], BINS, (0, 1))[0]
