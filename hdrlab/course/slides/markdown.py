"""Split the text of a notebook into blocks, and long paragraphs into parts, so that they fit on slides."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from functools import cache
from typing import Any

LINE_LETTERS = 72  # on a line of a slide
ROW_LETTERS = 88  # in a row of a table, whose letters are smaller
PARAGRAPH_SPACE_LINES = 0.5
EQUATION_LINES = 3.0
EQUATION_LETTERS = 66  # on a line of an equation
ROW_LINES = 1.1
FOLDED = re.compile(r"<details[^>]*>\s*<summary>(.*?)</summary>(.*?)</details>", re.DOTALL)
SENTENCE_END = re.compile(r"(?:(?<=[.?!])|(?<=[.?!]\)))\s+")
LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")
TEX_COMMAND = re.compile(r"\\[a-zA-Z]+|[{}\\$]")


class Kind(Enum):
    """What a block of text is."""

    HEADING = "heading"
    PARAGRAPH = "paragraph"
    EQUATION = "equation"
    ITEM = "item"
    TABLE = "table"


@dataclass(frozen=True)
class Block:
    """A block of Markdown.

    Attributes
    ----------
    kind : what it is
    text : its Markdown; of a heading, without the #
    level : the level of a heading, 1 for a title; 0 for other blocks
    """

    kind: Kind
    text: str
    level: int = 0

    @property
    def lines(self) -> float:
        """The height of the block on a slide, in lines of text; an estimate."""
        if self.kind is Kind.EQUATION:
            return EQUATION_LINES * _text_lines(self.text, EQUATION_LETTERS)
        if self.kind is Kind.TABLE:
            return sum(_row_lines(row) for row in self.text.splitlines()[2:]) + ROW_LINES
        return _text_lines(self.text, LINE_LETTERS) + PARAGRAPH_SPACE_LINES


@dataclass(frozen=True)
class Folded:
    """Text that a notebook folds, such as "What you should have seen"."""

    summary: str
    text: str


def parse(source: str) -> Iterator[Block | Folded]:
    """Yield the blocks of a Markdown cell, and its folded texts, in order."""
    end = 0
    for folded in FOLDED.finditer(source):
        yield from _blocks(source[end : folded.start()])
        yield Folded(" ".join(folded[1].split()), folded[2].strip())
        end = folded.end()
    yield from _blocks(source[end:])


def _blocks(source: str) -> Iterator[Block]:
    """Yield the blocks of Markdown without folded text."""
    lines = source.splitlines()
    items: list[Any] = []  # the outer lists in which a token is
    for token in _parser().parse(source):
        if token.type in ("bullet_list_open", "ordered_list_open") and token.level == 0:
            items.append(token)
        elif token.type in ("bullet_list_close", "ordered_list_close") and token.level == 0:
            items.pop()
        elif token.type == "list_item_open" and token.level == 1:
            yield Block(Kind.ITEM, _source_of(token, lines))
        if token.level > 0 or items or token.map is None:
            continue
        text = _source_of(token, lines)
        if token.type == "heading_open":
            yield Block(Kind.HEADING, text.lstrip("# "), int(token.tag[1]))
        elif token.type == "math_block":
            yield Block(Kind.EQUATION, text)
        elif token.type == "table_open":
            yield Block(Kind.TABLE, text)
        elif token.type in ("paragraph_open", "fence", "blockquote_open", "html_block"):
            yield Block(Kind.PARAGRAPH, text)


def _source_of(token: Any, lines: list[str]) -> str:
    """Return the lines of a token."""
    first, last = token.map
    return "\n".join(lines[first:last]).strip()


def parser() -> Any:
    """Return a parser of a notebook's Markdown, which knows tables and formulas."""
    from markdown_it import MarkdownIt
    from mdit_py_plugins.dollarmath import dollarmath_plugin

    return MarkdownIt("commonmark", {"html": True}).enable("table").use(dollarmath_plugin)


_parser = cache(parser)


def plain_length(text: str) -> int:
    """Return about how many letters of Markdown are visible: not those of links and commands of TeX."""
    return len(TEX_COMMAND.sub("", LINK.sub(r"\1", text)).replace("*", "").replace("`", ""))


def height_of(text: str) -> float:
    """Return the height of paragraphs on a slide, in lines of text; an estimate."""
    paragraphs = [paragraph for paragraph in text.split("\n\n") if paragraph]
    return sum(Block(Kind.PARAGRAPH, paragraph).lines for paragraph in paragraphs)


def _text_lines(text: str, letters: int) -> int:
    return -(-plain_length(text) // letters)


def _row_lines(row: str) -> float:
    return max(1, _text_lines(row, ROW_LETTERS)) * ROW_LINES


def split_sentences(text: str) -> list[str]:
    """Return the sentences of a paragraph; no formula, link or bracket is split.

    Examples
    --------
    >>> split_sentences("A stop is a factor of 2. (So two stops are 4. Three are 8.) Count them.")
    ['A stop is a factor of 2.', '(So two stops are 4. Three are 8.)', 'Count them.']
    """
    sentences = []
    start = 0
    for end in SENTENCE_END.finditer(text):
        sentence = text[start : end.start()]
        if _is_complete(sentence) and text[end.end()] not in "abcdefghijklmnopqrstuvwxyz":
            sentences.append(sentence)
            start = end.end()
    return [*sentences, text[start:]]


def _is_complete(text: str) -> bool:
    """Return whether no formula, code, emphasis or bracket is open at the end of the text."""
    pairs = (("(", ")"), ("[", "]"))
    has_pairs = all(text.count(opening) == text.count(closing) for opening, closing in pairs)
    return has_pairs and all(text.count(mark) % 2 == 0 for mark in "$`*")


def split_paragraph(block: Block, max_lines: float) -> list[Block]:
    """Return a paragraph as paragraphs of whole sentences, each at most `max_lines` high if possible."""
    if block.lines <= max_lines:
        return [block]
    parts = [""]
    for sentence in split_sentences(block.text):
        longer = f"{parts[-1]} {sentence}".strip()
        if parts[-1] and Block(block.kind, longer).lines > max_lines:
            parts.append(sentence)
        else:
            parts[-1] = longer
    return [Block(block.kind, part) for part in parts]


def split_table(block: Block, max_lines: float) -> list[Block]:
    """Return a table as tables with the same head and about as many rows, at most `max_lines` high."""
    head, rule, *rows = block.text.splitlines()
    for count in range(1, len(rows) + 1):
        size = -(-len(rows) // count)
        parts = [rows[start : start + size] for start in range(0, len(rows), size)]
        tables = [Block(Kind.TABLE, "\n".join([head, rule, *part])) for part in parts]
        if all(table.lines <= max_lines for table in tables):
            break
    return tables
