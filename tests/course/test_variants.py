"""Variants of a task: assignment, checks, hints, mistakes and solution agree, and each team has its own."""

import ast
import json
import re
from collections import Counter
from datetime import UTC, datetime
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import scoring

from hdrlab import cli
from hdrlab.course import materials, notebook, plan
from hdrlab.course.authoring import handouts, solutions
from hdrlab.course.authoring.export import autograder
from hdrlab.course.checks import SPECIFICATION, inprocess, misconceptions
from hdrlab.course.grading import grader
from hdrlab.course.plan import GradingOptions
from hdrlab.course.similarity import comparison, report, student_code
from hdrlab.course.students import csv_tables, roster
from hdrlab.course.submissions import reader
from hdrlab.course.submissions.class_folder import Submission
from hdrlab.course.variants import rewording

pytestmark = pytest.mark.grading

SOURCES = materials.folder("tests").parent / "solutions"
if not (SOURCES / "hw1.py").is_file():
    pytest.skip(
        "the handouts' prose is in a clone, and this is an installed package",
        allow_module_level=True,
    )
PLAN = plan.read()
TASKS = sorted(path.stem for path in rewording.FOLDER.glob("*.toml"))
EVERY = [(task, variant) for task in TASKS for variant in rewording.every(task)]
NOW = datetime(2026, 10, 1, tzinfo=UTC)
HOMEWORK = {task.id: homework for homework in PLAN.homeworks.values() for task in homework.tasks}
SECRET = "x"  # gives the two teams of the class different variants of all tasks
SHEET = """
[hw1]
title = "Alignment"
due = 2099-10-09T23:59:00Z
tasks = [
  { id = "exclusion", function = "align.mtb.exclusion", points = 10, parameters = VOTES },
  { id = "shift", function = "align.shift.shift", points = 15, parameters = MOVES },
]
"""
CLASS = SHEET.replace("VOTES", '["clipped", "tie", "margin"]').replace(
    "MOVES", '["border", "direction", "order"]'
)


def task_of(task, variant):
    return PLAN.task(task)._replace(variant=variant)


def homework_of(task, variant):
    """Return the homework of a task, with a variant of that task."""
    whole = HOMEWORK[task]
    return whole._replace(
        tasks=tuple(
            task_of(task, variant) if task_in_plan.id == task else task_in_plan
            for task_in_plan in whole.tasks
        )
    )


@cache
def made(task, variant):
    """Return the handout of a homework with a variant of one task."""
    pytest.importorskip("jupytext", reason="jupytext is not installed")
    homework = homework_of(task, variant)
    return handouts.handout((SOURCES / f"{homework.name}.py").read_text("utf8"), homework)


def about(task, variant):
    """Return all texts about a task, by kind."""
    handout = made(task, variant)
    sheet = [cell["source"] for cell in handout.assignment["cells"]]
    at = sheet.index(f'check("{task}")')
    checks = rewording.reword(task, variant, (SPECIFICATION / f"test_{task}.py").read_text("utf8"))
    return {
        "prose": next(text for text in reversed(sheet[:at]) if text.startswith("#")),
        "stub": sheet[at - 1],
        "class": sheet[at - 2] if sheet[at - 2].startswith(("class ", "from typing")) else "",
        "pictures": "\n".join(text for text in sheet if re.search(rf"(?<!def )\b{task}\(", text)),
        "solution": handout.solution["cells"][at - 1]["source"],
        "checks": checks,
        "mistakes": "\n".join(
            mistake.sentence for mistake in misconceptions.of_task(task_of(task, variant))
        ),
    }


def neighbors(task, variant):
    """Return the variants that differ from a variant in one parameter: the hardest to tell from it."""
    own = variant.split("/")
    pairs = {other: zip(own, other.split("/"), strict=True) for other in rewording.every(task)}
    return [other for other, pair in pairs.items() if sum(a != b for a, b in pair) == 1]


def each_value(task):
    """Return variants in which each value occurs, alone and with the last of all other parameters."""
    library, *_ = rewording.every(task)
    last = "/".join([*values][-1] for values in rewording.parameters(task).values())
    return [library, *dict.fromkeys([*neighbors(task, library), *neighbors(task, last), last])]


def subject(task, variant):
    return inprocess.Subject({task: plan.function(task_of(task, variant))})


@pytest.fixture
def course(tmp_path, monkeypatch):
    """A plan with variants, a class of three and its secret; change to its folder."""
    monkeypatch.chdir(tmp_path)
    Path("plan.toml").write_text(CLASS)
    Path("roster.csv").write_text("student,name,team\nb1,Ada,\nb2,Bo,pair\nb3,Cy,pair\n")
    Path("secret.txt").write_text(SECRET + "\n")
    return plan.read("plan.toml")


def run(*words, code=None):
    with pytest.raises(SystemExit) as ended:
        cli.run([str(word) for word in words])
    assert ended.value.code == code


def build(out, *more):
    words = (
        "--plan",
        "plan.toml",
        "--sources",
        SOURCES,
        "--out",
        out,
        "--variants",
        "roster.csv",
        *more,
    )
    run("course", "build", *words, "--secret-file", "secret.txt")


def filled(homework, path):
    """Write an assignment, solved with the solutions of its own variants, and return its path."""
    source = (SOURCES / f"{homework.name}.py").read_text("utf8")
    path.write_text(handouts.to_text(handouts.handout(source, homework).solution))
    return path


# What a variant is


@pytest.mark.quick
@pytest.mark.parametrize("task", TASKS)
def test_each_variant_has_its_own_checks_and_its_result_names_the_variant(task):
    digests = set()
    for variant in rewording.every(task):
        homework = homework_of(task, variant)
        events = grader.iter_events(
            reader.SubmittedCode({}, (), ""), homework, GradingOptions(tier="practice")
        )
        digests.add(next(events)["specification"])
        events.close()
    assert len(digests) == len(rewording.every(task)) > 1


def test_every_task_has_at_least_three_variants_and_the_librarys_own_values_come_first():
    for task in TASKS:
        assert len(rewording.every(task)) >= 3
        for values in rewording.parameters(task).values():
            assert len(values) >= 2 and [*values.values()][0] == []


@pytest.mark.parametrize("task", TASKS)
def test_every_text_replacement_of_a_variant_is_used(task):
    used = set()
    texts = [*about(task, "").values()]
    texts += [
        solutions.texts(homework_of(task, ""), [mistake.name])[task]
        for mistake in misconceptions.known()
        if mistake.task == task
    ]
    for variant in rewording.every(task):
        for text in texts:
            for values, value in zip(
                rewording.parameters(task).values(), variant.split("/"), strict=True
            ):
                for was, now in values[value]:
                    if was in text:
                        used.add((value, was))
                    text = text.replace(was, now)
    pairs = {
        (value, was)
        for values in rewording.parameters(task).values()
        for value, replacement in values.items()
        for was, _ in replacement
    }
    assert pairs - used == set(), pairs - used


@pytest.mark.parametrize(("task", "variant"), EVERY)
def test_a_replaced_text_no_longer_occurs_in_a_variant(task, variant):
    for kind, text in about(task, variant).items():
        for values, value in zip(
            rewording.parameters(task).values(), variant.split("/"), strict=True
        ):
            for was, now in values[value]:
                assert was not in text.replace(now, ""), f"{kind}: {was}"


# of each value, what the prose of the sheet says then and for no other value, and the same of the
# hints; None where the library's own value needs no words
SAID = {
    "exclusion": {
        "clipped": {"excluded": ("values 0 and 255", "neither 0 nor 255")},
        "tie": {"above": ("t| > ", "t| > "), "from": (r"t| \ge ", "t| >= ")},
        "margin": {
            "four": (" 4$", "and t + 4"),
            "six": (" 6$", "and t + 6"),
            "eight": (" 8$", "and t + 8"),
        },
    },
    "shift": {
        "border": {"cut": ("crop them to", "Crop the images"), "black": ("is black", "are black")},
        "direction": {
            "goes": ("must move, ", "where the image must move: "),
            "came": ("has moved, ", "how far the image has moved: "),
        },
        "order": {
            "rows": ("$(dy, dx)$", "offset (dy, dx)"),
            "columns": ("$(dx, dy)$", "offset (dx, dy)"),
        },
    },
    "weight": {
        "planes": {
            "rgb": ("R, G and B as planes", ", of the gray Y.\n"),
            "bgr": ("**B first**", "F[0] is blue"),
        },
        "neighbours": {
            "sides": (r"Y_\text{up}", "|up + down"),
            "corners": (r"Y_\text{NW}", "|NW + NE"),
        },
        "curve": {
            "narrow": ("0.2^2", "0.2^2"),
            "wide": ("0.3^2", "0.3^2"),
            "parabola": ("4 F (1 - F)", "4 F (1 - F)"),
        },
    },
    "gsolve": {
        "exposures": {
            "logarithms": (None, "not its logarithm"),
            "times": ("times in seconds", "not t itself"),
            "stops": ("ln 2$ times", "not the stops themselves"),
        },
        "lambda": {
            "inside": (r"\{\lambda", "factors, lambda"),
            "outside": (r"\sqrt\lambda", "root of `smoothness`"),
        },
        "weights": {
            "inside": (r"\{ w(Z_{ij})", "rows by the weight"),
            "outside": (r"\sqrt w", "root of the weight"),
        },
    },
    "merge": {
        "weights": {
            "hat": ("the hat of homework 2", "below the middle and 255"),
            "parabola": ("the parabola", "use w(z) = z (255 - z)"),
        },
        "time": {
            "equal": (r"(Z_j)\,[\,g", "/ sum_j w(Z_j), and"),
            "longer": (r"(Z_j)\,t_j\,[\,g", "/ sum_j w(Z_j) t_j, and"),
        },
        "exposures": {
            "times": ("`(P,)` seconds", "times[j] belongs"),
            "stops": ("exposures in stops", "stops[j] belongs"),
        },
    },
    "tonemap": {
        "white": {
            "square": ("{white}^2", "Lm / white^2"),
            "factor": ("1 / L_{white}", "1 / white"),
        },
        "key": {
            "scaled": (r"\frac{a L}{\bar L}", "by key / Lav"),
            "displayed": ("displayed as $a$", "key / (1 - key)"),
        },
    },
    "display": {
        "white": {
            "square": ("L_{white}^2", "square of white"),
            "factor": ("1 / L_{white}", "white itself"),
            "cube": ("L_{white}^3", "cube of white"),
        },
    },
    "adjust_steps": {
        "range": {
            "nats": ("both in nats", "both natural"),
            "decades": ("in decades", "a decade is"),
            "stops": ("in stops", "a stop is"),
        },
        "slope": {
            "one": ("or below 1. With", "ceiling = T"),
            "half_more": ("at or below 1.5", "ceiling = 1.5 T"),
        },
    },
    "guided": {
        "result": {
            "smooth": (r"operatorname{mean}(b).$$", "2 q + 3: q"),
            "detail": ("d = p - q", "must be 2 d"),
        },
        "epsilon": {
            "variance": ("is the variance", "above eps,"),
            "deviation": ("is the standard deviation", "above eps^2,"),
        },
    },
    "align": {
        "direction": {
            "goes": (None, "where the image must move"),
            "came": ("*has moved*", "how far the image has moved"),
        },
        "order": {
            "rows": (None, "one row for each"),
            "columns": ("$(dx, dy)$", "(dx, dy) for each"),
        },
    },
    "recover": {
        "exposures": {
            "times": (None, "by their times first"),
            "stops": ("exposures in stops", "by their stops first"),
        },
        "logarithm": {
            "natural": (r"g = \ln f^{-1}", "take the logarithm"),
            "binary": ("log_2 f", "take the log2"),
            "decimal": ("log_{10} f", "take the log10"),
        },
    },
    "inverse_variance_merge": {
        "spread": {
            "deviation": (r"\sqrt{\sum 1 / V}", "s is a standard deviation"),
            "variance": ("$s^2$", "s^2 is a variance"),
        },
        "noise": {
            "electrons": ("(X, D, N, R)", "(E t, D, N, R)"),
            "relative": ("(X, D, N, R N)", "(E t, D, N, R N)"),
        },
    },
    "brightness_transfer": {
        "values": {
            "rounded": (r"$z + \frac{1}{2}$", "and H_B(z + 1) at z + 1/2."),
            "truncated": ("truncated", "and H_B(z + 1) at z + 1."),
        },
        "result": {
            "position": ("Do not round", None),
            "difference": ("$T(m) - m$", "T(m) - m is"),
        },
    },
    "reconstruct": {
        "filters": {
            "transparency": ("(`e` is", "Divided by e,"),
            "stops": ("(`stops` is", "Divided by e = 2^-stops,"),
        },
        "limit": {
            "high": (r"\ge 0.995", "X is 0.995"),
            "low": (r"\ge 0.95$", "X is 0.95 "),
        },
    },
    "equalise": {
        "display": {
            "srgb": ("that of sRGB", "decode it as sRGB"),
            "early": ("$P^{1.8}$", "power of 1.8"),
            "cinema": ("$P^{2.6}$", "power of 2.6"),
        },
    },
    "refine": {
        "turn": {
            "clockwise": (", clockwise as seen", "turns clockwise"),
            "counterclockwise": ("counterclockwise as seen", "turns counterclockwise"),
        },
        "order": {
            "rows": (r"$(d_y, d_x, r\varphi)$", None),
            "columns": (r"$(d_x, d_y, r\varphi)$", "Right comes first"),
        },
    },
}


@pytest.mark.parametrize(("task", "variant"), EVERY)
def test_assignment_and_hints_of_a_variant_name_only_its_own_values(task, variant):
    texts = about(task, variant)
    own = dict(zip(rewording.parameters(task), variant.split("/"), strict=True))
    for parameter, values in SAID[task].items():
        for value, (prose, hint) in values.items():
            if prose is not None:
                assert (prose in texts["prose"]) == (own[parameter] == value), (
                    prose,
                    texts["prose"],
                )
            if hint is not None:
                assert (hint in texts["checks"]) == (own[parameter] == value), hint


@pytest.mark.parametrize("variant", rewording.every("shift"))
def test_the_cell_below_the_task_calls_it_as_the_variant_is_called(variant):
    from hdrlab.align.shift import crop, shift

    arguments = re.search(r"shift\(grays, (.*?)\)\)", about("shift", variant)["pictures"])[1]
    rng = np.random.default_rng(3)
    grays = rng.integers(0, 256, (3, 30, 40), np.uint8)
    offsets = np.array([[0, 0], [4, -3], [-2, 5]])
    shifted = plan.function(task_of("shift", variant))(grays, eval(arguments, {"offsets": offsets}))
    common = (slice(None), *crop(offsets, grays.shape[1:]))
    expected = shift(grays, offsets)
    assert np.array_equal(shifted[common] if variant.startswith("black") else shifted, expected)


@pytest.mark.parametrize(("task", "variant"), EVERY)
def test_the_stub_of_a_variant_documents_the_arguments_that_it_has(task, variant):
    (function,) = ast.parse(about(task, variant)["stub"]).body
    documented = (ast.get_docstring(function) or "").partition("Parameters\n---")[2]
    names = re.findall(r"(?m)^(\w+(?:, \w+)*) : ", documented.partition("\n\n")[0])
    arguments = {one.arg for one in (*function.args.args, *function.args.kwonlyargs)}
    assert {name for each in names for name in each.split(", ")} <= arguments


# What its checks say


@pytest.mark.parametrize("task", TASKS)
@pytest.mark.parametrize("student", ["ada", "Emmy Noether"])
def test_the_solution_of_every_variant_passes_every_check(task, student):
    for variant in rewording.every(task):
        share, outcomes = scoring.score(
            task, subject(task, variant), plan.seed("x", student, task), variant
        )
        assert share == 1, (
            variant,
            {name: str(error) for name, error in outcomes.items() if error},
        )


@pytest.mark.parametrize("task", TASKS)
def test_the_solution_of_another_variant_loses_a_quarter_of_the_points_or_more(task):
    subjects = {variant: subject(task, variant) for variant in rewording.every(task)}
    for variant in subjects:
        for other in neighbors(task, variant):
            share, _ = scoring.score(task, subjects[other], plan.seed("x", "ada", task), variant)
            assert share <= 0.75, other


@pytest.mark.filterwarnings("ignore")  # a wrong function may well divide by 0
@pytest.mark.parametrize("task", TASKS)
def test_each_named_mistake_is_named_for_every_variant_and_costs_points_but_not_all(task):
    for variant in each_value(task):
        for mistake in misconceptions.of_task(task_of(task, variant)):
            wrong = inprocess.Subject({task: mistake.function})
            share, _ = scoring.score(task, wrong, plan.seed("x", "ada", task), variant)
            closest = misconceptions.closest(task_of(task, variant), wrong.calls[:20])
            assert closest is not None and closest.name == mistake.name, variant
            assert 0 < share < 1 and (share >= 0.5 or mistake.misses_method), variant


@pytest.mark.parametrize("task", TASKS)
def test_mistakes_of_variants_can_be_imitated_for_a_class(task):
    for variant in rewording.every(task):
        right = solutions.texts(homework_of(task, variant))
        for mistake in misconceptions.of_task(task_of(task, variant)):
            assert solutions.texts(homework_of(task, variant), [mistake.name])[task] != right[task]


def test_alignment_works_with_the_exclusion_bitmap_of_any_variant():
    for variant in rewording.every("exclusion")[:: len(rewording.every("exclusion")) - 1]:
        scope = {}
        exec(
            "\n\n".join(misconceptions.solutions(homework_of("exclusion", variant).tasks).values()),
            scope,
        )
        assert scoring.score("align", inprocess.Subject({"align": scope["align"]}))[0] == 1


# Which team gets which variant


def test_a_plan_without_parameters_asks_everybody_the_same():
    for homework in PLAN.homeworks.values():
        assert plan.draw_variants(homework, "b1", SECRET) == homework


def test_variant_values_are_drawn_evenly_and_unlisted_parameters_stay(
    course,
):
    some = course.homeworks["hw1"].tasks[0]._replace(parameters=("margin", "tie"))
    variants = [
        plan.draw_variants(course.homeworks["hw1"]._replace(tasks=(some,)), f"b{n}", SECRET)
        .tasks[0]
        .variant
        for n in range(600)
    ]
    counted = [
        Counter(values)
        for values in zip(*(variant.split("/") for variant in variants), strict=True)
    ]
    assert [*counted[0]] == ["compared"]
    assert all(240 < n < 360 for n in counted[1].values()) and len(counted[1]) == 2
    assert all(150 < n < 250 for n in counted[2].values()) and len(counted[2]) == 3


def test_the_same_roster_and_secret_make_the_same_sheets_and_a_team_has_one(course, capsys):
    build("one", "--solutions", "worked")
    build("two")
    files = sorted(path.relative_to("one") for path in Path("one").rglob("*.ipynb"))
    assert [str(path) for path in files] == ["b1/hw1.ipynb", "pair/hw1.ipynb"]
    assert all(
        (Path("one") / path).read_bytes() == (Path("two") / path).read_bytes() for path in files
    )
    for team in ("b1", "pair"):
        drawn = plan.draw_variants(course.homeworks["hw1"], team, SECRET)
        sheet = reader.tasks_of(f"one/{team}/hw1.ipynb", ["exclusion", "shift"])
        assert sheet.variants == {task.id: task.variant for task in drawn.tasks}
        assert "NotImplementedError" not in Path(f"worked/{team}/hw1.ipynb").read_text()
    Path("secret.txt").write_text("another\n")
    build("three")
    assert any(
        (Path("one") / path).read_bytes() != (Path("three") / path).read_bytes() for path in files
    )


def test_the_sheets_of_variants_need_a_secret_parameters_and_prose_that_they_can_reword(
    course, capsys
):
    words = ("course", "build", "--plan", "plan.toml", "--variants", "roster.csv", "--out", "out")
    run(*words, "--sources", SOURCES, code=2)
    assert "--variants needs --secret-file" in capsys.readouterr().err
    words = (*words, "--secret-file", "secret.txt")
    Path("plan.toml").write_text(re.sub(r", parameters = \[.*?\]", "", CLASS))
    run(*words, "--sources", SOURCES, code=2)
    assert "a plan that gives parameters to a task" in capsys.readouterr().err
    Path("plan.toml").write_text(CLASS)
    Path("prose").mkdir()
    text = (SOURCES / "hw1.py").read_text("utf8")
    Path("prose/hw1.py").write_text(
        text.replace("|Y - t| > 4", "|t - Y| > 4").replace("dy, dx", "down, right")
    )
    run(*words, "--sources", "prose", code=2)
    assert "in hdrlab's words" in capsys.readouterr().err and not list(Path().glob("out/*/*"))


@pytest.mark.parametrize(
    ("was", "now", "message"),
    [
        ('"tie"', '"knot"', "expected parameters of exclusion out of clipped, tie, margin, got"),
        ('["clipped", "tie", "margin"]', '"tie"', "expected parameters of exclusion"),
        ('["clipped", "tie", "margin"]', "7", "expected title, due and tasks"),
        (
            '"align.mtb.exclusion"',
            '"mine.py:exclusion"',
            "expected parameters of exclusion out of none",
        ),
        (
            'id = "exclusion", function = "align.mtb.exclusion"',
            'id = "hat", function = "core.weights.hat"',
            "out of none",
        ),
    ],
)
def test_unknown_parameters_of_a_task_are_refused_with_a_message(was, now, message, tmp_path):
    (tmp_path / "plan.toml").write_text(CLASS.replace(was, now))
    with pytest.raises(ValueError, match=message):
        plan.read(tmp_path / "plan.toml")


# How it is graded


def test_a_student_can_check_their_assignment_without_the_secret(course, tmp_path, monkeypatch):
    own = plan.draw_variants(course.homeworks["hw1"], "b7", SECRET)
    assert all(task.variant not in ("", rewording.every(task.id)[0]) for task in own.tasks)
    path = filled(own, tmp_path / "hw1.ipynb")
    plain = course.homeworks["hw1"]._replace(
        tasks=tuple(task._replace(parameters=()) for task in course.homeworks["hw1"].tasks)
    )
    result = grader.grade(path, plain, GradingOptions("practice"))
    assert result.score == 25 and not result.problems
    sources = ["".join(cell["source"]) for cell in json.loads(path.read_text())["cells"]]
    (source,) = [source for source in sources if "use_plan(" in source]
    monkeypatch.setattr(notebook, "_planned", {})
    exec(source.partition("\nroom =")[0], {})
    checked_tasks = notebook.find_tasks("hw1")[0].tasks
    assert [task.variant for task in checked_tasks] == [task.variant for task in own.tasks]


def test_grading_uses_the_variant_of_the_secret_and_not_the_one_named_in_the_notebook(
    course, tmp_path
):
    homework = course.homeworks["hw1"]
    theirs = plan.draw_variants(homework, "b7", SECRET)
    path = filled(theirs, tmp_path / "hw1.ipynb")
    own = grader.grade(path, homework, GradingOptions("practice", "b7", SECRET))
    other = grader.grade(path, homework, GradingOptions("practice", "pair", SECRET))
    assert own.score == 25 and not own.problems
    assert other.score <= 0.75 * 25 and other.specification != own.specification
    (problem,) = other.problems
    assert "exclusion, shift" in problem
    promises = {check.name for check in other.checks} ^ {check.name for check in own.checks}
    assert any("values_on_either_side" in name for name in promises)


@pytest.mark.parametrize("named", ["", "a/b/c", "excluded/from/six/and", "../../x/y/z", "<b>/x/y"])
def test_an_assignment_with_an_unknown_variant_is_checked_like_the_library(named, course, tmp_path):
    path = tmp_path / "hw1.py"
    path.write_text(
        f'use_plan("hw1", variants={{"exclusion": "{named}"}})\n\n# %%\nimport numpy as np\n\n\n'
        "def exclusion(Y, t):\n    return np.abs(Y.astype(int) - t) > 4\n"
    )
    read = reader.tasks_of(path, ["exclusion"])
    believed = plan.draw_variants(course.homeworks["hw1"], "", "", read.variants)
    assert [task.variant for task in believed.tasks] == ["", ""]
    path.write_text("def exclusion(Y, t):\n    return abs(Y.astype(int) - t) > 4\n")
    assert reader.tasks_of(path, ["exclusion"]).variants is None


def test_a_class_is_graded_each_by_the_variant_of_its_sheet(course, capsys):
    build("sheets", "--solutions", "worked")
    Path("in").mkdir()
    Path("in/b1_hw1.ipynb").write_bytes(Path("worked/pair/hw1.ipynb").read_bytes())
    Path("in/pair_hw1.ipynb").write_bytes(Path("worked/pair/hw1.ipynb").read_bytes())
    words = (
        "--homework",
        "hw1",
        "--plan",
        "plan.toml",
        "--roster",
        "roster.csv",
        "--tier",
        "practice",
    )
    run("grade", "in", *words, "--secret-file", "secret.txt", "-o", "out")
    points = {
        row["student"]: float(row["score"]) for row in csv_tables.read_csv("out/gradebook.csv")
    }
    assert points["b2"] == points["b3"] == 25 and points["b1"] <= 0.75 * 25
    page = Path("out/similar.html").read_text()
    assert "Sheets of another variant" in page and "<b>b1</b>: exclusion, shift" in page
    feedback_page = Path("out/feedback/b1/feedback.html").read_text()
    assert "This is the assignment of another student" in feedback_page


def test_the_assignments_of_a_class_of_variants_agree_with_their_grading(tmp_path):
    benchmark = pytest.importorskip(
        "benchmarks.class_.sheets", reason="the benchmarks are not installed"
    )
    rows = benchmark.build(tmp_path, 3)
    varied = {HOMEWORK[task].name for task in TASKS}
    assert rows["sheets"] == 3 * len(varied) and rows["different ones"] > len(varied)
    assert rows["sheets that ask what is not graded"] == 0


def test_gradescope_uses_the_variants_of_a_roster_with_email_addresses(course):
    Path("roster.csv").write_text(
        'student,team\nbo@x.edu,"bo@x.edu,cy@x.edu"\ncy@x.edu,"bo@x.edu,cy@x.edu"\n'
    )
    (team,) = roster.read("roster.csv").teams()
    users = [{"email": "cy@x.edu"}, {"email": "bo@x.edu"}]
    assert autograder.student({"users": users}) == team


# What is alike


def written(folder, texts, course):
    """Return the similarity page and table of a class that has submitted these texts for hw1."""
    known = {task.id: task for task in course.homeworks["hw1"].tasks}
    homework = HOMEWORK["shift"]
    tasks = tuple(known.get(task.id, task) for task in homework.tasks)
    homework = homework._replace(tasks=tasks)
    handins = {}
    for team, text in texts.items():
        (folder / f"{team}.py").write_text(text)
        handins[team] = Submission(team, (team,), folder / f"{team}.py", NOW, "digest")
    list(report.write_steps(folder, homework, handins, SECRET))
    return (folder / "similar.html").read_text(), csv_tables.read_csv(folder / "similar.csv")


def test_a_copy_with_changed_parameters_is_found_and_its_assignment_is_named(course, tmp_path):
    apart = materials.folder("tests") / "equivalent"
    text = (apart / "hw1_loops.py").read_text()
    other = (apart / "hw1_float32.py").read_text()
    copied = text.replace("> 4\n", ">= 6\n").replace("(dy, dx) in", "(dx, dy) in")
    assert copied != text
    homework = course.homeworks["hw1"]
    names = {}
    for team in "ab":
        tasks = plan.draw_variants(homework, team, SECRET).tasks
        names[team] = {task.id: task.variant for task in tasks}
    head = {team: f'use_plan("hw1", variants={json.dumps(names[team])})\n\n# %%\n' for team in "ab"}
    texts = {"a": head["a"] + text, "b": head["a"] + copied, "c": other}
    page, rows = written(tmp_path, texts, course)
    (row,) = rows
    differing = sum(names["a"][task] != names["b"][task] for task in names["a"])
    assert (row["one"], row["other"]) == ("a", "b") and float(row["share"]) > 0.8 and differing
    assert row["tasks on the other's sheet"] == str(differing)
    assert re.search(rf"{differing} tasks? on the other's sheet", page) and "<b>b</b>: " in page
    page, rows = written(tmp_path, {**texts, "b": head["b"] + copied}, course)
    assert rows[0]["tasks on the other's sheet"] == "0" and "on the other's sheet" not in page
    assert "Sheets of another variant" not in page


@pytest.mark.parametrize("id", TASKS)
def test_the_solution_of_any_variant_counts_as_the_librarys_and_for_no_pair(id):
    task = PLAN.task(id)._replace(parameters=tuple(rewording.parameters(id)))
    homework = HOMEWORK[id]._replace(tasks=(task,))
    library = comparison.fingerprint(report.library_code(homework)).hashes
    for variant in rewording.every(id):
        text = misconceptions.solutions((task._replace(variant=variant),))[id]
        prints = comparison.fingerprint(student_code.own_code(text, homework.name, ()))
        assert prints.hashes <= library
