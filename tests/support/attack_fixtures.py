"""What the tests of attacks share: the attacks made ready, a place for them to look around in, and an oracle.

The attacks are files in tests/attacks. A file's name begins with its number in the list of attacks,
1 to 26, and what it does is harmless: it writes to no place but the one it is told, or where only a
sandbox has one.
"""

import ctypes
import re
import site
import socketserver
import threading
from contextlib import contextmanager
from pathlib import Path

import hdrlab

HERE = Path(__file__).parents[1] / "attacks"
NAMES = sorted(path.stem for path in HERE.glob("a*.py"))
HONEST = "def double(x):\n    return 2 * x\n"
# past Python's own refusals
IMPOLITE = "import sys; getattr(sys.modules.get('worker'), 'FORBIDDEN_ACTIONS', {}).clear()\n"


def armed(name, place, port):
    """Return an attack's source, told where things are, past what Python itself refuses."""
    library, packages = str(Path(hdrlab.__file__).parent), site.getsitepackages()[0]
    told = f"PLACE, LIBRARY, SITE, PORT = {str(place)!r}, {library!r}, {packages!r}, {port}"
    text = (HERE / f"{name}.py").read_text()
    return IMPOLITE + re.sub(r"^[A-Z = ]+ = (\"\"|0)$", lambda _: told, text, flags=re.MULTILINE)


def furnish(place):
    """Fill a folder with what an attack might look for, open to everybody, and return it."""
    (place / "tests").mkdir()
    for name in ("solution.py", "other.py", "tests/test_double.py"):
        (place / name).write_text(HONEST)
    for folder in (place, place.parent, place / "tests"):
        folder.chmod(0o777)
    return place


def listing(place):
    """Return all files of a folder, with their sizes."""
    return {str(path): path.stat().st_size if path.is_file() else 0 for path in place.rglob("*")}


@contextmanager
def adopting():
    """Make what loses its parent a child of this process, so that it is seen."""
    libc = ctypes.CDLL(None)
    libc.prctl(36, 1, 0, 0, 0)
    try:
        yield
    finally:
        libc.prctl(36, 0, 0, 0, 0)


class _Oracle(socketserver.BaseRequestHandler):
    """A server that knows the answer."""

    def handle(self):
        self.request.sendall(b"2")


@contextmanager
def oracle():
    """Yield the port of a server of this machine that knows the answer."""
    with socketserver.ThreadingTCPServer(("127.0.0.1", 0), _Oracle) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield server.server_address[1]
        finally:
            server.shutdown()
            thread.join()
