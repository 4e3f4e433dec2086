"""Questions about a student's own functions, with answers from running changed versions of them."""

import base64
import difflib
import re
from html.parser import HTMLParser
from pathlib import Path
from types import SimpleNamespace

import nbformat
import numpy as np
import pytest
from click.testing import CliRunner
from support import attack_fixtures

from benchmarks import viva as bench
from hdrlab.cli import main
from hdrlab.course import plan
from hdrlab.course.checks.misconceptions import CheckedCalls
from hdrlab.course.grading import grader
from hdrlab.course.plan import GradingOptions
from hdrlab.course.sandbox import tiers
from hdrlab.course.sandbox.inside import system
from hdrlab.course.viva import changed, examining, inputs, pages

pytestmark = pytest.mark.grading

HOMEWORKS = plan.read().homeworks
SOLUTIONS = {name: bench.solutions(homework) for name, homework in HOMEWORKS.items()}
SHEETS = [name for name in HOMEWORKS if name != "project"]
NASTY = "</pre><script>alert(1)</script>{{ 7 * 7 }}```\x1b[31m\u202e&"
HOSTILE = f'def twice(x):\n    """{NASTY}"""\n    return 2 * x  # {NASTY}\n'


HERE = "benchmarks.viva.twice:Examining"
THERE = "hdrlab.course.viva.examining:Examining"


def examined(name, seed=0, tasks=None, by=HERE, **more):
    """Return the questions about the library's solution of a homework."""
    homework = HOMEWORKS[name]
    sources = SOLUTIONS[name]
    if tasks:
        kept = tuple(version for version in homework.tasks if version.id in tasks)
        homework = homework._replace(tasks=kept)
        sources = {task: sources[task] for task in tasks}
    submission = bench.as_submission(sources | more)
    ((passed, questions),) = bench.examined((name, homework, submission, [seed]), by, most=5)[1]
    return name, passed, questions


@pytest.fixture(scope="module")
def made():
    """The questions about the library's solutions, computed once per homework."""
    results = {}

    def once(name):
        if name not in results:
            results[name] = examined(name)
        return results[name]

    return once


def question(kind, **more):
    """Return a question of a kind with hostile text."""
    version = {"function": HOSTILE, "line": 3, "change": "* → /", "was": f"    return x  # {NASTY}"}
    versions = [{"source": f"import numpy  # {NASTY}\n{HOSTILE}", **version}] * 4
    return {"kind": kind, "task": "twice", "right": 1, "versions": versions, **more}


CURVE = inputs.figure(np.arange(0, 250, 10, dtype=np.uint8))
IMAGE = inputs.figure(np.arange(256, dtype=np.uint8).reshape(16, 16))
EVERY = [
    question(
        "promise",
        texts=["It is twice as much", NASTY, "No sign is lost", ""],
        call=NASTY,
        broken=[[NASTY]] * 4,
    ),
    question("line", texts=[f"x = 1  # {NASTY}"] * 3, lines=[1, 2, 3]),
    question("part", own=IMAGE, given=IMAGE, marks=[0, 9, 18, 63], call=NASTY, scale=(0.0, 1.0)),
    question(
        "picture", own=CURVE, figures=[CURVE, IMAGE, CURVE, IMAGE], call=NASTY, scale=(0.0, 1.0)
    ),
    question("value", call=f"twice({NASTY!r})", texts=["1", "2", NASTY, "4"]),
]


def written(questions, student=NASTY):
    """Return all files of some questions, by name."""
    job = SimpleNamespace(
        student=student, tier="strict", seed=7, submission=Path(NASTY.replace("/", ""))
    )
    words = {"homework": HOMEWORKS["hw2"], "read": SimpleNamespace(hash="abc"), "asked": job}
    lines = [{"passed": ["twice"]}, *({"question": version} for version in questions)]
    return dict(pages.pages(lines, **words))


class Tags(HTMLParser):
    """The tags of a page, and its references to other resources."""

    def __init__(self, text):
        super().__init__()
        self.tags = set()
        self.refers = []
        self.alts = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.add(tag)
        named = dict(attributes)
        self.refers += [named[name] for name in ("href", "src") if named.get(name)]
        if tag in ("img", "svg"):
            self.alts.append(named.get("alt") or named.get("aria-label"))
        assert not any(name.startswith("on") for name in named)


# What is changed


@pytest.mark.parametrize("task", ["gsolve", "hat", "recover_steps"])
def test_a_version_is_python_that_differs_in_one_token(task):
    source = SOLUTIONS["hw2"][task]
    versions = changed.versions(source)
    assert len(versions) > 8
    for version in versions:
        old, new = version.change.split(" → ")
        (was, now) = [
            (source[a:b], version.source[c:d])
            for tag, a, b, c, d in difflib.SequenceMatcher(
                None, source, version.source, False
            ).get_opcodes()
            if tag != "equal"
        ][0]
        assert was in old and now in new
        assert version.function in version.source
        assert new in version.function.split("\n")[version.line - 1]
        compile(version.source, task, "exec")


def test_strings_comments_and_own_names_are_not_changed():
    versions = changed.versions(
        'def f(x):\n    """Take 2 of 3."""\n    y = "1 + 1"  # not 4\n    return y * (x + 5)\n'
    )
    assert {version.change for version in versions} == {
        "* → /",
        "* → +",
        "+ → -",
        "+ → *",
        "5 → 6",
        "5 → 4",
    }


def test_there_are_no_questions_about_a_function_too_long_to_show():
    assert changed.versions("def f(x):\n" + "    x = x + 1\n" * 100 + "    return x\n") == []
    assert (
        changed.versions("def f(x):\n    return 1 + x\n" + "# \n" * changed.MAX_SOURCE_CHARACTERS)
        == []
    )


def test_a_line_whose_value_is_written_out_where_it_was_used_can_be_taken_out():
    source = "def f(λ, x):\n    y = λ + 1\n    z = 2 * y\n    return y * z - x\n"
    idle = changed.unused(source)
    assert sorted(idle) == [2, 3]
    for line, text in idle.items():
        answers = []
        for code in (source, text, changed.without(text, line)):
            scope = {}
            exec(code, scope)
            answers.append(scope["f"](3.0, 4.0))
        assert answers == [answers[0]] * 3
        scope = {}
        exec(changed.without(source, line), scope)
        with pytest.raises(NameError):
            scope["f"](3.0, 4.0)


def test_an_image_shows_the_photograph_in_the_levels_that_it_had():
    rng = np.random.default_rng(1)
    image = rng.random((3, 20, 30)).astype(np.float32)
    photo = rng.integers(0, 256, (40, 50))
    (shown, curve), named = inputs.put_photograph(((image, np.arange(5.0)), {"k": 2}), photo)
    assert shown.shape == (3, 60, 90)
    assert shown.dtype == np.float32
    assert np.array_equal(curve, np.arange(5.0))
    assert named == {"k": 2}
    for before, after in zip(image, shown, strict=True):
        assert np.array_equal(np.unique(before), np.unique(after))
    seen = photo[np.ix_(np.arange(60) * 40 // 60, np.arange(90) * 50 // 90)]
    assert np.corrcoef(seen.ravel(), shown[0].ravel())[0, 1] > 0.99


def test_an_argument_by_hand_is_small_and_written_as_python():
    arguments = inputs.small(([np.arange(40, dtype=np.uint8).reshape(5, 8)], 0.123456))
    assert inputs.count(arguments) == 5
    assert np.array_equal(eval(repr(arguments[0]), vars(np))[0], [[11, 12], [19, 20]])
    assert inputs.format_answer(arguments[1]) == "0.12"


def test_an_answer_without_a_form_that_can_be_drawn_is_not_drawn():
    shapes = [np.zeros((9, 0)), np.zeros((0, 9)), np.float64(3), "text", None, [], [[], []], {}, ()]
    assert [
        inputs.drawable_part(shape) for shape in [*shapes, *((shape,) for shape in shapes)]
    ] == [None] * 18


# Pages


@pytest.mark.parametrize("name", ["viva.html", "quiz.html", "oral.html", "examiner.html"])
def test_a_page_runs_no_script_loads_nothing_and_reports_what_it_cannot_show(name):
    text = written(EVERY)[name]
    page = Tags(text)
    assert not page.tags & {"script", "iframe", "object", "form", "base"}
    assert all(link.startswith(("data:", "#")) for link in page.refers)
    assert all(page.alts) and len(page.alts) == 7
    assert "They do not show who wrote it" in text
    assert "{{ 7 * 7 }}" in text
    assert not re.search("[\x00-\x08\x0b-\x1f\u202e]", text)


def test_only_the_examiners_page_names_the_right_option():
    files = written(EVERY)
    assert "<b>B</b> is right" in files["examiner.html"]
    for name in ("viva.html", "quiz.html", "oral.html", "viva.ipynb"):
        assert "</b> is right" not in files[name]
        moved = written([{**question, "right": 2} for question in EVERY])[name]
        keys = re.compile(r"[0-9a-f]{64}")
        assert keys.sub("", moved) == keys.sub("", files[name])


def test_code_in_the_notebook_has_its_lines_where_no_style_is():
    notebook = nbformat.reads(written(EVERY)["viva.ipynb"], 4)
    cell = next(
        entry["source"] for entry in notebook["cells"] if "checks from the top" in entry["source"]
    )
    code = re.sub("<[^>]+>", "", re.search(r"<pre>(.*?)</pre>", cell, re.DOTALL)[1]).split("\n")
    assert code[0] == "  1  def twice(x):"
    assert [line[:3] for line in code if line] == ["  1", "  2", "   ", "  3"]


def test_the_notebook_checks_itself_and_then_says_what_each_option_comes_from(capsys):
    notebook = nbformat.reads(written(EVERY)["viva.ipynb"], 4)
    nbformat.validate(notebook)
    code = [cell.source for cell in notebook.cells if cell.cell_type == "code"]
    scope = {}
    exec(code[0], scope)
    for n in range(1, 6):
        scope["check"](n, "B")
        scope["check"](n, "C")
    output = capsys.readouterr().out
    assert (
        re.findall("^(right|not this one)", output, re.MULTILINE) == ["right", "not this one"] * 5
    )
    assert output.count("C comes from line 3, * → /: return 2 * x  #") == 4
    assert output.count("D comes from your code as it is") == 1
    assert "\x1b" not in output
    for cell in notebook.cells:
        named = re.findall(r"attachment:([\w.]+)", cell.source)
        assert sorted(named) == sorted(cell.get("attachments", {}))
        assert "<script" not in cell.source
        for attachment in cell.get("attachments", {}).values():
            assert Tags(base64.b64decode(attachment["image/svg+xml"]).decode()).alts


def test_fewer_than_five_questions_are_announced():
    for name, text in written(EVERY[:2]).items():
        shown = nbformat.reads(text, 4).cells[0].source if "ipynb" in name else text
        assert "2 of five questions." in shown
        assert "twice" in text


# Questions


def test_who_sees_the_options_alone_is_at_chance_since_each_is_right_for_some_version_and_one_is_drawn(
    monkeypatch,
):
    monkeypatch.setattr(examining.QuestionGenerator, "is_reproducible", lambda *_: True)
    versions = [changed.Version(HOSTILE, HOSTILE, 3, f"{k}") for k in range(4)]
    draft = examining.QuestionDraft(
        versions=versions,
        values=[*range(4)],
        view=int,
        differ=np.not_equal,
        shown={"texts": ["1.5", "1.4", "1.6", "-900"]},
    )
    monkeypatch.setattr(examining.QuestionGenerator, "draft_value", lambda self: draft)
    run = SimpleNamespace(job={"sources": {"twice": HOSTILE}}, calls_of=lambda task: [])
    generator = examining.QuestionGenerator(run, "twice", [], np.random.default_rng(3))
    drawn = [generator.question("value", 20) for _ in range(4000)]
    share = np.bincount([option["right"] for option in drawn], minlength=4) / len(drawn)
    assert np.all(np.abs(share - 0.25) < 0.03)
    for most in (True, False):
        assert abs(np.mean([bench.blind(option, most) for option in drawn]) - 0.25) < 0.03


@pytest.mark.parametrize(("memory", "right"), [("zeros", True), ("empty", False)])
def test_uninitialized_memory_is_not_an_answer(memory, right, monkeypatch):
    # which the run of a version changes, in a process of its own
    monkeypatch.setattr(np, "empty", np.empty)
    monkeypatch.setattr(np, "empty_like", np.empty_like)
    run = SimpleNamespace(job={"sources": {"twice": HOSTILE}}, calls_of=lambda task: [])
    generator = examining.QuestionGenerator(run, "twice", [], np.random.default_rng(3))
    texts = [
        f"import numpy as np\n\n\ndef twice():\n    return np.{memory}(1)[0] + {k}\n"
        for k in range(4)
    ]

    def view(version):
        scope = {}
        exec(version.source, scope)
        return scope["twice"]()

    versions = [changed.Version(text, text) for text in texts]
    draft = examining.QuestionDraft(
        versions=versions, values=[*range(4)], view=view, differ=np.not_equal, shown={}
    )
    assert generator.is_reproducible(draft) == right


def test_a_call_is_shown_with_its_parameters_and_large_arrays_by_size_and_range():
    large = np.linspace(0, 1, 100).reshape(10, 10)
    text = inputs.format_call("scale", ["x", "by"], (large, 3), {"offset": np.array([0.5, 1])}, 16)
    assert text.startswith("scale(x=") and text.endswith(", by=3, offset=[0.5, 1.0])")
    assert "10 × 10" in text and "0 to 1" in text


@pytest.mark.parametrize("name", SHEETS)
def test_five_questions_are_of_different_tasks_and_have_one_right_answer_where_they_are_run_again(
    name, made
):
    _, passed, questions = made(name)
    assert sorted(passed) == sorted(question.id for question in HOMEWORKS[name].tasks)
    assert [question["again"] for question in questions] == [True] * 5
    assert len({(question["task"], question["kind"]) for question in questions}) == 5
    assert len({question["task"] for question in questions}) >= 4
    assert len({question["kind"] for question in questions}) >= (2 if name == "hw2" else 3)
    for question in questions:
        versions = [version["source"] for version in question["versions"]]
        assert len(set(versions)) == 4
        if question["kind"] != "line":
            assert SOLUTIONS[name][question["task"]] not in versions


def test_equal_seeds_give_equal_questions_also_in_the_sandbox_and_other_seeds_give_others(made):
    first = made("hw1")[2]
    assert written(examined("hw1", by=THERE)[2]) == written(first)
    assert written(examined("hw1", seed=1)[2]) != written(first)


def test_the_questions_about_one_function_are_of_different_kinds():
    *_, questions = examined("hw4", tasks=["display"])
    kinds = [question["kind"] for question in questions]
    assert 2 <= len(kinds) == len(set(kinds))


@pytest.mark.parametrize(("tasks", "more"), [("abcd", 0), ("abcde", 3)])
def test_more_versions_are_tried_if_five_tasks_have_few_questions(tasks, more, monkeypatch):
    tried = []
    written = []
    few = examining.VERSIONS_PER_SEARCH[0]
    known = {("value", "a"), ("part", "b")}

    class Asked:
        def __init__(self, run, task, items, rng):
            self.task = task

        def question(self, kind, max_versions):
            tried.append((max_versions, kind, self.task))
            if (kind, self.task) in known or max_versions > few:
                return {"kind": kind, "task": self.task}
            return None

    monkeypatch.setattr(examining, "QuestionGenerator", Asked)
    run = examining.Examining.__new__(examining.Examining)
    run.job = {"seed": "1", "sources": dict.fromkeys(tasks, ""), "timeout": 1}
    run.failed = set()
    one_call = CheckedCalls(calls=[((), {}, None)], holds=True)
    run.calls = dict.fromkeys(tasks, [one_call])
    run.submission = SimpleNamespace(seconds_left=1)
    run._replace_sandbox = lambda: None
    run._write = lambda **line: written.append(line)
    run.pytest_sessionfinish(SimpleNamespace(items=[]))
    questions = [line["question"] for line in written if "question" in line]
    assert len({(line["kind"], line["task"]) for line in questions}) == len(questions) == 2 + more
    pairs = len(tasks) * len(examining.KINDS)
    assert [most for most, *_ in tried] == [few] * pairs + [examining.VERSIONS_PER_SEARCH[1]] * more


def test_there_are_no_questions_about_a_function_that_fails_a_check():
    wrong = SOLUTIONS["hw1"]["ev"].replace("log2", "log")
    _, passed, questions = examined("hw1", tasks=["ev", "equivalent_time"], ev=wrong)
    assert passed == ["equivalent_time"]
    assert {question["task"] for question in questions} == {"equivalent_time"}


def test_a_changed_version_that_never_ends_is_dropped_and_other_questions_remain():
    text = "import numpy as np\n\n\ndef ev(N, t, S=100.0):\n    k = 0\n    while k < 3:\n        k += 1\n"
    text += "    return np.log2(N**2 / t) - np.log2(S / 100)\n"
    assert any("k -= 1" in version.source for version in changed.versions(text))
    *_, questions = examined("hw1", tasks=["ev"], by=THERE, ev=text)
    assert questions
    assert not any(
        "k -= 1" in version["source"] for question in questions for version in question["versions"]
    )


@pytest.mark.parametrize("name", attack_fixtures.ATTACK_NAMES)
def test_an_attack_breaks_no_page_and_leaves_nothing(name, tmp_path):
    try:
        tiers.choose("strict")
    except tiers.Unavailable as reason:
        pytest.skip(str(reason))
    place = attack_fixtures.fill_folder(tmp_path)
    files = attack_fixtures.list_file_sizes(place)
    processes = system.list_children()
    begin = "\n\ntry:\n    double(1.0)\nexcept BaseException:\n    pass\n"
    sources = {task: SOLUTIONS["hw1"][task] for task in ("ev", "equivalent_time")}
    sources["ev"] = attack_fixtures.prepare_attack(name, place, 9) + begin + sources["ev"]
    homework = HOMEWORKS["hw1"]
    homework = homework._replace(
        tasks=tuple(event for event in homework.tasks if event.id in sources)
    )
    conditions = GradingOptions("strict", timeout=5.0, draw=False)
    more = {"seed": "3", "photographs": pages.photographs([])}
    more["by"] = THERE
    events = [*grader.iter_events(bench.as_submission(sources), homework, conditions, **more)]
    questions = [event["question"] for event in events if "question" in event]
    assert any(event["task"] == "equivalent_time" for event in questions)
    for text in written(questions).values():
        assert "<script>alert" not in text
    assert system.list_children() == processes, "a process is left"
    assert attack_fixtures.list_file_sizes(place) == files, "a file is left"


def test_the_command_writes_all_notebooks_and_lists_files_that_it_did_not_read(
    tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    work = tmp_path / "hw1.py"
    work.write_text("# %%\n" + SOLUTIONS["hw1"]["equivalent_time"])
    words = ["viva", str(work), "--tier", "practice", "--seed", "2"]
    ended = CliRunner().invoke(main, words, catch_exceptions=False)
    assert ended.exit_code == 0
    out = tmp_path / "viva" / "hw1"
    assert {path.name for path in out.iterdir()} == {*written(EVERY)}
    assert (out / "examiner.html").stat().st_mode & 0o077 == 0
    assert "note: ev was not found" in ended.output
    assert "of five questions." in (out / "viva.html").read_text()
