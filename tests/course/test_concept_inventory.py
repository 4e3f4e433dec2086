"""The concept inventory: its questions, and the learning gain that `hdrlab course gain` computes."""

import csv
import json
import math
import re
import statistics
import xml.etree.ElementTree as ET
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from hdrlab import cli
from hdrlab.course.question_bank import answers, gain
from hdrlab.course.question_bank.inventory import CONCEPTS, all_questions
from hdrlab.course.question_bank.inventory.question import DONT_KNOW

QUESTIONS = all_questions()
NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
needs_site = pytest.mark.skipif(
    any(find_spec(name) is None for name in ("mdit_py_plugins", "ziamath")),
    reason='question banks need pip install ".[site]"',
)
MAX_STEM_WORDS = 60

# Calculated by hand, or with the formulas of a textbook, and not with hdrlab.
BY_HAND = {
    "stops-of-a-ratio": math.log2(1000),  # 9.97
    "levels-of-the-brightest-stop": len(range(2048, 4096)),
    "photos-for-a-scene": next(n for n in range(1, 20) if 8 + 2 * (n - 1) >= 15),
    "time-of-a-smaller-aperture": 25,  # 1/100 s * (8/4)^2 = 4/100 s = 1/25 s
    "time-of-three-stops": 10,  # 1/80 -> 1/40 -> 1/20 -> 1/10 s
    "snow-and-the-meter": math.log2(90 / 18),  # 2.32
    "shot-noise": math.sqrt(400),  # the standard deviation of a Poisson variable
    "mean-of-photos": 8 / math.sqrt(16),
    "two-sources-of-noise": 100 / math.hypot(10, 10),  # 7.07
    "twice-the-light": 255 * (2 * (100 / 255) ** 2.2) ** (1 / 2.2),  # 137
    "light-from-a-curve": 40 / (8 / 4),
    "equal-values": 4,  # the same collected light in four times the time: 1/4
    "number-of-unknowns": 256 + 50,
    "common-factor-of-times": (10 / 0.5) / (1 / 0.5),
    "what-is-minimized": statistics.mean([10, 10, 16]),
    "weighted-mean": (120 * 12 + 40 * 8) / 160,
    "clipped-pixel": (20 / 1 + 80 / 4) / 2,
    # the variance of a count N over its time t is E t / t^2 = E / t
    "weight-of-a-long-exposure": (1 / 1) / (1 / 9),
    "thresholds-that-agree": statistics.median([20, 40, 60, 80, 250]),
    "chained-shifts": 3 + 2,
    "moved-between-photos": 80,
    "contrast-of-highlights": 100 * (200 / 201 / (100 / 101) - 1),  # 0.498 %
    "average-of-a-scene": 100 * 0.18 / (1 * 1 * 1 * 10_000) ** 0.25,  # 1.8 %
    "one-curve-for-two-rooms": math.sqrt(100),
    "halo": ((1 + 1 + 100) / 3) / ((1 + 1 + 1) / 3),
    "edge-preserving-mean": statistics.mean([50, 52, 54]),
    "compressed-gradients": 0 + 1 + 0 + 8 / 2 + 0,
    "shared-exponent": 8 * math.floor(3 / 8),  # 1600 / 4 > 255, 1600 / 8 = 200
    "checkerboard": 255 * math.exp(math.log(0.5) / 2.2),  # 186
    "absolute-code": 100,  # ST 2084: the code is the luminance
}


def numbers(text):
    """Return the numbers of an answer; for 1/25 s, this is 25."""
    return [float(number) for number in re.findall(r"\d+(?:\.\d+)?", text.replace("1/", ""))]


@pytest.mark.parametrize("question", QUESTIONS, ids=lambda question: question.name)
def test_a_right_answer_agrees_with_a_calculation_by_hand(question):
    by_hand = BY_HAND[question.name]
    shown = numbers(question.right)[0]
    digits = len(f"{shown:g}".partition(".")[2])
    assert shown == pytest.approx(by_hand, abs=0.5 * 10**-digits + 1e-9)


def test_the_directions_of_answers_are_right():
    right = {question.name: question.right for question in QUESTIONS}
    assert "dark" in right["snow-and-the-meter"]  # a meter makes snow gray
    assert "left" in right["chained-shifts"]  # the way back from a move to the right
    assert "darker" in right["halo"]  # 1 over a mean that contains 100


def test_only_the_right_thresholds_make_the_same_places_white():
    question = next(question for question in QUESTIONS if question.name == "thresholds-that-agree")
    for option in question.options[:-1]:
        first, second = numbers(option)
        white_in_a = [value > first for value in (20, 40, 60, 80, 250)]
        white_in_b = [value > second for value in (40, 80, 120, 160, 255)]
        assert (white_in_a == white_in_b) == (option == question.right)


def test_only_the_right_place_contradicts_its_exposure_times():
    question = next(question for question in QUESTIONS if question.name == "moved-between-photos")
    for option in question.options[:-1]:
        short, middle, long = numbers(option)
        follows_the_times = middle == min(2 * short, 255) and long == min(4 * short, 255)
        assert follows_the_times != (option == question.right)


def test_the_inventory_has_ten_concepts_of_three_questions_with_names_of_their_own():
    assert [len(concept.questions) for concept in CONCEPTS] == [3] * 10
    assert len({question.name for question in QUESTIONS}) == 30


@pytest.mark.parametrize("question", QUESTIONS, ids=lambda question: question.name)
def test_answers_are_distinct_after_rounding_and_each_wrong_one_has_its_misconception(question):
    assert len(question.options) == 5 and question.options[-1] == DONT_KNOW
    assert len({" ".join(option.lower().split()) for option in question.options}) == 5
    if question.name not in ("thresholds-that-agree", "moved-between-photos"):
        amounts = [(numbers(option), re.sub(r"[\d.]", "", option)) for option in question.options]
        assert len({str(amount) for amount in amounts}) == 5
    sentences = list(question.misconceptions.values())
    assert len(set(sentences)) == 3 and all(sentence.endswith(".") for sentence in sentences)
    assert question.because.endswith(".")


@pytest.mark.parametrize("question", QUESTIONS, ids=lambda question: question.name)
def test_a_question_is_short_and_its_section_exists(question):
    assert len(question.stem.split()) <= MAX_STEM_WORDS and "?" in question.stem
    assert "{" not in question.stem + question.because + "".join(question.options)
    notebook = json.loads((NOTEBOOKS / f"{question.notebook}.ipynb").read_text("utf-8"))
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "markdown"]
    lines = "\n".join("".join(cell["source"]) for cell in cells).splitlines()
    assert f"## {question.section}" in lines


def test_no_answer_is_a_bare_number_or_date_that_a_spreadsheet_rewrites():
    for question in QUESTIONS:
        for option in question.options:
            assert re.search(r"[A-Za-z]", option) or "," in option


def test_the_place_of_the_right_answer_does_not_give_it_away():
    places = [question.options.index(question.right) for question in QUESTIONS]
    assert all(4 <= places.count(place) <= 11 for place in range(4))


@needs_site
def test_a_quiz_has_all_questions_in_their_order_and_does_not_give_answers_away(tmp_path):
    path = tmp_path / "inventory.xml"
    with pytest.raises(SystemExit) as ended:
        cli.run(["course", "questions", "--inventory", "-o", str(path)])
    assert not ended.value.code
    quiz = ET.parse(path).getroot()
    elements = [element for element in quiz if element.get("type") == "multichoice"]
    names = [element.findtext("name/text") for element in elements]
    assert names == sorted(names) and len(names) == 30
    for element, question in zip(elements, QUESTIONS, strict=True):
        assert question.stem in element.findtext("questiontext/text").replace("&#x27;", "'")
        points = [answer.get("fraction") for answer in element.findall("answer")]
        assert points.index("100") == question.options.index(question.right)
        assert points.count("0") == 4
        assert element.findtext("shuffleanswers") == "false"
        assert not element.findtext("generalfeedback/text")


@needs_site
def test_the_printed_page_keeps_the_key_apart_from_the_questions(tmp_path):
    path = tmp_path / "inventory.html"
    with pytest.raises(SystemExit) as ended:
        cli.run(["course", "questions", "--inventory", "-o", str(path)])
    assert not ended.value.code
    questions_part, _, key = (
        path.read_text("utf-8").replace("&#39;", "'").partition("<h1>Answers</h1>")
    )
    for question in QUESTIONS:
        assert question.stem in questions_part and question.because not in questions_part
        letter = "abcd"[question.options.index(question.right)]
        assert f"{letter}) {question.right}. {question.because}" in key
        for misconception in question.misconceptions.values():
            assert misconception in key and misconception not in questions_part
    assert not re.search(r"(?:src|href)=\"(?!data:)", questions_part + key)


@needs_site
def test_the_inventory_takes_no_notebooks(tmp_path, capsys):
    with pytest.raises(SystemExit):
        cli.run(["course", "questions", "04", "--inventory", "-o", str(tmp_path / "a.xml")])
    assert "--inventory" in capsys.readouterr().err


# a class, its files, and its gain


def write_table(path, header, rows):
    with path.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([header, *rows])
    return path


def write_letters(path, students, header=None):
    """Write a table of students with letters, right where an entry is True, wrong where it is False."""
    rows = []
    for name, right in students.items():
        letters = []
        for question, is_right in zip(QUESTIONS, right, strict=False):
            text = question.right if is_right else question.wrong[0].text
            letters.append("abcde"[question.options.index(text)])
        rows.append([name, *letters])
    count = max(len(row) for row in rows) - 1
    return write_table(path, header or ["student", *(f"q{k + 1}" for k in range(count))], rows)


def gain_of(before, after):
    first = answers.read_answers(before)
    second = answers.read_answers(after)
    return gain.compute_gain(first, second, answers.match_students(first, second))


def test_the_gain_of_a_simulated_class_is_found_and_lies_in_its_interval(tmp_path):
    rng = np.random.default_rng(7)
    students = [f"s{k}" for k in range(400)]
    known_before = rng.random((400, 30)) < 0.25
    # of what a student does not know, half is learned: the gain is 0.5
    learned = known_before | (rng.random((400, 30)) < 0.5)
    before = write_letters(tmp_path / "b.csv", dict(zip(students, known_before, strict=True)))
    after = write_letters(tmp_path / "a.csv", dict(zip(students, learned, strict=True)))
    gain = gain_of(before, after)
    assert gain.students == 400
    assert gain.total.gain == pytest.approx(0.5, abs=0.02)
    assert gain.total.interval.low < 0.5 < gain.total.interval.high
    assert gain.total.interval.high - gain.total.interval.low < 0.04
    for concept in gain.concepts:
        assert concept.gain == pytest.approx(0.5, abs=0.1)
        assert concept.interval.low < concept.gain < concept.interval.high
        assert concept.before == pytest.approx(25, abs=5)


def test_intervals_contain_the_true_gain_of_most_classes(tmp_path):
    # binomial: of 200 intervals of 95 %, fewer than 174 with a probability below 1e-5
    rng = np.random.default_rng(11)
    contained = 0
    for _ in range(200):
        before = 100 * rng.binomial(30, 0.3, 40) / 30
        after = before + (100 - before) * rng.beta(4, 6, 40)
        interval = gain.bootstrap_interval(before, after)
        contained += interval.low <= 0.4 <= interval.high
    assert contained >= 174


def test_only_students_in_both_files_count_and_the_others_are_named(tmp_path, capsys):
    everything = [True] * 30
    nothing = [False] * 30
    before = write_letters(tmp_path / "b.csv", {"ann": nothing, "ben": everything})
    after = write_letters(tmp_path / "a.csv", {"ANN": everything, "cid": nothing})
    with pytest.raises(SystemExit) as ended:
        page = tmp_path / "gain.html"
        cli.run(["course", "gain", str(before), str(after), "-o", str(page)])
    assert not ended.value.code
    printed = capsys.readouterr()
    assert "1 student " in printed.out and "gain 1.00" in printed.out
    assert "ben" in printed.err and "cid" in printed.err
    text = page.read_text("utf-8")
    assert "ben" not in text.lower().split() and "1 student who answered" in text


def test_a_page_about_a_class_loads_nothing_and_names_the_misconception_that_remains(tmp_path):
    nothing = dict.fromkeys(("ann", "ben", "cid"), [False] * 30)
    page = tmp_path / "gain.html"
    before = write_letters(tmp_path / "b.csv", nothing)
    after = write_letters(tmp_path / "a.csv", nothing)
    with pytest.raises(SystemExit):
        cli.run(["course", "gain", str(before), str(after), "-o", str(page)])
    text = page.read_text("utf-8").replace("&#39;", "'")
    for concept in CONCEPTS:
        first = concept.questions[0]
        assert f"3 of 3 chose “{first.wrong[0].text}”" in text
        assert first.wrong[0].misconception in text
        assert f"notebook {first.notebook[:2]}, “{first.section}”" in text
    assert not re.search(r"(?:src|href)=\"(?!data:)", text) and "<script" not in text


def test_a_class_that_knew_everything_before_has_no_gain(tmp_path):
    everything = dict.fromkeys((f"s{k}" for k in range(20)), [True] * 30)
    class_gain = gain_of(
        write_letters(tmp_path / "b.csv", everything), write_letters(tmp_path / "a.csv", everything)
    )
    assert class_gain.total.gain is None and class_gain.total.interval is None
    assert class_gain.total.remaining is None
    assert "–" in gain.gain_page(class_gain)


def moodle_table(path, rows, ids=("ID number", "Email address")):
    """Write the quiz report "Responses", with the columns of Moodle 4 [mod/quiz/report/responses]."""
    header = ["Last name", "First name", *ids, "State", "Started on", "Completed", "Time taken"]
    header += ["Grade/30.00", *(f"Response {k + 1}" for k in range(30))]
    times = ["Finished", "1 October 2026  10:02 AM", "1 October 2026  10:41 AM", "39 mins"]
    table = [
        ["O'Hara", "Ann", *student_ids, *times, "12.00", *chosen] for student_ids, chosen in rows
    ]
    return write_table(path, header, table)


def test_the_quiz_report_of_moodle_is_read(tmp_path):
    right = [question.right for question in QUESTIONS]
    wrong = [question.wrong[1].text for question in QUESTIONS]
    nothing = ["-"] * 30
    before = moodle_table(
        tmp_path / "b.csv",
        [(["1", "o'hara@x.edu"], wrong), (["", "no-attempt@x.edu"], nothing)],
    )
    after = moodle_table(tmp_path / "a.csv", [(["1", "o'hara@x.edu"], right)])
    gain = gain_of(before, after)
    assert (gain.students, gain.total.before, gain.total.after) == (1, 0, 100)


def test_a_table_of_letters_and_a_report_of_moodle_can_be_compared(tmp_path):
    right = [question.right for question in QUESTIONS]
    before = write_letters(
        tmp_path / "b.csv",
        {"ann@x.edu": [False] * 30},
        header=["email address", *(f"Q{k + 1}" for k in range(30))],
    )
    after = moodle_table(tmp_path / "a.csv", [(["", "Ann@X.edu"], right)])
    assert gain_of(before, after).total.gain == 1


def test_ids_with_apostrophes_are_those_of_the_file(tmp_path):
    names = ("o'hara", "'t hooft", "'=b2")  # a spreadsheet gets the last one for =b2
    before = write_letters(tmp_path / "b.csv", dict.fromkeys(names, [False] * 30))
    after = write_letters(tmp_path / "a.csv", {name: [True] * 30 for name in (*names[:2], "=b2")})
    assert gain_of(before, after).students == 3


def test_empty_cells_are_no_answers_and_not_right(tmp_path):
    columns = ["student", *(f"q{k + 1}" for k in range(30))]
    key = ["abcde"[question.options.index(question.right)] for question in QUESTIONS]
    before = write_table(tmp_path / "b.csv", columns, [["ann", key[0]], ["ben"]])
    after = write_table(tmp_path / "a.csv", columns, [["ann", *key[:3], "", "e", *key[5:]]])
    gain = gain_of(before, after)
    assert gain.students == 1  # ben answered nothing
    assert gain.total.before == pytest.approx(100 / 30)
    assert gain.total.after == pytest.approx(100 * 28 / 30)
    assert gain.total.unknown_before == pytest.approx(100 * 29 / 30)
    assert gain.total.unknown_after == pytest.approx(100 * 2 / 30)


def test_questions_that_only_one_file_has_are_left_out(tmp_path):
    columns = ["student", "q1", "q2", "q30"]
    before = write_table(tmp_path / "b.csv", columns, [["ann", "e", "e", "e"]])
    after = write_table(tmp_path / "a.csv", columns[:3], [["ann", "B)", "a."]])
    gain = gain_of(before, after)
    assert list(gain.questions) == [1, 2] and gain.missing == tuple(range(3, 31))
    assert [concept.title for concept in gain.concepts] == ["Dynamic range and stops"]


@pytest.mark.parametrize(
    ("text", "named"),
    {
        "a letter too many": ("student,q1,q2\nann,a,b\n\nben,a,f\n", "line 4, column 'q2'"),
        "an answer to another question": (
            'student,q1\n"ann","about\n2048 numbers"\n',
            "line 2, column 'q1'",
        ),
        "a question too many": ("student,q31\nann,a\n", "column 'q31'"),
        "a question twice": ("student,q1,Response 1\nann,a,b\n", "column 'response 1'"),
        "no student": ("name,q1\nann,a\n", "'student'"),
        "semicolons": ("student;q1\nann;a\n", "commas"),
        "grades": ("Email address,Q. 1 /1.00\nann@x.edu,1.00\n", "Responses"),
        "nothing chosen": ("student,q1\nann,-\nben,\n", "answer"),
        "a student twice": ("student,q1\nann,a\nben,a\nAnn,b\n", "line 4, column 'student'"),
        "an empty id": ("student,q1\nann,a\n,b\n", "line 3, column 'student'"),
    }.values(),
    ids=lambda value: None,
)
def test_a_bad_table_is_refused_with_its_file_line_and_column(text, named, tmp_path, capsys):
    bad = tmp_path / "bad.csv"
    bad.write_text(text)
    good = write_letters(tmp_path / "good.csv", {"ann": [True] * 30})
    for files in ([bad, good], [good, bad]):
        with pytest.raises(SystemExit) as ended:
            cli.run(["course", "gain", *map(str, files), "-o", str(tmp_path / "gain.html")])
        assert ended.value.code == 2
        message = capsys.readouterr().err
        assert "bad.csv" in message and named in message
    assert not (tmp_path / "gain.html").exists()


def test_files_with_other_ids_are_refused(tmp_path, capsys):
    before = write_letters(tmp_path / "b.csv", {"ann": [True] * 30})
    after = write_letters(tmp_path / "a.csv", {"ben": [True] * 30})
    columns = ["username", *(f"q{k + 1}" for k in range(30))]
    other = write_letters(tmp_path / "c.csv", {"ann": [True] * 30}, header=columns)
    for second in (after, other):
        with pytest.raises(SystemExit) as ended:
            cli.run(["course", "gain", str(before), str(second), "-o", str(tmp_path / "g.html")])
        assert ended.value.code == 2
        message = capsys.readouterr().err
        assert "b.csv" in message and second.name in message and "student" in message
