"""When an answer counts as the answer of a known mistake, and where the wrong functions come from."""

import warnings

import numpy as np
import pytest

from hdrlab.course import plan
from hdrlab.course.authoring import solutions
from hdrlab.course.checks import misconceptions
from hdrlab.course.checks.misconceptions import MAX_DIFFERENCE, closest, difference, in_gauge
from hdrlab.course.checks.mistakes import KnownMistake, mistake

NAN = np.nan
INF = np.inf


@pytest.mark.parametrize(
    ("a", "b", "apart"),
    [
        (3, 3, 0),
        (3, 2, 0.5),
        (-2, 2, 2),
        ([1, 2, 2], (1, 2, 2), 0),
        (np.array([3, 4]), np.array([0, 0]), MAX_DIFFERENCE),
        (np.zeros(2), np.zeros(2), 0),
        (np.array([4.0, 4.0]), np.array([3.0, 5.0]), (2 / 34) ** 0.5),
        (np.array([0.0, 5.0]), np.array([3.0, 1.0]), (25 / 10) ** 0.5),
        (np.full(2, 1e-9), np.full(2, 1e-13), MAX_DIFFERENCE),
        (np.full(2, 500.0), np.ones(2), 499),
        (np.full(2, 3000.0), np.ones(2), MAX_DIFFERENCE),
        (np.array([NAN, 2.0]), np.array([NAN, 1.0]), 1),
        (np.array([INF, 2.0]), np.array([NAN, 1.0]), 1),
        (np.array([1.0, NAN]), np.array([NAN, 1.0]), MAX_DIFFERENCE),
        (np.array([NAN]), np.array([NAN]), 0),
        (np.array([]), np.array([]), 0),
        (np.ones((1, 2)), np.ones((2, 1)), 0),
        (np.ones(2), np.ones(3), MAX_DIFFERENCE),
        (np.ones(2), np.array(["a", "b"]), MAX_DIFFERENCE),
        (np.array(["a", "b"]), np.ones(2), MAX_DIFFERENCE),
        (np.array([True, False]), np.array([1, 0]), 0),
        (None, None, 0),
        (None, 1, MAX_DIFFERENCE),
        (1, None, MAX_DIFFERENCE),
        ("a", "a", 0),
        ("a", "b", MAX_DIFFERENCE),
        (b"a", b"a", 0),
        (b"a", "a", MAX_DIFFERENCE),
        (1, "a", MAX_DIFFERENCE),
        ({}, 1, MAX_DIFFERENCE),
        ([1, [2]], np.ones(2), MAX_DIFFERENCE),
        ([], np.ones(2), MAX_DIFFERENCE),
        ([1, 3], np.array([1, 1]), 2**0.5),
        ((1, 3), np.array([1, 1]), 2**0.5),
        ((), (), 0),
        ((1, 2), (1,), MAX_DIFFERENCE),
        (1, (1,), MAX_DIFFERENCE),
        ("ab", ("a", "b"), MAX_DIFFERENCE),
        ((1, 3), (1, 2), 0.5),
        ([4, 3], [2, 2], 1),
    ],
)
def test_the_difference_of_two_answers_is_that_of_its_worst_part_as_a_share_of_what_is_expected(
    a, b, apart
):
    assert difference(a, b) == pytest.approx(apart, rel=1e-12)


@pytest.mark.parametrize(
    ("task", "answer", "gauged"),
    [
        ("hat", np.array([1.0, 4.0, 2.0]), [0.25, 1, 0.5]),
        ("hat", [1, 4, 2], [0.25, 1, 0.5]),
        ("gsolve", (np.array([1.0, 2.0, 4.0]), np.array([9.0])), ([-1, 0, 2], [7])),
        (
            "gsolve",
            (np.array([1.0, 2.0, 4.0, 8.0, 16.0]), np.array([9.0])),
            ([-3, -2, 0, 4, 12], [5]),
        ),
        ("recover", np.arange(256.0) ** 2, (np.arange(256.0) ** 2 - 128**2).tolist()),
        ("recover", list(range(256)), list(range(-128, 128))),
        ("recover_steps", [(np.arange(256.0), 7)], [(np.arange(256) / 128).tolist()]),
        ("recover_steps", [[np.arange(256.0), 7]], [(np.arange(256) / 128).tolist()]),
        ("recover_steps", [np.arange(256.0)], [(np.arange(256) / 128).tolist()]),
        ("solve", np.array([1.0, 2.0, 6.0]), [-2, -1, 3]),
        ("solve", (1, 2, 6), [-2, -1, 3]),
        ("merge", np.array([1.0, 2.0]), [1, 2]),
    ],
)
def test_an_answer_is_compared_in_the_gauge_or_scale_that_its_checks_leave_free(
    task, answer, gauged
):
    parts = (
        type(gauged)(map(np.array, gauged))
        if task in ("gsolve", "recover_steps")
        else np.array(gauged)
    )
    assert difference(in_gauge(task, answer), parts) < 1e-12


@pytest.mark.parametrize("answer", ["no", None, 7, {"a": 1}])
def test_an_answer_of_another_shape_is_not_rescaled(answer):
    for task in ("gsolve", "recover_steps"):
        assert in_gauge(task, answer) is answer or in_gauge(task, answer) == answer
    assert in_gauge("merge", answer) is answer


# Which mistake it is

TASK = plan.Task("merge", "radiance.debevec.merge", 1)


@pytest.fixture
def named(monkeypatch):
    """named({name: answer}, student_answer, right) -> the name of the mistake that explains an answer."""

    def named(answers, *student_answers, right=1.0):
        mistakes = [
            KnownMistake(
                name=name, task="merge", sentence="", function=lambda k, answer=answer: answer
            )
            for name, answer in answers.items()
        ]
        monkeypatch.setattr(misconceptions, "of_task", lambda task: mistakes)
        monkeypatch.setattr(plan, "function", lambda task: lambda k: right)
        mistake_found = closest(
            TASK, [((k,), {}, answer) for k, answer in enumerate(student_answers)]
        )
        return mistake_found and mistake_found.name

    return named


@pytest.mark.parametrize(
    ("student_answer", "name"),
    [
        (1.001, None),
        (1.0011, "near"),
        (1.0015, "near"),
        (1.01, None),
        (None, None),
    ],
)
def test_an_answer_is_no_mistake_within_a_thousandth_of_the_librarys(student_answer, name, named):
    assert named({"near": 1.0015, "far": 5.0}, student_answer) == name


@pytest.mark.parametrize(
    ("student_answer", "name"),
    [(2.0, "two"), (2.0 * 1.0999, "two"), (2.0 * 1.1001, None), (1.5 * 0.9, None), (1.95, "two")],
)
def test_a_mistake_must_explain_all_but_a_tenth_of_the_difference_to_the_library(
    student_answer, name, named
):
    assert named({"two": 2.0}, student_answer) == name


def test_a_difference_of_exactly_one_thousandth_still_counts_as_equal(named):
    assert named({"near": 1001.0}, 1001.0, right=1000.0) is None
    assert named({"near": 1000.0}, 1001.0, right=998.0) == "near"


def test_of_two_mistakes_that_differ_in_the_last_bit_of_one_value_the_nearer_is_named(named):
    near = np.full(4, 2.0)
    far = near.copy()
    far[0] = np.nextafter(2.0, 0)
    assert named({"far": far, "near": near}, near, right=np.ones(4)) == "near"


def test_a_mistake_close_to_the_library_must_match_within_a_tenth_of_their_difference(named):
    assert named({"some": 1.1}, 1.11) == "some"  # 0.0091 of 1.1, of 0.11
    assert named({"some": 1.1}, 1.115) is None


def test_a_mistake_is_named_only_if_it_matches_every_call(named):
    assert named({"a": 2.0, "b": 2.1}, 2.0, 2.0) == "a"
    assert named({"b": 2.1, "a": 2.0}, 2.0, 2.02) == "a"
    assert named({"a": 2.0, "b": 2.1}, 2.1, 2.09) == "b"
    assert named({"a": 2.0}, 2.0, 3.0) is None
    assert named({"a": 2.0}, 2.0, 1.0) is None
    assert named({"a": 2.0}, None, None) is None and named({"a": 2.0}) is None
    assert named({"a": 2.0}, 2.0, None) is None
    assert named({}, 2.0) is None


def test_a_mistake_may_warn_and_has_no_answer_if_it_fails():
    def warns(k):
        warnings.warn("of a kind", UserWarning, stacklevel=1)
        return np.log(np.zeros(1)) * 0 + k

    def fails(k):
        raise ZeroDivisionError

    assert np.isnan(misconceptions.call_quietly(warns, (1,), {})).all()
    assert misconceptions.call_quietly(warns, (), {"k": 2.0}).shape == (1,)
    assert misconceptions.call_quietly(fails, (1,), {}) is None


# Where they stand


def test_the_mistakes_of_a_task_are_its_own_and_those_in_method_miss_what_it_is_about(tmp_path):
    (tmp_path / "mistakes" / "method").mkdir(parents=True)
    for place, value in (("vignette_b.py", 2), ("method/vignette_a.py", 1), ("other_a.py", 0)):
        text = f'"""Mistake\n\nnumber {value}."""\ndef vignette():\n    return {value}\n'
        (tmp_path / "mistakes" / place).write_text(text, encoding="utf8")
    mistakes = misconceptions.of_task(
        plan.Task("vignette", f"{tmp_path / 'vignette.py'}:vignette", 1)
    )
    texts = [
        (mistake.name, mistake.task, mistake.sentence, mistake.function(), mistake.misses_method)
        for mistake in mistakes
    ]
    assert texts == [
        ("vignette_a", "vignette", "Mistake number 1.", 1, True),
        ("vignette_b", "vignette", "Mistake number 2.", 2, False),
    ]


def test_the_name_of_a_mistake_begins_with_its_task_and_is_not_taken():
    def gsolve_halved(Z):
        return Z / 2

    gsolve_halved.__module__ = "a.package.of_mistakes"
    with pytest.raises(ValueError, match="of_mistakes_"):
        mistake("gsolve_halved", says="A sentence.")(gsolve_halved)
    mistake("of_mistakes_halved", says="A sentence.")(gsolve_halved)
    with pytest.raises(ValueError, match="of_mistakes_halved"):
        mistake("of_mistakes_halved", says="Another sentence.")(gsolve_halved)


def test_a_mistake_replaces_the_solution_of_its_task_alone():
    homework = plan.read().homeworks["hw2"]
    right = solutions.texts(homework)
    wrong = solutions.texts(homework, ["hat_ends_count"])
    assert [task for task in right if right[task] != wrong[task]] == ["hat"]
    scope = {}
    exec("\n\n".join(wrong.values()), scope)
    assert scope["hat"]()[0] > 0 and "ends_count" not in wrong["hat"]


def test_a_wrong_hat_answers_in_the_form_of_the_right_one():
    hat = [mistake for mistake in misconceptions.known() if mistake.task == "hat"]
    right = plan.function(plan.read().task("hat"))()
    assert hat and all(np.shape(mistake.function()) == right.shape for mistake in hat)


def test_a_mistake_in_a_variant_is_a_change_of_that_variants_solution():
    task = plan.read().task("exclusion")._replace(variant="compared/above/six")
    image = np.uint8([[100, 113, 114, 120, 126, 127, 200]])
    strange, *_ = misconceptions.of_task(task)
    arguments = (image, 120)
    assert strange.function(*arguments).shape == image.shape
    others = [mistake.function(*arguments) for mistake in misconceptions.of_task(task)]
    assert any(not np.array_equal(mistake, plan.function(task)(*arguments)) for mistake in others)
