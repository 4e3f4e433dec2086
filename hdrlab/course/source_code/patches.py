"""Find the lines of a student's code that hold the difference between a wrong and a right function.

A wrong function is the right one with a few tokens changed, such as `log2` in place of `log`. Where
the wrong tokens stand in a line of the student's code, the right ones are put in their place. The
caller runs each changed source: only if it gives the right answers, the lines count as found.
"""

import io
import tokenize
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from difflib import SequenceMatcher

from hdrlab.course.source_code import names

# a longer edit is another structure, not a patch
MAX_EDIT_TOKENS = 12
# changed sources that are tried with one line changed, and lines that are changed together
MAX_TRIALS = 60
MAX_TOGETHER = 10
DOCSTRING_START = '"""'
# tokens that are layout only
LAYOUT_TOKENS = (
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
)


@dataclass(frozen=True)
class Edit:
    """Tokens of the wrong function, and what the right one has in their place."""

    wrong: tuple[str, ...]
    right: tuple[str, ...]


def edits(wrong: str, right: str) -> list[Edit]:
    """Return the short edits among those that turn a wrong source into the right one.

    Examples
    --------
    >>> edits("B = np.log2(t)", "B = np.log(t)")
    [Edit(wrong=('log2',), right=('log',))]
    """
    before = [token.string for token in _tokens(wrong)]
    after = [token.string for token in _tokens(right)]
    matcher = SequenceMatcher(None, before, after, autojunk=False)
    spans: list[list[int]] = []
    for kind, i, j, k, m in matcher.get_opcodes():
        if kind == "equal":
            continue
        if kind == "insert":  # nothing to look for: take a token on either side along
            i = max(i - 1, 0)
            j += 1
            k = max(k - 1, 0)
            m += 1
        if spans and i < spans[-1][1]:  # two inserts share a token
            spans[-1][1] = j
            spans[-1][3] = m
        else:
            spans.append([i, j, k, m])
    short_edits = []
    for i, j, k, m in spans:
        length = max(j - i, m - k)
        if j > i and length <= MAX_EDIT_TOKENS:
            short_edits.append(Edit(tuple(before[i:j]), tuple(after[k:m])))
    return short_edits


def edit(wrong: str, right: str) -> Edit:
    """Return the edit between two pieces of code."""
    return Edit(
        tuple(token.string for token in _tokens(wrong)),
        tuple(token.string for token in _tokens(right)),
    )


def wrong_lines(source: str, candidates: list[Edit], is_right: Callable[[str], bool]) -> list[int]:
    r"""Return the numbers of the lines whose change makes a source right, counted from 1.

    Single lines are tried first, and then all lines together, of which those that matter remain. The
    list is empty if nothing makes the source right.

    Parameters
    ----------
    source : str
    candidates : list of Edit
        The edits that may be applied.
    is_right : function
        Whether a changed source is right. At most `MAX_TRIALS` sources are tried.

    Examples
    --------
    >>> wrong_lines("a = 1\nb = log2(a)", [Edit(("log2",), ("log",))], lambda text: "log(" in text)
    [2]
    """
    texts = _changed_texts(source, candidates)
    trials = 0
    for number, alternatives in texts.items():
        for text in alternatives:
            trials += 1
            if trials > MAX_TRIALS:
                return []
            if is_right(_with_lines(source, {number: text})):
                return [number]
    changed = {number: alternatives[-1] for number, alternatives in texts.items()}
    if not 1 < len(changed) <= MAX_TOGETHER or not is_right(_with_lines(source, changed)):
        return []
    for number in list(changed):
        others = {other: text for other, text in changed.items() if other != number}
        if is_right(_with_lines(source, others)):
            changed = others
    return sorted(changed)


def _with_lines(source: str, texts: Mapping[int, str]) -> str:
    """Return a source with some lines replaced."""
    lines = source.split("\n")
    for number, text in texts.items():
        lines[number - 1] = text
    return "\n".join(lines)


def _changed_texts(source: str, candidates: list[Edit]) -> dict[int, list[str]]:
    """Return how each line may read after a change, the last one with all edits in it."""
    lines: dict[int, list[tokenize.TokenInfo]] = {}
    for token in _tokens(source):
        if token.start[0] == token.end[0]:
            lines.setdefault(token.start[0], []).append(token)
    texts = {}
    for number, tokens in lines.items():
        if tokens[0].string == "def":  # a signature is given
            continue
        choices = list(_choices(tokens, candidates))
        if choices:
            texts[number] = list(dict.fromkeys(_replace(tokens, choice) for choice in choices))
    return texts


def _choices(
    tokens: list[tokenize.TokenInfo], candidates: list[Edit]
) -> Iterator[list[tuple[Edit, int]]]:
    """Yield one edit at one place of a line, one edit at all its places, and at last all edits."""
    places = [(edit, at) for edit in candidates for at in _places(tokens, edit.wrong)]
    if not places:
        return
    for place in places:
        yield [place]
    for edit in candidates:
        of_edit = [place for place in places if place[0] == edit]
        if of_edit:
            yield of_edit
    yield places


def _tokens(source: str) -> list[tokenize.TokenInfo]:
    """Return the tokens of a source; none if it is no Python."""
    try:
        tokens = list(tokenize.generate_tokens(io.StringIO(source).readline))
    except (tokenize.TokenError, *names.PARSE_ERRORS):
        return []
    return [
        token
        for token in tokens
        if token.type not in LAYOUT_TOKENS and not token.string.startswith(DOCSTRING_START)
    ]


def _places(tokens: list[tokenize.TokenInfo], wrong: tuple[str, ...]) -> list[int]:
    """Return where a run of tokens begins in the tokens of a line."""
    texts = tuple(token.string for token in tokens)
    last = len(texts) - len(wrong)
    return [at for at in range(last + 1) if texts[at : at + len(wrong)] == wrong]


def _replace(tokens: list[tokenize.TokenInfo], choice: list[tuple[Edit, int]]) -> str:
    """Return the line of some tokens with edits applied, from right to left; overlaps are skipped."""
    line = tokens[0].line.rstrip("\n")
    first_changed = len(tokens)
    for edit, at in sorted(choice, key=lambda place: place[1], reverse=True):
        end = at + len(edit.wrong)
        if end > first_changed:
            continue
        first_changed = at
        start = tokens[at].start[1]
        line = line[:start] + " ".join(edit.right) + line[tokens[end - 1].end[1] :]
    return line
