"""A class with attackers is graded completely: attackers get no points, and the others what they earned.

The attacks of tests/attacks on the grader, its results and their readers are submitted as files. The
grader reads and checks them with pytest, writes the results, and makes the reports.
"""

import json

import pytest
from support import attack_fixtures

from hdrlab.course import plan
from hdrlab.course.grading import grader, results
from hdrlab.course.reports import feedback
from hdrlab.course.sandbox import tiers

pytestmark = pytest.mark.grading

HONEST = (
    "import numpy as np\n\ndef hat(n):\n    z = np.arange(n)\n    return np.minimum(z, n - 1 - z)\n"
)
# at the grader's process, its files, its output, its patience, its channel, and its readers
AIMED = (
    *("a03_patched_tools", "a04_patched_grader", "a07_results", "a09_exit", "a10_forged_lines"),
    *("a12_endless_import", "a16_floods", "a20_scripts", "a26_truncated"),
)


def test_a_class_with_attackers_is_graded_to_the_end(tmp_path):
    homework = plan.read().homeworks["hw2"]
    homework = homework._replace(tasks=tuple(task for task in homework.tasks if task.id == "hat"))
    place = attack_fixtures.fill_folder(tmp_path)
    sources = {"anna": HONEST}
    for name in AIMED:
        sources[name] = attack_fixtures.prepare_attack(name, place, 9).replace(
            "def double(x)", "def hat(x)"
        )
    sources["zoe"] = HONEST
    for student, source in sources.items():
        (place / f"{student}.py").write_text(source)
    files = attack_fixtures.list_file_sizes(place)
    messages = {}
    for student in sources:
        conditions = plan.GradingOptions("strict", student, "a secret", timeout=3.0, draw=False)
        try:
            messages[student] = grader.grade(place / f"{student}.py", homework, conditions)
        except tiers.Unavailable as reason:
            pytest.skip(str(reason))
    assert attack_fixtures.list_file_sizes(place) == files
    assert {
        student for student, result in messages.items() if result.score == result.max_score
    } == {
        "anna",
        "zoe",
    }
    assert {messages[name].score for name in AIMED} == {0.0}
    for result in messages.values():
        read = results.from_json(results.to_json(result))
        assert read.score == result.score
        assert json.loads(results.to_json(result))["tier"] == "strict"
        page = feedback.page(result, private=True)
        assert "<script>alert" not in page and "<svg onload" not in page and "\x1b" not in page
    # the name is shown as text
    assert "alert(1)" in feedback.page(messages["a20_scripts"], private=True)
