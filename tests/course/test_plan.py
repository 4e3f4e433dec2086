"""A course plan that an instructor writes: accepted values, limits and defaults."""

import stat

import pytest

from hdrlab.course import plan
from hdrlab.course.grading import grader
from hdrlab.course.plan import GradingOptions, Homework, Late, ManualTask, Task
from hdrlab.response.debevec import gsolve

TASK = 'id = "gsolve", function = "response.debevec.gsolve"'


@pytest.fixture
def read(tmp_path):
    """read(...) -> the plan of a homework with these lines and tasks, and any text before it."""

    def read(lines="", tasks=f"{{ {TASK}, points = 7.5 }}", before="", due="2026-10-01T12:00:00Z"):
        text = f'{before}\n[hw9]\ntitle = "Curves"\ndue = {due}\n{lines}\ntasks = [{tasks}]\n'
        (tmp_path / "plan.toml").write_text(text, encoding="utf8")
        return plan.read(tmp_path / "plan.toml")

    return read


def test_grading_is_strict_and_lateness_costs_nothing_by_default():
    assert GradingOptions().tier == "strict"
    assert Late() == (0, 0.0)


def test_a_task_is_named_after_its_function_and_an_own_task_has_a_file(tmp_path):
    library = Task("a", "response.debevec.gsolve", 1)
    own = Task("a", f"{tmp_path}/v.1.py:vignette", 1)
    assert (library.name, library.own) == ("gsolve", None)
    assert (own.name, own.own) == ("vignette", tmp_path / "v.1.py")
    assert Task("a", "plain", 1).name == "plain"


@pytest.mark.parametrize(("at_most", "points"), [(None, 12), (20.0, 12), (12.0, 12), (7.0, 7)])
def test_a_homework_is_worth_the_sum_of_its_tasks_up_to_its_maximum(at_most, points):
    tasks = (Task("a", "b.a", 5.0), Task("c", "b.c", 7.0))
    assert Homework("hw", "", None, tasks, (ManualTask("x", 3.0),), at_most).points == points


def test_one_line_of_a_plan_varies_all_tasks_that_have_variants(tmp_path):
    text = plan.PLAN.read_text("utf8")
    path = tmp_path / "plan.toml"
    path.write_text(f"vary_all_tasks = true\n{text}", "utf8")
    tasks = [task for homework in plan.read(path).homeworks.values() for task in homework.tasks]
    for task in tasks:
        assert task.parameters == tuple(plan.rewording.parameters(task.id))
    varied = [task for task in tasks if task.parameters]
    most = sorted(tasks, key=lambda task: -task.points)[:5]
    assert len(varied) >= 12 and set(most) <= set(varied)
    path.write_text(f"vary_all_tasks = 1\n{text}", "utf8")
    with pytest.raises(ValueError, match="vary_all_tasks"):
        plan.read(path)


def test_a_solution_comes_from_the_library_a_variant_or_the_own_task(tmp_path):
    assert plan.function(Task("gsolve", "response.debevec.gsolve", 1)) is gsolve
    (tmp_path / "v.py").write_text("def vignette():\n    return 7\n", encoding="utf8")
    assert plan.function(Task("v", f"{tmp_path}/v.py:vignette", 1))() == 7
    task = Task("exclusion", "align.mtb.exclusion", 1, variant="compared/above/six")
    assert plan.function(task).__module__ == "exclusion"


def test_a_task_says_what_everybody_is_to_write_and_its_parameters(read):
    homework_read = read(tasks=f"{{ {TASK}, points = 2, minimum = true }}").homeworks["hw9"]
    assert homework_read.tasks == (Task("gsolve", "response.debevec.gsolve", 2.0, True),)
    assert (
        not read(tasks=f"{{ {TASK}, points = 2, minimum = 1 }}").homeworks["hw9"].tasks[0].minimum
    )
    shift = 'id = "shift", function = "align.mtb.shift", points = 1'
    names = list(plan.rewording.parameters("shift"))
    for some in ([], names[:1], names):
        task = read(tasks=f"{{ {shift}, parameters = {some} }}").homeworks["hw9"].tasks[0]
        assert task.parameters == tuple(some)
    with pytest.raises(ValueError, match=rf"parameters of shift out of {', '.join(names)}"):
        read(tasks=f"{{ {shift}, parameters = ['other'] }}")
    with pytest.raises(ValueError, match="parameters of gsolve out of exposures, lambda, weights"):
        read(tasks=f"{{ {TASK}, points = 1, parameters = ['other'] }}")


@pytest.mark.parametrize(
    ("function", "taken"),
    [
        ("v.py:vignette", True),
        ("v.py:", False),
        ("v.txt:vignette", False),
        ("folder/v.py:vignette", False),
        ("../v.py:vignette", False),
    ],
)
def test_an_own_function_must_be_in_a_file_next_to_the_plan(function, taken, read, tmp_path):
    tasks = f'{{ id = "shift", function = "{function}", points = 1 }}'
    if taken:
        assert read(tasks=tasks).homeworks["hw9"].tasks[0].own == tmp_path / "v.py"
        with pytest.raises(ValueError, match="out of none"):
            read(tasks=tasks.replace("points", "parameters = ['cut'], points"))
    else:
        with pytest.raises(ValueError, match="function of hdrlab, or FILE.py:NAME .*plan"):
            read(tasks=tasks)


@pytest.mark.parametrize(
    ("points", "by_hand", "message"),
    [
        ("0", "", ""),
        ("0.5", "0", ""),
        ("-0.5", "", "of 0 points or more each"),
        ("1", "-1", "of 0 points or more each"),
        ("inf", "", "of 0 points or more each"),
        ("nan", "", "of 0 points or more each"),
        ("1", "inf", "of 0 points or more each"),
    ],
)
def test_points_are_not_negative_and_not_all_zero(points, by_hand, message, read):
    lines = (
        f"by_hand = [{{ title = 'T', points = {by_hand}, rubric = ['a', 1] }}]" if by_hand else ""
    )
    if message:
        with pytest.raises(ValueError, match=message):
            read(lines, f"{{ {TASK}, points = {points} }}")
    else:
        homework_read = read(lines, f"{{ {TASK}, points = {points} }}").homeworks["hw9"]
        assert homework_read.points == float(points)
        assert homework_read.by_hand == ((ManualTask("T", 0.0, ("a", "1")),) if by_hand else ())


@pytest.mark.parametrize(
    ("at_most", "taken"), [(7.5, True), (0.1, True), (10.5, True), (10.6, False), (0, False)]
)
def test_the_maximum_of_a_homework_lies_between_zero_and_all_points(at_most, taken, read):
    lines = f"at_most = {at_most}\nby_hand = [{{ title = 'T', points = 3 }}]"
    if taken:
        assert read(lines).homeworks["hw9"].at_most == at_most
    else:
        with pytest.raises(ValueError, match=f"above 0 and at most 10.5.*{at_most:g}"):
            read(lines)
    assert read().homeworks["hw9"].at_most is None


@pytest.mark.parametrize(
    ("free", "a_day", "taken"),
    [
        (0, 0, True),
        (0, 1.5, True),
        (3, 0, True),
        (-1, 1, False),
        (1, -0.1, False),
        (-1, -1, False),
        ("'a'", 1, False),
    ],
)
def test_late_rules_are_not_negative(free, a_day, taken, read):
    late = f"[late]\nfree_days = {free}\npoints_a_day = {a_day}"
    if taken:
        assert read(before=late).late == (free, a_day)
    else:
        with pytest.raises(
            ValueError, match=r"free_days and points_a_day, at least 0, in \[late\]"
        ):
            read(before=late)


@pytest.mark.parametrize("due", ["2026-10-01T12:00:00", "2026-10-01", "7", "12:00:00"])
def test_a_due_date_has_a_time_and_a_zone(due, read):
    assert read().homeworks["hw9"].due.isoformat() == "2026-10-01T12:00:00+00:00"
    with pytest.raises(ValueError, match=r"\[hw9\]: expected due as a date with time and zone"):
        read(due=due)


def test_a_task_occurs_in_one_homework_only_and_is_found_by_its_id(read):
    plan_read = read()
    assert plan_read.task("gsolve").points == 7.5
    with pytest.raises(KeyError, match="task out of gsolve.*'merge'"):
        plan_read.task("merge")
    with pytest.raises(ValueError, match="gsolve"):
        read(tasks=f"{{ {TASK}, points = 1 }}, {{ {TASK}, points = 2 }}")
    with pytest.raises(ValueError, match="expected tasks"):
        read("by_hand = [{ title = 'T', points = 1 }]", tasks="")


def test_an_own_task_needs_a_file_of_checks_next_to_it(
    tmp_path,
):
    own = Homework("hw2", "", None, (Task("vignette", f"{tmp_path / 'v.py'}:vignette", 1.0),))
    with pytest.raises(ValueError, match=f"checks for hw2 in {tmp_path}.*none"):
        grader.files_of(own, None)
    (tmp_path / "test_vignette.py").touch()
    assert grader.files_of(own, None) == [tmp_path / "test_vignette.py"]


def test_a_secret_is_created_once_and_readable_by_its_owner_only(tmp_path):
    file = tmp_path / "secret"
    secret, made = plan.read_secret(file)
    assert made and len(secret) == 43 and file.read_text("utf8") == secret + "\n"
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    assert plan.read_secret(file) == (secret, False)
    file.write_text(" \n", encoding="utf8")
    with pytest.raises(ValueError, match="secret file is empty"):
        plan.read_secret(file)
    file.unlink()
    assert plan.read_secret(file)[0] != secret
    (tmp_path / "link").symlink_to(tmp_path / "planted")
    with pytest.raises(FileExistsError):
        plan.read_secret(tmp_path / "link")


def test_the_seed_of_a_student_and_task_never_changes():
    assert f"{plan.seed('salt', 'ada', 'gsolve'):064x}" == (
        "232f8d0106ce80bf45e6f941f8f86093a4e05652921d8288ce0ef3e1260b2131"
    )
