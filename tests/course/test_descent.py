"""The system calls with which root prepares a sandbox, in the order and form of the kernel's manual.

A fake kernel answers and does nothing, so the tests run on every machine and without root.
"""

import errno
import json
import os
import runpy
import struct
import sys
from ctypes import c_ulong

import pytest

from hdrlab.course.sandbox import descent

# landlock_create_ruleset, landlock_add_rule, landlock_restrict_self
CREATE = 444
ADD = 445
RESTRICT = 446
RULES = 1000  # a descriptor that there is not


class Kernel:
    """A fake C library and module os that record their calls; `version` is that of Landlock."""

    def __init__(self, version=6):
        self.version = version
        self.asked = []
        self.opened = {}

    def record(self, *words):
        self.asked.append(words)
        return 0

    def syscall(self, number, *words):
        if number == CREATE and words[0] is None:
            return self.record("version", *words) or self.version
        self.record(number, *words)
        return RULES if number == CREATE else 0

    def __getattr__(self, name):
        if name in ("prctl", "mount", "unshare", "setgroups", "setresgid", "setresuid", "execve"):
            return lambda *words: self.record(
                name, *(word.value if isinstance(word, c_ulong) else word for word in words)
            )
        return getattr(os, name)

    def open(self, path, flags):
        self.record("open", str(path), flags)
        descriptor = os.open(path, flags)
        self.opened[descriptor] = str(path)
        return descriptor

    def close(self, descriptor):
        path = self.opened.pop(descriptor, None)
        if path is not None:
            os.close(descriptor)
        self.record("close", path or descriptor)

    def set_inheritable(self, descriptor, whether):
        self.record("inherit", self.opened[descriptor], whether)


@pytest.fixture
def kernel(monkeypatch):
    """A kernel that records the calls of descent.py; at the end, all its descriptors must be closed."""
    made = Kernel()
    monkeypatch.setattr(descent, "_libc", made)
    monkeypatch.setattr(descent, "os", made)
    yield made
    for left in made.opened:
        os.close(left)


def test_a_refused_system_call_raises_os_error_with_its_action():
    with pytest.raises(OSError, match="trick was refused") as raised:
        descent.check_result(descent._libc.prctl(-1, 0, 0, 0, 0), "a trick")
    assert raised.value.errno == errno.EINVAL
    assert descent.check_result(0, "nothing") == 0 and descent.check_result(7, "a descriptor") == 7


@pytest.mark.parametrize(("answer", "version"), [(-1, 0), (0, 0), (1, 1), (7, 7)])
def test_the_landlock_version_is_zero_without_landlock(answer, version, kernel):
    kernel.version = answer
    assert descent.landlock_version() == version
    assert kernel.asked == [("version", None, 0, 1)]


# the rights over files, ports and scopes that each version of Landlock supports
KNOWN = {
    1: [0x1FFF],
    2: [0x3FFF],
    3: [0x7FFF],
    4: [0x7FFF, 3],
    5: [0xFFFF, 3],
    6: [0xFFFF, 3, 3],
    7: [0xFFFF, 3, 3],
}


@pytest.mark.parametrize("version", KNOWN)
def test_the_landlock_ruleset_handles_every_right_of_its_version(version, kernel):
    kernel.version = version
    descent.restrict_files([], [], [])
    rights = KNOWN[version]
    size = 8 * len(rights)
    assert kernel.asked == [
        ("version", None, 0, 1),
        (CREATE, struct.pack(f"={len(rights)}Q", *rights), size, 0),
        ("prctl", 38, 1, 0, 0, 0),
        (RESTRICT, RULES, 0),
        ("close", RULES),
    ]


def test_landlock_rules_allow_reading_listing_and_writing_only_as_given(kernel, tmp_path):
    folder = tmp_path / "folder"
    file = tmp_path / "file"
    listed = tmp_path / "listed"
    written = tmp_path / "written"
    folder.mkdir()
    listed.mkdir()
    file.touch()
    written.touch()
    descent.restrict_files([str(folder), str(file)], [str(listed)], [str(written)])
    rights = {str(folder): 4 + 8 + 1, str(file): 4 + 1, str(listed): 8, str(written): 4 + 2}
    calls = kernel.asked[2:-3]
    assert [call[:3] for call in calls if call[0] == "open"] == [
        ("open", path, os.O_PATH) for path in rights
    ]
    rules = [call for call in calls if call[0] == ADD]
    assert [call[1:3] + call[4:] for call in rules] == [(RULES, 1, 0)] * 4
    assert [struct.unpack("=Qi", call[3])[0] for call in rules] == list(rights.values())
    assert [call[0] for call in calls] == ["open", ADD, "close"] * 4
    assert [call[1] for call in calls if call[0] == "close"] == list(rights) and not kernel.opened


def test_a_landlock_rule_refers_to_the_opened_path(kernel, monkeypatch, tmp_path):
    places = []
    monkeypatch.setattr(
        kernel,
        "open",
        lambda path, flags: places.append(Kernel.open(kernel, path, flags)) or places[-1],
    )
    descent.restrict_files([], [str(tmp_path)], [])
    (rule,) = [call for call in kernel.asked if call[0] == ADD]
    assert struct.unpack("=Qi", rule[3]) == (8, *places)


def test_paths_are_bind_mounted_in_a_private_mount_namespace(kernel, monkeypatch, tmp_path):
    stage = tmp_path / "stage"
    folder = tmp_path / "folder"
    file = tmp_path / "file"
    for path in (stage, folder):
        path.mkdir()
    file.touch()
    monkeypatch.setattr(descent, "STAGE", str(stage))
    descent.stage([str(folder), str(file)])
    mounts = [path for path in kernel.asked if path[0] in ("unshare", "mount")]
    none = b""
    where = str(stage).encode()
    assert mounts[:3] == [
        ("unshare", 0x20000),
        ("mount", b"none", b"/", none, 0x4000 | 0x40000, none),
        ("mount", b"tmpfs", where, b"tmpfs", 0, b"size=64k,mode=755"),
    ]
    assert [path[2:] for path in mounts[3:]] == [
        (where + b"/%d" % j, none, 0x5000, none) for j in (0, 1)
    ]
    assert all(path[1].startswith(b"/proc/self/fd/") for path in mounts[3:])
    assert (stage / "0").is_dir() and (stage / "1").is_file() and not kernel.opened
    opened = [path[1] for path in kernel.asked if path[0] == "open"]
    assert opened == [str(folder), str(file), f"{stage}/1"]
    begun = [path[0] for path in kernel.asked]
    assert begun.index("mount") < begun.index("open"), (
        "what is opened before is of the old namespace"
    )


def test_becoming_a_user_drops_all_privileges_of_root(kernel):
    descent.become_user(60706)
    assert kernel.asked == [
        ("setgroups", []),
        ("setresgid", 60706, 60706, 60706),
        ("setresuid", 60706, 60706, 60706),
        ("prctl", 1, 9, 0, 0, 0),
    ]


def order(**more):
    return json.dumps({"user": 5, "command": ["/bin/a", "b"], "environment": {"C": "d"}, **more})


def test_without_mounts_and_landlock_the_program_starts_as_the_user(kernel):
    descent.main(order())
    assert [call[0] for call in kernel.asked] == [
        "setgroups",
        "setresgid",
        "setresuid",
        "prctl",
        "execve",
    ]
    assert kernel.asked[-1] == ("execve", "/bin/a", ["/bin/a", "b"], {"C": "d"})


def test_mounts_and_landlock_come_before_dropping_privileges(kernel, monkeypatch):
    monkeypatch.setattr(descent, "stage", lambda paths: kernel.record("stage", paths))
    monkeypatch.setattr(descent, "restrict_files", lambda **order: kernel.record("fence", order))
    fence = {"readable": ["r"], "listable": ["w"], "writable": []}
    descent.main(order(stage=["/a"], fence=fence))
    assert kernel.asked[:3] == [("stage", ["/a"]), ("fence", fence), ("setgroups", [])]


def test_opened_home_folders_are_passed_to_the_command_by_descriptor(kernel, tmp_path):
    names = [str(tmp_path / name) for name in ("a", "b")]
    for name in names:
        os.mkdir(name)
    words = {"command": ["{0}/bin", "{1}:{0}", "{2}"], "environment": {"HOME": "{1}"}}
    descent.main(order(homes=names, **words))
    first, second = (f"/proc/self/fd/{number}" for number in kernel.opened)
    assert kernel.asked[:4] == [
        *(("open", name, os.O_PATH) for name in names),
        *(("inherit", name, True) for name in names),
    ]
    assert kernel.asked[-1] == (
        "execve",
        f"{first}/bin",
        [f"{first}/bin", f"{second}:{first}", "{2}"],
        {"HOME": second},
    )


def test_descent_runs_as_a_script_with_one_argument(monkeypatch):
    kernel = Kernel()
    monkeypatch.setattr("ctypes.CDLL", lambda name, use_errno: kernel)
    for name in ("setgroups", "setresgid", "setresuid", "execve"):
        monkeypatch.setattr(os, name, getattr(kernel, name))
    monkeypatch.setattr(sys, "argv", ["descent.py", order(), "more"])
    runpy.run_path(descent.__file__, run_name="__main__")
    assert kernel.asked[-1] == ("execve", "/bin/a", ["/bin/a", "b"], {"C": "d"})
