"""Serve the gallery in one process, with limits on headers, connections, time and its log.

Connections that have not sent a whole request wait in a queue, the oldest first. One is closed when
its time is over, or when there are too many connections and it is the first in the queue. A voter's
request is complete within milliseconds, so this closes connections that only occupy a place. Half a
request costs a file descriptor for some seconds.
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

UVICORN_OPTIONS: dict[str, Any] = tomllib.loads(
    Path(__file__).with_name("server.toml").read_text("utf8")
)
MAX_CONNECTIONS = 2000
# connections that the system hands over together, before the first of them can be refused
BACKLOG_CONNECTIONS = 256
# descriptors for the database, pictures, the log, and files that libraries open
OTHER_DESCRIPTORS = 64
# for a request's head to arrive, and between two requests of a connection
REQUEST_TIMEOUT_SECONDS = 10.0
# for the client to take an answer
ANSWER_TIMEOUT_SECONDS = 60.0
LOG_FILE = "gallery.log"
MAX_LOG_BYTES = 1_000_000
KEPT_OLD_LOGS = 2
# between two lines of the log that say that the gallery is full
FULL_WARNING_SECONDS = 60.0
# files that this process writes are readable by their owner only
UMASK = 0o077
log = logging.getLogger("hdrlab.gallery")


class LimitedProtocol(H11Protocol):
    """A connection that is closed if its request, or taking the answer, takes too long.

    Attributes
    ----------
    max_connections : number of connections at a time
    silent : connections that have sent no whole request yet, the oldest first
    idle : connections between two requests, the oldest first
    full_warning_at : when the log last said that the gallery is full
    """

    max_connections: int
    # dictionaries serve as ordered sets
    silent: "dict[LimitedProtocol, None]"
    idle: "dict[LimitedProtocol, None]"
    full_warning_at = -FULL_WARNING_SECONDS

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Wait for a request; if there are too many connections, close the first in the queue."""
        super().connection_made(transport)
        self.timer = self.loop.call_later(REQUEST_TIMEOUT_SECONDS, self.end)
        self.silent[self] = None
        if len(self.connections) > self.max_connections:
            self._warn_full()
            # an idle connection is closed if the only silent one is this new one
            queue = self.idle if self.idle and len(self.silent) == 1 else self.silent
            oldest = next(iter(queue))
            oldest.end()

    def connection_lost(self, exc: Exception | None) -> None:
        """Remove the connection from the queues."""
        super().connection_lost(exc)
        self._leave_queues()

    def handle_events(self) -> None:
        """Handle received data; a connection with a whole head leaves the queue.

        The body of a form has its own timeout.
        """
        before = self.cycle
        super().handle_events()
        if self.cycle is not before and not self.cycle.response_complete:
            self._leave_queues()
            self.timer = self.loop.call_later(ANSWER_TIMEOUT_SECONDS, self.end)

    def on_response_complete(self) -> None:
        """Wait for the next request, or for the client to take the rest of the answer."""
        self._leave_queues()
        is_taken = self.transport.is_closing() or not self.transport.get_write_buffer_size()
        timeout = REQUEST_TIMEOUT_SECONDS if is_taken else ANSWER_TIMEOUT_SECONDS
        self.timer = self.loop.call_later(timeout, self.end)
        self.idle[self] = None
        super().on_response_complete()

    def end(self) -> None:
        """Close the connection at once, even in the middle of a request or an answer."""
        self._leave_queues()
        self.transport.abort()

    def _leave_queues(self) -> None:
        """Stop the timer, and wait for nothing."""
        self.timer.cancel()
        self.silent.pop(self, None)
        self.idle.pop(self, None)

    def _warn_full(self) -> None:
        """Log that there are too many connections, unless the log said so shortly before."""
        protocol = type(self)  # one for the whole server
        now = time.monotonic()
        if now - protocol.full_warning_at < FULL_WARNING_SECONDS:
            return
        protocol.full_warning_at = now
        log.warning(
            "full: %d connections; the oldest without a whole request is closed",
            self.max_connections,
        )


def limited(max_connections: int) -> type[LimitedProtocol]:
    """Return a protocol class with its own queues, for a server with so many connections."""

    class ServerProtocol(LimitedProtocol):
        pass

    ServerProtocol.max_connections = max_connections
    ServerProtocol.silent = {}
    ServerProtocol.idle = {}
    return ServerProtocol


def serve(folder: str | Path, address: str, *, host: str, port: int, behind_proxy: bool) -> None:
    """Serve the gallery until Ctrl-C.

    The log contains no requests, because a personal link is an address that must not leak.

    Parameters
    ----------
    folder : folder of the gallery
    address : the address that voters use, such as https://vote.example.edu
    host, port : where the server listens
    behind_proxy : whether a proxy on this machine states the clients' addresses
    """
    os.umask(UMASK)
    keep_log(Path(folder))
    config = uvicorn.Config(
        application(Gallery(folder, address)),
        host=host,
        port=port,
        # h11 is strict about headers, and limits their size
        http=limited(connection_limit()),
        proxy_headers=behind_proxy,
        backlog=BACKLOG_CONNECTIONS,
        timeout_keep_alive=int(REQUEST_TIMEOUT_SECONDS),
        log_config=None,
        **UVICORN_OPTIONS,
    )
    uvicorn.Server(config).run()


def keep_log(folder: Path) -> None:
    """Write the log into the folder, in a few files of limited size."""
    handler = RotatingFileHandler(
        folder / LOG_FILE, maxBytes=MAX_LOG_BYTES, backupCount=KEPT_OLD_LOGS, encoding="utf8"
    )
    logging.basicConfig(
        handlers=[handler], format="%(asctime)s %(levelname)s %(message)s", force=True
    )


def connection_limit() -> int:
    """Return how many connections this process can have, after raising its limit of open files.

    Raises
    ------
    InputError
        If the system allows too few open files for any connection.
    """
    if resource is None:  # Windows has no such limit
        return MAX_CONNECTIONS
    reserved = BACKLOG_CONNECTIONS + OTHER_DESCRIPTORS
    wanted = MAX_CONNECTIONS + reserved
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        soft = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    if soft == resource.RLIM_INFINITY:
        return MAX_CONNECTIONS
    connections = min(MAX_CONNECTIONS, soft - reserved)
    if connections < 1:
        raise InputError(
            f"expected more than {reserved} open files, got a limit of {soft}; run `ulimit -n 4096`"
        )
    return connections
