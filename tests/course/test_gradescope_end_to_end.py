"""Gradescope's autograder from start to end, on a copy of this machine without hdrlab.

The copy is laid out as Gradescope documents it [gradescope-autograders.readthedocs.io, Autograder
Specifications and Submission Metadata]. It is an overlay of this machine's file system, in which
only Debian's own programs are left. setup.sh installs everything there, and all of it is gone when
the test ends.
"""

import json
import os
import shlex
import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest

from hdrlab.course import plan
from hdrlab.course.authoring.export import gradescope

pytestmark = pytest.mark.grading

CLEAN_PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
HIDDEN_FOLDERS = ("/usr/local", "/root", "/home", "/srv", "/mnt", "/tmp")
# variables that tell pip and apt how this machine reaches their packages
NETWORK_VARIABLES = ("PIP_", "SSL_", "REQUESTS_CA", "http_proxy", "https_proxy", "no_proxy")
PLAN = """
[hw2]
title = "The response curve"
due = 2026-10-23T23:59:00Z
tasks = [
  { id = "hat", function = "core.weights.hat", points = 10 },
  { id = "irradiance", function = "response.robertson.irradiance", points = 10 },
]
"""
HAT = """import numpy as np

def hat(n=256):
    z = np.arange(n)
    return np.minimum(z, n - 1 - z) / ((n - 1) // 2)
"""
IRRADIANCE = """
# %%
def irradiance(Z, t, f, w):
    weights = w[Z]
    top = (weights * f[Z] * t).sum(1)
    bottom = (weights * t**2).sum(1)
    return np.divide(top, bottom, out=np.full(len(Z), np.nan), where=bottom > 0)
"""
FORGOTTEN_TIMES = """
# %%
def irradiance(Z, t, f, w):
    return (w[Z] * f[Z]).sum(1) / w[Z].sum(1)
"""
CRASHING = """import numpy as np, os

def hat(n=256):
    os.abort()

# %%
def irradiance(Z, t, f, w):
    raise RuntimeError("irradiance is not finished")
"""
# Each function tries to read the course's secret and to write its own result.
HOSTILE = """import json, os, signal, subprocess, sys

SECRET = "unread"
for place in ("/autograder/source/settings.json", "/autograder/submission_metadata.json"):
    try:
        SECRET = open(place).read()
    except OSError:
        pass
for place in ("/autograder/results/results.json", "/autograder/results/planted", "/tmp/planted"):
    try:
        open(place, "w").write(json.dumps({"score": 20}))
    except OSError:
        pass

def hat(n=256):
    print("PASS", SECRET)
    for pid in os.listdir("/proc") if os.path.isdir("/proc") else ():
        if pid.isdigit():
            try:
                os.kill(int(pid), signal.SIGKILL)
            except OSError:
                pass
    raise ValueError(SECRET)

# %%
def irradiance(Z, t, f, w):
    while True:
        pass
"""
SUBMISSIONS = {
    "right": HAT + IRRADIANCE,
    "half": HAT + FORGOTTEN_TIMES,
    "crashing": CRASHING,
    "hostile": HOSTILE,
}
# As documented, with an extension for the second student of a group.
METADATA = {
    "id": 123456,
    "created_at": "2026-10-26T10:00:00.365935-07:00",
    "assignment": {
        "due_date": "2026-10-23T23:59:00.000000-07:00",
        "group_size": 2,
        "group_submission": True,
        "id": 25828,
        "course_id": 1234,
        "late_due_date": None,
        "release_date": "2026-10-02T00:00:00.000000-07:00",
        "title": "The response curve",
        "total_points": "20.0",
    },
    "submission_method": "upload",
    "users": [
        {"email": "ada@example.org", "id": 1, "name": "Ada Lovelace"},
        {
            "email": "bo@example.org",
            "id": 2,
            "name": "Bo Diddley",
            "assignment": {"due_date": "2026-10-24T23:59:00.000000-07:00"},
        },
    ],
    "previous_submissions": [],
}
# Gradescope extracts the zip into source, copies run_autograder, and runs it in /autograder.
SCRIPT = """
set -eu
machine=$(mktemp -d)
mount -t tmpfs -o size=4g tmpfs "$machine"
mkdir "$machine/changes" "$machine/work" "$machine/root"
mount -t overlay overlay -o "lowerdir=/,upperdir=$machine/changes,workdir=$machine/work" "$machine/root"
root=$machine/root
mount -t proc proc "$root/proc"
mount --rbind /dev "$root/dev"
mkdir -p "$root/autograder"
cp -r "$shared/." "$root/autograder/"
for folder in $hidden; do mount -t tmpfs tmpfs "$root$folder"; done
chmod 1777 "$root/tmp"
inside() { chroot "$root" /usr/bin/env -i $variables "$@"; }
cp "$root/autograder/source/run_autograder" "$root/autograder/"
if ! inside bash -e /autograder/source/setup.sh >"$shared/setup.log" 2>&1; then exit 3; fi
for name in $submissions; do
  rm -rf "$root/autograder/submission" "$root/autograder/results"
  mkdir "$root/autograder/submission" "$root/autograder/results"
  cp "$shared/handed_in/$name.py" "$root/autograder/submission/hw2.py"
  inside bash -c "cd /autograder && ./run_autograder" >"$shared/$name.stdout" 2>&1
  cp -r "$root/autograder/results" "$shared/$name"
  ls "$root/tmp" >"$shared/$name.tmp"
done
inside bash -c "cd /autograder && ulimit -v 20000 && ./run_autograder" >/dev/null 2>&1 || true
cp -r "$root/autograder/results" "$shared/memory"
"""


def can_overlay():
    """Return whether this user may mount an overlay file system."""
    if not shutil.which("unshare") or os.geteuid() != 0:
        return False
    probe = (
        "set -e; mount -t tmpfs tmpfs /mnt; mkdir /mnt/a /mnt/b /mnt/c; "
        "mount -t overlay overlay -o lowerdir=/,upperdir=/mnt/a,workdir=/mnt/b /mnt/c"
    )
    ran = subprocess.run(["unshare", "--mount", "bash", "-c", probe], capture_output=True)
    return ran.returncode == 0


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    """Return the folder with the autograder's output for each submission."""
    if not can_overlay():
        pytest.skip("needs root, and a kernel that overlays file systems")
    if not shutil.which("apt-get"):
        pytest.skip("setup.sh needs apt-get, as on Gradescope's images")
    shared = tmp_path_factory.mktemp("gradescope")
    own = shared / "plan.toml"
    own.write_text(PLAN)
    (archive,) = gradescope.export(plan.read(own), shared, plan_file=own, secret="the salt")
    with zipfile.ZipFile(archive) as opened:
        for entry in opened.infolist():
            extracted = Path(opened.extract(entry, shared / "source"))
            extracted.chmod(entry.external_attr >> 16)
    (shared / "submission_metadata.json").write_text(json.dumps(METADATA))
    (shared / "handed_in").mkdir()
    for name, text in SUBMISSIONS.items():
        (shared / "handed_in" / f"{name}.py").write_text(text)
    network = {
        name: value for name, value in os.environ.items() if name.startswith(NETWORK_VARIABLES)
    }
    variables = {"PATH": CLEAN_PATH, **network}
    settings = {
        "shared": str(shared),
        "hidden": " ".join(folder for folder in HIDDEN_FOLDERS if Path(folder).is_dir()),
        "variables": shlex.join(f"{name}={value}" for name, value in variables.items()),
        "submissions": " ".join(SUBMISSIONS),
    }
    command = ["unshare", "--mount", "--pid", "--fork", "--kill-child", "bash", "-c", SCRIPT]
    ran = subprocess.run(
        command, env={**os.environ, **settings}, capture_output=True, text=True, timeout=900
    )
    log = shared / "setup.log"
    log_text = log.read_text() if log.is_file() else ""
    assert ran.returncode == 0, log_text[-3000:] + ran.stderr
    return shared


def results(graded, name):
    return json.loads((graded / name / "results.json").read_text())


def points(report, task):
    return sum(test["score"] for test in report["tests"] if test["name"].startswith(f"{task}:"))


def test_setup_installs_all_that_grading_needs_and_says_which_tiers_work(graded):
    log = (graded / "setup.log").read_text()
    assert any(line.split()[:2] == ["container", "yes"] for line in log.splitlines()), log


def test_a_right_submission_gets_all_points_for_credit(graded):
    report = results(graded, "right")
    assert report["score"] == 20
    assert {test["status"] for test in report["tests"]} == {"passed"}
    assert "credit" not in report["output"]


def test_a_half_right_submission_loses_points_in_the_wrong_task_alone_and_reads_why(graded):
    report = results(graded, "half")
    assert points(report, "hat") == 10
    assert 0 < points(report, "irradiance") < 10
    failed = [test for test in report["tests"] if test["status"] == "failed"]
    assert failed and all(test["output"] for test in failed)


def test_a_crashing_submission_gets_no_points_and_reads_its_own_error(graded):
    report = results(graded, "crashing")
    assert report["score"] == 0
    outputs = " ".join(test["output"] for test in report["tests"])
    assert "irradiance is not finished" in outputs


def test_a_hostile_submission_reads_no_secret_and_writes_no_result(graded):
    report = results(graded, "hostile")
    assert report["score"] == 0
    assert os.listdir(graded / "hostile") == ["results.json"]
    assert "planted" not in (graded / "hostile.tmp").read_text()
    written = json.dumps(report) + (graded / "hostile.stdout").read_text()
    assert "the salt" not in written and "ada@example.org" not in written


def test_students_read_how_late_the_group_is_after_its_extension(graded):
    assert "Received 2 days after the due date" in results(graded, "right")["output"]


def test_an_autograder_without_memory_still_reports_the_problem(graded):
    report = results(graded, "memory")
    assert report["score"] == 0 and "memory" in report["output"]


@pytest.mark.parametrize("name", [*SUBMISSIONS, "memory"])
def test_results_have_only_documented_fields_with_documented_values(graded, name):
    report = results(graded, name)
    top = {
        "score": (int, float),
        "execution_time": (int, float),
        "output": str,
        "output_format": str,
        "test_output_format": str,
        "test_name_format": str,
        "visibility": str,
        "stdout_visibility": str,
        "extra_data": dict,
        "tests": list,
        "leaderboard": list,
    }
    of_test = {
        "score": (int, float),
        "max_score": (int, float),
        "status": str,
        "name": str,
        "name_format": str,
        "number": str,
        "output": str,
        "output_format": str,
        "tags": list,
        "visibility": str,
        "extra_data": dict,
    }
    words = {
        "output_format": {"text", "html", "simple_format", "md", "ansi"},
        "status": {"passed", "failed"},
        "visibility": {"hidden", "after_due_date", "after_published", "visible"},
        "stdout_visibility": {"hidden", "after_due_date", "after_published", "visible"},
    }
    for record, kinds in [(report, top), *((test, of_test) for test in report.get("tests", []))]:
        for field, value in record.items():
            assert isinstance(value, kinds[field])
            assert value in words.get(field, [value])
    assert "score" in report
