"""The system calls that the sandbox allows, and the user ids that it leases."""

import errno
import socket
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from hdrlab.course.sandbox import filters, users
from hdrlab.course.sandbox.session import Unavailable


class Rules:
    """A fake filter of libseccomp that records its rules; it does not know three of the calls."""

    LACKING = {"arch_prctl": -1, "access": -10, "open": 0}
    made: list = []

    def __init__(self, default):
        self.default = default
        self.rules = []
        self.made.append(self)

    def add_rule(self, action, call, *arguments):
        self.rules.append((action, call, *arguments))

    def export_bpf(self, file):
        file.write(b"a program")


@pytest.fixture
def seccomp(monkeypatch):
    """A fake binding of libseccomp that knows a call by its name."""

    def resolve(architecture, call):
        assert architecture == "native"
        if call == "time":
            raise OSError
        return Rules.LACKING.get(call, call if isinstance(call, int) else 1000 + len(call))

    made = SimpleNamespace(
        SyscallFilter=Rules,
        ERRNO=lambda number: ("errno", number),
        ALLOW="allow",
        EQ="==",
        MASKED_EQ="masked",
        Arg=lambda *words: words,
        Arch=SimpleNamespace(NATIVE="native"),
        resolve_syscall=resolve,
    )
    monkeypatch.setitem(sys.modules, "pyseccomp", made)
    filters.program.cache_clear()
    Rules.made.clear()
    yield made
    filters.program.cache_clear()


def numbers(*rooms):
    calls = [call for room in rooms for call in filters.SYSTEM_CALLS[room] if call != "time"]
    return [
        ("allow", n)
        for n in (Rules.LACKING.get(call, 1000 + len(call)) for call in calls)
        if n >= 0
    ]


# system calls of a check with restricted arguments; the numbers are those of the kernel
# headers
NARROW = [
    ("allow", "clone", (0, "masked", 0x10000, 0x10000)),
    (("errno", errno.ENOSYS), "clone3"),
    ("allow", "prlimit64", (0, "==", 0), (2, "==", 0)),
    *(("allow", "fcntl", (1, "==", order)) for order in (0, 1, 2, 3, 4, 1030)),
    *(("allow", "ioctl", (1, "==", order)) for order in (0x5401, 0x5421, 0x5451, 0x5450)),
]


@pytest.mark.parametrize(
    ("name", "rooms", "more"),
    [
        ("check", ("computing", "reading"), NARROW),
        ("supervisor", ("computing", "reading", "supervising"), []),
    ],
)
def test_a_filter_allows_only_the_listed_system_calls(name, rooms, more, seccomp):
    assert filters.program(name) == b"a program"
    (made,) = Rules.made
    assert made.default == ("errno", errno.EPERM) and made.rules == [*numbers(*rooms), *more]
    assert ("allow", 0) in made.rules


@pytest.mark.parametrize(
    ("text", "mapped"),
    [
        ("         0          0 4294967295\n", [range(4294967295)]),
        ("0 1000 1\n60000 100000 800\n", [range(1), range(60000, 60800)]),
    ],
)
def test_mapped_users_are_read_from_the_uid_map(text, mapped, monkeypatch):
    monkeypatch.setattr(
        Path, "read_text", lambda self: text if str(self) == "/proc/self/uid_map" else ""
    )
    assert users._mapped_users() == mapped


def test_without_a_uid_map_no_user_can_be_leased(monkeypatch):
    def missing(self):
        raise FileNotFoundError

    monkeypatch.setattr(Path, "read_text", missing)
    assert users._mapped_users() == []
    with pytest.raises(Unavailable, match="no user number of 60706 to 61183 is free here"):
        users.lease()


class Held:
    """A socket whose name may be in use."""

    taken: set = set()
    made: list = []

    def __init__(self, family):
        assert family == socket.AF_UNIX
        self.closed = False
        self.made.append(self)

    def bind(self, name):
        if name in self.taken:
            raise OSError
        self.taken.add(name)

    def close(self):
        self.closed = True


def test_a_lease_takes_the_first_free_user_id_of_the_namespace(monkeypatch):
    monkeypatch.setattr(users, "socket", SimpleNamespace(socket=Held, AF_UNIX=socket.AF_UNIX))
    monkeypatch.setattr(Held, "taken", {"\0hdrlab-user-60708"})
    monkeypatch.setattr(Held, "made", [])
    monkeypatch.setattr(users, "_mapped_users", lambda: [range(10), range(60707, 60710)])
    leased = [users.lease() for _ in range(2)]
    assert [user for user, _ in leased] == [60707, 60709]
    assert not any(held.closed for _, held in leased)
    assert [held for held in Held.made if not held.closed] == [held for _, held in leased]
    assert Held.taken == {f"\0hdrlab-user-{user}" for user in (60707, 60708, 60709)}
    with pytest.raises(Unavailable):
        users.lease()
    monkeypatch.setattr(users, "_mapped_users", lambda: [range(61183, 70000)])
    assert users.lease()[0] == 61183
    with pytest.raises(Unavailable):
        users.lease()
