"""`python -m hdrlab` is the `hdrlab` command."""

from hdrlab.cli import run

if __name__ == "__main__":
    run()
