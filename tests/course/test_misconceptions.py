"""Known mistakes: each costs points, not all of them, and is recognized by name."""

from collections import Counter
from functools import cache

import numpy as np
import pytest
import scoring

from hdrlab.course import plan
from hdrlab.course.checks import inprocess, misconceptions
from hdrlab.course.checks.mistakes import KnownMistake

KNOWN = misconceptions.known()
NAMES = [one.name for one in KNOWN]
PLAN = plan.read()
pytestmark = pytest.mark.filterwarnings("ignore")  # a wrong function may well divide by 0


@cache
def asked(one, student):
    """Return the share of its task's points that a wrong file gets, and what it was asked and answered."""
    subject = inprocess.Subject({one.task: one.function})
    share, _ = scoring.score(one.task, subject, plan.seed("secret", student, one.task))
    return share, subject.calls


def roughened(answer):
    """Return an answer as another solver would give it: a few digits less."""
    if isinstance(answer, tuple | list):
        return type(answer)(roughened(one) for one in answer)
    if isinstance(answer, np.ndarray) and answer.dtype.kind == "f":
        return answer * (1 + 1e-5 * np.random.default_rng(0).standard_normal(answer.shape))
    return answer


def test_every_task_has_named_mistakes_and_there_are_thirty_or_more():
    assert len(KNOWN) >= 30
    tasks = {task.id for homework in PLAN.homeworks.values() for task in homework.tasks}
    assert {one.task for one in KNOWN} == tasks


@pytest.mark.grading
@pytest.mark.parametrize("one", KNOWN, ids=NAMES)
def test_a_mistake_costs_points_and_not_all_of_them(one):
    for student in ("ada", "grace"):
        assert 0 < asked(one, student)[0] < 1


@pytest.mark.parametrize("one", KNOWN, ids=NAMES)
def test_a_mistake_has_a_sentence_and_says_what_to_do(one):
    assert (
        one.name.startswith(one.task)
        and 40 < len(one.sentence) < 200
        and one.sentence.endswith(".")
    )


@pytest.mark.grading
def test_nine_in_ten_mistakes_are_recognized_whatever_inputs_a_student_draws():
    for student in ("ada", "grace"):
        missed = []
        for one in KNOWN:
            calls = [
                (given, named, roughened(came)) for given, named, came in asked(one, student)[1]
            ]
            found = misconceptions.closest(PLAN.task(one.task), calls)
            missed += [] if found is not None and found.name == one.name else [one.name]
        assert len(missed) <= 0.1 * len(KNOWN), missed


@pytest.mark.grading
@pytest.mark.parametrize("task", sorted({one.task for one in KNOWN}))
def test_the_library_and_a_blank_stub_are_not_taken_for_a_mistake(task):
    subject = inprocess.library()
    scoring.score(task, subject)
    assert misconceptions.closest(PLAN.task(task), subject.calls) is None
    stub = inprocess.Subject({task: lambda *given, **named: None})
    scoring.score(task, stub)
    assert misconceptions.closest(PLAN.task(task), stub.calls) is None
    assert misconceptions.closest(PLAN.task(task), []) is None


def diagnosed(task, function):
    """Return the diagnosis of a wrong function from the checks of its task."""
    subject = inprocess.Subject({task: function})
    _, asked = scoring.answered_and_asked(task, subject, plan.seed("secret", "ada", task))
    return misconceptions.diagnose(PLAN.task(task), asked)


@pytest.mark.grading
def test_two_independent_mistakes_are_both_named():
    def signed_contrast_and_exposedness_of_the_mean(F, powers=(1, 1, 1)):
        Y = np.pad(0.299 * F[0] + 0.587 * F[1] + 0.114 * F[2], 1, mode="edge")
        around = Y[:-2, 1:-1] + Y[2:, 1:-1] + Y[1:-1, :-2] + Y[1:-1, 2:]
        contrast = around - 4 * Y[1:-1, 1:-1]
        exposedness = np.exp(-((F.mean(axis=0) - 0.5) ** 2) / (2 * 0.2**2))
        return contrast ** powers[0] * F.std(axis=0) ** powers[1] * exposedness ** powers[2]

    found = diagnosed("weight", signed_contrast_and_exposedness_of_the_mean)
    assert not found.explains_all and not found.costs_half_at_most
    names = {one.name for one in found.mistakes}
    assert names == {"weight_sign_kept", "weight_exposedness_of_the_mean"}
    assert all(one.sentence in found.sentence for one in found.mistakes)


@pytest.mark.grading
def test_a_mistake_that_a_right_answer_contradicts_is_not_named():
    def wrong_for_one_fraction(h, q):
        right = plan.function(PLAN.task("threshold"))(h, q)
        return right + 1 if np.ndim(q) == 0 and q == 0.5 else right

    found = diagnosed("threshold", wrong_for_one_fraction)
    assert found.mistakes == ()


@pytest.mark.grading
def test_a_nonsense_answer_is_not_taken_for_a_known_mistake():
    Z = np.random.default_rng(0).integers(0, 256, (30, 4))
    given = (Z, np.arange(4.0), 10.0, np.ones(256))
    answers = (
        (np.arange(256.0), np.zeros(30)),
        (np.zeros(3), np.zeros(2)),
        "no",
        [1.0],
        (np.zeros(256),),
    )
    for answer in answers:
        assert misconceptions.closest(PLAN.task("gsolve"), [(given, {}, answer)]) is None


def unscaled(one):
    """Return the answers that a wrong function gives in another scale or gauge, which the checks accept."""
    others = {
        "hat": lambda w: [256 * float(one) for one in w],
        "gsolve": lambda both: tuple(part - both[0][0] for part in both),
        "recover_steps": lambda states: [7 * np.asarray(state[0]) for state in states],
        "recover": lambda g: g + 3.0,
        "solve": lambda u: u - u.min(),
    }
    return lambda *given, **named: others[one.task](inprocess.plain(one.function(*given, **named)))


@pytest.mark.grading
@pytest.mark.parametrize(
    "name",
    [
        *("hat_ends_count", "gsolve_log2_of_the_times", "recover_steps_exponential_start"),
        *("recover_times_believed", "solve_wrong_sign"),
    ],
)
def test_a_mistake_is_named_in_every_scale_and_gauge_that_the_checks_accept(name):
    one = KNOWN[NAMES.index(name)]
    subject = inprocess.Subject({one.task: unscaled(one)})
    scoring.answered(one.task, subject, plan.seed("secret", "ada", one.task))
    assert misconceptions.closest(PLAN.task(one.task), subject.calls[:20]) == one


@pytest.mark.grading
@pytest.mark.parametrize(
    "one", [one for one in KNOWN if not one.misses_method], ids=lambda one: one.name
)
def test_a_mistake_costs_half_at_most_unless_it_misses_what_the_task_is_about(one):
    assert asked(one, "ada")[0] >= 0.5


def test_no_two_sentences_are_the_same():
    assert [
        said for said, count in Counter(one.sentence for one in KNOWN).items() if count > 1
    ] == []


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_the_difference_of_two_answers_is_relative_to_their_size(scale):
    assert misconceptions.difference([1.1 * scale, -1.1 * scale], [scale, -scale]) == pytest.approx(
        0.1
    )
    assert misconceptions.difference([scale, scale], [0.0, 0.0]) == misconceptions.MAX_DIFFERENCE


@pytest.mark.parametrize("order", [1, -1])
def test_the_mistake_nearest_over_all_calls_is_named(order, monkeypatch):
    def answers(share):
        return lambda L: 3 * (1 + share * L.max())

    near, far = (
        KnownMistake(name=name, task="log_average", sentence="", function=answers(share))
        for name, share in (("near", 0.001), ("far", 0.005))
    )
    monkeypatch.setattr(misconceptions, "of_task", lambda task: [near, far][::order])
    calls = [((np.full((2, 2), L),), {}, 3.0) for L in (1.0, 10.0)]
    assert misconceptions.closest(PLAN.task("log_average"), calls) == near


@pytest.mark.parametrize(
    ("task", "answer", "other"),
    [
        ("hat", np.arange(1.0, 5), np.arange(3.0, 15, 3)),
        ("gsolve", (np.arange(5.0), np.ones(3)), (np.arange(5.0) + 7, np.ones(3) + 7)),
        ("recover_steps", [(np.arange(256.0), 1)], [(3 * np.arange(256.0), 1)]),
        ("recover", np.arange(256.0), np.arange(256.0) - 140),
        ("solve", np.eye(3), np.eye(3) - 5),
    ],
)
def test_answers_that_differ_only_in_a_free_scale_or_offset_count_as_equal(task, answer, other):
    in_gauge = misconceptions.in_gauge
    assert misconceptions.difference(in_gauge(task, other), in_gauge(task, answer)) < 1e-12
    assert misconceptions.difference(other, answer) > 0.5
