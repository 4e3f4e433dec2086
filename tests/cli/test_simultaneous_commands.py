"""Two processes that write to one folder at the same time lose nothing, and leave no half-written file.

Either both succeed, or one of them is refused with a line that names the folder.
"""

import json
import shutil
import subprocess
import sys
from contextlib import closing
from importlib.util import find_spec
from pathlib import Path

import pytest
from support import interrupted_commands, one_task_homework, small_gallery

from hdrlab.course.gallery import ballots, store

TESTS = Path(__file__).parents[1]
INIT = "gallery init g --closes 2099-01-01T00:00+00:00"
GRADE = (
    "grade class --homework hw2 --tier practice --plan plan.toml --roster roster.csv --jobs 1 "
    "-o results"
)
# Each of the voters enters the gallery, and votes for the images of two teams.
VOTE = """
import asyncio, json, sys
sys.path.insert(0, sys.argv[1])
from pathlib import Path
from support import small_gallery as small
from hdrlab.course.gallery.web import app
origin = {"origin": small.ADDRESS}
pages = app.Gallery(Path(sys.argv[2]), small.ADDRESS, small.Clock())
application = app.application(pages)
print("ready", flush=True)
sys.stdin.readline()
for token, marks in json.loads(sys.argv[3]):
    browser = small.Browser(application)
    browser.post(f"/enter/{token}", headers=origin)
    key = small.form_key(browser.get("/").text)
    assert browser.post("/ballot", {"key": key, "mark": marks}, headers=origin).status == 303
asyncio.run(pages.close())
"""


def run_twice(words, folder):
    """Run a command in two processes at the same time, and return their exit codes and last lines."""
    processes = [
        subprocess.Popen(
            [sys.executable, "-m", "hdrlab", *words.split()],
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        for _ in range(2)
    ]
    errors = [process.communicate()[1] for process in processes]
    assert not [error for error in errors if "Traceback" in error]
    return [
        (process.returncode, (error.strip().splitlines() or [""])[-1])
        for process, error in zip(processes, errors, strict=True)
    ]


def check_refused_in_a_line(ended, named):
    """Check that the commands that did not succeed name the folder in one line."""
    assert any(code == 0 for code, _ in ended), ended
    for code, line in ended:
        if code != 0:
            assert code == 2, ended
            assert line.startswith("hdrlab: ")
            assert named in line


def check_no_temporary_file(folder):
    """Check that no unfinished file is left."""
    assert not [path for path in folder.rglob(".hdrlab-*") if ".lock" not in path.name]


@pytest.mark.grading
def test_of_two_processes_that_make_a_gallery_one_is_refused(tmp_path):
    ended = run_twice(INIT, tmp_path)
    check_refused_in_a_line(ended, "g")
    assert sorted(code for code, _ in ended) == [0, 2]
    with closing(store.connect(tmp_path / "g")) as db:
        assert store.settings(db).is_open(0)
    check_no_temporary_file(tmp_path)


@pytest.mark.grading
def test_two_processes_that_add_the_same_images_add_each_image_once(tmp_path):
    for seed, team in enumerate(("team1", "team2")):
        small_gallery.write_photo(tmp_path / f"{team}.png", seed)
    roster = "student,name,team\nann,Ann,team1\nben,Ben,team2\n"
    (tmp_path / "roster.csv").write_text(roster)
    subprocess.run([sys.executable, "-m", "hdrlab", *INIT.split()], cwd=tmp_path, check=True)
    ended = run_twice("gallery add g --roster roster.csv team1.png team2.png", tmp_path)
    assert [code for code, _ in ended] == [0, 0], ended
    with closing(store.connect(tmp_path / "g")) as db:
        artifacts = store.artifacts(db).values()
        assert sorted(artifact.team for artifact in artifacts) == ["team1", "team2"]
    check_no_temporary_file(tmp_path)


@pytest.mark.grading
@pytest.mark.skipif(
    any(find_spec(name) is None for name in ("starlette", "uvicorn")),
    reason='the gallery needs pip install ".[class]"',
)
def test_two_servers_of_one_gallery_lose_no_ballot(tmp_path):
    gallery = small_gallery.make_gallery(tmp_path, {f"t{k}": (f"s{k}",) for k in range(12)})
    students = sorted(gallery.links)
    expected = {}
    for k, student in enumerate(students):
        own = f"t{student[1:]}"
        teams = [team for team in sorted(gallery.artifacts) if team != own]
        expected[student] = {gallery.artifacts[teams[k % 11]], gallery.artifacts[teams[k % 11 - 1]]}
    servers = []
    for half in (students[::2], students[1::2]):
        votes = [(gallery.links[student], sorted(expected[student])) for student in half]
        words = [sys.executable, "-c", VOTE, str(TESTS), str(gallery.folder), json.dumps(votes)]
        pipe = subprocess.PIPE
        servers.append(subprocess.Popen(words, stdin=pipe, stdout=pipe, text=True))
    for server in servers:
        assert server.stdout.readline() == "ready\n"
    for server in servers:
        server.stdin.write("go\n")
        server.stdin.flush()
    for server in servers:
        server.communicate()
    assert [server.returncode for server in servers] == [0, 0]
    with closing(store.connect(gallery.folder)) as db:
        assert {who: set(chosen) for who, chosen in ballots.every(db).items()} == expected


@pytest.mark.grading
def test_two_graders_of_a_class_leave_the_results_of_one(tmp_path):
    (tmp_path / "class").mkdir()
    (tmp_path / "plan.toml").write_text(one_task_homework.PLAN)
    (tmp_path / "class/ann.py").write_text(one_task_homework.CORRECT_CODE)
    (tmp_path / "class/ben.py").write_text("def hat(n=256):\n    return 1\n")
    (tmp_path / "roster.csv").write_text("student,name\nann,Ann\nben,Ben\n")
    check_refused_in_a_line(run_twice(GRADE, tmp_path), "results")
    together = interrupted_commands.read_folder(tmp_path / "results")
    check_no_temporary_file(tmp_path)
    shutil.rmtree(tmp_path / "results")
    subprocess.run([sys.executable, "-m", "hdrlab", *GRADE.split()], cwd=tmp_path, check=True)
    assert together == interrupted_commands.read_folder(tmp_path / "results")
