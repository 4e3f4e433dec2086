"""Give students codes instead of names, and replace names in texts, so that work can be read anonymously.

A code is computed from the student's id and the secret of the course: it stays the same in all
homeworks, and whoever has the roster but not the secret cannot compute it.

In texts, hdrlab looks for the names, ids and addresses of all students of the roster, because
students name each other, too. In code, it looks in comments and strings. The names of variables
stay, so that the code still runs; only a full name or an id with letters is replaced there.
"""

import hmac
import io
import re
import tokenize
import unicodedata
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from hdrlab.course.students.roster import Roster, Student, fold

# without vowels, which could form words, and without letters that look like digits
CODE_LETTERS = "BCDFGHJKMNPQRTVWXZ23456789"
CODE_LENGTH = 7  # after the S; two of a thousand students have the same once in 16,000 courses
REPLACED = "[name]"
MIN_ID_DIGITS = 4  # a shorter number in a text is rarely an id
MIN_NAME_LENGTH = 2
MIN_ANY_CASE_LENGTH = 3  # shorter names are replaced only as the roster writes them: "An", not "an"
MIN_ADDRESS_LENGTH = 4  # of the part of an email address before the @
WORD = re.compile(r"[^\W_]+")
UMLAUTS = str.maketrans(
    {"ä": "ae", "ö": "oe", "ü": "ue", "Ä": "Ae", "Ö": "Oe", "Ü": "Ue", "ß": "ss"}
)


def make_codes(names: Iterable[str], secret: str) -> dict[str, str]:
    """Return a code for each id or team.

    Examples
    --------
    >>> codes = make_codes(["b1", "b2"], "salt")
    >>> codes == make_codes(["b2", "b1"], "salt"), codes == make_codes(["b1", "b2"], "pepper")
    (True, False)
    """
    codes: dict[str, str] = {}
    used: set[str] = set()
    for name in sorted(set(names)):
        attempt = 0
        while (code := _make_code(name, secret, attempt)) in used:
            attempt += 1
        used.add(code)
        codes[name] = code
    return codes


def _make_code(name: str, secret: str, attempt: int) -> str:
    message = f"anonymous\0{fold(name)}\0{attempt}"
    number = int.from_bytes(hmac.digest(secret.encode(), message.encode(), "sha256"), "big")
    letters = []
    for _ in range(CODE_LENGTH):
        number, index = divmod(number, len(CODE_LETTERS))
        letters.append(CODE_LETTERS[index])
    return "S" + "".join(letters)


@dataclass(frozen=True)
class Anonymity:
    """The codes of a class, and the patterns that find its names in texts.

    Attributes
    ----------
    students, teams : the codes by id and by team
    clear : finds what can be no ordinary word: full names, addresses, and ids with letters
    words : finds single names, ids and teams, which can also be ordinary words or numbers
    replacements : the code of what was found, by its folded letters and digits
    exact : single names that are replaced only where they are written as in the roster
    """

    students: dict[str, str]
    teams: dict[str, str]
    clear: re.Pattern[str]
    words: re.Pattern[str]
    replacements: Mapping[str, str]
    exact: frozenset[str]

    def redact(self, text: str) -> str:
        """Return a text without the names, ids and addresses of the class."""
        return self._redact(text, protected=frozenset())

    def redact_code(self, text: str) -> str:
        """Return Python code whose comments and strings have no names of the class.

        Code that Python cannot split into tokens is treated as text.
        """
        text = self.clear.sub(self._replacement, unicodedata.normalize("NFC", text))
        return self._redact(text, protected=_words_of_code(text))

    def _redact(self, text: str, protected: frozenset[str]) -> str:
        text = self.clear.sub(self._replacement, unicodedata.normalize("NFC", text))
        exact_folded = {fold(word) for word in self.exact}

        def replace_word(match: re.Match[str]) -> str:
            word = match[0]
            is_other_word = fold(word) in exact_folded and word not in self.exact
            return word if word in protected or is_other_word else self._replacement(match)

        return self.words.sub(replace_word, text)

    def _replacement(self, match: re.Match[str]) -> str:
        return self.replacements.get(_key(match[0]), REPLACED)


def make_anonymity(roster: Roster, secret: str, ordinary_words: Iterable[str] = ()) -> Anonymity:
    """Return the codes of a class, and what finds its names in texts.

    Parameters
    ----------
    roster : the class
    secret : of the course
    ordinary_words : words of the assignment, such as "max": a student of this name is found only
        where the name is written as in the roster, "Max"
    """
    ids = [student.id for student in roster.students]
    teams = [student.team for student in roster.students]
    codes = make_codes([*ids, *teams], secret)
    clear: dict[str, set[str]] = {}
    words: dict[str, set[str]] = {}
    for student in roster.students:
        for spelling in _clear_spellings(student):
            clear.setdefault(spelling, set()).add(codes[student.id])
        for word in _single_names(student):
            words.setdefault(word, set()).add(REPLACED)
        for name in {student.id, student.team}:
            has_letters = any(letter.isalpha() for letter in name)
            if has_letters or len(name) >= MIN_ID_DIGITS:
                words.setdefault(name, set()).add(codes[name])
    ordinary = {fold(word) for word in ordinary_words}
    exact = frozenset(
        word for word in words if len(word) < MIN_ANY_CASE_LENGTH or fold(word) in ordinary
    )
    replacements: dict[str, str] = {}
    for found, meanings in [*words.items(), *clear.items()]:
        replacements[_key(found)] = meanings.pop() if len(meanings) == 1 else REPLACED
    return Anonymity(
        students={id: codes[id] for id in ids},
        teams={team: codes[team] for team in teams},
        clear=_any_of(clear, is_bounded=False),
        words=_any_of(words, is_bounded=True),
        replacements=replacements,
        exact=exact,
    )


def _clear_spellings(student: Student) -> Iterator[str]:
    """Yield a student's full name in both orders, the address, and an id with letters and digits."""
    for name in _spellings(student.name):
        parts = [part for part in WORD.findall(name) if part[0].isupper()] or WORD.findall(name)
        if len(parts) > 1:
            yield f"{parts[0]} {parts[-1]}"
            yield f"{parts[-1]} {parts[0]}"
            yield " ".join(parts)
    if student.email:
        yield student.email
        local_part = student.email.partition("@")[0]
        if len(local_part) >= MIN_ADDRESS_LENGTH and not local_part.isalpha():
            yield local_part
    kinds = {letter.isdigit() for letter in student.id if letter.isalnum()}
    if len(student.id) >= MIN_ID_DIGITS and len(kinds) > 1:
        yield student.id


def _single_names(student: Student) -> Iterator[str]:
    """Yield the parts of a student's name, without particles such as "von", and of the address."""
    local_part = student.email.partition("@")[0]
    if len(local_part) >= MIN_ADDRESS_LENGTH and local_part.isalpha():
        yield local_part
    if student.name == student.id:  # the roster has no name
        return
    for name in _spellings(student.name):
        parts = WORD.findall(name)
        is_capitalized = any(part[0].isupper() for part in parts)
        for part in parts:
            if len(part) >= MIN_NAME_LENGTH and (part[0].isupper() or not is_capitalized):
                yield part


def _spellings(name: str) -> set[str]:
    """Return a name with its accents, without them, and with German umlauts written out."""
    composed = unicodedata.normalize("NFC", name)
    decomposed = unicodedata.normalize("NFD", name)
    plain = "".join(letter for letter in decomposed if not unicodedata.combining(letter))
    return {composed, plain, composed.translate(UMLAUTS)}


def _any_of(names: Iterable[str], *, is_bounded: bool) -> re.Pattern[str]:
    """Return a pattern for any of these names, the longest first, in upper or lower case.

    Between the parts of a name there may be anything but letters and digits, or nothing. An
    underscore counts as the end of a word.
    """
    patterns = []
    for name in sorted(names, key=len, reverse=True):
        parts = [re.escape(part) for part in WORD.findall(name)]
        if parts:
            patterns.append(r"[\W_]{0,3}".join(parts))
    end = r"(?![^\W_])" if is_bounded else ""
    alternatives = "|".join(patterns) or r"(?!)"
    return re.compile(rf"(?<![^\W_])(?:{alternatives}){end}", re.IGNORECASE)


def _key(text: str) -> str:
    """Return the letters and digits of a text, folded."""
    return fold("".join(WORD.findall(text)))


def _words_of_code(text: str) -> frozenset[str]:
    """Return the words in names and numbers of Python code: neither of comments nor of strings."""
    words: set[str] = set()
    try:
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            if token.type in (tokenize.NAME, tokenize.NUMBER):
                words.update(WORD.findall(token.string))
    except (tokenize.TokenError, SyntaxError, ValueError):
        return frozenset()
    return frozenset(words)
