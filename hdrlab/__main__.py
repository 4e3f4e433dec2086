"""`python -m hdrlab` is the `hdrlab` command; Ctrl-C while it is loaded ends it in one line, too."""

import sys

try:
    from hdrlab.cli import run
except (
    KeyboardInterrupt,
    ImportError,
    RuntimeError,
) as error:  # a module of C wraps what rises in it
    if not isinstance(error.__cause__ or error, KeyboardInterrupt):
        raise
    sys.stderr.write("hdrlab: interrupted\n")
    sys.exit(130)

if __name__ == "__main__":
    run()
