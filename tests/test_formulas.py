"""Formulas and numbers of notebooks and assignments: symbols are explained, equations are numbered.

A page is the text of a notebook or of an assignment. The table of symbols is in its first cell. A
*display* is a formula between two $$. A number in a folded answer must be computed on the page.
"""

import re

import pytest
from support import numbers_from_outside
from test_notebooks import NOTEBOOKS, cells_of
from test_sentences import SENTENCES

# how LaTeX writes the letters that stand for a quantity, or for an operator
LOWER_GREEK = (
    r"alpha|beta|gamma|delta|epsilon|varepsilon|eta|theta|kappa|lambda|mu|nu|xi|rho|sigma|tau|phi|"
    r"varphi|chi|psi|omega"
)
GREEK = re.compile(rf"(?:{LOWER_GREEK}|Phi|Psi|Omega|Delta|Gamma|Sigma|Lambda|nabla|ell)")
# indices, places in an image, the base of natural logarithms and a differential
COMMON_SYMBOLS = set("ijkxyed")
DISPLAY = re.compile(r"\$\$(.*?)\$\$", re.DOTALL)
INLINE = re.compile(r"\$([^$]+)\$")
WORDS = re.compile(
    r"\\(?:text|mathrm|operatorname\*?|begin|end|tag)\{[^{}]*\}(?:\{[lcr|]+\})?", re.DOTALL
)
SUBSCRIPT = re.compile(r"_(?:\{[^{}]*\}|\\[A-Za-z]+|\w)")
# "equation 1.9" is one of a paper; "one system of equations (30 points)" is none
REFERENCE = re.compile(
    r"\b(?:[Ee]quations?|[Ee]qs?\.)\s+\(?(\d+)\)?(?!\.?\d| points| of the (?:same )?paper)"
)
# an equation of a paper: a link or a citation stands right before it
CITED_REFERENCE = re.compile(r"(?:\]\([^)]*\),\s+|\[\w+\s+)(?:equations?|eqs?\.)\s+\(?\d+\)?")
FOLD = re.compile(r"<details>.*?</details>", re.DOTALL)
# exercises and questions name values to try, which nobody has to compute
EXERCISES = re.compile(r"^## Exercises.*", re.DOTALL | re.MULTILINE)
QUESTION = re.compile(r"[^.:?!]*(?:\d\.\d[^.:?!]*)*\?")
CODE_OR_LINK = re.compile(r"`[^`]*`|\]\([^)]*\)|<[^>]*>")
# a number of two digits or more, with a decimal point or without
NUMBER = re.compile(r"(?<![\w.])(?:\d+\.\d+|\d{2,}(?: \d{3})*)(?![\w.]\d|\w)")
YEAR = re.compile(r"(?:19|20)\d\d")
# spellings of units that these pages do not use: cd/m², 5 %, 24 mm, 16 bits are right
OTHER_SPELLINGS = re.compile(
    r"cd/m2|cd/m\^2|\bnits?\b|\d%|\d(?:mm|cm|ms|px|cd)\b|\bsecs?\b|\bEVs\b"
)
# a number of one digit is one of these only together with its unit: "8 %", "3 stops"
UNITS = (
    r"%|stops?|levels?|decades?|bits?|bytes?|electrons?|pixels?|seconds?|s|mm|cd/m²|degrees?|times"
)
NUMBER_WITH_UNIT = re.compile(rf"(?<![\w.·$/])\d (?:{UNITS})(?!\w)")
# and so is a number that is written as a word: "three stops", "half a level"
NUMBER_WORDS = (
    "two|three|four|five|six|seven|eight|nine|ten|eleven|twelve|fifteen|half an?|"
    "a (?:quarter|third|fifth|tenth|hundredth|fiftieth|thousandth) of an?"
)
MEASURES = r"stops?|levels?|decades?|percent|bits|electrons?|degrees?|times|seconds?"
WORDS_WITH_UNIT = re.compile(rf"\b(?:{NUMBER_WORDS}) (?:{MEASURES})\b")

SHEETS = sorted((NOTEBOOKS[0].parents[1] / "assignments").glob("*.ipynb"))

each_page = pytest.mark.parametrize("path", [*NOTEBOOKS, *SHEETS], ids=lambda path: path.stem)
each_notebook = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def symbols(formula):
    """Return the letters of a formula, without subscripts and words: {"E", "sigma"}."""
    text = SUBSCRIPT.sub(" ", WORDS.sub(" ", formula))
    letters = {name for name in re.findall(r"\\([A-Za-z]+)", text) if GREEK.fullmatch(name)}
    return letters | set(re.findall(r"[A-Za-z]", re.sub(r"\\[A-Za-z]+", " ", text)))


def explained_in(text):
    """Return the symbols that a text names between single dollars, or with words inside a formula."""
    inline = INLINE.findall(DISPLAY.sub(" ", text))
    in_words = re.findall(r"([A-Za-z])\s*\\text\{ (?:a|the) ", text)
    return set(in_words).union(*map(symbols, inline))


def table_rows(text):
    """Return the rows of the table of symbols, each a list of its cells."""
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("|")]
    return rows[2:]


def quantities(text):
    """Return the numbers of one digit, or one word, with their units: {"8 %", "three stops"}."""
    return set(NUMBER_WITH_UNIT.findall(text)) | set(WORDS_WITH_UNIT.findall(text.lower()))


def numbers_in(prose):
    """Return the numbers of a prose text without its formulas, code and years, some with a unit."""
    prose = INLINE.sub(" ", DISPLAY.sub(" ", CODE_OR_LINK.sub(" ", prose)))
    prose = re.sub(r"(?<=\d),(?=\d{3})", " ", " ".join(prose.split()))  # 1,500 is 1 500
    return {number for number in NUMBER.findall(prose) if not YEAR.fullmatch(number)} | quantities(
        prose
    )


def texts_of(path):
    return [cell.source for cell in cells_of(path, "markdown")]


@each_page
def test_each_symbol_of_a_display_is_in_the_table_or_explained_beside_it(path):
    texts = texts_of(path)
    in_table = explained_in("\n".join(line for line in texts[0].splitlines() if line[:1] == "|"))
    for text in texts:
        known = in_table | explained_in(text) | COMMON_SYMBOLS
        for formula in DISPLAY.findall(text):
            assert symbols(formula) - known == set(), formula


@each_page
def test_the_table_has_a_row_only_once_for_each_symbol_and_says_what_it_is(path):
    rows = table_rows(texts_of(path)[0])
    names = [name.partition("=")[0].strip() for row in rows for name in INLINE.findall(row[0])]
    assert sorted(names) == sorted(set(names))
    assert [row for row in rows if len(row) < 2 or len(row[1].strip()) < 3] == []


@each_notebook
def test_the_letters_of_height_and_width_in_a_table_are_no_symbols_of_the_same_table(path):
    """A table whose H is a filter, or W a weight, writes (rows, columns) for the shape of an image."""
    rows = table_rows(texts_of(path)[0])
    lengths = set(re.findall(r"\b[HW]\b", " ".join(row[-1] for row in rows if "(" in row[-1])))
    named = [symbols(name) for row in rows for name in INLINE.findall(row[0])]
    assert lengths & set().union(*named) == set()


@each_page
def test_an_equation_that_the_text_refers_to_has_its_number_on_the_page(path):
    text = "\n".join(texts_of(path))
    numbered = set(re.findall(r"\\tag\{(\d+)\}", text))
    referred = set(REFERENCE.findall(CITED_REFERENCE.sub(" ", " ".join(text.split()))))
    assert referred <= numbered
    assert numbered == {str(k + 1) for k in range(len(numbered))}


@each_notebook
def test_a_number_of_a_folded_answer_is_computed_on_the_page_or_has_a_source(path):
    """It stands in the page's code or before the fold, in the table of sentences, or has a source."""
    number = path.stem[:2]
    code = "\n".join(cell.source for cell in cells_of(path, "code"))
    text = "\n".join(texts_of(path))
    open_text = FOLD.sub(" ", text)
    known = set(NUMBER.findall(" ".join([code.replace("_", " "), open_text])))
    known |= set(NUMBER.findall(" ".join(SENTENCES.get(number, {}))))
    known |= set(numbers_from_outside.NUMBERS.get(number, {}))
    known |= {page.stem[:2] for page in NOTEBOOKS}
    before = " ".join([*open_text.split(), *SENTENCES.get(number, {})])
    known |= quantities(before)
    numbers = set().union(*(numbers_in(fold) for fold in FOLD.findall(text)))
    assert numbers - known == set()


@each_notebook
def test_a_number_of_the_open_text_is_computed_on_the_page_or_has_a_source(path):
    """It stands in the page's code, its table or the table of sentences, or has a source."""
    number = path.stem[:2]
    table, *texts = texts_of(path)
    code = "\n".join(cell.source for cell in cells_of(path, "code")).replace("_", " ")
    known = numbers_in(code) | set(NUMBER.findall(code)) | numbers_in(table)
    known |= numbers_in(" ".join(SENTENCES.get(number, {})))
    known |= set(numbers_from_outside.NUMBERS.get(number, {}))
    known |= set(numbers_from_outside.OPEN_TEXT.get(number, {}))
    known |= {page.stem[:2] for page in NOTEBOOKS}
    text = EXERCISES.sub(" ", FOLD.sub(" ", "\n\n".join(texts)))
    prose = INLINE.sub(" ", DISPLAY.sub(" ", CODE_OR_LINK.sub(" ", text)))
    assert numbers_in(QUESTION.sub(" ", prose)) - known == set()


@each_page
def test_a_unit_is_written_in_one_way_with_a_space_before_it(path):
    prose = INLINE.sub(" ", DISPLAY.sub(" ", CODE_OR_LINK.sub(" ", "\n".join(texts_of(path)))))
    assert OTHER_SPELLINGS.findall(prose) == []
