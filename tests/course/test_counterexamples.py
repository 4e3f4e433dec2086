"""The counterexample of a failed check is small, correct, reproducible by pasting, and reveals no secret."""

import inspect
from dataclasses import replace
from fractions import Fraction
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from hdrlab.core.steps import last
from hdrlab.course import plan
from hdrlab.course.checks import counterexamples, misconceptions, shrinking, snippets
from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.grading import grader, results
from hdrlab.course.grading.results import Check, Counterexample, Result
from hdrlab.course.plan import GradingOptions
from hdrlab.course.reports import feedback
from hdrlab.course.sandbox import in_process, tiers
from hdrlab.course.source_code.names import imported_numpy_modules
from hdrlab.course.submissions.reader import SubmittedCode

PLAN = plan.read()
FAIRNESS = Path(__file__).parents[2] / "benchmarks" / "fairness"
# a mistake of each of these, and a check that it fails
MISTAKES = {
    "hat_ends_count": "test_any_number_of_levels_works",
    "shrink_overflows": "test_a_bright_sky_does_not_overflow",
    "shift_rolls_around": "test_pixels_do_not_wrap_around_the_border",
    "merge_by_the_number_of_frames": "test_it_is_the_weighted_mean_of_the_logarithms",
    "display_white_not_squared": "test_white_becomes_1_and_brighter_pixels_are_clipped",
    "exclusion_bytes_wrap": "test_bytes_do_not_wrap_around",
    "log_average_linear": "test_it_is_the_geometric_mean",
}
SNR_CHECK = "test_the_weight_is_the_signal_over_its_slope"
KNOWN = {mistake.name: mistake for mistake in misconceptions.known()}
pytestmark = pytest.mark.filterwarnings("ignore")


def subject_of(task, text):
    """Return a Subject of one function, which runs in this process."""
    modules = tuple(imported_numpy_modules([text]))
    return Subject({task: text}, tiers.choose(in_process.TIER), 10.0, modules)


def module_of(task):
    return import_module(f"hdrlab.course.checks.specification.test_{task}")


def runner(check):
    """Return the function that runs a check on a subject with a random generator."""
    names = inspect.signature(check).parameters

    def run(subject, rng):
        arguments = {"subject": subject, "rng": rng}
        check(**{name: arguments[name] for name in names})

    return run


def find(task, text, check, *, raised=False):
    """Return the counterexample of a task's function for a check, or None."""
    module = module_of(task)
    solution = plan.function(PLAN.task(task))
    run = runner(getattr(module, check))
    with subject_of(task, text) as subject:
        try:
            return counterexamples.find(task, module, run, subject, solution, raised=raised)
        except counterexamples.NoCounterexample:
            return None


def source_of(name):
    """Return the complete source of a known mistake."""
    mistake = KNOWN[name]
    return misconceptions.solutions([PLAN.task(mistake.task)], [name])[mistake.task]


def pasted(example, function):
    """Run the code of a counterexample in a notebook with a function, and return what it prints."""
    task = example.call.partition("(")[0]
    if task == "list" or task == "np.array":
        task = example.call.split("(")[1]
    scope = {"np": np, task: function}
    exec("\n".join(example.inputs), scope)
    return snippets.show(eval(example.call, scope))


def function_in(task, text):
    scope = {"np": np}
    exec(text, scope)
    return scope[task]


@pytest.mark.parametrize(("name", "check"), MISTAKES.items())
def test_pasting_a_counterexample_gives_the_two_values_that_it_claims(name, check):
    task = KNOWN[name].task
    example = find(task, source_of(name), check)
    assert example is not None
    assert pasted(example, function_in(task, source_of(name))) == example.yours
    assert pasted(example, plan.function(PLAN.task(task))) == example.correct
    assert example.yours != example.correct
    assert snippets.Snippet(example.inputs, example.call).count <= 9


@pytest.mark.parametrize(("name", "check"), MISTAKES.items())
def test_no_row_of_a_counterexample_can_be_left_out(name, check):
    task = KNOWN[name].task
    module = module_of(task)
    example = find(task, source_of(name), check)
    value = snippets.Snippet(example.inputs, example.call).arguments()
    with subject_of(task, source_of(name)) as subject:
        search = counterexamples.Search(
            task, module, subject, plan.function(PLAN.task(task)), raised=False
        )
        assert search.try_input(*value) is not None
        for path, array in shrinking.leaves(value):
            for axis in range(np.ndim(array)):
                lengths = {np.shape(leaf)[axis : axis + 1] for _, leaf in shrinking.leaves(value)}
                if array.shape[axis] == 1 or len(lengths) > 2:
                    continue
                shorter = shrinking.replace_at(value, path, np.delete(array, 0, axis))
                assert search.try_input(*shorter) is None


@pytest.mark.parametrize("task", ["hat", "threshold", "shrink", "display", "to_pixels"])
def test_a_right_answer_never_gets_a_counterexample(task):
    if not FAIRNESS.is_dir():
        pytest.skip("benchmarks/ is no part of the installed package")
    checks = [name for name in vars(module_of(task)) if name.startswith("test_")]
    for path in sorted((FAIRNESS / "right" / task).glob("*.py")):
        for check in checks:
            assert find(task, path.read_text("utf8"), check) is None, path.name


TASKS = [task.id for homework in PLAN.homeworks.values() for task in homework.tasks]
TASKS_WITH_SMALL_INPUTS = [task for task in TASKS if hasattr(module_of(task), "SMALL_INPUTS")]


@pytest.mark.parametrize("task", TASKS_WITH_SMALL_INPUTS)
def test_right_answers_agree_on_all_small_inputs_of_a_task(task):
    if not FAIRNESS.is_dir():
        pytest.skip("benchmarks/ is no part of the installed package")
    module = module_of(task)
    solution = plan.function(PLAN.task(task))
    for path in sorted((FAIRNESS / "right" / task).glob("*.py")):
        with subject_of(task, path.read_text("utf8")) as subject:
            search = counterexamples.Search(task, module, subject, solution, raised=False)
            for args, kwargs in counterexamples.small_inputs(module):
                assert search.try_input(args, kwargs) is None, (path.name, args, kwargs)


def graded(task, text, options, name="hw1"):
    """Return the result of one task's function."""
    homework = PLAN.homeworks[name]
    tasks = tuple(candidate for candidate in homework.tasks if candidate.id == task)
    code = SubmittedCode({task: text}, (), "", ("numpy",))
    return last(grader.check_steps(code, homework._replace(tasks=tasks), options))


CUT = """import numpy as np
def shrink(Y):
    Y = Y[: len(Y) // 2 * 2, : Y.shape[1] // 2 * 2].astype(int)
    return ((Y[::2, ::2] + Y[1::2, ::2] + Y[::2, 1::2] + Y[1::2, 1::2]) // 4).astype(np.uint8)
"""


@pytest.mark.grading
def test_a_counterexample_shows_nothing_of_the_inputs_that_were_drawn_with_the_secret():
    options = GradingOptions(in_process.TIER, "ada", "one secret", draw=False)
    others = replace(options, student="grace", secret="another")
    results = [graded("shrink", CUT, grading_options) for grading_options in (options, others)]
    public = graded("shrink", CUT, GradingOptions(in_process.TIER, draw=False))
    shown = [[check.counterexample for check in result.checks] for result in (*results, public)]
    assert any(shown[0])
    assert shown[0] == shown[1] == shown[2]
    # the messages do show numbers of the inputs, which differ
    assert [check.message for check in results[0].checks] != [
        check.message for check in results[1].checks
    ]


def test_a_hidden_check_gets_no_counterexample(tmp_path):
    (tmp_path / "test_shrink.py").write_text(
        "import numpy as np\nfrom hdrlab.course.checks.compare import same\n\n\n"
        "def test_the_secret_image(subject):\n"
        "    same(subject.shrink(np.full((2, 2), 77, np.uint8) + np.eye(2, dtype=np.uint8) * 3),\n"
        "         [[79]], 0)\n"
    )
    options = GradingOptions(in_process.TIER, hidden=tmp_path, draw=False)
    result = graded("shrink", CUT, options)
    (hidden,) = [check for check in result.checks if check.hidden]
    assert hidden.outcome == "fails" and hidden.counterexample is None
    assert "77" not in str([check.counterexample for check in result.checks])


@pytest.mark.grading
def test_the_search_changes_neither_outcomes_nor_points(monkeypatch):
    options = GradingOptions(in_process.TIER, draw=False)
    with_search = graded("shrink", CUT, options)

    def broken(*_, **__):
        raise RuntimeError("the search broke")

    monkeypatch.setattr(counterexamples, "find", broken)
    without = graded("shrink", CUT, options)
    assert any(check.counterexample for check in with_search.checks)
    assert [replace(check, counterexample=None) for check in with_search.checks] == list(
        without.checks
    )


def test_a_function_that_raises_on_small_inputs_is_not_blamed_for_that():
    text = CUT.replace("    Y =", "    if len(Y) < 6: raise ValueError('too small')\n    Y =")
    example = find("shrink", text, "test_a_level_is_the_rounded_mean_of_four_pixels")
    assert "raised" not in example.yours
    assert len(snippets.Snippet(example.inputs, "shrink(small_Y)").arguments()[0][0]) == 6


def test_a_check_that_failed_by_an_exception_shows_a_small_input_that_raises_it():
    text = "def shrink(Y):\n    return Y[len(Y)]\n"
    example = find("shrink", text, "test_a_level_is_the_rounded_mean_of_four_pixels", raised=True)
    assert "IndexError" in example.yours
    assert snippets.Snippet(example.inputs, example.call).count <= 6


def test_a_function_that_answers_wrongly_only_after_some_calls_gets_no_counterexample():
    right = CUT.replace(") // 4)", " + 2) // 4)")
    text = right.replace("    Y =", "    calls.append(1)\n    if len(calls) > 2: return Y\n    Y =")
    text = text.replace("def ", "calls = [1, 1]\ndef ")
    assert find("shrink", text, "test_a_level_is_the_rounded_mean_of_four_pixels") is not None
    later = text.replace("[1, 1]", "[]")
    assert find("shrink", later, "test_a_level_is_the_rounded_mean_of_four_pixels") is None


def test_a_function_that_changes_its_input_gets_the_same_counterexample():
    text = CUT.replace("    return", "    Y0[:] = 0\n    return").replace(
        "    Y =", "    Y0 = Y\n    Y ="
    )
    check = "test_a_level_is_the_rounded_mean_of_four_pixels"
    assert find("shrink", text, check) == find("shrink", CUT, check) is not None


class Late:
    """A subject that answers some calls and then exceeds the time limit."""

    def __init__(self, function, answers):
        self.function = function
        self.answers = answers
        self.calls = []

    def fresh(self):
        """Start a new check, in which the subject answers calls again."""
        self.left = self.answers

    def limit_check(self, seconds):
        """Do nothing: there is no clock."""

    def shrink(self, Y):
        """Answer, or exceed the time limit."""
        self.left -= 1
        if self.left < 0:
            raise NoAnswer("shrink took longer than 5 s", "late")
        return self.function(Y)


def test_a_search_that_runs_out_of_time_shows_the_best_that_it_has():
    module = module_of("shrink")
    solution = plan.function(PLAN.task("shrink"))
    run = runner(module.test_a_level_is_the_rounded_mean_of_four_pixels)
    sizes = []
    for answers in (8, 1000):
        subject = Late(function_in("shrink", CUT), answers)
        example = counterexamples.find("shrink", module, run, subject, solution)
        sizes.append(snippets.Snippet(example.inputs, example.call).count)
    assert sizes[0] > sizes[1] == 4


def test_an_input_shrinks_to_the_one_value_that_matters():
    rng = np.random.default_rng(0)
    images = rng.integers(0, 200, (3, 20, 30)).astype(np.uint8)
    images[1, 7, 11] = 222
    value = (images, np.array([1.0, 2.0, 4.0]))
    *_, smallest = shrinking.shrink(value, lambda value: bool((value[0] > 201).any()))
    assert smallest[0].tolist() == [[[202]]] or smallest[0].tolist() == [[[222]]]
    assert smallest[0].dtype == np.uint8 and smallest[1].shape == (1,)


def test_small_inputs_may_end_with_keyword_arguments():
    example = find("snr", source_of("snr_signal_alone"), SNR_CHECK)
    assert example.call == "snr(small_g, least=0.01, span=1)"
    assert pasted(example, function_in("snr", source_of("snr_signal_alone"))) == example.yours


def test_an_argument_that_is_a_named_tuple_shrinks_and_is_pasted_as_a_tuple():
    text = source_of("distance_squared")
    example = find("distance", text, "test_the_distance_is_measured_in_standard_deviations")
    assert pasted(example, function_in("distance", text)) == example.yours
    assert snippets.Snippet(example.inputs, example.call).count <= 9


@pytest.mark.parametrize(
    "value",
    [
        np.array([[0, 3], [1, 2]], np.uint8),
        np.array([0.1, 1 / 3, np.nan, np.inf, 1e-30]),
        np.array([[0.1]], np.float32),
        np.linspace(0, 1, 256),
        np.linspace(-3, 0.5, 256),
        np.linspace(0, [1, 2, 4], 256),
        np.minimum(np.arange(256), 255 - np.arange(256)),
        np.full((4, 5), 7.5, np.float32),
        np.eye(4),
        np.array([True, False]),
    ],
)
def test_an_array_that_is_written_as_code_is_read_back_the_same(value):
    snippet = snippets.write("f", lambda x, y: 0, [value, 2.5], {"k": (1, "a")})
    (x, y), named = snippet.arguments()
    assert x.dtype == value.dtype and np.array_equal(x, value, equal_nan=value.dtype.kind == "f")
    assert y == 2.5 and named == {"k": (1, "a")}


EXAMPLE = Counterexample("Y = np.array([[1]])\nshrink(Y)", "<b>4</b>", "5")
CHECK = Check("shrink", "n", "P", Fraction(0), Fraction(1), "fails", "off", counterexample=EXAMPLE)
RESULT = Result("ada", "hw1", "T", "strict", (CHECK,), {}, (), "", "", "", {})


def test_feedback_leads_with_the_counterexample_and_escapes_it():
    assert results.from_json(results.to_json(RESULT)) == RESULT
    for page in (feedback.fragment(RESULT), feedback.page(RESULT)):
        assert page.index("shrink(Y)") < page.index(">off<")
        assert "<b>4</b>" not in page and "&lt;b&gt;4" in page
    assert "Yours: <b>4</b>. Correct: 5." in feedback.text(RESULT)
    hidden = replace(RESULT, checks=(replace(CHECK, hidden=True),))
    assert "shrink(Y)" not in feedback.fragment(hidden)
    assert b"shrink(Y)" not in results.for_team(results.to_json(hidden))


def test_feedback_states_an_error_that_was_raised_once():
    error = "shrink raised IndexError: index 9"
    example = EXAMPLE._replace(yours=error)
    check = replace(
        CHECK, outcome="no answer", kind="raised", message=error, counterexample=example
    )
    result = replace(RESULT, checks=(check,))
    for text in (feedback.fragment(result), feedback.text(result)):
        assert "your function raises an error" in text
        assert "wrong answer" not in text
        assert text.count(error) == 1


@pytest.mark.grading
def test_checks_of_a_task_that_have_the_same_counterexample_show_it_once():
    source = "def threshold(h, q):\n    return h[999]\n"
    result = graded("threshold", source, GradingOptions(tier=in_process.TIER, draw=False))
    codes = [check.counterexample.code for check in result.checks if check.counterexample]
    assert codes
    assert len(codes) == len(set(codes))
    assert all(check.message for check in result.checks if check.outcome == "no answer")
