"""Decide what is on each slide of a notebook. Nothing is run, and no text is written that is not there.

- The title slide has the title, the minutes, and what readers can do afterwards.
- Text is on slides with at most one displayed equation each. Paragraphs that do not fit on two
  slides are in the notes; equations, lists and tables continue on more slides.
- A question, Predict or Think, is on a slide of its own, before the figure that answers it. Readers
  draw or choose their prediction there. A short text before the question stands above it.
- The figure or widget of a cell is a slide. Still images of a slider, side by side, are left out.
- What a cell prints is in the notes of the figure before it. Without one, it is a slide.
- Folded text is in the notes of the figures before it. Folded answers without a figure become a
  slide with their questions, and are in its notes.
- Code is left out, except short functions that need nothing but NumPy.
"""

import ast
import builtins
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Any

from hdrlab.course.site import pages
from hdrlab.course.slides.markdown import (
    Block,
    Folded,
    Kind,
    height_of,
    parse,
    split_paragraph,
    split_sentences,
    split_table,
)

MAX_LINES = 11.0  # of text on a slide
MIN_EXPLAINED_LINES = 2.5  # of text below an equation, if a paragraph is split for it
MAX_TABLE_LINES = 13.0
MAX_TEXT_SLIDES = 2  # of paragraphs in a row
MAX_LEAD_LINES = 3.5  # of the text above a question
MAX_ASKED_LINES = 6.0  # of a question and the text above it, if a widget is below
MAX_DRAWN_LINES = 3.0  # the same, if the widget is a plot or a photo
MIN_CODE_LINES = 3
MAX_CODE_LINES = 12
QUESTION = re.compile(r"\*\*(Predict|Think)\.\*\*\s*")
# paragraphs for readers who run the cells, which a lecture leaves out
FOR_READERS = re.compile(r"\*\*(?:Your own photos?|How to use a notebook)\.\*\*")
# and such remarks in brackets
ASIDE = re.compile(
    r"\s\((?:[^()]*your own photos|[^()]*photos of your own|The next cell|This cell)[^()]*\)"
)
TO_READERS = "Before each figure there is a question: answer it first, then look."
SYMBOLS = "Symbols"


class SlideKind(Enum):
    """What a slide shows."""

    TITLE = "title"
    TEXT = "text"
    QUESTION = "question"
    FIGURE = "figure"
    PRINTED = "printed"
    CODE = "code"


@dataclass(frozen=True)
class Slide:
    """A slide.

    Attributes
    ----------
    kind : what it shows
    heading : the heading of its section
    label : the minutes of a title, "Predict" or "Think" of a question
    lead : Markdown above a question
    text : Markdown; the code of a slide with code
    cell : index of the cell whose output the slide shows; None if it shows none
    notes : Markdown for the speaker
    printed : indices of cells whose printed text belongs in the notes
    """

    kind: SlideKind
    heading: str
    label: str = ""
    lead: str = ""
    text: str = ""
    cell: int | None = None
    notes: tuple[str, ...] = ()
    printed: tuple[int, ...] = ()

    @property
    def is_result(self) -> bool:
        """Whether the slide shows what a cell computed."""
        return self.kind in (SlideKind.FIGURE, SlideKind.PRINTED)


def make_slides(cells: Sequence[Any], name: str = "") -> list[Slide]:
    """Return the slides of a notebook's cells; `name` is the title of a notebook without one.

    Examples
    --------
    >>> text = "A stop is a factor of 2. **Think.** What are two stops?"
    >>> [slide] = make_slides([{"cell_type": "markdown", "source": text}])
    >>> slide.lead, slide.label, slide.text
    ('A stop is a factor of 2.', 'Think', 'What are two stops?')
    """
    maker = _SlideMaker(heading=name)
    for index, cell in enumerate(cells):
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            maker.add_text(source)
        elif cell["cell_type"] == "code":
            is_folded = cell.get("metadata", {}).get("jupyter", {}).get("source_hidden", False)
            maker.add_code(index, source, is_folded=is_folded)
    if name and not any(slide.kind is SlideKind.TITLE for slide in maker.slides):
        return [Slide(SlideKind.TITLE, name), *maker.slides]
    return maker.slides


def drop_empty(slides: Sequence[Slide], cells: Sequence[Any]) -> list[Slide]:
    """Return the slides without those of executed cells that have shown and printed nothing."""
    return [
        slide
        for slide in slides
        if not slide.is_result or slide.cell is None or cells[slide.cell]["outputs"]
    ]


@dataclass
class _SlideMaker:
    """Makes slides from one cell after the other.

    Attributes
    ----------
    slides : the finished slides
    heading : the heading of the current section
    title : the title of the notebook
    blocks : text that is not yet on a slide
    first : number of slides before those whose notes take the next folded text
    """

    slides: list[Slide] = field(default_factory=list)
    heading: str = ""
    title: str = ""
    blocks: list[Block] = field(default_factory=list)
    first: int = 0

    def add_text(self, source: str) -> None:
        """Add a Markdown cell."""
        source = pages.SENTENCES_ON_RUNNING.sub("", source).replace(TO_READERS, "")
        questions: list[Folded] = []
        for block in parse(source):
            if isinstance(block, Folded):
                self._finish_text()
                if self._has_results() or not block.summary.endswith("?"):
                    self._add_folded_note(block)
                else:
                    questions.append(block)
            elif block.level == 1:
                self._add_title(block.text, source)
            elif block.kind is Kind.HEADING:
                self._finish_text()
                self._add_folded_questions(questions)
                questions = []
                self.heading = block.text
                self.first = len(self.slides)
            elif block.kind is Kind.PARAGRAPH:
                self._add_paragraph(block.text)
            else:
                self.blocks.append(block)
        self._finish_text()
        self._add_folded_questions(questions)

    def _add_title(self, title: str, source: str) -> None:
        """Add the title slide."""
        self.heading = title
        self.title = title
        lesson = pages.LESSON.search(source + "\n")
        if lesson is None:
            self.slides.append(Slide(SlideKind.TITLE, title))
            return
        slide = Slide(
            SlideKind.TITLE,
            title,
            label=f"{lesson['minutes']} minutes",
            text=" ".join(lesson["goal"].split()),
            notes=(lesson[0].strip(),),
        )
        self.slides.append(slide)

    def _add_paragraph(self, text: str) -> None:
        """Add a paragraph, which may contain a question, or be one."""
        if pages.LESSON.fullmatch(text + "\n") or FOR_READERS.match(text):
            return
        before, *parts = QUESTION.split(ASIDE.sub("", text))
        if before.strip():
            self.blocks.append(Block(Kind.PARAGRAPH, before.strip()))
        for label, question in zip(parts[::2], parts[1::2], strict=True):
            lead = self._take_lead()
            self._finish_text()
            slide = Slide(
                SlideKind.QUESTION, self.heading, label=label, lead=lead, text=question.strip()
            )
            self.slides.append(slide)

    def _take_lead(self) -> str:
        """Return the end of the text before a question, if it is short enough to stand above it."""
        *groups, lead = _group(self.blocks) or [[]]
        is_plain = all(block.kind is Kind.PARAGRAPH for block in lead)
        if not is_plain or sum(block.lines for block in lead) > MAX_LEAD_LINES:
            return ""
        self.blocks = [block for group in groups for block in group]
        return _join(lead)

    def _has_results(self) -> bool:
        return any(slide.is_result for slide in self.slides[self.first :])

    def _add_folded_note(self, folded: Folded) -> None:
        """Add folded text to the notes of the figures before it, or else of the last slide."""
        note = f"**{folded.summary}**\n\n{folded.text}"
        has_results = self._has_results()
        for index in range(self.first, len(self.slides)):
            if self.slides[index].is_result:
                self._add_note(index, note)
        if not has_results and self.slides:
            self._add_note(len(self.slides) - 1, note)
        self.first = len(self.slides)

    def _add_folded_questions(self, questions: Sequence[Folded]) -> None:
        """Add slides with the questions whose answers are folded; the answers are in the notes."""
        items = [Block(Kind.ITEM, f"- {question.summary}") for question in questions]
        answers = [f"**{question.summary}**\n\n{question.text}" for question in questions]
        for group in _group(items):
            notes = tuple(answers[: len(group)])
            answers = answers[len(group) :]
            slide = Slide(SlideKind.TEXT, self.heading, text=_join(group), notes=notes)
            self.slides.append(slide)

    def _add_note(self, index: int, note: str) -> None:
        slide = self.slides[index]
        self.slides[index] = replace(slide, notes=(*slide.notes, note))

    def add_code(self, index: int, source: str, *, is_folded: bool) -> None:
        """Add the short functions of a code cell, and its figure or what it prints."""
        body = parse_code(source)
        if not is_folded:
            for function in plain_functions(source, body):
                self.slides.append(Slide(SlideKind.CODE, self.heading, text=function))
        last = self.slides[-1] if self.slides else None
        if shows_figure(body):
            self._add_figure(index, source)
        elif prints(body) and last is not None and last.is_result and last.heading == self.heading:
            self.slides[-1] = replace(last, printed=(*last.printed, index))
        elif prints(body):
            self.slides.append(Slide(SlideKind.PRINTED, self.heading, cell=index))

    def _add_figure(self, index: int, source: str) -> None:
        """Add the figure of a cell: below its question, on a slide of its own, or not at all."""
        if "pictures.side_by_side(" in source:
            return
        last = self.slides[-1] if self.slides else None
        asks = "predict." in source.splitlines()[-1]
        if asks and last is not None and last.kind is SlideKind.QUESTION:
            needs_room = "predict.curve(" in source or "predict.place(" in source
            limit = MAX_DRAWN_LINES if needs_room else MAX_ASKED_LINES
            height = height_of(last.lead) + height_of(last.text)
            if last.cell is None and height <= limit:
                self.slides[-1] = replace(last, cell=index)
                return
        kind = SlideKind.QUESTION if asks else SlideKind.FIGURE
        label = last.label if asks and last is not None else ""
        self.slides.append(Slide(kind, self.heading, label=label, cell=index))

    def _finish_text(self) -> None:
        """Put the text that is not yet on a slide on slides, and what does not fit into the notes."""
        groups = _group(self.blocks)
        self.blocks = []
        for number, group in enumerate(groups):
            is_plain = all(block.kind is Kind.PARAGRAPH for block in group)
            if is_plain and number >= MAX_TEXT_SLIDES:
                self._add_note(len(self.slides) - 1, _join(group))
                continue
            is_legend = group[0].kind is Kind.TABLE and self.heading == self.title
            heading = SYMBOLS if is_legend else self.heading
            self.slides.append(Slide(SlideKind.TEXT, heading, text=_join(group)))


def _group(blocks: Sequence[Block]) -> list[list[Block]]:
    """Return the blocks in groups, each for one slide."""
    groups: list[list[Block]] = []
    free_lines = 0.0
    waiting = [part for block in blocks for part in _split(block)]
    while waiting:
        block = waiting.pop(0)
        has_equation = bool(groups) and any(old.kind is Kind.EQUATION for old in groups[-1])
        is_paragraph = block.kind is Kind.PARAGRAPH
        if is_paragraph and has_equation and MIN_EXPLAINED_LINES <= free_lines < block.lines:
            # the explanation of an equation begins on its slide
            block, *rest = split_paragraph(block, free_lines)
            if rest:
                waiting.insert(0, replace(block, text=" ".join(part.text for part in rest)))
        is_second_equation = block.kind is Kind.EQUATION and has_equation
        if block.kind is Kind.TABLE or is_second_equation or block.lines > free_lines:
            lead = _take_last_sentence(groups) if block.kind is Kind.EQUATION else []
            groups.append(lead)
            free_lines = MAX_LINES - sum(old.lines for old in lead)
        groups[-1].append(block)
        free_lines -= MAX_LINES if block.kind is Kind.TABLE else block.lines
    return groups


def _take_last_sentence(groups: list[list[Block]]) -> list[Block]:
    """Take the sentence that leads to an equation off the last group, and return it in a list."""
    if not groups or groups[-1][-1].kind is not Kind.PARAGRAPH:
        return []
    paragraph = groups[-1].pop()
    *before, last = split_sentences(paragraph.text)
    if before:
        groups[-1].append(replace(paragraph, text=" ".join(before)))
    elif not groups[-1]:
        groups.pop()
    return [replace(paragraph, text=last)]


def _split(block: Block) -> list[Block]:
    """Return a block in parts that fit on a slide."""
    if block.kind is Kind.TABLE:
        return split_table(block, MAX_TABLE_LINES)
    if block.kind is Kind.PARAGRAPH:
        return split_paragraph(block, MAX_LINES)
    return [block]


def _join(blocks: Sequence[Block]) -> str:
    return "\n\n".join(block.text for block in blocks)


def parse_code(source: str) -> list[ast.stmt]:
    """Return the statements of a cell, which may contain commands of IPython."""
    try:
        return ast.parse(source).body
    except SyntaxError:
        from IPython.core.inputtransformer2 import TransformerManager

        return ast.parse(TransformerManager().transform_cell(source)).body


def shows_figure(body: Sequence[ast.stmt]) -> bool:
    """Return whether a cell with these statements shows the value of its last line."""
    return bool(body) and isinstance(body[-1], ast.Expr) and not _is_print(body[-1].value)


def prints(body: Sequence[ast.stmt]) -> bool:
    """Return whether one of these statements contains a call of print."""
    return any(_is_print(node) for statement in body for node in ast.walk(statement))


def _is_print(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and getattr(node.func, "id", "") == "print"


def plain_functions(source: str, body: Sequence[ast.stmt]) -> Iterator[str]:
    """Yield the source of the short functions among these statements that need nothing but NumPy."""
    known = {"np", *dir(builtins)}
    for statement in body:
        if not isinstance(statement, ast.FunctionDef):
            continue
        names = [node for node in ast.walk(statement) if isinstance(node, ast.Name)]
        used = {node.id for node in names if isinstance(node.ctx, ast.Load)}
        own = {node.id for node in names if isinstance(node.ctx, ast.Store)}
        own |= {node.arg for node in ast.walk(statement) if isinstance(node, ast.arg)}
        text = ast.get_source_segment(source, statement) or ""
        is_short = MIN_CODE_LINES <= len(text.splitlines()) <= MAX_CODE_LINES
        if is_short and used <= own | known:
            yield text
