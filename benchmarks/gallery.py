"""A class votes at once: voters in a second process, each on a connection of its own.

burst    every voter opens the wall, and then all send a ballot in the same instant
session  the voters come within ten seconds, open wall and pictures, vote, and change their ballots twice
slow     the same, while 1,300 clients hold half a request each, and come again when they are sent away
killed   the server is killed while ballots come in, and started again: what it acknowledged must be there

The figures are those of the client: from the first byte of a request to the last of its answer.
"""

import asyncio
import json
import os
import resource
import signal
import socket
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path
from random import Random
from typing import Any, NamedTuple
from urllib.parse import urlencode, urlsplit

import numpy as np

from benchmarks.experiments import Experiment, at_least, at_most
from benchmarks.measure import ROOT
from hdrlab.course.gallery import ballots, collect, store, tokens
from hdrlab.io import photos

VOTERS = 300
WITHIN = 10.0
TEAM = 2
PICTURES = 8
SLOW = 1300
KINDS = ("wall", "picture", "ballot")
OPEN_FOR = "2099-12-31T23:59+00:00"


class Voted(NamedTuple):
    """What the voters saw: seconds by kind of request, ballots acknowledged last and sent last, refusals."""

    seconds: dict[str, list[float]]
    last: dict[str, list[str]]
    sent: dict[str, list[str]]
    refused: int


class Connection:
    """One voter's connection, kept open, with the cookie that the gallery gives."""

    def __init__(self, address: str) -> None:
        self.parts = urlsplit(address)
        self.cookie = ""
        self.streams: tuple[asyncio.StreamReader, asyncio.StreamWriter] | None = None

    async def ask(
        self, method: str, path: str, body: bytes = b"", accept: str = "text/html"
    ) -> tuple[int, bytes]:
        """Return status and body of an answer; a connection that was closed meanwhile is made again."""
        fresh = self.streams is None
        try:
            return await self.exchange(method, path, body, accept)
        except (OSError, EOFError):
            if fresh:
                raise
            self.streams = None  # as a browser does
            return await self.exchange(method, path, body, accept)

    async def exchange(self, method: str, path: str, body: bytes, accept: str) -> tuple[int, bytes]:
        """Return status and body of an answer."""
        if self.streams is None:
            self.streams = await asyncio.open_connection(self.parts.hostname, self.parts.port)
        reader, writer = self.streams
        lines = [f"{method} {path} HTTP/1.1", f"Host: {self.parts.netloc}", f"Accept: {accept}"]
        if self.cookie:
            lines.append(f"Cookie: {self.cookie}")
        if method == "POST":
            lines += [
                f"Origin: {self.parts.scheme}://{self.parts.netloc}",
                f"Content-Length: {len(body)}",
            ]
            lines += ["Content-Type: application/x-www-form-urlencoded"]
        writer.write("\r\n".join([*lines, "", ""]).encode() + body)
        head = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1").split("\r\n")
        fields = {
            name.lower(): value for name, _, value in (line.partition(": ") for line in head[1:])
        }
        if "set-cookie" in fields:
            self.cookie = fields["set-cookie"].split(";")[0]
        return int(head[0].split()[1]), await reader.readexactly(
            int(fields.get("content-length", 0))
        )


def build(folder: Path, voters: int) -> tuple[Path, dict[str, str]]:
    """Make a gallery of teams of two, and return it with everybody's token."""
    room = folder / "gallery"
    rng = np.random.default_rng(1)
    store.create(room, "Spring", _when(), 3)
    picture = folder / "picture.png"
    with closing(store.connect(room)) as db:
        with store.transaction(db):
            for k in range(voters):
                store.admit(db, store.Voter(f"v{k}", f"Voter {k}", f"team{k // TEAM}"))
        for team in range(-(-voters // TEAM)):
            photos.write_picture(
                picture,
                np.kron(rng.integers(0, 256, (8, 12, 3), np.uint8), np.ones((20, 20, 1), np.uint8)),
            )
            collect.hang(
                db,
                room,
                collect.Entry(f"team{team}", f"View {team}", "A caption of a few words.", picture),
            )
        with store.transaction(db):
            links = {f"v{k}": tokens.new_link(db, f"v{k}") for k in range(voters)}
    return room, links


def _when() -> Any:
    from datetime import datetime

    return datetime.fromisoformat(OPEN_FOR)


def start(
    room: Path, port: int = 0, descriptors: int | None = None
) -> tuple[subprocess.Popen[bytes], str]:
    """Serve a gallery in a process of its own, and return it with its address when it answers.

    It has so many descriptors, and those of this process unless told.
    """
    if not port:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
    command = [sys.executable, "-m", "hdrlab", "gallery", "serve", str(room), "--port", str(port)]
    if descriptors is not None:
        command = ["sh", "-c", f'ulimit -n {descriptors}; exec "$@"', "sh", *command]
    server = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL)
    for _ in range(600):
        try:
            socket.create_connection(("127.0.0.1", port)).close()
            return server, f"http://127.0.0.1:{port}"
        except OSError:
            if server.poll() is not None:
                break
            time.sleep(0.05)
    server.kill()
    raise RuntimeError("the gallery did not start")


class Voter:
    """Somebody who comes, looks and votes; the seconds of it and the ballots go into `done`."""

    def __init__(self, address: str, who: str, token: str, done: Voted) -> None:
        self.connection = Connection(address)
        self.who = who
        self.token = token
        self.done = done
        self.refused = 0

    async def timed(self, kind: str, *request: Any) -> tuple[int, bytes]:
        """Return an answer, and note how long it took."""
        begun = time.perf_counter()
        answer = await self.connection.ask(*request)
        self.done.seconds[kind].append(time.perf_counter() - begun)
        return answer

    async def look(self) -> tuple[str, list[str]]:
        """Enter, open the wall and some pictures; return the key of ballots, and the marks of pictures."""
        await self.connection.ask("POST", f"/enter/{self.token}")
        _, page = await self.timed("wall", "GET", "/")
        text = page.decode()
        marks = [part[:24] for part in text.split('name="mark" value="')[1:]]
        for mark in marks[:PICTURES]:
            await self.timed("picture", "GET", f"/picture/{mark}/small")
        return text.split('name="key" value="')[1][:64], marks

    async def vote(self, key: str, chosen: list[str]) -> None:
        """Send a ballot, and note what became of it."""
        form = urlencode([("key", key), *(("mark", mark) for mark in chosen)]).encode()
        self.done.sent[self.who] = chosen
        status, _ = await self.timed("ballot", "POST", "/ballot", form, "application/json")
        if status == 200:
            self.done.last[self.who] = chosen
        self.refused += status != 200

    def leave(self) -> None:
        """Close the connection."""
        if self.connection.streams:
            self.connection.streams[1].close()


async def voted(
    address: str, links: dict[str, str], *, within: float, changes: int, together: bool
) -> Voted:
    """Let everybody vote, and return what they saw. A server that dies ends it."""
    random = Random(7)
    gate = asyncio.Barrier(len(links)) if together else None
    done = Voted({kind: [] for kind in KINDS}, {}, {}, 0)
    voters = [Voter(address, who, token, done) for who, token in links.items()]

    async def visit(voter: Voter, come: float) -> None:
        try:
            await asyncio.sleep(come)
            key, marks = await voter.look()
            for change in range(changes):
                if gate and not change:
                    await gate.wait()
                await voter.vote(key, sorted(marks[3 * change : 3 * change + 3]))
                if not gate:
                    await asyncio.sleep(random.uniform(0.2, 1.0))
        except (OSError, EOFError):
            return
        finally:
            voter.leave()

    await asyncio.gather(*(visit(voter, random.uniform(0, within)) for voter in voters))
    return done._replace(refused=sum(voter.refused for voter in voters))


def judged(room: Path, seen: Voted) -> dict[str, Any]:
    """Return what became of the ballots that were acknowledged, and how long requests took.

    A later ballot may stand there whose acknowledgement the kill cut off: it was written, so
    nothing is lost.
    """
    with closing(store.connect(room)) as db:
        kept = ballots.every(db)
        rows = db.execute("SELECT count(*) FROM ballots").fetchone()[0]
    lost = sum(
        kept.get(who) not in (frozenset(last), frozenset(seen.sent[who]))
        for who, last in seen.last.items()
    )
    figures: dict[str, Any] = {
        "ballots lost": lost,
        "ballots double": rows - len(kept),
        "refused": seen.refused,
    }
    for kind, seconds in seen.seconds.items():
        if seconds:
            figures[f"ms of a {kind}: median, 95 %, worst"] = 1e3 * np.quantile(
                seconds, (0.5, 0.95, 1)
            )
    return figures | {"voters": len(seen.last)}


def voters(address: str, links: str, within: str, changes: str, together: str) -> None:
    """Vote, in the second process: read the links, print what was seen as JSON."""
    read = json.loads(Path(links).read_text())
    seen = asyncio.run(
        voted(
            address,
            read,
            within=float(within),
            changes=int(changes),
            together=together == "together",
        )
    )
    sys.stdout.write(json.dumps(seen._asdict()) + "\n")


async def hold_half_requests(address: str, count: int) -> None:
    """Hold so many connections with half a request each; who is sent away comes again after a second."""
    parts = urlsplit(address)
    most = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))

    async def hold() -> None:
        while True:
            try:
                reader, writer = await asyncio.open_connection(parts.hostname, parts.port)
                writer.write(b"GET / HTTP/1.1\r\nHost: ")
                await reader.read()
                writer.close()
            except OSError:
                pass
            await asyncio.sleep(1)

    await asyncio.gather(*(hold() for _ in range(count)))


def load(
    folder: Path,
    how: str,
    count: int = VOTERS,
    *,
    within: float = WITHIN,
    changes: int = 3,
    slow: int = 0,
    descriptors: int | None = None,
) -> dict[str, Any]:
    """Return the figures of a class that votes, meanwhile so many clients hold half a request each."""
    room, links = build(folder / how, count)
    file = folder / how / "links.json"
    file.write_text(json.dumps(links))
    server, address = start(room, descriptors=descriptors)
    holding = None
    try:
        if slow:
            words = [sys.executable, "-m", "benchmarks.gallery", "hold", address, str(slow)]
            holding = subprocess.Popen(words, cwd=ROOT)
            _wait_for_connections(
                server, slow if descriptors is None else min(slow, descriptors // 5)
            )
        arguments = [address, str(file), str(within), str(changes), how]
        command = [sys.executable, "-m", "benchmarks.gallery", *arguments]
        ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
        if ran.returncode:
            raise RuntimeError(ran.stderr.strip()[-2000:])
    finally:
        for process in filter(None, (holding, server)):
            process.terminate()
            process.wait()
    log = sum(path.stat().st_size for path in room.glob("gallery.log*"))
    return judged(room, Voted(**json.loads(ran.stdout))) | {"bytes of log": log}


def _wait_for_connections(server: subprocess.Popen[bytes], count: int) -> None:
    """Wait until a server has so many descriptors open."""
    while server.poll() is None and len(list(Path(f"/proc/{server.pid}/fd").iterdir())) < count:
        time.sleep(0.02)


def killed(
    folder: Path, count: int = VOTERS, times: int = 5, *, after: float = 1.5
) -> dict[str, Any]:
    """Return how many acknowledged ballots were lost when the server was killed while they came in."""
    lost = 0
    acknowledged = 0
    for k in range(times):
        home = folder / f"killed{k}"
        room, links = build(home, count)
        (home / "links.json").write_text(json.dumps(links))
        server, address = start(room)
        arguments = [address, str(home / "links.json"), str(after), "20", "apart"]
        command = [sys.executable, "-m", "benchmarks.gallery", *arguments]
        client = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE)
        _wait_for_ballots(room, server, count // 2 + 7 * k)
        os.kill(server.pid, signal.SIGKILL)
        server.wait()
        seen = Voted(**json.loads(client.communicate()[0]))
        again, _ = start(room)
        again.terminate()
        again.wait()
        lost += int(judged(room, seen)["ballots lost"])
        acknowledged += len(seen.last)
    return {
        "acknowledged ballots lost": lost,
        "acknowledged before the kill": acknowledged,
        "kills": times,
    }


def _wait_for_ballots(room: Path, server: subprocess.Popen[bytes], count: int) -> None:
    with closing(store.connect(room)) as db:
        while server.poll() is None:
            if db.execute("SELECT count(*) FROM ballots").fetchone()[0] >= count:
                return
            time.sleep(0.01)


WHOLE = (
    at_most("ballots lost", 0),
    at_most("ballots double", 0),
    at_most("refused", 0),
    at_least("voters", VOTERS),
)
QUICK = at_most("ms of a ballot: median, 95 %, worst", np.inf, 200, np.inf)
UNDER_ATTACK = (
    *(at_most(f"ms of a {kind}: median, 95 %, worst", np.inf, 500, np.inf) for kind in KINDS),
    at_most("bytes of log", 3_000_000),
)
ROWS = (
    Experiment(
        "session",
        f"{VOTERS} voters within {WITHIN:g} s, who change their ballots twice",
        lambda f: load(f, "apart"),
        (*WHOLE, QUICK),
    ),
    Experiment(
        "burst",
        f"{VOTERS} voters who send a ballot in the same instant",
        lambda f: load(f, "together", within=3, changes=1),
        WHOLE,  # ballots of one instant wait for each other; what is held is that none is lost
    ),
    Experiment(
        "slow",
        f"{VOTERS} voters within {WITHIN:g} s, while {SLOW:,} clients hold half a request; 1,024 descriptors",
        lambda f: load(f / "slow", "apart", slow=SLOW, descriptors=1024),
        (*WHOLE, *UNDER_ATTACK),
    ),
    Experiment(
        "killed",
        "the server is killed while ballots come in",
        killed,
        (at_most("acknowledged ballots lost", 0), at_least("acknowledged before the kill", VOTERS)),
    ),
)

if __name__ == "__main__":
    if sys.argv[1] == "hold":
        asyncio.run(hold_half_requests(sys.argv[2], int(sys.argv[3])))
    else:
        voters(*sys.argv[1:])
