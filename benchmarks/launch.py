"""Run a command and print its seconds, peak memory in bytes, processor seconds and exit code.

A small process of its own, because Linux counts what the parent of a command held as the command's
own.

arguments: CPU to stay on or -1, file for its input, file for its output, the command
"""

import os
import subprocess
import sys
import time

KIB = 1 if sys.platform == "darwin" else 1024  # the unit of ru_maxrss


def main(cpu: str, source: str, target: str, *command: str) -> None:
    """Run it, and print what it took."""
    if int(cpu) >= 0:
        os.sched_setaffinity(0, {int(cpu)})
    with open(source, "rb") as stdin, open(target, "wb") as stdout:
        start = time.perf_counter()
        process = subprocess.Popen(command, stdin=stdin, stdout=stdout)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.perf_counter() - start
    cpu_seconds = usage.ru_utime + usage.ru_stime
    print(seconds, usage.ru_maxrss * KIB, cpu_seconds, os.waitstatus_to_exitcode(status))


if __name__ == "__main__":
    main(*sys.argv[1:])
