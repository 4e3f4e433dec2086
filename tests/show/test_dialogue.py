"""A dialogue shows one question after another."""

import pytest

from hdrlab.errors import InputError
from hdrlab.show.widgets import predict
from hdrlab.show.widgets.dialogue import Dialogue


def steps():
    yield "<p>first</p>"
    yield predict.entry("How many?", 3)
    yield predict.choice("Which?", 0, ["A", "B"])
    yield "<p>last</p>"


def test_the_next_step_comes_when_a_question_is_answered():
    dialogue = Dialogue("Ask me", steps)
    assert dialogue.questions == [] and dialogue.texts == []
    dialogue.button.click()
    assert [form.question for form in dialogue.questions] == ["How many?"]
    assert dialogue.texts == ["<p>first</p>"]
    dialogue.questions[0].done = True
    assert [form.question for form in dialogue.questions] == ["How many?", "Which?"]
    dialogue.questions[1].done = True
    assert dialogue.texts == ["<p>first</p>", "<p>last</p>"]
    dialogue.button.click()
    assert len(dialogue.questions) == 1


def test_an_error_of_hdrlab_ends_the_dialogue_with_its_message():
    def broken():
        raise InputError("run the cell <first>")
        yield ""

    dialogue = Dialogue("Ask me", broken)
    dialogue.begin()
    assert dialogue.texts == ["<p>run the cell &lt;first&gt;</p>"]


def test_a_page_without_a_kernel_says_how_to_get_the_questions():
    data, _ = Dialogue("Ask me", steps)._repr_mimebundle_()
    assert data["text/plain"] == "Ask me: run this cell again"


def test_only_a_number_can_be_typed():
    with pytest.raises(InputError, match="nan"):
        predict.entry("How many?", float("nan"))
