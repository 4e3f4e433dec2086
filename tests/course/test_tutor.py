"""The tutor's questions are true, lead to the mistake, and end where there is nothing to ask."""

import difflib
import re
from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from hdrlab.core.steps import last
from hdrlab.course import notebook, plan, tutor
from hdrlab.course.checks import counterexamples, misconceptions, sentences, snippets
from hdrlab.course.grading import grader
from hdrlab.course.grading.results import Check, Counterexample, Result
from hdrlab.course.plan import GradingOptions
from hdrlab.course.sandbox import in_process
from hdrlab.course.source_code import inline, patches
from hdrlab.course.source_code.closure import Cell
from hdrlab.course.submissions.reader import SubmittedCode
from hdrlab.show.widgets.predict import Prediction

PLAN = plan.read()
KNOWN = {known.name: known for known in misconceptions.known() if known.questions}
HERE = GradingOptions(in_process.TIER, draw=False)
pytestmark = pytest.mark.filterwarnings("ignore")


def source_of(task, function):
    """Return the text of a function of hdrlab as a student's cell holds it."""
    return inline.inlined({task: function})[task].text


def code_of(task, text):
    return SubmittedCode({task: text}, (), "", ("numpy",))


def result_of(task, *checks, sentence=""):
    """Return the result of some checks of a task."""
    mistakes = {task: sentence} if sentence else {}
    return Result("", "hw", "", "practice", checks, mistakes, (), "", "", "", {})


def failed(task, **details):
    fields = {"outcome": "fails", "message": "wrong"} | details
    return Check(task, "test_it", "It works", Fraction(0), Fraction(1), **fields)


def dialogue_about(task, text, result, options=HERE):
    """Return the questions and the texts of the whole dialogue."""
    steps = list(tutor.ask(PLAN.task(task), code_of(task, text), result, options))
    forms = [step for step in steps if isinstance(step, Prediction)]
    return forms, [step for step in steps if isinstance(step, str)]


@cache
def dialogue_of(name):
    """Return the dialogue of a student whose function is the mistake."""
    known = KNOWN[name]
    result = result_of(known.task, failed(known.task), sentence=known.sentence)
    return dialogue_about(known.task, source_of(known.task, known.source), result)


def value(code, task, function):
    """Return what the last line of some code gives with a function, or None if it fails."""
    scope = {"np": np, task: function}
    lines = code.split("\n")
    with np.errstate(all="ignore"):
        exec("\n".join(lines[:-1]), scope)
        try:
            return eval(lines[-1], scope)
        except Exception:
            return None


def truth_of(form):
    """Return the right answer of a form as a number."""
    if form.kind == "choice":
        return float(form.labels[form.truth])
    return form.truth


def test_at_least_twenty_mistakes_have_questions_and_each_has_three():
    assert len(KNOWN) >= 20
    assert {len(known.questions) for known in KNOWN.values()} == {tutor.QUESTION_COUNT}


@pytest.mark.grading
@pytest.mark.parametrize("name", KNOWN)
def test_questions_lead_from_a_right_value_to_wrong_ones_and_tell_both_truly(name):
    known = KNOWN[name]
    forms, texts = dialogue_of(name)
    solution = plan.function(PLAN.task(known.task))
    assert [form.code for form in forms] == [question.code for question in known.questions]
    is_wrong = []
    for form, text in zip(forms, texts, strict=False):
        right = value(form.code, known.task, solution)
        mistaken = value(form.code, known.task, known.function)
        assert np.isclose(truth_of(form), right, rtol=1e-3, equal_nan=True)
        is_wrong.append(not np.isclose(mistaken, right, rtol=2e-3, equal_nan=True))
        assert f"leads to <code>{snippets.show(mistaken)}</code>" in text or not is_wrong[-1]
        assert "leads to this value" in text or is_wrong[-1]
    assert is_wrong == [False, True, True]


@pytest.mark.parametrize("name", KNOWN)
def test_each_reason_is_one_sentence_of_the_assignment(name):
    known = KNOWN[name]
    demands = sentences.demands_of(PLAN.task(known.task))
    for question in known.questions:
        found = [demand for demand in demands if demand.sentence.startswith(question.because)]
        assert len(found) == 1, question.because


@pytest.mark.grading
@pytest.mark.parametrize("name", KNOWN)
def test_the_line_that_is_shown_is_one_in_which_the_mistake_differs_from_the_solution(name):
    known = KNOWN[name]
    closing = dialogue_of(name)[1][-1]
    assert known.sentence.split("'")[0][:20] in closing.replace("&#x27;", "'").replace("&gt;", ">")
    shown = re.search("<pre>(.*)</pre>", closing, re.DOTALL)
    if shown is None:
        assert "does not know which line" in closing
        return
    wrong = source_of(known.task, known.source).splitlines()
    right = source_of(known.task, PLAN.task(known.task).function).splitlines()
    changed = [line[2:].strip() for line in difflib.ndiff(right, wrong) if line.startswith("+ ")]
    lines = shown[1].replace("&gt;", ">").replace("&lt;", "<").replace("&quot;", '"').splitlines()
    assert lines and set(lines) <= set(changed)


@pytest.mark.grading
def test_the_line_is_found_for_most_mistakes_in_their_own_code():
    closings = [dialogue_of(name)[1][-1] for name in KNOWN]
    assert sum("<pre>" in closing for closing in closings) > len(KNOWN) / 2


def test_the_line_is_found_in_code_with_other_names_and_a_loop():
    text = """import numpy as np
def hat(n=256):
    levels = []
    for z in range(n):
        levels.append(min(z + 1, n - z))
    return np.array(levels)
"""
    known = KNOWN["hat_ends_count"]
    result = result_of("hat", failed("hat"), sentence=known.sentence)
    assert (
        "<pre>levels.append(min(z + 1, n - z))</pre>" in dialogue_about("hat", text, result)[1][-1]
    )


def test_the_only_line_of_a_function_is_shown_even_if_no_fix_is_known():
    text = """def hat(n=256):
    return [1.0] * n
"""
    closing = dialogue_about("hat", text, result_of("hat", failed("hat")))[1][-1]
    assert "<pre>return [1.0] * n</pre>" in closing


def test_a_lambda_with_the_name_of_the_task_gets_a_closing_without_a_line():
    text = "hat = lambda n=256: [1.0] * n\n"
    closing = dialogue_about("hat", text, result_of("hat", failed("hat")))[1][-1]
    assert "<pre>" not in closing and "does not know which line" in closing


def test_a_function_that_is_right_by_now_gets_no_question():
    known = KNOWN["hat_ends_count"]
    example = Counterexample("hat(4)", "[0.5, 1, 1, 0.5]", "[0, 1, 1, 0]")
    result = result_of("hat", failed("hat", counterexample=example), sentence=known.sentence)
    forms, texts = dialogue_about("hat", source_of("hat", "core.weights.hat"), result)
    assert forms == [] and "is right now" in texts[0]


def test_there_is_nothing_to_ask_about_passed_hidden_and_unwritten_checks():
    passed = failed("hat", outcome="holds")
    hidden = failed("hat", hidden=True)
    stub = failed(
        "hat", outcome="no answer", kind="raised", message="hat raised NotImplementedError"
    )
    assert tutor.tasks_to_ask(result_of("hat", passed, hidden, stub)) == []
    assert tutor.tasks_to_ask(result_of("hat", passed, failed("hat"))) == ["hat"]
    forms, texts = dialogue_about("hat", "def hat(n): return 1", result_of("hat", passed, hidden))
    assert forms == [] and "nothing to ask" in texts[0]


def test_an_endless_function_gets_a_message_and_no_question():
    late = failed("hat", outcome="no answer", kind="late", message="hat took longer than 10 s")
    forms, texts = dialogue_about(
        "hat", "def hat(n):\n    while True: pass", result_of("hat", late)
    )
    assert forms == [] and "hat took longer than 10 s" in texts[0]


@pytest.mark.grading
def test_a_function_that_is_endless_for_one_input_ends_in_a_message(monkeypatch):
    monkeypatch.setattr(tutor, "CALL_TIMEOUT_SECONDS", 0.5)
    text = """import numpy as np
def hat(n=256):
    while n < 8:
        pass
    return np.ones(n)
"""
    practice = replace(HERE, tier="practice")
    forms, texts = dialogue_about("hat", text, result_of("hat", failed("hat")), practice)
    assert 1 <= len(forms) <= 3
    assert any("took longer than 0.5 s" in text for text in texts)


def test_a_function_that_raises_an_error_is_asked_about_once():
    text = "def hat(n=256):\n    return [1][n]\n"
    forms, texts = dialogue_about("hat", text, result_of("hat", failed("hat")))
    assert len([form for form in forms if form.code]) == 1
    assert "IndexError" in texts[0] and "return [1][n]" in texts[0]


CUT = """import numpy as np
def shrink(Y):
    Y = Y[: len(Y) // 2 * 2, : Y.shape[1] // 2 * 2]
    return Y[::2, ::2]
"""


@pytest.mark.grading
def test_other_failures_are_asked_about_with_their_counterexample_and_their_sentence():
    homework = PLAN.homeworks["hw1"]
    task = PLAN.task("shrink")
    code = code_of("shrink", CUT)
    result = last(grader.check_steps(code, homework._replace(tasks=(task,)), HERE))
    forms, _ = dialogue_about("shrink", CUT, result)
    simple, wrong, which = forms
    example = next(check.counterexample for check in result.checks if check.counterexample)
    scope = {}
    exec(CUT, scope)
    own = scope["shrink"]
    solution = plan.function(task)
    assert value(simple.code, "shrink", own) == value(simple.code, "shrink", solution)
    assert value(wrong.code, "shrink", own) != value(wrong.code, "shrink", solution)
    # the student has read the right value of the counterexample itself
    assert not wrong.code.startswith(example.code)
    demands = sentences.demands_of(task)
    broken = [demand for demand in demands if "shrink_skips_pixels" in demand.wrong]
    assert which.labels[which.truth] == f"Sentence {demands.index(broken[0]) + 1}"


def test_a_variant_of_a_task_is_not_asked_about_in_the_words_of_another():
    task = PLAN.task("shift")._replace(variant="black/goes/rows")
    known = KNOWN["shift_rolls_around"]
    result = result_of("shift", failed("shift"), sentence=known.sentence)
    code = code_of("shift", source_of("shift", known.source))
    steps = list(tutor.ask(task, code, result, HERE))
    codes = [step.code for step in steps if isinstance(step, Prediction)]
    assert not set(codes) & {question.code for question in known.questions}


def test_text_of_a_student_is_escaped():
    text = "def hat(n=256):\n    raise ValueError('<script>alert(1)</script>')\n"
    _, texts = dialogue_about("hat", text, result_of("hat", failed("hat")))
    assert "alert(1)" in "".join(texts) and "<script" not in "".join(texts)


def test_the_button_asks_about_the_function_that_is_defined_now(monkeypatch):
    known = KNOWN["hat_ends_count"]
    wrong = source_of("hat", known.source)
    result = result_of("hat", failed("hat"), sentence=known.sentence)
    monkeypatch.setattr(notebook, "PRACTICE", HERE)
    monkeypatch.setattr(notebook, "_cells_of_kernel", lambda: [Cell(wrong)])
    homework, _ = notebook.find_tasks("hat")
    dialogue = notebook.FeedbackWithTutor(result, homework).dialogue("hat")
    for number in range(3):
        if number == 0:
            dialogue.begin()
        dialogue.questions[number].done = True
    assert len(dialogue.questions) == 3 and known.sentence in dialogue.texts[-1]
    monkeypatch.setattr(notebook, "_cells_of_kernel", lambda: [])
    dialogue.begin()
    assert dialogue.questions == [] and "hat is not defined" in dialogue.texts[0]


def test_edits_at_one_place_are_tried_before_several_lines_together():
    edits = [patches.edit("log2", "log"), patches.edit("+ 1", "")]
    source = "a = log2(x)\nb = log2(y) + 1\nc = 1\n"
    assert patches.wrong_lines(source, edits, lambda text: "log(y)" in text) == [2]
    together = patches.wrong_lines(source, edits, lambda text: "log2" not in text)
    assert together == [1, 2]
    assert patches.wrong_lines(source, edits, lambda text: False) == []
    assert patches.wrong_lines("this is no Python (", edits, lambda text: True) == []


def test_small_differences_of_answers_count_as_right_as_in_the_counterexamples():
    step = tutor.Step(code="f()", right=1.0, yours=1.0 + counterexamples.WRONG_FRACTION / 2)
    assert step.is_right
    assert not tutor.Step(code="f()", right=1.0, yours=1.01).is_right
    assert not tutor.Step(code="f()", right=1.0, failure="f raised ValueError").is_right
