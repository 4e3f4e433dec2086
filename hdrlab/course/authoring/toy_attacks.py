"""A hostile submission of the toy class: functions that attack the grader instead of computing."""


# %% It prints what a grader prints when a check holds.
def hat(*args, **kwargs):
    """Print a forged test report."""
    import sys

    sys.stdout.write("PASS\n{'outcome': 'holds'}\n2 passed in 0.01s\n")
    sys.stdout.flush()


# %% It ends the process before anything is compared.
def gsolve(*args, **kwargs):
    """End the process."""
    import os

    os._exit(0)


# %% It raises what a page might run and a terminal obey.
def update(*args, **kwargs):
    """Raise an error whose message is a script and a terminal code."""
    raise ValueError("\x1b[2J<script>alert(1)</script>")


# %% It answers with what claims to equal everything.
def recover(*args, **kwargs):
    """Return an object that claims to equal everything."""
    return type("Anything", (), {"__eq__": lambda self, other: True})()
