"""Run as root: prepare what another user may see, become that user for good, and start a program.

Another user cannot read an interpreter that lies in somebody's home folder. There are two ways
around that:

stage  for the strict tier: this process mounts a file system over STAGE that no other process sees,
       and binds the paths to STAGE/0, STAGE/1 and so on, from where bubblewrap takes them. The
       mounts end with the process.
homes  for the container tier: root opens the folders, and the user reaches them as
       /proc/self/fd/3, /proc/self/fd/4 and so on

In the container tier, Landlock also restricts the files that this process and its children may
read, and lets them write only what is listed (`restrict_files`).

This file is run as a script, and imports the standard library alone.
"""

import ctypes
import json
import os
import stat
import struct
import sys

# It exists on every system. What was in it is reached by descriptors that were opened before.
STAGE = "/tmp"

# of unshare and mount, from <sched.h> and <sys/mount.h>
CLONE_NEWNS = 0x20000
MS_BIND = 0x1000
MS_REC = 0x4000
MS_PRIVATE = 0x40000

# of prctl, from <linux/prctl.h>
PR_SET_PDEATHSIG = 1
PR_SET_NO_NEW_PRIVS = 38
SIGKILL = 9

# Landlock's system calls, which have the same numbers on every processor
LANDLOCK_CREATE_RULESET = 444
LANDLOCK_ADD_RULE = 445
LANDLOCK_RESTRICT_SELF = 446
LANDLOCK_CREATE_RULESET_VERSION = 1
LANDLOCK_RULE_PATH_BENEATH = 1

# rights in Landlock's rules, from <linux/landlock.h>
ACCESS_FS_EXECUTE = 1
ACCESS_FS_WRITE_FILE = 2
ACCESS_FS_READ_FILE = 4
ACCESS_FS_READ_DIR = 8
# how many rights over files Landlock has, by the version that added the last of them
FILE_RIGHT_COUNTS = {1: 13, 2: 14, 3: 15, 5: 16}
# binding and connecting TCP ports
NETWORK_RIGHTS = 0b11
FIRST_VERSION_WITH_NETWORK = 4
# signals and abstract sockets of processes outside
SCOPES = 0b11
FIRST_VERSION_WITH_SCOPES = 6

_libc = ctypes.CDLL(None, use_errno=True)


def check_result(result: int, action: str) -> int:
    """Return the result of a system call, or raise an OSError that names the action if it failed."""
    if result < 0:
        raise OSError(ctypes.get_errno(), f"{action} was refused")
    return result


def mount(source: str, target: str, kind: str = "", flags: int = 0, options: str = "") -> None:
    """Mount a file system, or raise an OSError that names the target."""
    result = _libc.mount(
        source.encode(), target.encode(), kind.encode(), ctypes.c_ulong(flags), options.encode()
    )
    check_result(result, f"mounting {target}")


def stage(paths: list[str]) -> None:
    """Bind the paths to STAGE/0, STAGE/1 and so on, in a mount namespace of this process's own."""
    check_result(_libc.unshare(CLONE_NEWNS), "a namespace of mounts")
    mount("none", "/", flags=MS_REC | MS_PRIVATE)
    # opened before the mount over STAGE, which may hide some of them
    descriptors = [os.open(path, os.O_PATH) for path in paths]
    mount("tmpfs", STAGE, "tmpfs", options="size=64k,mode=755")
    for j, descriptor in enumerate(descriptors):
        target = f"{STAGE}/{j}"
        if stat.S_ISDIR(os.fstat(descriptor).st_mode):
            os.mkdir(target)
        else:
            os.close(os.open(target, os.O_CREAT | os.O_WRONLY))
        mount(f"/proc/self/fd/{descriptor}", target, flags=MS_BIND | MS_REC)
        os.close(descriptor)


def landlock_version() -> int:
    """Return the version of Landlock that the kernel has, or 0 if it has none."""
    version = _libc.syscall(LANDLOCK_CREATE_RULESET, None, 0, LANDLOCK_CREATE_RULESET_VERSION)
    return max(0, version)


def restrict_files(readable: list[str], listable: list[str], writable: list[str]) -> None:
    """Restrict this process and its children to the listed files and folders, by Landlock.

    They also lose TCP ports, and signals and abstract sockets of processes outside, as far as the
    kernel's version of Landlock knows them.

    Parameters
    ----------
    readable : list of str
        Files and folders that may be read and executed, with all that the folders contain.
    listable : list of str
        Folders whose names of files may be listed.
    writable : list of str
        Files that may be read and written.
    """
    ruleset = _create_ruleset()
    rights_of_paths = [
        (readable, ACCESS_FS_READ_FILE | ACCESS_FS_READ_DIR | ACCESS_FS_EXECUTE),
        (listable, ACCESS_FS_READ_DIR),
        (writable, ACCESS_FS_READ_FILE | ACCESS_FS_WRITE_FILE),
    ]
    for paths, rights in rights_of_paths:
        for path in paths:
            _add_rule(ruleset, path, rights)
    check_result(_libc.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0), "giving up privileges")
    check_result(_libc.syscall(LANDLOCK_RESTRICT_SELF, ruleset, 0), "restricting files by Landlock")
    os.close(ruleset)


def _create_ruleset() -> int:
    """Return the descriptor of a ruleset that denies everything the kernel's Landlock can deny."""
    version = landlock_version()
    file_right_count = max(count for since, count in FILE_RIGHT_COUNTS.items() if since <= version)
    # struct landlock_ruleset_attr: one field of 64 bits in the first version, and three by now
    fields = [(1 << file_right_count) - 1]
    if version >= FIRST_VERSION_WITH_NETWORK:
        fields.append(NETWORK_RIGHTS)
    if version >= FIRST_VERSION_WITH_SCOPES:
        fields.append(SCOPES)
    attributes = struct.pack(f"={len(fields)}Q", *fields)
    ruleset = _libc.syscall(LANDLOCK_CREATE_RULESET, attributes, len(attributes), 0)
    return check_result(ruleset, "a ruleset of Landlock")


def _add_rule(ruleset: int, path: str, rights: int) -> None:
    """Allow some rights over a file, or over a folder with all that it contains."""
    descriptor = os.open(path, os.O_PATH)
    if not stat.S_ISDIR(os.fstat(descriptor).st_mode):
        # Landlock refuses rights over folders for a file
        rights &= ~ACCESS_FS_READ_DIR
    # struct landlock_path_beneath_attr
    attributes = struct.pack("=Qi", rights, descriptor)
    result = _libc.syscall(LANDLOCK_ADD_RULE, ruleset, LANDLOCK_RULE_PATH_BENEATH, attributes, 0)
    check_result(result, f"a rule for {path}")
    os.close(descriptor)


def become_user(user: int) -> None:
    """Become this user and group for good, and die with the parent process."""
    os.setgroups([])
    os.setresgid(user, user, user)
    os.setresuid(user, user, user)
    # last, because a change of the user resets it
    check_result(_libc.prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0), "an end with the parent")


def main(text: str) -> None:
    """Carry out an order.

    Parameters
    ----------
    text : str
        A JSON object. "user", "command" and "environment" say which program to start, and as whom.
        Optional are "stage", the paths for `stage`; "fence", the arguments of `restrict_files`; and
        "homes", folders to open first. {0} in the command and in the environment stands for the
        first of the homes, {1} for the second, and so on.
    """
    order = json.loads(text)
    homes = [os.open(path, os.O_PATH) for path in order.get("homes", ())]
    for home in homes:
        os.set_inheritable(home, True)
    if "stage" in order:
        stage(order["stage"])
    if "fence" in order:
        restrict_files(**order["fence"])
    become_user(order["user"])
    command = [_insert_homes(word, homes) for word in order["command"]]
    environment = {}
    for name, value in order["environment"].items():
        environment[name] = _insert_homes(value, homes)
    os.execve(command[0], command, environment)


def _insert_homes(text: str, homes: list[int]) -> str:
    """Replace {0}, {1} and so on in a text with the paths of the opened folders."""
    for j, home in enumerate(homes):
        text = text.replace(f"{{{j}}}", f"/proc/self/fd/{home}")
    return text


if __name__ == "__main__":
    main(sys.argv[1])
