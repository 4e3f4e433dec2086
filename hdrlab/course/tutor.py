"""Three questions that lead from a failed check to the mistake, without a language model.

Each question shows a small input and asks what the student's function should give. After her answer,
the tutor shows what her own function gives, what is right, and the sentence of the assignment that
says so. The last step shows the line of her code, if it is known.

The questions of frequent mistakes are beside the mistakes (`checks.mistakes`). For all other failures
the tutor makes them from the counterexample of the failed check: a simpler input for which her
function is right, the smallest one for which it is wrong, and which sentence that input breaks.

Nothing here is used in grading. The inputs are those of the table of mistakes and of public
counterexamples, so they reveal nothing of hidden checks. Her function runs in the sandbox of `check`.
"""

import ast
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from html import escape
from importlib import import_module
from itertools import islice
from types import ModuleType
from typing import Any

import numpy as np

from hdrlab.course import plan
from hdrlab.course.checks import counterexamples, misconceptions, sentences, shrinking, snippets
from hdrlab.course.checks.mistakes import KnownMistake, Question
from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.grading.results import Check, Result
from hdrlab.course.plan import GradingOptions, Task
from hdrlab.course.sandbox import tiers
from hdrlab.course.source_code import inline, patches
from hdrlab.course.submissions.reader import SubmittedCode
from hdrlab.course.variants import rewording
from hdrlab.show.widgets import predict
from hdrlab.show.widgets.dialogue import Steps

QUESTION_COUNT = 3
# of a call: less than in `check`, because a student waits for it
CALL_TIMEOUT_SECONDS = 3.0
# inputs that are tried for one question
MAX_CHANGED_INPUTS = 60
# how checks end for which a function gives no answer at all
SILENT_KINDS = ("late", "died", "killed", "refused", "damaged")
# a number that has so few digits can be worked out by hand, and typed
MAX_TYPED_DIGITS = 3
# relative error of a number in float32, and of one that was rounded to these digits
TYPED_PRECISION = 1e-4
MAX_LABELS = 4
MAX_OPTIONS = 4
# numbers of an answer among which the worst one is looked for
MAX_PLACES = 300
# what a stub raises until a student writes the function
STUB_ERROR = "NotImplementedError"
Arguments = tuple[tuple[Any, ...], dict[str, Any]]
# formulas and code in an assignment's sentence
MARKDOWN_PARTS = re.compile(r"(\$\$.*?\$\$|\$.*?\$|`.*?`)", re.DOTALL)


@dataclass(frozen=True, kw_only=True)
class Step:
    """A small input, and what functions give for it.

    Attributes
    ----------
    code : lines of Python; the last one is an expression
    right : what the solution gives
    yours : what the student's function gives; None if it fails
    failure : how the student's function fails, "" if it gives a value
    why : how to work the right value out by hand
    sentence : of the assignment, in Markdown
    """

    code: str
    right: Any
    yours: Any = None
    failure: str = ""
    why: str = ""
    sentence: str = ""

    @property
    def is_right(self) -> bool:
        """Whether the student's function gives the right value."""
        return not self.failure and not counterexamples.differs(self.yours, self.right)


def tasks_to_ask(result: Result) -> list[str]:
    """Return the tasks of a result for which the tutor has something to ask.

    These are the tasks with a public check that failed, except for stubs that are not yet written.
    """
    failed = [check for check in _failed(result) if not check.message.count(STUB_ERROR)]
    return [name for name in result.tasks if any(check.task == name for check in failed)]


def ask(
    task: Task,
    code: SubmittedCode,
    result: Result,
    options: GradingOptions,
) -> Steps:
    """Yield the steps of the dialogue about a task: questions, and the text after each, as HTML.

    Parameters
    ----------
    task : the task
    code : the student's functions as they are now
    result : the latest result of the task's checks
    options : how `check` runs a student's functions
    """
    failed = [check for check in _failed(result) if check.task == task.id]
    if not failed:
        yield _paragraph(f"All checks of {_code(task.id)} pass. There is nothing to ask.")
        return
    silent = [check for check in failed if check.kind in SILENT_KINDS]
    if silent:
        yield _paragraph(
            f"There is nothing to ask yet: {_code(silent[0].message)}. First make your function "
            "answer. Does each of its loops end?"
        )
        return
    tutor = Tutor(task, code, options)
    sentence = result.misconceptions.get(task.id, "")
    mistakes = [known for known in misconceptions.of_task(task) if known.sentence in sentence]
    yield from tutor.ask(failed, mistakes)


def _failed(result: Result) -> list[Check]:
    """Return the public checks that do not hold."""
    return [
        check
        for check in result.checks
        if not check.hidden and check.outcome in ("fails", "no answer") and check.kind != "missing"
    ]


class Tutor:
    """The questions about one student's function.

    Parameters
    ----------
    task : the task
    code : the student's functions
    options : how `check` runs them
    """

    def __init__(self, task: Task, code: SubmittedCode, options: GradingOptions) -> None:
        self._task = task
        self._code = code
        self._options = options
        self._solution = plan.function(task)
        self._demands = sentences.demands_of(task)
        self._known = misconceptions.of_task(task)

    def ask(self, failed: Sequence[Check], mistakes: Sequence[KnownMistake]) -> Steps:
        """Yield questions about a function that fails checks, with the mistakes that it shows."""
        steps = self._steps_of_mistakes(mistakes) or self._steps_of_task()
        if not steps:
            steps = self._steps_of_counterexample(failed)
        if steps and all(step.is_right for step in steps):
            yield _paragraph(
                f"For the inputs of these questions, your {_code(self._task.name)} is right now. "
                "Run the check again."
            )
            return
        asks_for_sentence = len(steps) < QUESTION_COUNT
        quoted = ""
        for number, step in enumerate(steps, 1):
            yield self._question(number, step)
            shows_sentence = not asks_for_sentence and step.sentence != quoted
            yield self._explanation(step, shows_sentence=shows_sentence)
            quoted = step.sentence
        if not steps:
            yield _paragraph(
                "hdrlab found no small input for which your function is wrong. If you have changed "
                "it since, run the check again."
            )
        if asks_for_sentence:
            yield from self._ask_for_sentence(len(steps) + 1, failed, mistakes)
        yield self._closing(steps, mistakes)

    def _steps_of_mistakes(self, mistakes: Sequence[KnownMistake]) -> list[Step]:
        """Return the steps of the first mistake whose questions fit the student's function.

        Questions fit if her function answers the last one as the mistake does.
        """
        for known in mistakes:
            steps = self._steps_of_questions(known.questions)
            if not steps:
                continue
            last = steps[-1]
            expected = run_code(last.code, self._task.id, known.function)
            if not last.failure and not counterexamples.differs(last.yours, expected):
                return steps
        return []

    def _steps_of_task(self) -> list[Step]:
        """Return steps out of the questions of all mistakes of the task: one right, two wrong."""
        by_code = {question.code: question for known in self._known for question in known.questions}
        steps = self._steps_of_questions(list(by_code.values()))
        wrong = [step for step in steps if not step.is_right]
        if not wrong:
            return []
        if any(step.failure for step in wrong):  # one error is enough to look at
            wrong = [next(step for step in wrong if step.failure)]
        right = [step for step in steps if step.is_right]
        return [*right[:1], *wrong[: QUESTION_COUNT - 1]]

    def _steps_of_questions(self, questions: Sequence[Question]) -> list[Step]:
        """Return the steps of questions; none for a variant, in whose words they are not written."""
        if not questions or self._task.variant not in ("", rewording.every(self._task.id)[0]):
            return []
        with self._subject() as subject:
            return [
                self._step(
                    question.code,
                    subject,
                    why=question.why,
                    sentence=self._sentence(question.because),
                )
                for question in questions
            ]

    def _steps_of_counterexample(self, failed: Sequence[Check]) -> list[Step]:
        """Return a simple input for which the function is right, and one for which it is wrong.

        The wrong one is similar to the counterexample, whose right value the student has read in the
        feedback. If the function is right for all similar ones, it is the counterexample.
        """
        codes = [check.counterexample.code for check in failed if check.counterexample]
        if not codes:
            return []
        with self._subject() as subject:
            whole = self._step(codes[0], subject)
            if whole.is_right:
                return [whole]
            code = self._similar_counterexample(codes[0], whole.right, subject) or codes[0]
            whole = self._step(code, subject)
            place = _worst_place(whole.right, whole.yours)
            wrong = self._step(code + place, subject)
            simpler = self._rewritten(code, shrinking.simpler_inputs)
            candidates = [text + place for text, _ in simpler]
            candidates += [code + other for other in _places(whole.right)]
            for candidate in candidates:
                with suppress(Exception):  # the expression may not fit a smaller input
                    step = self._step(candidate, subject)
                    if step.is_right:
                        return [step, wrong]
        return [wrong]

    def _similar_counterexample(self, code: str, right: Any, subject: Subject) -> str:
        """Return a similar counterexample with another right value than this one; "" if none is found.

        The checks of the task decide whether the function is wrong, as for the first counterexample.
        """
        module = _module_of(self._task)
        if module is None:
            return ""
        search = counterexamples.Search(
            self._task.id, module, subject, self._solution, raised=False
        )
        for candidate, (args, kwargs) in self._rewritten(code, similar_inputs):
            with suppress(Exception):  # the functions may not accept this input
                step = self._step(candidate, subject)
                is_other = counterexamples.differs(step.right, right)
                if not is_other or step.is_right or step.failure:
                    continue
                if search.try_input(args, kwargs) is not None:
                    return candidate
        return ""

    def _rewritten(
        self, code: str, change: Callable[[Arguments], Iterable[Arguments]]
    ) -> Iterator[tuple[str, Arguments]]:
        """Yield the code of a counterexample with other inputs, and these inputs.

        `change` makes them from those of the counterexample. If the file of checks has SMALL_INPUTS,
        they are used instead, because inputs such as files have a structure that must be kept.
        """
        inputs, _, last = code.rpartition("\n")
        start = last.index(f"{self._task.id}(")
        call = _balanced(last[start:])
        arguments = snippets.Snippet(tuple(inputs.splitlines()), call).arguments()
        module = _module_of(self._task)
        is_valid = getattr(module, "is_valid_input", None)
        if module is not None and hasattr(module, "SMALL_INPUTS"):
            inputs_to_try = counterexamples.small_inputs(module)
        else:
            inputs_to_try = iter(change(arguments))
        for number, (args, kwargs) in enumerate(inputs_to_try):
            if number == MAX_CHANGED_INPUTS:
                return
            if is_valid is not None and not is_valid(*args, **kwargs):
                continue
            snippet = snippets.write(self._task.id, self._solution, args, kwargs)
            rest = last[start + len(call) :]
            text = "\n".join([*snippet.inputs, last[:start] + snippet.call + rest])
            yield text, (tuple(args), dict(kwargs))

    def _subject(self) -> Subject:
        """Return the student's functions in a sandbox."""
        sandbox = tiers.choose(self._options.tier)
        return Subject(self._code.sources, sandbox, CALL_TIMEOUT_SECONDS, self._code.modules)

    def _step(self, code: str, subject: Subject, *, why: str = "", sentence: str = "") -> Step:
        """Return a step with what the solution and the student's function give."""
        right = run_code(code, self._task.id, self._solution)
        yours, failure = self._answer(code, subject)
        return Step(
            code=code, right=right, yours=yours, failure=failure, why=why, sentence=sentence
        )

    def _answer(self, code: str, subject: Subject, source: str = "") -> tuple[Any, str]:
        """Return what the student's function, or a changed one, gives, and how it fails."""
        subject.fresh(**{self._task.id: source or self._code.sources[self._task.id]})
        try:
            return run_code(code, self._task.id, getattr(subject, self._task.id)), ""
        except NoAnswer as error:
            return None, str(error)
        except Exception as error:  # her answer has another form than the expression expects
            return None, f"an answer of another form ({type(error).__name__}: {error})"

    def _sentence(self, start: str) -> str:
        """Return the demand of the assignment that begins with some words, "" if there is none."""
        return next((d.sentence for d in self._demands if d.sentence.startswith(start)), "")

    def _question(self, number: int, step: Step) -> predict.Prediction:
        """Return the form that asks for a step's right value."""
        what = "the last line" if "\n" in step.code else "this"
        text = f"{number}. What should {what} give?"
        labels = self._labels(step)
        if labels:
            truth = labels.index(snippets.show(step.right))
            form = predict.choice(text, truth, labels)
        else:
            form = predict.entry(text, float(f"{float(step.right):.{MAX_TYPED_DIGITS}g}"))
        form.code = step.code
        form.covers = False
        return form

    def _labels(self, step: Step) -> list[str]:
        """Return the values to choose from; none for a number that a student can type."""
        if isinstance(step.right, bool | np.bool):
            return ["False", "True"]
        if _is_typed(step.right):
            return []
        values = [step.right]
        if not step.failure:
            values.append(step.yours)
        for known in self._known:
            with suppress(Exception):  # a wrong function may fail in any way
                values.append(run_code(step.code, self._task.id, known.function))
        if not _is_number(step.right):
            values.append("an error")
        elif not np.isfinite(float(step.right)):
            values += [np.nan, 0.0, 1.0]
        texts = dict.fromkeys(
            value if isinstance(value, str) else snippets.show(value) for value in values
        )
        labels = sorted(list(texts)[:MAX_LABELS])
        return labels if len(labels) > 1 else []

    def _explanation(self, step: Step, *, shows_sentence: bool) -> str:
        """Return the text after the answer to a question."""
        name = _code(self._task.name)
        if step.failure:
            parts = [f"<b>Your {name} gives no value:</b> {_code(step.failure)}."]
        elif step.is_right:
            parts = [f"<b>Your {name} leads to this value, too.</b>"]
        else:
            yours = _code(snippets.show(step.yours))
            parts = [f"<b>Your {name} leads to {yours}.</b>"]
        if step.why:
            parts.append(escape(step.why))
        if step.sentence and shows_sentence:
            parts.append(f"The assignment says: {_quote(step.sentence)}")
        return _paragraph(" ".join(parts))

    def _ask_for_sentence(
        self, number: int, failed: Sequence[Check], mistakes: Sequence[KnownMistake]
    ) -> Steps:
        """Ask which sentence of the assignment the function breaks."""
        names = {known.name for known in mistakes}
        shown = next((check for check in failed if check.counterexample), failed[0])
        broken = [d for d in self._demands if names & d.wrong.keys()]
        broken = broken or [d for d in self._demands if shown.name in d.checks]
        if not broken:
            return
        others = [d for d in self._demands if d not in broken and shown.name not in d.checks]
        options = [d for d in self._demands if d is broken[0] or d in others[: MAX_OPTIONS - 1]]
        if len(options) == 1:
            yield _paragraph(f"The assignment says: {_quote(broken[0].sentence)}")
            return
        items = "".join(f"<li>{_html(d.sentence)}</li>" for d in options)
        yield f"<p>{number}. The assignment says:</p><ol>{items}</ol>"
        labels = [f"Sentence {place}" for place in range(1, len(options) + 1)]
        text = "Which of these sentences does your function not obey?"
        form = predict.choice(text, options.index(broken[0]), labels)
        form.covers = False
        yield form
        yield _paragraph(f"The check that failed: {escape(shown.promise)}.")

    def _closing(self, steps: Sequence[Step], mistakes: Sequence[KnownMistake]) -> str:
        """Return the end of the dialogue: the mistake, and the lines of the student's code."""
        named = "".join(
            _paragraph(f"<b>Likely mistake:</b> {escape(mistake.sentence)}") for mistake in mistakes
        )
        numbers = self._find_lines(steps, mistakes)
        source = self._code.sources[self._task.id]
        only_line = "" if numbers else _only_line(source, self._task.id)
        if only_line:
            return named + (
                "<p>Your function does everything in one line. Compare this line with the sentence "
                f"of the assignment:</p><pre>{escape(only_line)}</pre>"
            )
        if not numbers:
            return named + _paragraph(
                "hdrlab does not know which line of your code it is. Look for the one that should "
                "do what the sentence of the assignment says."
            )
        lines = source.split("\n")
        texts = "\n".join(lines[number - 1].strip() for number in numbers)
        these = "this line" if len(numbers) == 1 else "these lines"
        return named + (
            f"<p>Look at {these} of your code. With a change in {these} alone, your "
            f"{_code(self._task.name)} is right for all inputs above:</p><pre>{escape(texts)}</pre>"
        )

    def _find_lines(self, steps: Sequence[Step], mistakes: Sequence[KnownMistake]) -> list[int]:
        """Return the numbers of the lines whose change makes the function right for all inputs.

        The change is that from a named mistake to the solution, so only its lines are found.
        """
        if all(step.is_right for step in steps):
            return []
        source = self._code.sources[self._task.id]
        with self._subject() as subject:

            def is_right(changed: str) -> bool:
                return self._is_right_everywhere(changed, steps, subject)

            for known in mistakes:
                for edits in self._edits(known):
                    numbers = patches.wrong_lines(source, edits, is_right)
                    if numbers:
                        return numbers
        return []

    def _edits(self, known: KnownMistake) -> Iterator[list[patches.Edit]]:
        """Yield the changes of code that may correct a mistake: its fixes, and those to the solution."""
        if known.fixes:
            yield [patches.edit(wrong, right) for wrong, right in known.fixes]
        if known.source:
            yield patches.edits(self._source(known.source), self._source(self._task.function))

    def _source(self, function: str) -> str:
        """Return the text of one of hdrlab's functions, as a student's cell would hold it."""
        text = inline.inlined({self._task.id: function})[self._task.id].text
        return rewording.reword(self._task.id, self._task.variant, text)

    def _is_right_everywhere(self, source: str, steps: Sequence[Step], subject: Subject) -> bool:
        """Return whether a changed source gives the right value for all inputs."""
        for step in steps:
            yours, failure = self._answer(step.code, subject, source)
            if failure or counterexamples.differs(yours, step.right):
                return False
        return True


def run_code(code: str, task: str, function: Callable[..., Any]) -> Any:
    r"""Return the value of the last line of a question's code, in which a task has a function.

    The code is hdrlab's own: of a question, or of a counterexample.

    Examples
    --------
    >>> run_code("z = np.arange(3)\ndouble(z)[2]", "double", lambda z: 2 * z).item()
    4
    """
    inputs, _, last = code.rpartition("\n")
    scope: dict[str, Any] = {"np": np, task: function}
    exec(inputs, scope)
    return eval(last, scope)


def similar_inputs(arguments: Arguments) -> Iterator[Arguments]:
    """Yield the arguments of a call with one array doubled, or with its values in reverse order.

    Examples
    --------
    >>> [args for args, _ in similar_inputs(((np.array([1, 3]),), {}))]
    [(array([2, 6]),), (array([3, 1]),)]
    """
    args, kwargs = arguments
    for place, value in enumerate(args):
        if not isinstance(value, np.ndarray) or value.dtype.kind not in "uif":
            continue
        doubled = 2 * value.astype(np.float64)
        is_integer = value.dtype.kind != "f"
        if not is_integer or doubled.max(initial=0) <= np.iinfo(value.dtype).max:
            yield (*args[:place], doubled.astype(value.dtype), *args[place + 1 :]), kwargs
        yield (*args[:place], np.flip(value), *args[place + 1 :]), kwargs


def _module_of(task: Task) -> ModuleType | None:
    """Return the module with the checks of a task, None for an instructor's own."""
    if task.own is not None:
        return None
    return import_module(f"hdrlab.course.checks.specification.test_{task.id}")


def _balanced(text: str) -> str:
    """Return the call at the start of a text, up to its closing parenthesis."""
    depth = 0
    for end, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        if letter == ")" and depth == 0:
            return text[: end + 1]
    return text


def _only_line(source: str, name: str) -> str:
    """Return the line of a function that has one statement in one line, "" for all others."""
    functions = [node for node in ast.parse(source).body if isinstance(node, ast.FunctionDef)]
    function = next((node for node in functions if node.name == name), None)
    if function is None:  # such as a lambda that was given the name
        return ""
    statements = [
        statement
        for statement in function.body
        if not (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant))
    ]
    if len(statements) != 1 or statements[0].lineno != statements[0].end_lineno:
        return ""
    return source.split("\n")[statements[0].lineno - 1].strip()


def _worst_place(right: Any, yours: Any) -> str:
    """Return the index of the part of an answer that differs most, as code; "" for one number."""
    places = _places(right)
    errors = []
    for place in places:
        error = np.inf
        with suppress(Exception):  # her answer may have any form
            error = abs(float(_part(yours, place)) - float(_part(right, place)))
        errors.append(np.inf if np.isnan(error) else error)
    return places[int(np.argmax(errors))] if places else ""


def _places(answer: Any, start: str = "") -> list[str]:
    """Return the indices of all numbers in an answer of several parts, as code."""
    if isinstance(answer, tuple | list):
        parts = [_places(part, f"{start}[{k}]") for k, part in enumerate(answer)]
        return [place for places in parts for place in places]
    if isinstance(answer, np.ndarray) and answer.ndim:
        return [
            start + "".join(f"[{k}]" for k in index)
            for index in islice(np.ndindex(answer.shape), MAX_PLACES)
        ]
    return [start] if start else []


def _part(answer: Any, place: str) -> Any:
    return eval(f"answer{place}", {"answer": answer})


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float | np.generic | np.ndarray) and np.ndim(value) == 0


def _is_typed(value: Any) -> bool:
    """Return whether a value is a number with so few digits that a student can type it."""
    if not _is_number(value):
        return False
    number = float(value)
    rounded = float(f"{number:.{MAX_TYPED_DIGITS}g}")
    return abs(rounded - number) <= TYPED_PRECISION * abs(number)


def _code(text: str) -> str:
    return f"<code>{escape(text)}</code>"


def _quote(sentence: str) -> str:
    """Return a sentence between quotes as HTML; a displayed formula has a line of its own."""
    if sentence.startswith("$$"):
        return _html(sentence)
    return f"<q>{_html(sentence)}</q>"


def _paragraph(html: str) -> str:
    return f"<p>{html}</p>"


def _html(markdown: str) -> str:
    """Return a sentence of an assignment as HTML; its formulas stay between dollar signs."""
    parts = []
    for part in MARKDOWN_PARTS.split(markdown):
        if part.startswith("`"):
            parts.append(_code(part.strip("`")))
        elif part.startswith("$"):
            parts.append(escape(part))
        else:
            parts.append(re.sub(r"\*+(.+?)\*+", r"<em>\1</em>", escape(part)))
    return "".join(parts)
