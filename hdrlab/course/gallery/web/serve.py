"""The gallery's server: one process, with limits on headers, connections, patience and its log.

A connection that has not sent a whole request waits in a line, the oldest first. It is closed when
its time is over, or when there are too many and it is the first in the line: a voter's request is
whole within milliseconds, so those go that only hold a place. Half a request costs a descriptor for
some seconds.
"""

import asyncio
import logging
import os
import time
import tomllib
from logging.handlers import RotatingFileHandler
from pathlib import Path
from typing import Any

import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol

from hdrlab.course.gallery.web.app import Gallery, application
from hdrlab.course.sandbox.inside.system import resource
from hdrlab.errors import InputError

SERVER: dict[str, Any] = tomllib.loads(Path(__file__).with_name("server.toml").read_text("utf8"))
CONNECTIONS = 2000
# connections that the system hands over together, before the first of them can be refused
BACKLOG = 256
# descriptors for the database, pictures, the log, and whatever libraries open
FILES = 64
# seconds for a request's head to arrive, and between two requests of a connection
PATIENCE = 10.0
# seconds for an answer to be taken
ANSWER = 60.0
LOG = "gallery.log"
# bytes of the log, and how many older ones are kept
LOG_SIZE = 1_000_000
LOGS = 2
# seconds between two lines of the log that say the gallery is full
WORD = 60.0
log = logging.getLogger("hdrlab.gallery")


class Limited(H11Protocol):
    """A connection that is closed where its request, or taking the answer, lasts too long; see `limited`.

    Attributes
    ----------
    most : connections at a time
    silent, idle : those that have sent no whole request yet, and those between two requests; oldest
        first
    """

    most: int
    silent: "dict[Limited, None]"
    idle: "dict[Limited, None]"
    said_full = -WORD

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin to wait for a request; where there are too many, the first in the line is closed."""
        super().connection_made(transport)
        self.timer = self.loop.call_later(PATIENCE, self.end)
        self.silent[self] = None
        if len(self.connections) > self.most:
            self._say_full()
            next(iter(self.idle if self.idle and len(self.silent) == 1 else self.silent)).end()

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget the connection."""
        super().connection_lost(exc)
        self._leave_line()

    def handle_events(self) -> None:
        """Take what has come. A request leaves the line; a form has its own patience for its body."""
        before = self.cycle
        super().handle_events()
        if self.cycle is not before and not self.cycle.response_complete:
            self._leave_line()
            self.timer = self.loop.call_later(ANSWER, self.end)

    def on_response_complete(self) -> None:
        """Wait for the next request, or for the rest of the answer to be taken."""
        self._leave_line()
        taken = self.transport.is_closing() or not self.transport.get_write_buffer_size()
        self.timer = self.loop.call_later(PATIENCE if taken else ANSWER, self.end)
        self.idle[self] = None
        super().on_response_complete()

    def end(self) -> None:
        """Close the connection, whatever is half sent."""
        self._leave_line()
        self.transport.abort()

    def _leave_line(self) -> None:
        self.timer.cancel()
        self.silent.pop(self, None)
        self.idle.pop(self, None)

    def _say_full(self) -> None:
        kind = type(self)
        if time.monotonic() - kind.said_full >= WORD:
            kind.said_full = time.monotonic()
            log.warning(
                "full: %d connections; the oldest without a whole request is closed", self.most
            )


def limited(most: int) -> type[Limited]:
    """Return the protocol of a server with so many connections at a time."""
    return type("Limited", (Limited,), {"most": most, "silent": {}, "idle": {}})


def serve(folder: str | Path, address: str, *, host: str, port: int, behind_proxy: bool) -> None:
    """Serve the gallery until Ctrl-C.

    Nothing is logged of requests: a personal link is an address, and what is not written down
    cannot leak. What a proxy says of its clients is believed where there is one, on this machine,
    and not otherwise.
    """
    os.umask(0o077)
    keep_log(Path(folder))
    h11 = limited(connection_limit())  # which is strict about headers, and bounds them
    own: dict[str, Any] = {
        "host": host,
        "port": port,
        "proxy_headers": behind_proxy,
        "backlog": BACKLOG,
    }
    app = application(Gallery(folder, address))
    config = uvicorn.Config(
        app, http=h11, log_config=None, timeout_keep_alive=int(PATIENCE), **own, **SERVER
    )
    uvicorn.Server(config).run()


def keep_log(folder: Path) -> None:
    """Write what is logged from now on into the folder, in a few files of bounded size."""
    handler = RotatingFileHandler(
        folder / LOG, maxBytes=LOG_SIZE, backupCount=LOGS, encoding="utf8"
    )
    logging.basicConfig(
        handlers=[handler], format="%(asctime)s %(levelname)s %(message)s", force=True
    )


def connection_limit() -> int:
    """Return how many connections the descriptors of this process bear, which are made more if they can be.

    Raises
    ------
    ValueError
        Where there are too few for any.
    """
    if resource is None:  # on Windows there is no such limit
        return CONNECTIONS
    around = BACKLOG + FILES
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft != resource.RLIM_INFINITY and soft < CONNECTIONS + around:
        wanted = CONNECTIONS + around
        soft = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    most = CONNECTIONS if soft == resource.RLIM_INFINITY else min(CONNECTIONS, soft - around)
    if most < 1:
        raise InputError(
            f"expected more than {around} open files, got a limit of {soft}: ulimit -n 4096"
        )
    return most
