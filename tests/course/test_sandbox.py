"""The sandbox in all tiers: equal answers, isolation as documented, and an error if it cannot isolate."""

import contextlib
import ctypes
import itertools
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import sysconfig
import tempfile
import textwrap
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

if sys.platform != "linux":  # test_windows goes the way of other systems
    pytest.skip("the walls of the sandboxes are those of Linux", allow_module_level=True)

from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.grading import doctor
from hdrlab.course.sandbox import contents, filters, practice, session, strict, tiers, users
from hdrlab.course.sandbox.inside import channel, system
from hdrlab.course.source_code.names import imported_numpy_modules

IMPOLITE = "import sys; sys.modules['worker'].FORBIDDEN_ACTIONS.clear()\n"
FUNCTIONS = """
import os, sys, time, warnings
from typing import NamedTuple
import numpy as np

class State(NamedTuple):
    s: object
    n: int

def scaled(x, k=2.0): return k * x
def steps(x):
    for n in range(3): yield State(x + n, n)
def both(x): return State(x, 1), b"bytes", None, "text", True
def nothing(x): pass
def loud(x):
    print("said"); warnings.warn("warned"); print("\\x1b[31mred", file=sys.stderr)
    return x
def loud_set(x):
    print("printed first")
    return {x}
def wrong(x):
    y = 1 / 0
def absent(x): import cv2
def leaves(x): os._exit(3)
def endless(x):
    while True: pass
def writes(x): open("here.txt", "w")
def forks(x): os.fork()
def hushed(x):
    with open(os.devnull, "w") as nowhere: print("x", file=nowhere)
    return x
def threaded(x):
    from concurrent.futures import ThreadPoolExecutor
    with ThreadPoolExecutor(4) as pool: return sum(pool.map(abs, range(10)))
def counted(x):
    np.count = getattr(np, "count", 0) + 1
    return np.count
def spoiled(x):
    x[...] = -1
    return x
def transformed(x):
    from scipy import fft, ndimage
    return ndimage.gaussian_filter(np.abs(fft.fft2(x, workers=2)), 1.0)
def drawn(x): return np.random.random(3)
def hashed(x): return hash("word")
"""
NAMES = re.findall(r"^def (\w+)", FUNCTIONS, re.MULTILINE)


def opened(tier, sources=None, timeout=30.0):
    """Return a Subject in a tier; skip the test if this machine cannot run the tier."""
    try:
        return Subject(sources or dict.fromkeys(NAMES, FUNCTIONS), tiers.choose(tier), timeout)
    except tiers.Unavailable as reason:
        pytest.skip(str(reason))


@pytest.fixture(scope="module", params=["strict", "container", "practice"])
def running_subject(request):
    with opened(request.param) as subject:
        try:
            subject.scaled(1.0)
        except tiers.Unavailable as reason:
            pytest.skip(str(reason))
        yield subject


@pytest.fixture
def subject(running_subject):
    """A new Subject in each tier."""
    running_subject.fresh()
    return running_subject


@pytest.fixture
def adopted():
    """Make orphaned processes children of this one, so that the test finds them."""
    libc = ctypes.CDLL(None)
    libc.prctl(36, 1, 0, 0, 0)
    yield
    libc.prctl(36, 0, 0, 0, 0)


def alone(source, tier, **others):
    """Return the answer of the function f of a source, in its own sandbox."""
    with opened(tier, {"f": source}, **others) as subject:
        return subject.f()


def test_answers_from_the_sandbox_are_plain_arrays(subject):
    x = np.arange(6.0).reshape(2, 3)
    np.testing.assert_array_equal(subject.scaled(x, k=3), 3 * x)
    states = subject.steps(x)
    assert [type(state) for state in states] == [tuple] * 3
    assert [int(n) for _, n in states] == [
        0,
        1,
        2,
    ]
    np.testing.assert_array_equal(states[2][0], x + 2)
    (array, tier), raw, none, text, truth = subject.both(x)
    assert raw == b"bytes" and none is None and text == "text" and truth == 1 and tier == 1
    assert subject.nothing(x) is None
    assert subject.transformed(np.ones((8, 8))).shape == (8, 8)
    assert subject.calls[0].task == "scaled" and subject.calls[0].kwargs == {"k": 3}


@pytest.mark.parametrize(
    ("task", "kind", "says"),
    [
        (
            "wrong",
            "raised",
            r"wrong raised ZeroDivisionError: division by zero \(line \d+: y = 1 / 0\)",
        ),
        (
            "absent",
            "raised",
            "No module named 'cv2' .numpy, scipy and Python's own modules are here",
        ),
        ("leaves", "died", "leaves ended its process, and gave no answer"),
        ("writes", "raised", "PermissionError: a function that is checked cannot write a file"),
        ("forks", "raised", "PermissionError: a function that is checked cannot start a process"),
    ],
)
def test_a_failed_call_has_a_plain_message_and_the_next_call_works(subject, task, kind, says):
    with pytest.raises(NoAnswer, match=says) as error:
        getattr(subject, task)(1.0)
    assert error.value.kind == kind
    assert subject.scaled(1.0) == 2.0


def test_a_call_that_takes_too_long_is_ended(running_subject):
    running_subject.fresh()
    running_subject._timeout, patience = 0.3, running_subject._timeout
    try:
        with pytest.raises(NoAnswer, match="endless took longer than 0.3 s"):
            running_subject.endless(1.0)
    finally:
        running_subject._timeout = patience
    assert running_subject.scaled(1.0) == 2.0


def test_no_state_survives_from_one_check_to_the_next(subject):
    assert [int(subject.counted(1.0)) for _ in range(2)] == [1, 2]
    subject.fresh()
    assert subject.counted(1.0) == 1 and len(subject.calls) == 1


def test_printed_text_and_warnings_are_recorded_without_control_codes(subject):
    subject.loud(1.0)
    assert "said\n" in subject.printed
    assert "UserWarning: warned" in subject.printed
    assert "red\n" in subject.printed
    assert "\x1b" not in subject.printed
    subject.fresh()
    assert subject.printed == ""


def test_printed_text_is_kept_if_the_answer_is_refused(subject):
    with pytest.raises(NoAnswer) as raised:
        subject.loud_set(1.0)
    assert raised.value.kind == "refused"
    assert "printed first" in subject.printed


def test_a_submission_cannot_change_the_graders_inputs(subject):
    x = np.ones(3)
    assert subject.spoiled(x).tolist() == [-1, -1, -1]
    assert x.tolist() == [1, 1, 1]


def test_threads_and_the_null_device_may_be_used(subject):
    assert subject.threaded(1.0) == 45
    assert subject.hushed(1.0) == 1


def test_grading_twice_gives_the_same(subject):
    first = subject.drawn(0).tolist(), int(subject.hashed(0))
    subject.fresh()
    assert first == (subject.drawn(0).tolist(), int(subject.hashed(0)))


def test_a_sandbox_that_was_killed_is_started_again(subject):
    subject.scaled(1.0)
    subject._session._launched.process.kill()
    subject._session._launched.process.wait()
    subject.fresh()
    assert subject.scaled(1.0) == 2.0


@pytest.mark.parametrize("tier", ["strict", "container"])
def test_the_sandbox_shows_only_the_files_that_computing_needs(tier):
    source = IMPOLITE + textwrap.dedent(
        """
        import ctypes, os, resource
        def tried(path):
            try: return sorted(os.listdir(path))
            except OSError: return None
        def f():
            libc = ctypes.CDLL(None)
            groups = os.getgroups()
            limits = [resource.getrlimit(getattr(resource, "RLIMIT_" + name)) for name in LIMITS]
            places = ["/", "/etc", "/home", "/root", "/tmp", "/work", "/proc", "/sys", "/dev", "/course"]
            calls = [libc.unshare(0x10000000), libc.setuid(0), libc.mount(b"a", b"/", b"tmpfs", 0, None)]
            calls += [libc.socket(1, 1, 0), libc.prctl(4, 1, 0, 0, 0), libc.chroot(b"/")]
            calls += [libc.memfd_create(b"a", 0), libc.execv(b"/bin/sh", None), libc.syscall(425, 1, None)]
            opened = [one for one in range(64) if libc.fcntl(one, 1) >= 0]
            return list(os.environ), groups, limits, [tried(place) for place in places], calls, len(opened)
        """
    ).replace("LIMITS", repr(list(session.LIMITS)))
    environment, groups, limits, places, calls, opened_files = alone(source, tier)
    assert set(environment) <= {*session.ENVIRONMENT, "LD_LIBRARY_PATH", "PYTHONHOME", "PWD"}
    assert [int(soft) for soft, _ in limits] == list(session.LIMITS.values())
    assert [int(hard) for _, hard in limits] == list(session.LIMITS.values())
    assert {int(answer) for answer in calls} == {-1}
    if tier == "strict":
        assert set(places[0]) <= {
            "course",
            "dev",
            "etc",
            "lib",
            "lib64",
            "packages",
            "python",
            "usr",
        }
        assert set(places[1] or ()) <= {"alternatives", "ld.so.cache"}
        assert places[2:8] == [None] * 6
        assert places[8:] == [["null"], sorted(contents.OWN_FILES)]
        assert opened_files == 4  # three that lead nowhere, and the link
    else:
        assert groups == [] and places == [None] * len(places)


@pytest.mark.grading
@pytest.mark.parametrize("tier", ["strict", "container"])
def test_the_sandbox_has_no_packages_except_numpy_and_scipy(tier):
    source = textwrap.dedent(
        """
        import os, sys
        def f():
            found = []
            for root, _, files in (one for path in ("/", *sys.path) for one in os.walk(path)):
                kept = [one for one in ("-packages", "hdrlab", "solutions", "/specification") if one in root]
                found += [name for name in files if kept and read(os.path.join(root, name))]
            return found, [name for name in ("numpy", "scipy.optimize", "hdrlab", "pytest") if can(name)]
        def read(path):
            try: return open(path, "rb").read(1)
            except OSError: return b""
        def can(name):
            try: __import__(name)
            except ImportError: return False
            return True
        """
    )
    assert alone(source, tier) == ([], ["numpy", "scipy.optimize"])


def test_other_files_beside_the_interpreters_modules_are_hidden(tmp_path):
    places = {"/python/lib": str(tmp_path), "/packages/numpy": str(tmp_path)}
    for name in ("python3.11/site-packages/cv2", "python3/dist-packages", "python3.11/json"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "python3.11" / "os.py").touch()
    hidden = contents._find_package_folders(places)
    assert hidden == ["/python/lib/python3.11/site-packages", "/python/lib/python3/dist-packages"]
    inside = contents.SandboxMounts(
        prefix="/usr",
        python="",
        places={"/python/lib": str(tmp_path)},
        hidden=tuple(hidden),
        packages={},
    )
    listed, read = inside.allowed_paths()
    assert {Path(path).name for path in listed} == {tmp_path.name, "python3.11", "python3"}
    assert {Path(path).name for path in read} == {"json", "os.py"}


@pytest.mark.parametrize("apart", [True, False])
def test_only_the_library_folders_of_this_processor_are_visible(apart, monkeypatch):
    whole = {"/lib", "/usr/lib"}
    own = {f"{folder}/riscv64-linux-gnu" for folder in whole}
    there = whole | own if apart else whole
    monkeypatch.setattr(os.path, "isdir", there.__contains__)
    monkeypatch.setattr(os.path, "exists", there.__contains__)
    monkeypatch.setattr(sysconfig, "get_config_var", lambda name: "riscv64-linux-gnu")
    assert set(contents._system_libraries()) == (own if apart else whole)


def test_without_fork_each_check_has_its_own_process():
    """As on Windows, except for the way in which the process gets its socket."""
    tier = replace(practice.sandbox(), can_fork=False)
    with Subject(dict.fromkeys(NAMES, FUNCTIONS), tier, 30) as subject:
        assert [int(subject.counted(1.0)) for _ in range(2)] == [1, 2]
        subject.fresh()
        assert subject.counted(1.0) == 1
        with pytest.raises(NoAnswer, match="ended its process"):
            subject.leaves(1.0)
        assert subject.scaled(1.0) == 2.0
        subject._timeout = 0.3
        with pytest.raises(NoAnswer, match="took longer"):
            subject.endless(1.0)
        subject._timeout = 30
        assert subject.scaled(1.0) == 2.0


def test_remembered_answers_have_a_limited_size():
    source = "import numpy as np\ndef f(n): return np.zeros(n)"
    with opened("practice", {"f": source}) as subject:
        for n in (1 << 19, 1 << 18, 1 << 19, 1):
            assert len(subject.f(n)) == n
        kept = [None if call.answer is None else len(call.answer) for call in subject.calls]
    assert kept == [1 << 19, 1 << 18, None, 1]


def test_an_unknown_tier_is_an_error():
    with pytest.raises(ValueError, match="strict, container, practice.*'none'"):
        tiers.choose("none")


@pytest.fixture
def without(monkeypatch):
    """without(name) -> forget everything that was cached about it."""
    strict.bubblewrap.cache_clear()
    filters.program.cache_clear()
    yield monkeypatch
    monkeypatch.undo()
    strict.bubblewrap.cache_clear()
    filters.program.cache_clear()


def test_without_bubblewrap_there_is_no_strict_tier(without):
    without.setattr(shutil, "which", lambda name: None)
    with pytest.raises(tiers.Unavailable, match="no bwrap .*path"):
        tiers.choose("strict")


def test_without_libseccomp_there_is_no_tier_for_credit(without):
    without.setitem(sys.modules, "pyseccomp", None)
    without.setattr(os, "geteuid", lambda: 0)
    for tier in ("strict", "container"):
        with pytest.raises(tiers.Unavailable, match="libseccomp|Landlock"):
            tiers.choose(tier)


def test_on_other_systems_there_is_no_tier_for_credit(without):
    without.setattr(sys, "platform", "darwin")
    for tier in ("strict", "container"):
        with pytest.raises(tiers.Unavailable, match="needs Linux, and this is darwin"):
            tiers.choose(tier)


def test_an_ordinary_user_has_no_container_tier(without):
    without.setattr(os, "geteuid", lambda: 1000)
    with pytest.raises(tiers.Unavailable, match="needs root"):
        tiers.choose("container")


@pytest.mark.parametrize(
    ("script", "says"),
    [
        ("echo usage", "needs bubblewrap 0.8 or later"),
        (
            "echo {options}; echo 'bwrap: setting up uid map: Permission denied' >&2; exit 1",
            "setting up uid map",
        ),
        ("echo {options}; exit 0", "did not start"),
    ],
)
def test_a_bubblewrap_that_does_not_work_is_an_error_that_says_why(without, script, says):
    opened("strict")
    with tempfile.TemporaryDirectory(dir="/var/tmp") as folder:  # where another user can read it
        os.chmod(folder, 0o755)
        fake = Path(folder) / "bwrap"
        fake.write_text("#!/bin/sh\n" + script.format(options=" ".join(strict.REQUIRED_OPTIONS)))
        fake.chmod(0o755)
        strict.bubblewrap.cache_clear()
        without.setattr(shutil, "which", lambda name: str(fake))
        with pytest.raises(tiers.Unavailable, match=says), strict_anyway() as subject:
            subject.scaled(1.0)


def strict_anyway():
    """Return a Subject of the strict tier, or raise."""
    return Subject({"scaled": FUNCTIONS}, tiers.choose("strict"))


def test_a_user_number_is_given_to_one_sandbox_at_a_time():
    if os.geteuid() != 0:
        pytest.skip("only root can become another user")
    first, first_lease = users.lease()
    second, second_lease = users.lease()
    with first_lease, second_lease:
        assert first != second and {first, second} <= set(users.SPARE_USERS)
    again, held = users.lease()
    held.close()
    assert again <= first


@pytest.mark.grading
def test_a_killed_grader_leaves_no_process_and_no_folder(adopted, tmp_path):
    """In all tiers, the process of the check and its supervisor end soon after the parent has died."""
    for tier in ("strict", "practice"):
        opened(tier)
        code = (
            "from hdrlab.course.checks.subject import Subject\n"
            "from hdrlab.course.sandbox import tiers\n"
            f"tier, source = tiers.choose({tier!r}), 'def f():\\n while True: pass'\n"
            "with Subject({'f': source}, tier, 60) as subject:\n"
            "    subject._session.start_check(); print('begun', flush=True); subject.f()\n"
        )
        before = system.list_children()
        folder = tmp_path / tier
        folder.mkdir()
        environment = os.environ | {"TMPDIR": str(folder)}
        grader = subprocess.Popen(
            [sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, env=environment
        )
        assert grader.stdout.readline() == "begun\n"
        time.sleep(0.2)
        grader.kill()
        grader.wait()
        grader.stdout.close()
        deadline = time.monotonic() + 300
        while set(system.list_children()) - set(before) and time.monotonic() < deadline:
            for pid in set(system.list_children()) - set(before):
                os.waitpid(pid, os.WNOHANG)
            time.sleep(0.02)
        assert not set(system.list_children()) - set(before)
        assert not list(folder.iterdir())


def test_root_and_an_ordinary_user_have_the_same_strict_tier():
    """Root also tries it as an ordinary user, with an interpreter that this user can read."""
    opened("strict")
    if os.geteuid() != 0:
        pytest.skip("this is an ordinary user: the other tests are the answer")
    code = (
        "from hdrlab.course.checks.subject import Subject\n"
        "from hdrlab.course.sandbox import tiers\n"
        "with Subject({'f': 'def f(x): return 2 * x'}, tiers.choose('strict'), 60) as s: print(s.f(21))\n"
    )
    user, held = users.lease()
    with held:
        command = "import sys, numpy, scipy, hdrlab.course.checks; print(sys.version_info[:2])"
        able = as_user(user, command) == f"{sys.version_info[:2]}\n"
        if not able:
            pytest.skip(
                "an ordinary user can read no interpreter of this version here, or not this installation"
            )
        assert as_user(user, code) == "42\n"


def as_user(user, code):
    """Return the output of the system's Python as another user, or its error."""
    paths = [
        Path(channel.__file__).parents[4],
        *{os.path.dirname(place) for place in session.package_folders().values()},
    ]
    process = subprocess.run(
        ["/usr/bin/env", "python3", "-B", "-c", code],
        env={
            "PYTHONPATH": ":".join(map(str, paths)),
            "PATH": os.defpath,
            "OPENBLAS_NUM_THREADS": "1",
        },
        user=user,
        group=user,
        extra_groups=[],
        cwd="/",
        capture_output=True,
        text=True,
    )
    return process.stdout or process.stderr


def test_the_practice_tier_lists_what_it_does_not_stop(tmp_path):
    """For each sentence, a function does what the sentence says, within its own folder."""
    (tmp_path / "solution.py").write_text("ANSWER = 42\n")
    (tmp_path / "yours.txt").write_text("yours")
    place = str(tmp_path)
    me = os.getpid()
    done = {
        "reading any file": f"open({place + '/solution.py'!r}).read().split()[-1]",
        "importing a package": f"sys.path.insert(0, {place!r}) or __import__('solution').ANSWER",
        "removing any file": f"os.remove({place + '/yours.txt'!r}) or 42",
        "using the network": "socket.socket(socket.AF_INET).fileno() > 0 and 42",
        "starting programs": f"os.kill({me}, 0) or subprocess.run(['true']).returncode or 42",
    }
    assert len(done) == len(practice.DOES_NOT_STOP)
    for sentence, (does, expression) in zip(practice.DOES_NOT_STOP, done.items(), strict=True):
        assert sentence.startswith(does)
        source = IMPOLITE + f"import os, socket, subprocess\ndef f(): return int({expression})"
        assert alone(source, "practice") == 42
    assert not (tmp_path / "yours.txt").exists()
    assert tiers.choose("practice").credit is False


def test_the_practice_tier_stops_mistakes(tmp_path, adopted):
    """Too much memory, an endless file, and processes that are left behind."""
    before = system.list_children()
    name = str(tmp_path / "written")
    with pytest.raises(NoAnswer, match="MemoryError"):
        alone("import numpy as np\ndef f(): return np.ones(1 << 34).sum()", "practice")
    with pytest.raises(NoAnswer, match="File too large"):
        alone(IMPOLITE + f"def f(): open({name!r}, 'wb').write(b'x' * 9999)", "practice")
    assert Path(name).stat().st_size == 0
    if sys.platform == "linux":  # elsewhere a process that leaves its group is not found
        daemon = (
            "import os, time\ndef f():\n if os.fork() == 0:\n  os.setsid()\n  if os.fork() == 0:\n"
            f"   time.sleep(0.5); os.remove({name!r})\n  os._exit(0)\n return 1"
        )
        assert alone(IMPOLITE + daemon, "practice") == 1
        time.sleep(0.7)
        assert Path(name).exists()
        assert system.list_children() == before


def test_the_doctor_reports_whether_each_tier_works_and_how_to_fix_it(without):
    findings = {finding.tier: finding for finding in doctor.examine_tiers()}
    assert list(findings) == ["strict", "container", "practice"]
    for tier, finding in findings.items():
        assert finding.credit == (tier != "practice")
        assert finding.details and (finding.works or finding.credit)
    assert all(sentence in findings["practice"].details for sentence in practice.DOES_NOT_STOP)
    strict.bubblewrap.cache_clear()
    without.setattr(shutil, "which", lambda name: None)
    assert not doctor.examine("strict").works
    assert "apt install bubblewrap" in doctor.examine("strict").remedy


def test_the_doctor_advises_to_install_only_what_is_missing():
    assert doctor.find_remedy("the strict tier needs bubblewrap").startswith("install bubblewrap")
    assert "install" not in doctor.find_remedy(
        "the strict sandbox did not start: bwrap: Permission denied"
    )
    assert doctor.find_remedy("the practice sandbox gave no answer") == ""


@pytest.mark.parametrize(
    ("ended", "works"), [(doctor.MAX_ATTEMPTS - 1, True), (doctor.MAX_ATTEMPTS, False)]
)
def test_a_sandbox_that_is_ended_while_it_starts_is_tried_again(monkeypatch, ended, works):
    starts = itertools.count()

    def launch(control):
        if next(starts) >= ended:
            return practice.launch(control)
        words = [sys.executable, "-c", "import os; os.kill(os.getpid(), 9)"]
        return session.SandboxProcess(
            process=session.start_process(words, {}), clean_up=lambda: None
        )

    monkeypatch.setitem(tiers.TIERS, "practice", lambda: replace(practice.sandbox(), launch=launch))
    finding = doctor.examine("practice")
    assert finding.works == works and next(starts) == doctor.MAX_ATTEMPTS
    assert works or finding.details.endswith("did not start: it was ended by signal 9")


def test_a_sandbox_that_does_not_start_leaves_nothing_behind():
    cleared = []

    def launch(control):
        process = session.start_process([sys.executable, "-c", "raise SystemExit('no')"], {})
        return session.SandboxProcess(
            process=process, clean_up=lambda: cleared.append(process.returncode)
        )

    started = session.SandboxSession(replace(practice.sandbox(), launch=launch))
    with pytest.raises(tiers.Unavailable, match="did not start: no"):
        started.wait_until_ready()
    assert cleared == [1]


def test_a_check_is_cleared_away_once(monkeypatch):
    with opened("practice") as subject:
        assert subject.scaled(1.0) == 2.0
        inside = subject._session
        ended, seconds = inside.clear_check()
        assert seconds > 0
        left = inside.cpu_seconds_left
        with monkeypatch.context() as changed:
            changed.setattr(session.channel, "send", None)  # no further requests are sent
            assert inside.clear_check() == (0, 0.0) and inside.cpu_seconds_left == left


def test_the_container_tier_works_where_mounting_is_forbidden():
    """As in most containers: root, without the right to create namespaces."""
    opened("container")
    if shutil.which("setpriv") is None:
        pytest.skip("there is no setpriv, by which root gives a right up")
    code = (
        "from hdrlab.course.grading import doctor\n"
        "for finding in doctor.examine_tiers(): print(finding.tier, finding.works, finding.details)\n"
    )
    less = [
        "setpriv",
        "--bounding-set=-sys_admin",
        "--inh-caps=-sys_admin",
        sys.executable,
        "-c",
        code,
    ]
    lines = subprocess.run(less, capture_output=True, text=True).stdout.splitlines()
    assert lines[0].startswith("strict False the strict ")
    assert "container True started in" in lines[1] and lines[2].startswith("practice True")


def test_the_doctor_finds_a_leaking_sandbox(monkeypatch):
    weak = replace(practice.sandbox(), tier="strict", credit=True)
    monkeypatch.setitem(tiers.TIERS, "strict", lambda: weak)
    finding = doctor.examine("strict")
    assert not finding.works
    assert finding.credit
    assert "a file of the grader could be read" in finding.details
    assert "a process could be started" in finding.details
    assert "a socket could be made" in finding.details
    assert not Path("/tmp/hdrlab-doctor").exists()


def test_a_subject_has_the_submitted_tasks_and_must_be_open(subject):
    with pytest.raises(AttributeError, match="has no task other"):
        subject.other(1)
    with pytest.raises(channel.UnsupportedValue, match="class function"):
        subject.scaled(lambda x: x)
    subject.fresh()
    closed = Subject({"f": ""}, practice.sandbox())
    with pytest.raises(RuntimeError, match="with statement"):
        closed.f()


def test_invalid_source_or_a_missing_function_is_reported():
    with opened("practice", {"a": "def a(:", "b": "x = 1", "c": "b = 3"}) as subject:
        with pytest.raises(NoAnswer, match=r"SyntaxError.*line 1: def a\(:"):
            subject.a()
        with pytest.raises(NoAnswer, match="there is no function b"):
            subject.b()


def test_the_parts_of_scipy_that_a_source_names_are_imported_before_its_checks():
    assert imported_numpy_modules(
        ["def f():\n    from scipy.sparse import linalg", "import hdrlab, os"]
    ) == [
        "scipy.sparse",
        "scipy.sparse.linalg",
    ]
    with opened(
        "practice", {"f": "import sys\ndef f(): return 'scipy.fft' in sys.modules"}
    ) as subject:
        assert not subject.f()


def test_a_submission_without_processor_time_left_is_reported():
    with opened("practice") as subject:
        assert subject.scaled(1.0) is not None
        subject._session.cpu_seconds_left = 0.0
        with pytest.raises(NoAnswer, match="processor time"):
            subject.scaled(1.0)


@pytest.mark.parametrize(
    ("sent", "ended", "used", "forks", "kind"),
    [
        (b"", signal.SIGKILL, 2.0, True, "late"),
        (b"", signal.SIGKILL, 2.0, False, "killed"),
        (b"", signal.SIGKILL, 0.1, True, "killed"),
        (b"", 0, 2.0, True, "died"),
        (b"", 0, 0.1, True, "died"),
        (b"nonsense", signal.SIGKILL, 2.0, True, "late"),
        (b"nonsense", signal.SIGKILL, 0.1, True, "killed"),
        (b"nonsense", 0, 0.1, True, "damaged"),
    ],
)
def test_a_missing_answer_says_what_ended_the_process(sent, ended, used, forks, kind):
    ours, theirs = socket.socketpair()
    theirs.sendall(sent)
    theirs.close()
    gone = linked(lambda: ours, forks=forks, ended=ended, used=used)
    with gone as subject, pytest.raises(NoAnswer) as error:
        subject.f()
    assert error.value.kind == kind


def test_the_time_of_a_check_and_of_a_submission_is_limited():
    theirs = []

    def check():  # nobody answers
        ours, other = socket.socketpair()
        theirs.append(other)
        return ours

    messages = []
    with linked(check, timeout=0.02) as subject:
        for _ in range(10):
            subject.fresh()
            for _ in range(4):
                with pytest.raises(NoAnswer) as error:
                    subject.f()
                assert error.value.kind == "late"
            messages.append(str(error.value))
    for folder in theirs:
        folder.close()
    assert "0.06 s" in messages[0]
    assert "0.4 s" in messages[-1]


@contextlib.contextmanager
def linked(check, *, timeout=10.0, forks=True, ended=0, used=0.0):
    """Yield a Subject whose connections come from a function, and whose processes have ended like this."""
    subject = Subject({"f": "def f(): return 1"}, practice.sandbox(), timeout)
    subject._session = SimpleNamespace(
        cpu_seconds_left=9.0,
        granted_cpu_seconds=2,
        sandbox=SimpleNamespace(can_fork=forks),
        start_check=check,
        clear_check=lambda seconds: (ended, used),
    )
    yield subject
    subject._close_link()


@pytest.mark.parametrize(
    ("tier", "counts"), [("strict", True), ("container", True), ("practice", False)]
)
def test_a_tier_gives_credit_only_if_it_isolates(tier, counts):
    opened(tier)
    assert tiers.choose(tier).credit is counts
