"""Run in Pyodide: all code cells of notebooks; for each, print a line of JSON with what failed.

The names come in ARGUMENTS, first the seconds after which no other notebook begins.
"""

import json
import os
import time
from pathlib import Path

from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output

os.environ["MPLBACKEND"] = "module://matplotlib_inline.backend_inline"
ROOT = Path("/hdrlab")
MAX_MESSAGE_CHARACTERS = 300

seconds, *paths = ARGUMENTS  # noqa: F821
deadline = time.monotonic() + float(seconds)
shell = InteractiveShell.instance()
os.makedirs("/work", exist_ok=True)
for path in paths:
    if time.monotonic() > deadline:
        break
    os.chdir("/work")
    shell.reset(new_session=True)
    notebook = json.loads((ROOT / path).read_text("utf8"))
    started = time.monotonic()
    count = 0
    failures = []
    for number, cell in enumerate(notebook["cells"]):
        if cell["cell_type"] != "code":
            continue
        count += 1
        source = "".join(cell["source"])
        with capture_output():
            result = shell.run_cell(source, store_history=True)
        error = result.error_before_exec or result.error_in_exec
        if error is not None:
            message = f"{type(error).__name__}: {error}"[:MAX_MESSAGE_CHARACTERS]
            failures.append({"cell": number, "error": message})
    line = {
        "notebook": path,
        "cells": count,
        "failures": failures,
        "seconds": round(time.monotonic() - started, 1),
    }
    print("RESULT " + json.dumps(line), flush=True)
