"""Questions about the tasks without a student's code: their keys are right, their options differ."""

import io
import math
from importlib.util import find_spec

import numpy as np
import pytest
from PIL import Image

from hdrlab import cli
from hdrlab.course.checks import misconceptions
from hdrlab.course.question_bank import bank, task_questions

pytestmark = [
    pytest.mark.grading,
    pytest.mark.skipif(
        any(find_spec(name) is None for name in ("mdit_py_plugins", "ziamath")),
        reason='question banks need pip install ".[site]"',
    ),
]
# Calculated by hand, or with the formulas of a textbook, and not with hdrlab.
BY_HAND = {
    "ev": math.log2(8**2 * 60) - 2,  # ISO 400 is two stops faster
    "equivalent_time": 1000 / 60 / 4 * 2,  # four times the area, half the ISO
    "threshold": 10,  # 3 of 10 pixels are at or below 10
    "exclusion": 105,
    "hat": 2 / 3,
    "irradiance": (1 * 1 + 4 * 6) / (1 + 16),
    # hat weights 64 and 63; ln E = ln 0.5, and ln (1.5 / 2)
    "merge": math.exp((64 * math.log(0.5) + 63 * math.log(0.75)) / 127),
    "variance": 0.5 / 1000 + 0.01**2 + 0.004**2 / 12,
    "log_average": 1000**0.5,
    "compress": 1 / (3 - 1) * (1.5 - 3),
    "divergence": (0 - 1) + 4,  # the lower row's step down leads out of the image
    "optimum": 8 - math.log2(0.24 / 0.06),
    "weighted_variance": (2 * 1 + 1 * 4 + 1 * 36) / 4 - ((2 * 1 + 2 + 6) / 4) ** 2,
    "to_pixels": 3 * 256 / 2**7,  # 64 = 0.5 * 2^7
    "brightness_transfer": 1.5 + (8 / 24 - 6 / 24) / (10 / 24),
    # V - 5 is 55 and 145: minimize the sum of (V - 5 - k S)^2 / (V - 5)^2
    "line": (100 / 55 + 300 / 145) / ((100 / 55) ** 2 + (300 / 145) ** 2),
}


@pytest.fixture(scope="module")
def lessons():
    return {lesson.title: lesson for lesson in bank.task_lessons()}


def test_the_keys_agree_with_calculations_by_hand(lessons):
    questions = lessons[task_questions.VALUE_TITLE].questions
    assert len(questions) == len(BY_HAND)
    for question in questions:
        expected = BY_HAND[question.name.removeprefix("task-value-")]
        shown = question.labels[question.right].removeprefix("EV ").partition(" ")[0]
        assert float(shown.rstrip(",")) == pytest.approx(expected, rel=0.006), question.name


def test_every_question_has_four_different_options_and_explains_the_wrong_ones(lessons):
    names = []
    for lesson in lessons.values():
        for question in lesson.questions:
            names.append(question.name)
            assert len(set(question.labels)) == len(question.labels) == 4, question.name
            is_explained = [bool(text) for text in question.misconceptions]
            assert is_explained == [index != question.right for index in range(4)]
    assert len(set(names)) == len(names) >= 40


def test_the_right_option_is_not_always_in_one_place(lessons):
    for lesson in lessons.values():
        places = {question.right for question in lesson.questions}
        assert len(places) >= min(3, len(lesson.questions))


def test_a_diagnosis_names_the_one_mistake_that_gives_the_answer(lessons):
    calls = {call.task: call for call in task_questions.SMALL_CALLS}
    for question in lessons[task_questions.DIAGNOSIS_TITLE].questions:
        call = calls[question.name.removeprefix("task-diagnosis-")]
        known = {one.sentence: one for one in misconceptions.mistakes_of(call.task)}
        for index, label in enumerate(question.labels):
            if label in known:
                answer = call.answer(known[label].function)
                assert (f"answers {answer}. What" in question.text) == (index == question.right)


def test_images_of_one_question_can_be_told_apart(lessons):
    for question in lessons[task_questions.PICTURE_TITLE].questions:
        pictures = [
            np.asarray(Image.open(io.BytesIO(image.content)).convert("L"), float)
            for image in question.images
        ]
        for index, first in enumerate(pictures):
            for second in pictures[index + 1 :]:
                assert np.mean(np.abs(first - second)) > 20


def test_the_command_writes_them_and_refuses_notebooks(tmp_path, capsys):
    with pytest.raises(SystemExit):
        cli.run(["course", "questions", "--tasks", "-o", str(tmp_path / "tasks.zip")])
    assert "questions" in capsys.readouterr().out and (tmp_path / "tasks.zip").is_file()
    for words in (["--tasks", "--inventory"], ["--tasks", "04"]):
        with pytest.raises(SystemExit) as ended:
            cli.run(["course", "questions", *words, "-o", str(tmp_path / "x.xml")])
        assert ended.value.code
        assert "without names" in capsys.readouterr().err
