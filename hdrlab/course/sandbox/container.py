"""The container tier, for machines where namespaces cannot nest: Landlock, a spare user, limits, filters.

The container that hdrlab runs in has to keep submissions from the machine and the network; its
owner is responsible for that. Inside it, a spare user, Landlock, limits and a filter of system
calls keep submissions from the grader and from each other. They protect the content of files;
a submission can still find out that a file of a certain name exists.
"""

import os
import sys
from contextlib import ExitStack
from socket import socket

from hdrlab.course.sandbox import descent, filters, session, users
from hdrlab.course.sandbox.contents import contents

ROOT_USER = 0


def sandbox() -> session.Sandbox:
    """Return the container tier.

    Raises
    ------
    Unavailable
        If the system is not Linux with Landlock, this is not root, or libseccomp is missing.
    """
    if sys.platform != "linux":
        raise session.Unavailable(f"the container tier needs Linux, and this is {sys.platform}")
    if os.geteuid() != ROOT_USER:
        raise session.Unavailable(
            "the container tier needs root, which alone can become another user"
        )
    if descent.landlock_version() == 0:
        raise session.Unavailable(
            "the container tier needs Landlock, which this kernel or container lacks"
        )
    return session.Sandbox(
        tier="container",
        credit=True,
        launch=launch,
        seccomp_program=filters.program("check"),
    )


def launch(control: socket) -> session.SandboxProcess:
    """Start the supervisor as a spare user, behind Landlock.

    The user may not walk to the interpreter and the packages if they lie in somebody's home folder.
    So root opens their folders, and the command refers to them by numbers: {0}, {1} and so on (see
    `descent.main`).
    """
    mounts = contents()
    packages = session.package_folders()
    homes = [mounts.prefix, str(session.SUPERVISOR_PATH.parent)]
    package_numbers = {}
    for name, folder in packages.items():
        package_numbers[name] = f"{{{len(homes)}}}"
        homes.append(folder)
    library_path = ["{0}/lib"]
    for folder in packages.values():
        libraries = f"{folder}.libs"
        if os.path.isdir(libraries):
            library_path.append(f"{{{len(homes)}}}")
            homes.append(libraries)
    python = os.path.relpath(mounts.places[mounts.python], mounts.prefix)
    supervisor = session.supervisor_command(
        f"{{0}}/{python}",
        f"{{1}}/{session.SUPERVISOR_PATH.name}",
        control.fileno(),
        package_numbers,
    )
    environment = session.ENVIRONMENT | {
        "PYTHONHOME": "{0}",
        "LD_LIBRARY_PATH": ":".join(library_path),
    }
    listable, readable = mounts.allowed_paths()
    with ExitStack() as stack:
        user, lease = users.lease()
        stack.enter_context(lease)
        command = users.descend(
            user=user,
            homes=homes,
            fence={"readable": readable, "listable": listable, "writable": [os.devnull]},
            command=supervisor,
            environment=environment,
        )
        process = session.start_process(command, {}, pass_fds=[control.fileno()])
        # the lease is held until the process has ended
        return session.SandboxProcess(process=process, clean_up=stack.pop_all().close)
