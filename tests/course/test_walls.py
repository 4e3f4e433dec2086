"""The options with which the sandboxes of the tiers for credit are started."""

import os
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from hdrlab.course.sandbox import (
    container,
    contents,
    descent,
    filters,
    practice,
    session,
    strict,
    users,
)
from hdrlab.course.sandbox.contents import SandboxMounts
from hdrlab.course.sandbox.session import Unavailable

INSIDE = SandboxMounts(
    prefix="/usr",
    python="/python/bin/python3",
    places={"/b": "/out/b", "/a": "/out/a"},
    hidden=("/a/x",),
    packages={"numpy": "/packages/numpy"},
)


def test_bubblewrap_gets_its_arguments_in_the_required_order(monkeypatch):
    monkeypatch.setattr(strict, "BUBBLEWRAP_OPTIONS", ["--walls"])
    monkeypatch.setattr(strict, "ENVIRONMENT", {"A": "1"})
    assert strict.bubblewrap_options(INSIDE, INSIDE.places, 7) == [
        "--walls",
        *("--setenv", "A", "1", "--setenv", "LD_LIBRARY_PATH", "/python/lib"),
        *("--ro-bind", "/out/a", "/a", "--ro-bind", "/out/b", "/b"),
        *("--perms", "0555", "--size", "4096", "--tmpfs", "/a/x", "--remount-ro", "/a/x"),
        *("--dev-bind", os.devnull, os.devnull),
        *("--remount-ro", "/", "--chdir", "/", "--seccomp", "7", "--"),
    ]


class Lease:
    """A fake lease of a user number."""

    def __init__(self, ended):
        self.ended = ended

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.ended.append("lease")


@pytest.fixture
def launched(monkeypatch):
    """The arguments of the process and of the descent of a launch; ended leases are in `ended`."""
    made = SimpleNamespace(started=[], orders=[], ended=[], rules=[])

    def start(words, environment, *, pass_fds):
        if len(pass_fds) > 1:
            made.rules.append(os.read(pass_fds[1], 99))
        made.started.append((words, environment, pass_fds[0]))
        return "process"

    def descend(**order):
        made.orders.append(order)
        return ["descend"]

    for room in (strict, session):
        monkeypatch.setattr(room, "start_process", start)
    for room in (strict, container):
        monkeypatch.setattr(room, "contents", lambda: INSIDE)
    monkeypatch.setattr(filters, "program", lambda name: f"rules of a {name}".encode())
    monkeypatch.setattr(users, "lease", lambda: (60706, Lease(made.ended)))
    monkeypatch.setattr(users, "descend", descend)
    return made


CONTROL = SimpleNamespace(fileno=lambda: 5)


@pytest.mark.parametrize("root", [True, False])
def test_the_strict_tier_is_launched_by_bubblewrap_and_root_becomes_a_spare_user_first(
    root, launched, monkeypatch
):
    monkeypatch.setattr(os, "geteuid", lambda: 0 if root else 1)
    made = strict.launch("/bin/bwrap", CONTROL)
    ((words, environment, control),) = launched.started
    assert (environment, control, launched.rules) == ({}, 5, [b"rules of a supervisor"])
    assert made.process == "process" and made.scratch == ""
    supervisor = session.supervisor_command(
        "/python/bin/python3", INSIDE.program, 5, INSIDE.packages
    )
    if root:
        (order,) = launched.orders
        assert words == ["descend"] and order["user"] == 60706 and order["environment"] == {}
        assert order["stage"] == ["/out/b", "/out/a"]
        bound = order["command"].index("--ro-bind")
        assert order["command"][bound : bound + 6] == [
            "--ro-bind",
            f"{descent.STAGE}/1",
            "/a",
            "--ro-bind",
            f"{descent.STAGE}/0",
            "/b",
        ]
        words = order["command"]
    assert words[0] == "/bin/bwrap" and words[-len(supervisor) :] == supervisor
    assert not launched.ended
    made.clean_up()
    assert launched.ended == (["lease"] if root else [])


def test_the_container_tier_is_launched_through_homes_that_root_has_opened(
    launched, monkeypatch, tmp_path
):
    (tmp_path / "scipy.libs").mkdir()
    folders = {"numpy": f"{tmp_path}/numpy", "scipy": f"{tmp_path}/scipy"}
    monkeypatch.setattr(session, "package_folders", lambda: folders)
    inside = replace(INSIDE, places={"/python/bin/python3": "/usr/local/bin/python3.11"}, hidden=())
    monkeypatch.setattr(container, "contents", lambda: inside)
    made = container.launch(CONTROL)
    (order,) = launched.orders
    program = session.SUPERVISOR_PATH
    assert order["homes"] == [
        "/usr",
        str(program.parent),
        *folders.values(),
        f"{tmp_path}/scipy.libs",
    ]
    listable, readable = inside.allowed_paths()
    assert order["fence"] == {"readable": readable, "listable": listable, "writable": [os.devnull]}
    assert order["user"] == 60706
    versions = {"numpy": "{2}", "scipy": "{3}"}
    assert order["command"] == session.supervisor_command(
        "{0}/local/bin/python3.11", "{1}/supervisor.py", 5, versions
    )
    more = {"PYTHONHOME": "{0}", "LD_LIBRARY_PATH": "{0}/lib:{4}"}
    assert order["environment"] == session.ENVIRONMENT | more
    assert launched.started == [(["descend"], {}, 5)] and not launched.ended
    made.clean_up()
    assert launched.ended == ["lease"]


def test_the_container_tier_needs_linux_root_and_landlock(launched, monkeypatch):
    here = {"platform": "linux", "user": 0, "landlock": 1}
    monkeypatch.setattr(container, "sys", SimpleNamespace(platform="linux"))
    monkeypatch.setattr(os, "geteuid", lambda: here["user"])
    monkeypatch.setattr(descent, "landlock_version", lambda: here["landlock"])
    made = container.sandbox()
    assert made.credit and made.seccomp_program == b"rules of a check"
    assert made.limits == session.LIMITS
    for name, value, message in (("landlock", 0, "needs Landlock"), ("user", 1, "needs root")):
        here[name] = value
        with pytest.raises(Unavailable, match=f"container tier {message}"):
            container.sandbox()
    container.sys.platform = "darwin"
    with pytest.raises(Unavailable, match="container tier needs Linux, and this is darwin"):
        container.sandbox()


@pytest.mark.parametrize("variables", [{"SYSTEMROOT": "C:"}, {}])
def test_the_practice_tier_runs_in_a_temporary_folder(variables, launched, monkeypatch):
    began = []
    monkeypatch.setattr(
        session, "start_process", lambda *words, **knobs: began.append((words, knobs)) or "process"
    )
    monkeypatch.delenv("SYSTEMROOT", raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    made = practice.launch(CONTROL)
    (((words, environment), knobs),) = began
    python = getattr(sys, "_base_executable", sys.executable)
    assert words == session.supervisor_command(
        python, str(session.SUPERVISOR_PATH), 5, session.package_folders()
    )
    own = {"HOME": made.scratch, "TMPDIR": made.scratch}
    assert environment == session.ENVIRONMENT | own | variables
    assert knobs == {
        "pass_fds": [5],
        "folder": made.scratch,
    }
    assert os.listdir(made.scratch) == []
    Path(made.scratch, "left").touch()
    made.clean_up()
    assert not os.path.exists(made.scratch)
    made.clean_up()


def test_the_practice_tier_limits_no_processes_and_gives_no_credit():
    assert practice.sandbox().credit is False
    assert set(practice.sandbox().limits) == {"CPU", "AS", "FSIZE", "NOFILE", "CORE"}
    assert practice.sandbox().limits.items() <= session.LIMITS.items()


def mounts(places, *hidden):
    return SandboxMounts(prefix="", python="", places=places, hidden=hidden, packages={})


def test_everything_mounted_is_readable_except_what_is_hidden(tmp_path):
    for folder in ("lib/a", "lib/packages/x", "lib/b/packages", "other"):
        (tmp_path / folder).mkdir(parents=True)
    places = {"/in": f"{tmp_path}/lib", "/o": f"{tmp_path}/other", "/none": f"{tmp_path}/none"}
    inside = mounts(places, "/in/packages", "/in/b/packages")
    listed, read = inside.allowed_paths()
    assert sorted(listed) == [f"{tmp_path}/lib", f"{tmp_path}/lib/b"]
    assert read == [f"{tmp_path}/lib/a", f"{tmp_path}/other"]
    assert mounts(places).allowed_paths() == (
        [],
        [f"{tmp_path}/lib", f"{tmp_path}/other"],
    )


def test_package_folders_are_found_in_the_mounted_paths(tmp_path):
    for folder in (
        "a/site-packages",
        "a/python3.11/dist-packages",
        "a/b/site-packages",
        "p/x-packages",
    ):
        (tmp_path / folder).mkdir(parents=True)
    places = {
        "/python/lib": f"{tmp_path}/a",
        "/packages/p": f"{tmp_path}/p",
        "/f": f"{tmp_path}/none",
    }
    folders = contents._find_package_folders(places)
    assert folders == ["/python/lib/python3.11/dist-packages", "/python/lib/site-packages"]
