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
NAMES = [mistake.name for mistake in KNOWN]
PLAN = plan.read()
pytestmark = pytest.mark.filterwarnings("ignore")  # a wrong function may well divide by 0


@cache
def calls_of(mistake, student):
    """Return the fraction of its task's points that a mistake gets, and its calls and answers."""
    subject = inprocess.Subject({mistake.task: mistake.function})
    share, _ = scoring.score(mistake.task, subject, plan.seed("secret", student, mistake.task))
    return share, subject.calls


def roughened(answer):
    """Return an answer as another solver would give it, with fewer correct digits."""
    if isinstance(answer, tuple | list):
        return type(answer)(roughened(item) for item in answer)
    if isinstance(answer, np.ndarray) and answer.dtype.kind == "f":
        return answer * (1 + 1e-5 * np.random.default_rng(0).standard_normal(answer.shape))
    return answer


def test_every_task_has_named_mistakes_and_there_are_thirty_or_more():
    assert len(KNOWN) >= 30
    tasks = {task.id for homework in PLAN.homeworks.values() for task in homework.tasks}
    assert {mistake.task for mistake in KNOWN} == tasks


@pytest.mark.grading
@pytest.mark.parametrize("mistake", KNOWN, ids=NAMES)
def test_a_mistake_costs_points_and_not_all_of_them(mistake):
    for student in ("ada", "grace"):
        assert 0 < calls_of(mistake, student)[0] < 1


@pytest.mark.parametrize("mistake", KNOWN, ids=NAMES)
def test_a_mistake_has_a_sentence_and_says_what_to_do(mistake):
    assert mistake.name.startswith(mistake.task)
    assert 40 < len(mistake.sentence) < 200
    assert mistake.sentence.endswith(".")


@pytest.mark.grading
def test_nine_in_ten_mistakes_are_recognized_whatever_inputs_a_student_draws():
    for student in ("ada", "grace"):
        missed = []
        for mistake in KNOWN:
            calls = [
                (arguments, named, roughened(answer))
                for arguments, named, answer in calls_of(mistake, student)[1]
            ]
            closest = misconceptions.closest(PLAN.task(mistake.task), calls)
            if closest is None or closest.name != mistake.name:
                missed.append(mistake.name)
        assert len(missed) <= 0.1 * len(KNOWN), missed


@pytest.mark.grading
@pytest.mark.parametrize("task", sorted({mistake.task for mistake in KNOWN}))
def test_the_library_and_a_blank_stub_are_not_taken_for_a_mistake(task):
    subject = inprocess.library()
    scoring.score(task, subject)
    assert misconceptions.closest(PLAN.task(task), subject.calls) is None
    stub = inprocess.Subject({task: lambda *arguments, **named: None})
    scoring.score(task, stub)
    assert misconceptions.closest(PLAN.task(task), stub.calls) is None
    assert misconceptions.closest(PLAN.task(task), []) is None


def diagnosed(task, function):
    """Return the diagnosis of a wrong function from the checks of its task."""
    subject = inprocess.Subject({task: function})
    _, calls = scoring.answered_and_asked(task, subject, plan.seed("secret", "ada", task))
    return misconceptions.diagnose(PLAN.task(task), calls)


@pytest.mark.grading
def test_two_independent_mistakes_are_both_named():
    def signed_contrast_and_exposedness_of_the_mean(F, powers=(1, 1, 1)):
        Y = np.pad(0.299 * F[0] + 0.587 * F[1] + 0.114 * F[2], 1, mode="edge")
        around = Y[:-2, 1:-1] + Y[2:, 1:-1] + Y[1:-1, :-2] + Y[1:-1, 2:]
        contrast = around - 4 * Y[1:-1, 1:-1]
        exposedness = np.exp(-((F.mean(axis=0) - 0.5) ** 2) / (2 * 0.2**2))
        return contrast ** powers[0] * F.std(axis=0) ** powers[1] * exposedness ** powers[2]

    diagnosis = diagnosed("weight", signed_contrast_and_exposedness_of_the_mean)
    assert not diagnosis.explains_all and not diagnosis.costs_half_at_most
    names = {name.name for name in diagnosis.mistakes}
    assert names == {"weight_sign_kept", "weight_exposedness_of_the_mean"}
    assert all(name.sentence in diagnosis.sentence for name in diagnosis.mistakes)


@pytest.mark.grading
def test_a_mistake_that_a_right_answer_contradicts_is_not_named():
    def wrong_for_one_fraction(h, q):
        right = plan.function(PLAN.task("threshold"))(h, q)
        return right + 1 if np.ndim(q) == 0 and q == 0.5 else right

    diagnosis = diagnosed("threshold", wrong_for_one_fraction)
    assert diagnosis.mistakes == ()


@pytest.mark.grading
def test_a_nonsense_answer_is_not_taken_for_a_known_mistake():
    Z = np.random.default_rng(0).integers(0, 256, (30, 4))
    arguments = (Z, np.arange(4.0), 10.0, np.ones(256))
    answers = (
        (np.arange(256.0), np.zeros(30)),
        (np.zeros(3), np.zeros(2)),
        "no",
        [1.0],
        (np.zeros(256),),
    )
    for answer in answers:
        assert misconceptions.closest(PLAN.task("gsolve"), [(arguments, {}, answer)]) is None


def unscaled(mistake):
    """Return a mistaken function whose answers have another scale or gauge, which the checks accept."""
    others = {
        "hat": lambda w: [256 * float(weight) for weight in w],
        "gsolve": lambda both: tuple(part - both[0][0] for part in both),
        "recover_steps": lambda states: [7 * np.asarray(state[0]) for state in states],
        "recover": lambda g: g + 3.0,
        "solve": lambda u: u - u.min(),
    }
    return lambda *arguments, **named: others[mistake.task](
        inprocess.plain(mistake.function(*arguments, **named))
    )


@pytest.mark.grading
@pytest.mark.parametrize(
    "name",
    [
        *("hat_ends_count", "gsolve_log2_of_the_times", "recover_steps_exponential_start"),
        *("recover_times_believed", "solve_wrong_sign"),
    ],
)
def test_a_mistake_is_named_in_every_scale_and_gauge_that_the_checks_accept(name):
    mistake = KNOWN[NAMES.index(name)]
    subject = inprocess.Subject({mistake.task: unscaled(mistake)})
    scoring.answered(mistake.task, subject, plan.seed("secret", "ada", mistake.task))
    assert misconceptions.closest(PLAN.task(mistake.task), subject.calls[:20]) == mistake


@pytest.mark.grading
@pytest.mark.parametrize(
    "mistake",
    [mistake for mistake in KNOWN if not mistake.misses_method],
    ids=lambda mistake: mistake.name,
)
def test_a_mistake_costs_half_at_most_unless_it_misses_what_the_task_is_about(mistake):
    assert calls_of(mistake, "ada")[0] >= 0.5


def test_no_two_sentences_are_the_same():
    assert [
        sentence
        for sentence, count in Counter(mistake.sentence for mistake in KNOWN).items()
        if count > 1
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

    near = KnownMistake(name="near", task="log_average", sentence="", function=answers(0.001))
    far = KnownMistake(name="far", task="log_average", sentence="", function=answers(0.005))
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
