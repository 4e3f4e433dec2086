"""The container tier, for machines where namespaces cannot nest: a user of its own, a fence, limits, filters.

The container around it keeps the machine and the network away: its owner says so. Here a spare
user, Landlock, the limits and the filter of system calls keep submissions from the grader and from
each other. What a file holds is kept from them; that there is a file of a certain name is not.
"""

import os
import sys
from contextlib import ExitStack
from socket import socket

from hdrlab.course.sandbox import descent, filters, running, users
from hdrlab.course.sandbox.contents import contents


def sandbox() -> running.Sandbox:
    """Return the container tier.

    Raises
    ------
    Unavailable
        Where the system is not Linux with Landlock, this is not root, or libseccomp is missing.
    """
    if sys.platform != "linux":
        raise running.Unavailable(f"the container tier needs Linux, and this is {sys.platform}")
    if os.geteuid() != 0:
        raise running.Unavailable(
            "the container tier needs root, which alone can become another user"
        )
    if descent.landlock() == 0:
        raise running.Unavailable(
            "the container tier needs Landlock, which this kernel or container lacks"
        )
    return running.Sandbox("container", True, launch, program=filters.program("check"))


def launch(control: socket) -> running.SandboxProcess:
    """Start the supervisor behind the fence, as a spare user who reads what root has opened."""
    inside, found = contents(), running.packages()
    libraries = [folder for one in found.values() if os.path.isdir(folder := f"{one}.libs")]
    homes = [inside.prefix, str(running.PROGRAM.parent), *found.values(), *libraries]
    folders = {name: f"{{{j}}}" for j, name in enumerate(found, 2)}
    python = "{0}/" + os.path.relpath(inside.places[inside.python], inside.prefix)
    loaded = ":".join(["{0}/lib", *(f"{{{j}}}" for j in range(2 + len(found), len(homes)))])
    walk, read = inside.readable()
    with ExitStack() as held:
        user, lease = users.lease()
        held.enter_context(lease)
        words = users.descend(
            user=user,
            homes=homes,
            fence={"read": read, "walk": walk, "write": [os.devnull]},
            command=running.command(
                python, f"{{1}}/{running.PROGRAM.name}", control.fileno(), folders
            ),
            environment=running.ENVIRONMENT | {"PYTHONHOME": "{0}", "LD_LIBRARY_PATH": loaded},
        )
        return running.SandboxProcess(
            running.start(words, {}, control.fileno()), held.pop_all().close
        )
