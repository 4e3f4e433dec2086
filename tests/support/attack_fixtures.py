"""What the tests of attacks share: the attacks of tests/attacks, a folder to attack, and a server.

The name of an attack's file begins with its number in the list of attacks, 1 to 26. All attacks are
harmless: they write only into the folder that the test names, or where only a sandbox has a file.
"""

import ctypes
import re
import site
import socketserver
import threading
from contextlib import contextmanager
from pathlib import Path

import hdrlab

ATTACKS_FOLDER = Path(__file__).parents[1] / "attacks"
ATTACK_NAMES = sorted(path.stem for path in ATTACKS_FOLDER.glob("a*.py"))
HONEST_CODE = "def double(x):\n    return 2 * x\n"
# Python in the sandbox refuses some actions before the system does; the tests are about the system.
ALLOW_FORBIDDEN_ACTIONS = (
    "import sys; getattr(sys.modules.get('worker'), 'FORBIDDEN_ACTIONS', {}).clear()\n"
)
PARAMETERS_LINE = re.compile(r"^[A-Z = ]+ = (\"\"|0)$", re.MULTILINE)
PR_SET_CHILD_SUBREAPER = 36  # of Linux, see prctl(2)


def prepare_attack(name, place, port):
    """Return the source of an attack with its parameters filled in.

    Parameters
    ----------
    name : one of ATTACK_NAMES
    place : the folder that the attack may write to, see `fill_folder`
    port : the port of a server that knows the answer, see `serve_answer`
    """
    library = str(Path(hdrlab.__file__).parent)
    packages = site.getsitepackages()[0]
    parameters = f"PLACE, LIBRARY, SITE, PORT = {str(place)!r}, {library!r}, {packages!r}, {port}"
    source = (ATTACKS_FOLDER / f"{name}.py").read_text()
    return ALLOW_FORBIDDEN_ACTIONS + PARAMETERS_LINE.sub(lambda _: parameters, source)


def fill_folder(place):
    """Write the files that an attack looks for into a folder, writable for everybody; return it."""
    (place / "tests").mkdir()
    for name in ("solution.py", "other.py", "tests/test_double.py"):
        (place / name).write_text(HONEST_CODE)
    for folder in (place, place.parent, place / "tests"):
        folder.chmod(0o777)
    return place


def list_file_sizes(place):
    """Return the size of each file below a folder, and 0 for each folder."""
    return {str(path): path.stat().st_size if path.is_file() else 0 for path in place.rglob("*")}


@contextmanager
def adopt_orphans():
    """Become the parent of processes whose parents end, so that the test can find them."""
    libc = ctypes.CDLL(None)
    libc.prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    try:
        yield
    finally:
        libc.prctl(PR_SET_CHILD_SUBREAPER, 0, 0, 0, 0)


class _AnswerHandler(socketserver.BaseRequestHandler):
    """Send the correct answer."""

    def handle(self):
        self.request.sendall(b"2")


@contextmanager
def serve_answer():
    """Run a server on this machine that knows the answer, and yield its port."""
    with socketserver.ThreadingTCPServer(("127.0.0.1", 0), _AnswerHandler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield server.server_address[1]
        finally:
            server.shutdown()
            thread.join()
