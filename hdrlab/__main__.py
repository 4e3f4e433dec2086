"""`python -m hdrlab` is the `hdrlab` command. Ctrl-C while it loads also ends in one line."""

import sys

EXIT_INTERRUPTED = 130

try:
    from hdrlab.cli import run
except (KeyboardInterrupt, ImportError, RuntimeError) as error:
    # C extensions wrap a KeyboardInterrupt that arrives while they load
    cause = error.__cause__ or error
    if not isinstance(cause, KeyboardInterrupt):
        raise
    sys.stderr.write("hdrlab: interrupted\n")
    sys.exit(EXIT_INTERRUPTED)

if __name__ == "__main__":
    run()
