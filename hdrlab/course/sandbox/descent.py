"""Run as root: arrange what another user is to see, become that user for good, and start a program.

An interpreter under a home folder cannot be read by that user, whom its owner keeps out. Two ways
lead there all the same.

stage  for the strict tier: a file system of this process's own is put over STAGE, and the paths are bound to
       STAGE/0, STAGE/1, ... for bubblewrap to take; nobody else sees it, and it ends with the
       process
homes  for the container tier: root opens the folders, and the user reaches them as /proc/self/fd/3, 4, ...
fence  for the container tier: Landlock lets what comes of this process read what is listed, and write nothing

It stands alone, on the standard library: it is run as a file.
"""

import ctypes
import json
import os
import stat
import struct
import sys

# it is everywhere, and what lies in it is reached by descriptors that were opened before
STAGE = "/tmp"
NEW_MOUNTS, BIND, RECURSIVE, PRIVATE = 0x20000, 4096, 16384, 1 << 18  # of unshare and mount
CREATE, ADD, RESTRICT = 444, 445, 446  # Landlock's system calls, the same on every processor
EXECUTE, WRITE_FILE, READ_FILE, READ_DIR = 1, 2, 4, 8  # its rights
RIGHTS = (
    (1, 13),
    (2, 14),
    (3, 15),
    (5, 16),
)  # since which of its versions there are how many of them
DIE_WITH_PARENT, NO_NEW_PRIVILEGES, KILL = 1, 38, 9  # of prctl
_libc = ctypes.CDLL(None, use_errno=True)


def check_answer(answer: int, what: str) -> int:
    """Return the system's answer, or raise an OSError that says what was asked for."""
    if answer < 0:
        raise OSError(ctypes.get_errno(), f"{what} was refused")
    return answer


def mount(source: str, target: str, kind: str = "", flags: int = 0, options: str = "") -> None:
    """Mount, or raise an OSError that names the target."""
    words = (word.encode() for word in (source, target, kind))
    check_answer(_libc.mount(*words, ctypes.c_ulong(flags), options.encode()), f"mounting {target}")


def stage(paths: list[str]) -> None:
    """Bind the paths to STAGE/0, STAGE/1 and so on, in a namespace of mounts of this process's own."""
    check_answer(_libc.unshare(NEW_MOUNTS), "a namespace of mounts")
    mount("none", "/", flags=RECURSIVE | PRIVATE)
    descriptors = [os.open(path, os.O_PATH) for path in paths]
    mount("tmpfs", STAGE, "tmpfs", options="size=64k,mode=755")
    for j, descriptor in enumerate(descriptors):
        target = f"{STAGE}/{j}"
        if stat.S_ISDIR(os.fstat(descriptor).st_mode):
            os.mkdir(target)
        else:
            os.close(os.open(target, os.O_CREAT | os.O_WRONLY))
        mount(f"/proc/self/fd/{descriptor}", target, flags=BIND | RECURSIVE)
        os.close(descriptor)


def landlock() -> int:
    """Return the version of Landlock that the kernel has, 0 where it has none."""
    return max(0, _libc.syscall(CREATE, None, 0, 1))


def fence(read: list[str], walk: list[str], write: list[str]) -> None:
    """Let this process read what is in `read`, list the folders of `walk`, write to `write`, and no more."""
    known = landlock()
    rights = (1 << max(count for since, count in RIGHTS if since <= known)) - 1
    nets, scopes = (
        (3 if known >= 4 else 0),
        (3 if known >= 6 else 0),
    )  # ports; signals and names of sockets
    size = 24 if known >= 6 else 16 if known >= 4 else 8
    rules = check_answer(
        _libc.syscall(CREATE, struct.pack("=QQQ", rights, nets, scopes), size, 0), "a fence"
    )
    wanted = [(path, READ_FILE | READ_DIR | EXECUTE) for path in read]
    wanted += [(path, READ_DIR) for path in walk] + [
        (path, READ_FILE | WRITE_FILE) for path in write
    ]
    for path, right in wanted:
        place = os.open(path, os.O_PATH)
        if not stat.S_ISDIR(os.fstat(place).st_mode):
            right &= ~READ_DIR
        check_answer(
            _libc.syscall(ADD, rules, 1, struct.pack("=Qi", right, place), 0), f"a rule for {path}"
        )
        os.close(place)
    check_answer(_libc.prctl(NO_NEW_PRIVILEGES, 1, 0, 0, 0), "giving up privileges")
    check_answer(_libc.syscall(RESTRICT, rules, 0), "the fence")
    os.close(rules)


def become(user: int) -> None:
    """Be this user and group, and no other, for good; and end when the parent ends."""
    os.setgroups([])
    os.setresgid(user, user, user)
    os.setresuid(user, user, user)
    check_answer(_libc.prctl(DIE_WITH_PARENT, KILL, 0, 0, 0), "an end with the parent")


def main(text: str) -> None:
    """Do what an order in JSON says; in its "command" and "environment", {0} is the first of its "homes"."""
    order = json.loads(text)
    homes = [os.open(path, os.O_PATH) for path in order.get("homes", ())]
    for home in homes:
        os.set_inheritable(home, True)
    if "stage" in order:
        stage(order["stage"])
    if "fence" in order:
        fence(**order["fence"])
    become(order["user"])
    command = [_placed(word, homes) for word in order["command"]]
    environment = {name: _placed(word, homes) for name, word in order["environment"].items()}
    os.execve(command[0], command, environment)


def _placed(word: str, homes: list[int]) -> str:
    """Return a word with the places of the homes in it."""
    for j, home in enumerate(homes):
        word = word.replace(f"{{{j}}}", f"/proc/self/fd/{home}")
    return word


if __name__ == "__main__":
    main(sys.argv[1])
