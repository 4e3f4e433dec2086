"""Similar submissions in a class: which ones are found, and a page that no submission can break."""

import os
import re
import stat
import subprocess
import sys
from datetime import UTC, datetime
from functools import cache
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from copydetect import compare_files

from hdrlab.cli import classroom as commands
from hdrlab.course import materials, plan
from hdrlab.course.classroom import run as classroom
from hdrlab.course.plan import GradingOptions
from hdrlab.course.similarity import comparison, report, student_code
from hdrlab.course.similarity.student_code import TeamCode
from hdrlab.course.source_code import closure, inline
from hdrlab.course.students import csv_tables
from hdrlab.course.students.roster import Roster
from hdrlab.course.submissions.class_folder import Submission, SubmissionScan

pytestmark = pytest.mark.grading

HW2 = plan.read().homeworks["hw2"]
TASKS = [task.id for task in HW2.tasks]
NOW = datetime(2026, 10, 20, tzinfo=UTC)
MADE_APART = sorted((materials.folder("tests") / "equivalent").glob("*.py"))
if not MADE_APART:
    pytest.skip("no model solution is part of the source distribution", allow_module_level=True)
SOLUTION_TEXTS = {path.stem: path.read_text() for path in MADE_APART}
LOOPS = SOLUTION_TEXTS["hw2_loops"]
GAUGE = SOLUTION_TEXTS["hw2_gauge"]
FLOAT32 = SOLUTION_TEXTS["hw2_float32"]
NAMES = {
    "above": "upper",
    "below": "lower",
    "known": "seen",
    "row": "line",
    "total": "sums",
    "Ei": "e",
}


def renamed(text):
    """Return a text with other names, comments and spaces."""
    text = re.sub(r"\b(" + "|".join(NAMES) + r")\b", lambda match: NAMES[match[1]], text)
    text = re.sub(
        r"^( +)(for|return)", r"\1# my own idea, step by step\n\1\2", text, flags=re.MULTILINE
    )
    return text.replace("# NaN is not", "# leave out").replace(" * ", "*").replace(" + ", "  +  ")


def reordered(text):
    """Return a text with its functions in another order."""
    return "import numpy as np\n\n" + "\n\n".join(reversed(re.split(r"\n(?=# %%|def )", text)))


@cache
def library():
    blocks = inline.inlined({task.id: task.function for task in HW2.tasks})
    return {name: block.text for name, block in blocks.items()}


def work(folder, team, text):
    (folder / f"{team}.py").write_text(text)
    return student_code.read(team, folder / f"{team}.py", "hw2", TASKS)


def likeness(folder, **texts):
    works = list(comparison.fingerprint_steps(work(folder, *file) for file in texts.items()))
    return comparison.compare(
        works, student_code.handout_code("hw2"), "\n\n".join(library().values())
    )


def written(folder, texts):
    """Return the similarity page and table of a class that has submitted these texts."""
    handins = {}
    for n, (team, text) in enumerate(texts.items()):
        path = folder / f"{n}_hw2.py"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        handins[team] = Submission(team, (team,), path, NOW, "digest")
    assert list(report.write_steps(folder, HW2, handins)) == sorted(texts)
    return (folder / "similar.html").read_text(), csv_tables.read_csv(folder / "similar.csv")


def tags(text):
    names = []
    reader = HTMLParser()
    reader.handle_starttag = lambda tag, attrs: names.append((tag, dict(attrs)))
    reader.feed(text)
    return names


@pytest.mark.parametrize("change", [renamed, reordered, lambda text: reordered(renamed(text))])
def test_a_copy_is_found_behind_other_names_comments_spaces_and_order(change, tmp_path):
    report_found = likeness(tmp_path, a=LOOPS, b=change(LOOPS), c=GAUGE)
    [pair] = report_found.pairs
    assert (pair.first, pair.second) == (0, 1)
    assert pair.fraction > 0.95
    rows = {
        row.task: min(row.first_in_second, row.second_in_first)
        for row in report.compare_tasks(report_found, report_found.pairs[0])
    }
    assert set(rows) == {"", "gsolve", "irradiance", "update", "recover_steps", "recover"}
    assert min(rows.values()) > 0.9


def test_one_function_that_was_copied_is_found_among_others_that_were_not(tmp_path):
    gsolve = re.search(r"(?s)def gsolve.*?(?=\n# %%)", renamed(LOOPS))[0]
    mixed = re.sub(r"(?s)def gsolve.*?(?=\n# %%)", lambda _: gsolve, GAUGE)
    report_found = likeness(tmp_path, a=LOOPS, b=mixed)
    together, *others = report.compare_tasks(report_found, report_found.pairs[0])
    # all tasks together do not tell
    assert max(together.first_in_second, together.second_in_first) < comparison.MIN_LISTED_FRACTION
    assert [row.task for row in others if row.first] == ["gsolve"]
    assert report_found.pairs[0].fraction > 0.95


@pytest.mark.parametrize("homework", ["hw1", "hw2", "hw3", "hw4", "project"])
def test_solutions_that_were_written_apart_are_far_below_the_threshold(homework):
    homework_plan = plan.read().homeworks[homework]
    tasks = [task.id for task in homework_plan.tasks]
    paths = [path for path in MADE_APART if path.stem.startswith(homework)]
    works = [student_code.read(path.stem, path, homework, tasks) for path in paths]
    assert len(works) >= 3 and all(work.texts and not work.notes for work in works)
    blocks = inline.inlined({task.id: task.function for task in homework_plan.tasks}).values()
    text = "\n\n".join(block.text for block in blocks)
    similarity_report = comparison.compare(
        list(comparison.fingerprint_steps(works)), student_code.handout_code(homework), text
    )
    assert similarity_report.counts[3:].sum() == 0
    assert not similarity_report.pairs  # the page says: less than 30 percent
    assert homework == "project" or similarity_report.counts.sum() >= 3


def test_team_mates_are_not_compared(tmp_path):
    mates = [work(tmp_path, "a", LOOPS), work(tmp_path, "b", LOOPS)._replace(team="a")]
    similarity_report = comparison.compare(list(comparison.fingerprint_steps(mates)))
    assert not similarity_report.pairs and similarity_report.counts.sum() == 0


def test_code_of_the_handout_is_not_compared(tmp_path):
    blank = "\n\n".join(student_code.handout_code("hw2"))
    report_found = likeness(tmp_path, a=blank, b=blank)
    assert report_found.counts.sum() == 0 and not any(report_found.own.values())
    solved = (
        "def gsolve(Z, B, smoothness, w):\n    return Solution(Z, B)"  # the handout's own class
    )
    assert (
        work(tmp_path, "c", "import numpy as np\n" + blank + "\n\n" + solved).texts["gsolve"]
        == solved
    )
    both = list(comparison.fingerprint_steps(work(tmp_path, team, LOOPS) for team in "de"))
    assert (
        comparison.compare(both, [LOOPS]).counts.sum() == 0 < comparison.compare(both).counts.sum()
    )


def test_a_copy_of_the_library_is_reported_separately_and_not_as_a_pair(tmp_path):
    taken = "\n\n\n".join(library().values())
    page, table = written(tmp_path, {"a": taken, "b": renamed(taken), "c": LOOPS})
    shares = [int(share) for share in re.findall(r"[ab] \((\d+) %\)", page)]
    assert not table and "c (" not in page
    assert len(shares) == 8 and set(shares) == {100}  # two works, four tasks that are long enough


def test_the_similarities_of_all_pairs_equal_those_of_copydetect(tmp_path):
    texts = [LOOPS, GAUGE, FLOAT32, renamed(LOOPS), "def hat(n=256):\n    return 1\n"]
    handout_hashes = comparison.fingerprint("\n\n".join(student_code.handout_code("hw2"))).hashes
    for task in ("gsolve", "recover", "update"):
        works = [
            work(tmp_path, f"w{n}", text).texts.get(task, "pass\n") for n, text in enumerate(texts)
        ]
        prints = [
            comparison.without(comparison.fingerprint(text), handout_hashes) for text in works
        ]
        expected = [
            [compare_files(fingerprint, other)[0] for other in prints] for fingerprint in prints
        ]
        assert np.array_equal(comparison.covered(prints), expected)
        assert expected[0][3] > 100 and expected[0][4] == 0


def test_a_repeated_passage_counts_twice():
    line = "    total = values[0] * weights[1] + values[2] / weights[3]\n"
    text = "def f(values, weights):\n" + line + "    print(total, sep='', end=9)\n" + line
    once = comparison.without(comparison.fingerprint(text), {1})
    assert once.token_coverage == len(once.filtered_code)


@pytest.mark.parametrize(
    ("message", "text"),
    [
        ("none of the tasks can be read", "def gsolve(Z, B:\n"),
        ("none of the tasks can be read", "def gsolve():\n    return '\0'\n"),
        ("none of the tasks can be read", "def gsolve():\n    return " + "-" * 60_000 + "1\n"),
        (
            "none of the tasks can be read",
            "def gsolve():\n    return " + "+".join("a" * 40_000) + "\n",
        ),
        ("neither a notebook nor Python", b"\xff\xfe\x00"),
        ("cut short or damaged", '{"cells": ' + "[" * 50_000),
        ("1,000,000 characters", "x = 1\n" * 350_000),  # two megabytes
        ("none of the tasks can be read", "x=1\n" * 20_000),
        (
            "gsolve has more than 30,000",
            "a = []\n" + "a.append(a)\n" * 3_900 + "def gsolve(): return a\n",
        ),
        ("gsolve has more than 30,000", "def gsolve():\n    return [" + "1," * 20_000 + "]\n"),
    ],
)
def test_a_broken_or_hostile_file_is_reported_and_the_others_are_compared(message, text, tmp_path):
    page, table = written(tmp_path, {"a": LOOPS, "b": renamed(LOOPS), "x": text})
    assert [(row["one"], row["other"]) for row in table] == [("a", "b")]
    assert re.search(f"<li><b>x</b>: [^\n]*{message}", page)


def test_empty_lines_are_removed_because_copydetect_takes_quadratic_time_in_them():
    text = "def hat():\n    return [" + "\n \t" * 9_000 + "1]\n"
    assert student_code.own_code(text, "hw2", set()) == "def hat():\n    return [\n \t1]"


def test_warnings_about_submitted_code_are_not_shown_to_the_instructor():
    assert (
        student_code.own_code("def hat(): return 1if 1else 2\n" * 2, "hw2", set()).count("1if") == 2
    )


def test_the_code_of_all_tasks_together_is_limited(tmp_path):
    names = ["gsolve", "hat", "irradiance", "update", "recover"]
    body = "\n".join(f"    x{k} = {k}" for k in range(1_500))
    (tmp_path / "hw2.py").write_text("\n".join(f"def {name}():\n{body}\n" for name in names))
    work = student_code.read("x", tmp_path / "hw2.py", "hw2", names)
    assert list(work.texts) == names[:4]
    assert "recover has more than 30,000 characters, or" in work.notes[0]


def calls_of(act):
    """Return the result of an action, and the number of function calls as its cost."""
    calls = []
    sys.setprofile(lambda frame, event, argument: calls.append(event) if "call" in event else None)
    try:
        made = act()
    finally:
        sys.setprofile(None)
    return made, len(calls)


def test_twice_as_many_changes_of_a_name_take_about_twice_as_long():
    def read(changes):
        cell = closure.Cell("a = []\n" + "a.append(a)\n" * changes + "def gsolve(): return a\n")
        return calls_of(
            lambda: closure.extract_sources([cell], ["gsolve"])[0]["gsolve"].count("append")
        )

    some, cost = read(400)
    more, larger = read(800)
    assert (some, more) == (400, 800) and larger < 2.5 * cost


def test_code_is_split_into_statements_as_python_parses_it():
    text = "µ = 'µ'; b = µ\r\nc = '\x0c' + b  # a form feed ends no line\rdef gsolve(): return c\n"
    sources, problems = closure.extract_sources([closure.Cell(text)], ["gsolve"])
    assert sources["gsolve"] == "µ = 'µ'\n\nb = µ\n\nc = '\x0c' + b\n\ndef gsolve(): return c\n"
    assert not problems


def test_names_and_sources_are_escaped_on_the_page(tmp_path):
    script = "<script>alert(1)</script>"
    mean = LOOPS.replace("k += 1", f"k += 1  # {script} \u202e\x1b[31m </pre></mark>", 1)
    page, table = written(
        tmp_path, {script: mean, '"><b onclick="x()">': mean, "=HYPERLINK(1)": mean}
    )
    names = tags(page)
    assert not {"script", "b onclick"} & {tag for tag, _ in names}
    assert not any(name.startswith("on") for _, attributes in names for name in attributes)
    assert "\u202e" not in page and "\x1b" not in page and page.count("&lt;/pre&gt;") == 6
    assert len(table) == 3 and sum(row["other"] == "'=HYPERLINK(1)" for row in table) == 2
    assert "default-src 'none'" in page


def test_the_page_states_its_threshold_its_caveats_and_the_texts_that_were_too_short(tmp_path):
    page, _ = written(tmp_path, {"a": LOOPS, "b": renamed(LOOPS), "c": GAUGE})
    words = re.sub(r"<[^>]+>|\s+", " ", page)
    assert "from 60 percent" in words and "no proof" in words and "talk to both" in words
    assert "Short functions coincide" in words
    words = re.sub(r" +", " ", words)
    assert "hat of 3 submissions: fewer than 100 tokens" in words
    assert "3 pairs compared, 1 of them" in words


def test_a_pair_can_be_opened_by_the_keyboard_and_shows_both_texts_with_marks(tmp_path):
    page, _ = written(tmp_path, {"a": LOOPS, "b": renamed(LOOPS)})
    names = [tag for tag, _ in tags(page)]
    assert names.count("summary") == names.count("details") == 1 and names.count("pre") == 10
    assert names.count("mark") > 50 and "lower = sum(" in page and "below = sum(" in page


def test_the_shown_pieces_join_to_the_whole_text():
    text = "a = 1\nb = 2  \n\nc = 3\n"
    parts = report.split_passages(text, np.array([[0, 14], [14, 20]]))
    assert "".join(part for part, _ in parts) == text
    assert [part for part, both in parts if both] == ["a = 1\nb = 2", "\nc = 3"]
    long = "x = 1\n" * 5_000 + "y = 2\n" * 5_000
    shown = report.split_passages(long, np.array([[30_000], [60_000]]))
    assert shown[0] == (("y = 2\n" * 5_000)[: report.MAX_SHOWN_CHARACTERS].rstrip(), True)


def test_the_same_class_gives_the_same_bytes_whatever_seed_python_hashes_with(tmp_path):
    names = ("loops", "gauge", "float32")
    program = (
        "import sys; from pathlib import Path; from hdrlab.course import plan\n"
        "from hdrlab.course.similarity import report\n"
        "from hdrlab.course.submissions.class_folder import Submission\n"
        "out, *files = map(Path, sys.argv[1:]); out.mkdir()\n"
        "handins = {f'{k}{n}': Submission('', (), f, None, '') for k in 'ba' for n, f in enumerate(files)}\n"
        "list(report.write_steps(out, plan.read().homeworks['hw2'], handins))\n"
    )
    files = [str(path) for path in MADE_APART if path.stem in {f"hw2_{name}" for name in names}]
    reports = []
    for seed in ("1", "2"):
        out = tmp_path / seed
        subprocess.run(
            [sys.executable, "-c", program, str(out), *files],
            check=True,
            env=os.environ
            | {"PYTHONHASHSEED": seed, "PYTHONPATH": str(Path(report.__file__).parents[2])},
        )
        reports.append([(out / name).read_bytes() for name in ("similar.html", "similar.csv")])
    assert reports[0] == reports[1] and b"a0" in reports[0][0]


@pytest.mark.skipif(os.name != "posix", reason="only here has a file an owner's mode")
def test_page_and_table_are_readable_by_their_owner_only(tmp_path):
    written(tmp_path, {"a": LOOPS})
    for name in ("similar.html", "similar.csv"):
        assert stat.S_IMODE((tmp_path / name).stat().st_mode) == 0o600


def test_submitted_code_is_never_run(tmp_path):
    mark = tmp_path / "ran"
    evil = f"open({str(mark)!r}, 'w')\n" + LOOPS + f"\nclass A:\n    open({str(mark)!r}, 'w')\n"
    written(tmp_path, {"a": evil, "b": evil})
    assert not mark.exists()


def test_an_empty_class_and_unrelated_submissions_make_a_page(tmp_path):
    page, table = written(tmp_path, {})
    assert "<details>" not in page and not table
    assert (
        comparison.compare([comparison.FingerprintedCode(TeamCode("a", {}), {})]).counts.sum() == 0
    )


def compared(folder, capsys):
    """Return the output of the command for a class of two."""
    (folder / "a.py").write_text(LOOPS)
    handins = {team: Submission(team, (team,), folder / "a.py", NOW, "digest") for team in "ab"}
    course = classroom.GradingContext(Roster(()), HW2, GradingOptions())
    scan = SubmissionScan(handins, (), {})
    commands._compare(folder, commands.GradedClass(course, scan, [], None, None))
    return capsys.readouterr().err


def test_grading_a_class_compares_it(tmp_path, capsys):
    compared(tmp_path, capsys)
    assert "b</b>: 100 percent" in (tmp_path / "similar.html").read_text()


def test_a_class_that_is_too_large_is_reported_and_not_compared(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(report, "MAX_SUBMISSIONS", 1)
    assert "at most 1 " in compared(tmp_path, capsys)
    assert not (tmp_path / "similar.html").exists()


def test_without_copydetect_a_line_says_what_to_install(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "copydetect", None)
    for name in ("report", "comparison"):
        monkeypatch.delitem(sys.modules, f"hdrlab.course.similarity.{name}")
        monkeypatch.delattr(f"hdrlab.course.similarity.{name}")
    output = compared(tmp_path, capsys)
    assert 'similar.html needs copydetect: pip install "hdrlab[class]"' in output
    assert not (tmp_path / "similar.html").exists()
