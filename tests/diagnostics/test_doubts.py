"""The sentences of doubt: each is said somewhere, and each place says one that there is."""

import ast
import string
from pathlib import Path

import hdrlab
from hdrlab.diagnostics import doubts

ROOMS = ("diagnostics", "pipeline")
FILES = [file for room in ROOMS for file in (Path(hdrlab.__file__).parent / room).glob("*.py")]
SAID = [
    (node.args[0].value, {one.arg for one in node.keywords})
    for file in FILES
    for node in ast.walk(ast.parse(file.read_text("utf8")))
    if isinstance(node, ast.Call) and ast.unparse(node.func) in ("say", "doubts.say")
]


def test_each_sentence_is_said_and_each_that_is_said_is_there():
    assert {name for name, _ in SAID} == set(doubts.SENTENCES)


def test_what_a_sentence_has_places_for_is_what_is_given_to_it():
    for name, given in SAID:
        places = {
            field for _, field, _, _ in string.Formatter().parse(doubts.SENTENCES[name]) if field
        }
        assert given == places, name


def test_a_sentence_is_one_line():
    assert not [name for name, said in doubts.SENTENCES.items() if "\n" in said or "  " in said]
