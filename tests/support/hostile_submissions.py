"""Submissions that try to harm the grader, the class or the reader of a page. All are harmless in fact.

NASTY_TEXTS            characters that break a page, a terminal, a table or a UTF-8 file
CODE_WITH_NASTY_TEXTS  functions that raise, print or return such a text
HOSTILE_CODE           functions that use up time or memory, end their process, or send wrong data
UNREADABLE_FILES       notebooks and Python files that are hard to read: (suffix, function that
                       returns their bytes)
NASTY_FILE_NAMES       the ends of file names, as bytes, after the name of the student
ODD_FILES              links, pipes, folders and huge files: (suffix, function that makes it at a path)

Each is a dictionary; its keys describe what is wrong.
"""

import codecs
import json
import os
import socket

CORRECT_CODE = (
    "import numpy as np\n\ndef hat(n=256):\n    return n - 1 - abs(2 * np.arange(n) - n + 1)\n"
)

NASTY_TEXTS = {
    "half a character": "\ud800",
    "both halves apart": "\udc80 \ud83d",
    "terminal codes": "\x1b[2J\x1b[31m\x1b]0;title\x07",
    "a code cut short": "\x1b[" + "0" * 2000,
    "turned direction": "\u202egnp.exe\u2066\u2067",
    "no shape": "\u200b\u200c\u200d\ufeff\u2060",
    "stacked accents": "o" + "\u0301\u0336\u20dd" * 500,
    "joined stacks": "o" + "\u0301\u0302\u034f" * 500,
    "controls": "\0\x07\x08\x9b31m\x85",
    "line separators": "a\u2028b\u2029c\x0b\x0c",
    "a script": "<script>alert(1)</script><svg onload=alert(1)>",
    "a formula": "=HYPERLINK('http://a')",
    "the words of the grader": "hat ended its process, and gave no answer",
    "XML's end": "]]></failure>\ufffe\uffff",
    "a template": "{{ 7 * 7 }}{% raise %}",
    "private use": "\ue000\U000f0000\U0010ffff",
}
RAISING_CODE = "def hat(n=256):\n    raise ValueError({text})\n"
PRINTING_CODE = "def hat(n=256):\n    print({text})\n    return None\n"
RETURNING_CODE = "def hat(n=256):\n    return {text}\n"
NAMING_CODE = "def hat(n=256):\n    raise type({text}, (Exception,), {{}})\n"
CODE_TEMPLATES = {"raised": RAISING_CODE, "printed": PRINTING_CODE, "returned": RETURNING_CODE}
CODE_WITH_NASTY_TEXTS = {
    f"{name}, {use}": template.format(text=ascii(text))
    for name, text in NASTY_TEXTS.items()
    for use, template in CODE_TEMPLATES.items()
}
NASTY_CLASS_NAME = "\x1b[2J" + "\u202e" * 5
CODE_WITH_NASTY_TEXTS["a nasty class"] = NAMING_CODE.format(text=ascii(NASTY_CLASS_NAME))

HOSTILE_CODE = {
    "sleeps in each call": "import time\ndef hat(n=256):\n    time.sleep(0.45)\n    return None\n",
    "computes in each call": "def hat(n=256):\n    while True: pass\n",
    "computes in threads": (
        "import threading, hashlib\ndef spin():\n    data = bytes(1 << 20)\n"
        "    while True: hashlib.sha256(data).digest()\n"
        "def hat(n=256):\n    for _ in range(4): threading.Thread(target=spin).start()\n    spin()\n"
    ),
    "computes at import": "while True: x = 1\ndef hat(n=256): return x\n",
    "a list of 340,000 integers": "def hat(n=256):\n    return [0] * 340_000\n",
    "a dictionary of 100,000": "def hat(n=256):\n    return {k: 0 for k in range(100_000)}\n",
    "lists of lists": "def hat(n=256):\n    return [[[k]] for k in range(60_000)]\n",
    "a ragged list": "def hat(n=256):\n    return [[1, 2], [3], 4]\n",
    "a generator without end": "def hat(n=256):\n    while True: yield 1\n",
    "a frame that lies": (
        "import sys, os\ndef hat(n=256):\n    os.write(3, b'\\0\\x0f\\xff\\xff[' + b'0,' * 500_000)\n"
    ),
    "a number of many digits": "def hat(n=256):\n    return 10 ** 5000\n",
    "ends by itself": "import os\ndef hat(n=256):\n    os._exit(0)\n",
    "ends otherwise each time": (
        "import os\ndef hat(n=256):\n    print(os.urandom(9).hex())\n    os._exit(os.urandom(1)[0])\n"
    ),
    "kills itself": "import os\ndef hat(n=256):\n    os.kill(os.getpid(), 9)\n    os.abort()\n",
    "closes its link": (
        "import os\ndef hat(n=256):\n    os.closerange(3, 64)\n    while True: pass\n"
    ),
    "fills the memory": "def hat(n=256):\n    return len([bytes(1 << 28) for _ in range(64)])\n",
    "crashes": "import ctypes\ndef hat(n=256):\n    ctypes.string_at(0)\n",
    "calls itself": "import sys\nsys.setrecursionlimit(10**9)\ndef hat(n=256):\n    return hat(n)\n",
    "prints without end": "def hat(n=256):\n    while True: print('\\u0301' * 10_000)\n",
    "a large array": "import numpy as np\ndef hat(n=256):\n    return np.zeros(1 << 23)\n",
}


def notebook(*sources, **fields):
    """Return a notebook with these code cells as bytes; `fields` replaces fields of the notebook."""
    cells = [{"cell_type": "code", "source": source, "metadata": {}} for source in sources]
    return json.dumps({"cells": cells, "nbformat": 4, "metadata": {}} | fields).encode()


def with_correct_code(lines):
    """Return a Python file with these lines, followed by a correct solution, as bytes."""
    return f"{lines}\n{CORRECT_CODE}".encode()


UNREADABLE_BYTES = 200_000  # the size of what is hard to read
UNREADABLE_FILES = {
    "empty dictionaries": (".ipynb", lambda: b'{"cells": [' + b"{}," * 9_000_000 + b"{}]}"),
    "deep lists": (".ipynb", lambda: b'{"cells": ' + b"[" * UNREADABLE_BYTES),
    "deep dictionaries": (".ipynb", lambda: b'{"cells":' * 100_000),
    "a long number": (".ipynb", lambda: b'{"cells": ' + b"9" * UNREADABLE_BYTES + b"}"),
    "many cells that are no Python": (".ipynb", lambda: notebook(*["def hat(:"] * 1_000)),
    "a cell with half a character": (".ipynb", lambda: notebook("x = '\ud800'", CORRECT_CODE)),
    "sheets that are no lists": (
        ".ipynb",
        lambda: b'{"worksheets": [{"cells": 7}, 3, {"cells": [5]}]}',
    ),
    "a cell's source that is a number": (".ipynb", lambda: notebook(7, [7, [8]], {"a": 1})),
    "names of cells": (".ipynb", lambda: b'{"cells": {"cell_type": "code"}}'),
    "NUL": (".py", lambda: b"\0" * UNREADABLE_BYTES),
    "an unknown coding": (".py", lambda: b"# coding: rot13\n" + CORRECT_CODE.encode()),
    "a coding that is slow": (".py", lambda: b"# coding: punycode\n" + b"a-" + b"z" * 60_000),
    "UTF-16 cut short": (".ipynb", lambda: codecs.BOM_UTF16_LE + b"{" * 7),
    "blank lines": (".py", lambda: with_correct_code("\n" * UNREADABLE_BYTES + "%")),
    "blank lines of spaces": (
        ".py",
        lambda: with_correct_code(" \n" * (UNREADABLE_BYTES // 2) + "?"),
    ),
    "a line of spaces": (
        ".py",
        lambda: with_correct_code("x = 1" + " " * UNREADABLE_BYTES + "\n%"),
    ),
    "a line of questions": (".py", lambda: with_correct_code("? " * (UNREADABLE_BYTES // 2) + "x")),
    "statements on a line": (".py", lambda: with_correct_code("a=1;" * 6_000)),
    "a chain of assignments": (
        ".py",
        lambda: with_correct_code(
            "a0 = 1\n" + "\n".join(f"a{k + 1} = a{k}" for k in range(4_000)) + "\nn = a4000"
        ),
    ),
    "a chain of functions": (
        ".py",
        lambda: with_correct_code(
            "\n".join(f"def f{k}(x=lambda: f{k + 1}): return f{k + 1}" for k in range(3_000))
        ),
    ),
    "many changes of a name": (
        ".py",
        lambda: with_correct_code("a = []\n" + "a.append(a)\n" * 3_000),
    ),
    "many bindings of a name": (
        ".py",
        lambda: with_correct_code("a = 1\n" + "a = a + 1\n" * 3_000),
    ),
    "many names at once": (
        ".py",
        lambda: with_correct_code(
            ", ".join(f"a{k}" for k in range(10_000)) + " = " + ", ".join(["b"] * 10_000)
        ),
    ),
    "branches in branches": (
        ".py",
        lambda: with_correct_code(
            "if a: x = 0\n" + "".join(f"elif b{k}: x = {k}\n" for k in range(3_000))
        ),
    ),
    "a long sum": (".py", lambda: with_correct_code("x = " + "a + " * 20_000 + "1")),
    "a long chain of attributes": (".py", lambda: with_correct_code("x = a" + ".b" * 20_000)),
    "brackets in brackets": (".py", lambda: with_correct_code("x = " + "(" * 100_000)),
    "signs in a row": (".py", lambda: with_correct_code("x = " + "-" * 400_000 + "1")),
    "functions in functions": (
        ".py",
        lambda: with_correct_code(
            "".join(" " * k + f"def f{k}():\n" for k in range(99)) + " " * 99 + "pass"
        ),
    ),
    "lambdas with many arguments": (
        ".py",
        lambda: with_correct_code(
            "f = lambda " + ", ".join(f"a{k}" for k in range(4_000)) + ": " + "(lambda: 0)," * 4_000
        ),
    ),
    "comprehensions that bind": (
        ".py",
        lambda: with_correct_code("x = " + "[(a := " * 60 + "1" + ") for _ in b]" * 60),
    ),
    "a name of a megabyte": (".py", lambda: with_correct_code("a" * UNREADABLE_BYTES + " = 1")),
    "dots": (".py", lambda: with_correct_code("import " + "a." * 9_000 + "b")),
    "too much code": (".py", lambda: with_correct_code("#" * 1_100_000)),
    "a task that is too long": (
        ".py",
        lambda: b"T = '" + b"x" * 950_000 + b"'\ndef hat(n=256): return T\n",
    ),
}

NASTY_FILE_NAMES = {
    "not UTF-8": b"_\xff\xfe.py",
    "terminal codes": b"_\x1b[2J.py",
    "two lines": b"_a\nb.py",
    "turned direction": "_\u202eyp.py".encode(),
    "no shape": "_\u200b\u2060.py".encode(),
    "stacked accents": ("_o" + "\u0301" * 60 + ".py").encode(),
    "a formula": b"-=1+1.py",
    "a script": b"_<img src=x onerror=alert(1)>.py",
    "an option": b" --help.py",
    "capitals": b"_HW2.PY",
}


def make_sparse_file(path, size=200 << 30):
    """Make a sparse file: it has a size in bytes, but uses no room on the disk."""
    with open(path, "wb") as file:
        file.truncate(size)


def make_socket(path):
    """Make a Unix socket."""
    previous_folder = os.getcwd()
    os.chdir(path.parent)  # the system limits the length of a socket's path
    try:
        with socket.socket(socket.AF_UNIX) as server:
            server.bind(path.name)
    finally:
        os.chdir(previous_folder)


def make_nested_submission(path, *parts):
    """Make a folder with a correct submission inside a folder inside it."""
    folder = path.joinpath(*parts)
    folder.mkdir(parents=True)
    (folder / "hw2.py").write_text(CORRECT_CODE)


ODD_FILES = {
    "a huge sparse notebook": (".ipynb", make_sparse_file),
    "a huge sparse archive": (".zip", make_sparse_file),
    "a notebook of 60 MB": (".ipynb", lambda path: make_sparse_file(path, 60_000_000)),
    "a link to a file": (".py", lambda path: path.symlink_to("/etc/hostname")),
    "a link to a device": (".py", lambda path: path.symlink_to("/dev/zero")),
    "a link to itself": (".py", lambda path: path.symlink_to(path.name)),
    "a link to nothing": (".zip", lambda path: path.symlink_to("nothing")),
    "a link to a folder": ("", lambda path: path.symlink_to("/")),
    "a pipe": (".py", os.mkfifo),
    "a pipe without an ending": ("", os.mkfifo),
    "a socket": (".py", make_socket),
    "a folder called a notebook": (".ipynb", lambda path: make_nested_submission(path, "a")),
    "a folder in a folder": ("", lambda path: make_nested_submission(path, "work")),
    "a deep folder": ("", lambda path: make_nested_submission(path, *"abcdefghij" * 9)),
    "an empty file": (".py", lambda path: path.write_bytes(b"")),
}
