"""Attacks on the gallery: a test for each row of the table in hdrlab.course.gallery.

The tests send requests as a program does, byte by byte where this matters.
"""

import asyncio
import io
import json
import logging
import os
import re
import socket
import sqlite3
import struct
import threading
import time
import zipfile
import zlib
from contextlib import closing, contextmanager
from html.parser import HTMLParser
from importlib.util import find_spec
from urllib.parse import quote, urlencode

import pytest
from PIL import Image
from support import small_gallery as small

if find_spec("starlette") is None or find_spec("uvicorn") is None:
    pytest.skip('the gallery needs pip install ".[class]"', allow_module_level=True)

from hdrlab.course import gallery
from hdrlab.course.gallery import ballots, collect, pictures, store, tokens
from hdrlab.course.gallery.web import app, guard, serve
from hdrlab.course.gallery.web.writer import Writer
from hdrlab.course.students import csv_tables
from hdrlab.course.students.roster import Roster, Student

pytestmark = pytest.mark.grading

ORIGIN = {"origin": small.ADDRESS}
ROSTER = Roster(
    tuple(
        Student(student, student.title(), team)
        for team, students in small.TEAMS.items()
        for student in students
    )
)


@pytest.fixture
def room(tmp_path):
    return small.make_gallery(tmp_path)


@contextmanager
def browser(room, address=small.ADDRESS):
    """Yield a browser connected to the gallery."""
    pages = app.Gallery(room.folder, address, room.clock)
    yield small.Browser(app.application(pages), address)
    asyncio.run(pages.close())


@pytest.fixture
def client(room):
    with browser(room) as test_browser:
        yield test_browser


def enter(client, room, who):
    """Sign a voter in, and return the key of their form."""
    client.cookies.clear()
    answer = client.post(f"/enter/{room.links[who]}", headers=ORIGIN)
    assert answer.status == 303
    return small.form_key(client.get("/").text) if room.clock() < small.CLOSES.timestamp() else ""


def vote(client, key, *marks, **headers):
    return client.post("/ballot", {"key": key, "mark": marks}, headers=ORIGIN | headers)


def saved(room, who):
    from hdrlab.course.gallery import ballots

    with closing(store.connect(room.folder)) as db:
        return ballots.every(db).get(who)


def test_every_row_of_the_table_has_its_test():
    rows = re.findall(r"^(\S.{20}) +\S.*  (\w+)$", gallery.__doc__, re.M)
    named = [test for attack, test in rows if attack.strip() != "attack"]
    assert len(named) >= 30
    assert [name for name in named if f"test_{name}" not in globals()] == []


# who one is


def test_a_forged_link(client, room):
    link = room.links["ann"]
    other = "A" if link[-1] != "A" else "B"
    for forged in (
        link[:12] + "x" * 43,
        link[:-1] + other,
        room.links["ben"][:12] + link[12:],
        "",
        "x" * 55,
    ):
        assert client.get(f"/enter/{forged}").status == 404
        assert client.post(f"/enter/{forged}", headers=ORIGIN).status == 404
    assert client.cookies == {}


def test_guessed_links(client, room):
    tries = [client.get(f"/enter/{k:055d}").status for k in range(60)]
    assert tries[:30] == [404] * 30 and set(tries[35:]) == {429}
    enter(client, room, "ann")  # the class behind the same address is not locked out


def test_a_replayed_link(client, room):
    enter(client, room, "ann")
    assert client.get(f"/enter/{room.links['ann']}").status == 303  # the own browser is led on
    client.cookies.clear()
    for ask in (client.get, client.post):
        assert ask(f"/enter/{room.links['ann']}", headers=ORIGIN).status == 404
    assert "gallery" not in client.cookies


def test_a_link_read_ahead(client, room):
    for _ in range(3):
        assert client.get(f"/enter/{room.links['ann']}").status == 200
        assert client.ask("HEAD", f"/enter/{room.links['ann']}").status == 200
    assert client.post(f"/enter/{room.links['ann']}").status == 403  # without the origin of a form
    enter(client, room, "ann")


def test_a_link_that_leaks(client, room, capfd):
    page = client.get(f"/enter/{room.links['ann']}")
    assert page.headers["referrer-policy"] == "same-origin"
    assert page.headers["cache-control"] == "no-store"
    # nothing on it is fetched elsewhere
    assert not re.findall(r'(?:src|href|action)="(?!/)', page.text)
    assert room.links["ann"] not in "".join(capfd.readouterr())
    assert serve.UVICORN_OPTIONS["access_log"] is False


def test_a_stolen_database(client, room):
    enter(client, room, "ann")
    session = client.cookies["gallery"]
    kept = b"".join(path.read_bytes() for path in room.folder.glob("gallery.sqlite*"))
    for token in (session, *room.links.values()):
        assert token[12:].encode() not in kept
    assert (room.folder / "gallery.sqlite").stat().st_mode & 0o077 == 0


def test_a_forged_session(client, room):
    enter(client, room, "ann")
    session = client.cookies["gallery"]
    for forged in (session[:12] + "x" * 43, room.links["ben"], "", "x" * 5000, "a\x00b"):
        client.cookies.clear()
        assert client.get("/", headers={"cookie": f"gallery={forged}"}).status in (401, 429)
    with store.writing(room.folder) as db:
        tokens.new_link(db, "ann")
    assert client.get("/", headers={"cookie": f"gallery={session}"}).status == 401


# ballots


def test_a_vote_for_the_own_team(client, room):
    key = enter(client, room, "ann")
    answer = vote(client, key, room.artifacts["team1"], room.artifacts["team2"])
    assert answer.status == 409 and "own team" in answer.text
    assert saved(room, "ann") is None
    assert room.artifacts["team1"] not in re.findall(
        r'name="mark" value="(\w+)"', client.get("/").text
    )


def test_a_second_ballot(client, room):
    key = enter(client, room, "ann")
    for team in ("team2", "eve", "fay"):
        assert vote(client, key, room.artifacts[team]).status == 303
    assert saved(room, "ann") == {room.artifacts["fay"]}
    with store.writing(room.folder) as db, pytest.raises(sqlite3.IntegrityError):
        db.execute("INSERT INTO ballots VALUES ('ann', 0)")


def test_too_many_votes(client, room):
    key = enter(client, room, "ann")
    others = [room.artifacts[team] for team in ("team2", "eve", "fay")]
    assert vote(client, key, *others).status == 409
    assert vote(client, key, *others[:1] * 40).status == 303  # one artifact many times is one vote
    assert saved(room, "ann") == set(others[:1])


def test_a_vote_for_no_artifact(client, room):
    key = enter(client, room, "ann")
    for mark in ("0" * 24, "", "ann", room.artifacts["eve"].upper(), "%00"):
        assert vote(client, key, room.artifacts["eve"], mark).status == 409
    assert saved(room, "ann") is None


def test_a_late_ballot(client, room):
    key = enter(client, room, "ann")
    assert vote(client, key, room.artifacts["eve"]).status == 303
    room.clock.now = small.CLOSES.timestamp()
    for claimed in ({}, {"date": "Tue, 01 Dec 2026 12:00:00 GMT"}):
        assert vote(client, key, room.artifacts["fay"], **claimed).status == 409
    assert saved(room, "ann") == {room.artifacts["eve"]}
    room.clock.now = small.START.timestamp()
    with store.writing(room.folder) as db:
        store.close(db, small.START)  # from another process, while the gallery is served
    assert vote(client, key, room.artifacts["fay"]).status == 409


def test_the_ballots_of_others(client, room):
    vote(client, enter(client, room, "ann"), room.artifacts["eve"], room.artifacts["fay"])
    before = {who: [] for who in ("cy", "eve")}
    for who in before:
        enter(client, room, who)
        pages = [client.get(path).text for path in ("/", f"/look/{room.artifacts['eve']}")]
        assert "checked" not in pages[0] and "No vote yet" in pages[0]
        # not even who hung what, while it is open
        assert all("ann" not in page.lower() for page in pages)


def test_results_before_the_end(client, room):
    vote(client, enter(client, room, "ann"), room.artifacts["eve"])
    assert client.get("/results").status == 403
    room.clock.now = small.CLOSES.timestamp() + 1
    assert client.get("/results").status == 200
    client.cookies.clear()
    assert client.get("/results").status == 401


# what students write and draw

SCRIPT = """"><script>alert(1)</script><img src=x onerror=alert(2)>{{7*7}}'"""


class Reader(HTMLParser):
    """The attributes and scripts of a page as a browser parses them, including the gallery's own."""

    def __init__(self):
        super().__init__()
        self.attributes = []
        self.scripts = []

    def handle_starttag(self, tag, attrs):
        self.attributes += [name for name, _ in attrs]
        if tag == "script":
            self.scripts.append(dict(attrs))


def test_script_in_a_name(tmp_path):
    room = small.make_gallery(tmp_path, names={"ann": SCRIPT})
    room.clock.now = small.CLOSES.timestamp() + 1
    with browser(room) as client:
        enter(client, room, "cy")
        page = client.get("/results")
    assert "&lt;script&gt;alert(1)" in page.text
    assert "<script>alert" not in page.text
    assert "{{7*7}}" in page.text
    assert "<img src=x" not in page.text
    policy = page.headers["content-security-policy"]
    assert "default-src 'none'" in policy and "unsafe" not in policy and "*" not in policy


def test_script_in_a_title(tmp_path):
    room = small.make_gallery(
        tmp_path, title=SCRIPT.replace("{", "{{").replace("}", "}}"), caption=SCRIPT
    )
    with browser(room) as client:
        enter(client, room, "cy")
        for path, script in (("/", "wall.js"), (f"/look/{room.artifacts['eve']}", "look.js")):
            page = client.get(path).text
            assert "<script>alert" not in page and "onerror=alert(2)>" not in page
            reader = Reader()
            reader.feed(page)
            assert not [
                name for name in reader.attributes if name == "style" or name.startswith("on")
            ]
            assert reader.scripts == [{"src": f"/static/{script}", "defer": None}]
    words = tmp_path / "team1.txt"
    words.write_text("A\u202etitle\x1b[2J \u0000\n" + "caption " * 100, encoding="utf8")
    with collect.entry(tmp_path / "team1.png", ROSTER) as entry:
        assert entry.title == "Atitle" and len(entry.caption) <= collect.MAX_CAPTION_CHARACTERS


def test_svg_as_an_artifact(tmp_path):
    svg = b'<svg xmlns="http://www.w3.org/2000/svg"><script>alert(1)</script></svg>'
    for name in ("team1.svg", "team1.png", "team1.jpg"):
        (tmp_path / name).write_bytes(svg)
        with pytest.raises(ValueError, match="photograph"):
            pictures.prepare(tmp_path / name)


def test_exif_of_an_artifact(tmp_path):
    exif = Image.Exif()
    exif[0x010E] = "<script>alert(1)</script>"
    exif.get_ifd(0x8825)[2] = (48.0, 51.0, 29.0)
    Image.new("RGB", (90, 60), "teal").save(tmp_path / "a.jpg", exif=exif, comment=b"<script>")
    for data in pictures.prepare(tmp_path / "a.jpg").files.values():
        assert b"script" not in data and b"EXIF" not in data and b"Exif" not in data


def test_a_polyglot(tmp_path):
    data = io.BytesIO()
    Image.new("RGB", (90, 60), "teal").save(data, "JPEG")
    page = b"<!DOCTYPE html><script>alert(1)</script>" + b"PK\3\4" + b"%PDF-1.7"
    (tmp_path / "a.jpg").write_bytes(data.getvalue() + page)
    for made in pictures.prepare(tmp_path / "a.jpg").files.values():
        assert made[:4] == b"RIFF" and made[8:12] == b"WEBP"
        assert not any(part in made for part in (b"<script", b"PK\3\4", b"%PDF"))


def test_a_decompression_bomb(tmp_path):
    def png(width, height, rows):
        chunks = [
            (b"IHDR", struct.pack(">LLBBBBB", width, height, 8, 2, 0, 0, 0)),
            (b"IDAT", rows),
            (b"IEND", b""),
        ]
        body = [
            struct.pack(">L", len(d)) + k + d + struct.pack(">L", zlib.crc32(k + d))
            for k, d in chunks
        ]
        return b"\x89PNG\r\n\x1a\n" + b"".join(body)

    for width, height in ((30_000, 30_000), (2**31 - 1, 2**31 - 1), (60_000, 2_000)):
        (tmp_path / "a.png").write_bytes(png(width, height, zlib.compress(bytes(10_000_000))))
        with pytest.raises(ValueError, match="claims"):
            pictures.prepare(tmp_path / "a.png")


def test_a_link_as_an_artifact(tmp_path):
    small.write_photo(tmp_path / "secret.png")
    (tmp_path / "team1.png").symlink_to(tmp_path / "secret.png")
    with pytest.raises(ValueError, match="plain file"):
        pictures.prepare(tmp_path / "team1.png")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
@pytest.mark.parametrize("kind", ["link", "pipe"])
@pytest.mark.parametrize("ending", [".png", ".zip"])
def test_links_and_pipes_are_refused_before_they_are_opened(tmp_path, kind, ending):
    odd = tmp_path / f"ann{ending}"
    os.mkfifo(odd) if kind == "pipe" else odd.symlink_to(handed_in(tmp_path / "other.zip"))
    with pytest.raises(ValueError, match="plain file"), collect.entry(odd, ROSTER):
        pass


def test_only_the_start_of_a_caption_file_is_read_and_links_are_not_followed(tmp_path):
    small.write_photo(tmp_path / "ann.png")
    with open(tmp_path / "ann.txt", "w") as file:
        file.write("Dusk\nSeven frames.")
        file.truncate(1 << 40)  # bytes, none of which the disk holds
    with collect.entry(tmp_path / "ann.png", ROSTER) as entry:
        assert (entry.title, entry.caption) == ("Dusk", "Seven frames.")
    (tmp_path / "secret").write_text("A secret")
    (tmp_path / "ann.txt").unlink()
    (tmp_path / "ann.txt").symlink_to(tmp_path / "secret")
    with collect.entry(tmp_path / "ann.png", ROSTER) as entry:
        assert entry.title == "Untitled"


def handed_in(path, students=("ann",), title="t"):
    """Write an archive as `hdrlab submit` does, with any description."""
    small.write_photo(path.with_suffix(".png"), 11)
    settings = {"students": students, "title": title, "caption": "", "artifact": "a.png"}
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("submission.json", json.dumps(settings))
        archive.write(path.with_suffix(".png"), "a.png")
    path.with_suffix(".png").unlink()
    return path


@pytest.mark.parametrize("students", [["ann"], ["eve", "ann"], ["team1"], [], "ann", ["nobody"]])
@pytest.mark.parametrize(
    "name", ["eve.zip", "eve_project.zip", "eve/ann.zip", "eve/team1.zip", "EVE-ann.zip"]
)
def test_anothers_artifact(tmp_path, students, name):
    room = small.make_gallery(tmp_path)
    folder = tmp_path / "in"
    (folder / name).parent.mkdir(parents=True)
    handed_in(folder / name, students)
    with closing(store.connect(room.folder)) as db:
        before = store.artifacts(db)
        for path, owner in collect.sources([folder]):
            with collect.entry(path, ROSTER, owner) as entry:
                assert entry.team == "eve"
                collect.hang(db, room.folder, entry)
        assert {
            id: artifact for id, artifact in store.artifacts(db).items() if artifact.team != "eve"
        } == {id: artifact for id, artifact in before.items() if artifact.team != "eve"}


@pytest.mark.parametrize(
    "name", ["submission.zip", "nobody/submission.zip", "anne.zip", "project_ann.zip"]
)
def test_an_artifact_without_an_owner_in_the_roster_is_refused(tmp_path, name):
    (tmp_path / "in" / name).parent.mkdir(parents=True)
    handed_in(tmp_path / "in" / name)
    ((path, owner),) = collect.sources([tmp_path / "in"])
    with (
        pytest.raises(ValueError, match="named .*student .*team"),
        collect.entry(path, ROSTER, owner),
    ):
        pass


def ask_pair(client):
    """Return the two artifacts that the page asks about."""
    return re.findall(r'name="of" value="(\w+)"', client.get("/").text)


def judge_pair(client, key, pair, winner, **headers):
    form = {"key": key, "of": pair, "winner": winner}
    return client.post("/pair", form, headers=ORIGIN | headers)


def answers(room):
    with closing(store.connect(room.folder)) as db:
        return db.execute("SELECT voter, first, second, winner FROM comparisons").fetchall()


def test_a_pair_of_ones_choice(tmp_path):
    room = small.make_gallery(tmp_path, pairs=2)
    with browser(room) as client:
        key = enter(client, room, "ann")
        asked = ask_pair(client)
        other = (set(room.artifacts.values()) - {*asked, room.artifacts["team1"]}).pop()
        refused = [
            ([asked[0], other], other),
            ([asked[0], room.artifacts["team1"]], room.artifacts["team1"]),
            ([asked[0], asked[0]], asked[0]),
            ([asked[0]], asked[0]),
            (asked, other),
            (asked, ""),
            ([asked[0], "nothing"], asked[0]),
            ([*asked, other], other),
        ]
        for pair, winner in refused:
            assert judge_pair(client, key, pair, winner).status == 409
        assert vote(client, key, asked[0]).status == 409
        assert judge_pair(client, "0" * 64, asked, asked[0]).status == 403
        assert judge_pair(client, key, asked, asked[0], origin="http://evil.test").status == 403
        assert answers(room) == []
        for _ in range(2):
            pair = ask_pair(client)
            assert judge_pair(client, key, pair, pair[0]).status == 303
        assert ask_pair(client) == []
        first, second = sorted((asked[0], other))
        rows = [
            ("ann", first, second),  # a third pair
            ("ben", *sorted((asked[0], room.artifacts["team1"]))),  # of the own team
        ]
        for voter, first, second in rows:
            with pytest.raises(sqlite3.IntegrityError), store.writing(room.folder) as db:
                db.execute(
                    "INSERT INTO comparisons VALUES (?, ?, ?, ?, 0)", (voter, first, second, first)
                )
        room.clock.now = small.CLOSES.timestamp()
        assert judge_pair(client, key, asked, asked[1]).status == 409
        assert len(answers(room)) == 2


def test_a_second_answer(tmp_path):
    room = small.make_gallery(tmp_path, pairs=1)
    with browser(room) as client:
        key = enter(client, room, "ann")
        pair = ask_pair(client)
        for winner in (pair[0], pair[0], pair[1]):
            assert judge_pair(client, key, pair[::-1], winner).status == 303
        assert answers(room) == [("ann", *sorted(pair), pair[1])]


def test_votes_erased(client, room, tmp_path):
    eve = room.artifacts["eve"]
    fay = room.artifacts["fay"]
    vote(client, enter(client, room, "ann"), eve)
    vote(client, enter(client, room, "cy"), eve, fay)
    with closing(store.connect(room.folder)) as db:
        other = small.write_photo(tmp_path / "other.png", 12)
        lost = collect.hang(db, room.folder, collect.Entry("eve", "Other", "", other), "eve.zip")
        assert lost == 2 and len(store.artifacts(db)) == 4
        rows = {row[0]: row for row in ballots.gradebook(db)}
        assert rows["eve"][4:6] == ("Other", 0) and rows["fay"][5] == 1
        assert rows["ann"][3] == rows["cy"][3] == "yes"  # who voted has voted
        assert db.execute("SELECT count(*) FROM votes").fetchone()[0] == 3
        assert "eve has hung another picture (eve.zip); 2 votes" in store.changes(db)[0]
        # it hangs no longer
        assert vote(client, small.form_key(client.get("/").text), eve).status == 409
        first = collect.Entry("eve", "Again", "", tmp_path / "eve.png")
        # the picture of before is back, and so are its votes
        assert collect.hang(db, room.folder, first) == 0
        assert {row[0]: row for row in ballots.gradebook(db)}["eve"][4:6] == ("Again", 2)
        assert len(store.changes(db)) == 2


def test_an_archive_with_traps(tmp_path):
    small.write_photo(tmp_path / "a.png")
    settings = {"students": ["ann"], "title": "t", "caption": "", "artifact": "../a.png"}
    with zipfile.ZipFile(tmp_path / "one.zip", "w") as archive:
        archive.writestr("submission.json", json.dumps(settings))
    with zipfile.ZipFile(tmp_path / "two.zip", "w") as archive:
        archive.writestr("../planted.png", b"x")
    for name in ("one.zip", "two.zip"):
        entry = collect.entry(tmp_path / name, ROSTER, "ann")
        with pytest.raises(ValueError, match="artifact|leads out"), entry:
            pass
    assert not (tmp_path.parent / "planted.png").exists()


# requests


def test_path_traversal(client, room):
    enter(client, room, "ann")
    good = room.artifacts["eve"]
    assert client.get(f"/picture/{good}/small").headers["content-type"] == "image/webp"
    for path in (
        *(
            "/picture/..%2f..%2fgallery.sqlite/small",
            "/picture/../gallery.sqlite",
            "/static/..%2fapp.py",
        ),
        *(
            f"/picture/{good}/..%2f..%2fgallery.sqlite",
            f"/picture/{good}/small%00",
            "/static/%2e%2e/app.py",
        ),
        *("/picture//etc/passwd/small", "/static/wall.js/../../app.py", f"/look/..%2f{good}"),
    ):
        answer = client.get(path)
        assert answer.status == 404 and b"SQLite" not in answer.content, path


def test_an_oversize_form(client, room):
    key = enter(client, room, "ann")

    def pieces():
        for _ in range(40):
            yield b"mark=" + b"x" * 1000 + b"&"

    kind = ORIGIN | {"content-type": "application/x-www-form-urlencoded"}
    assert client.post("/ballot", body=pieces(), headers=kind).status == 413
    assert client.post("/ballot", body=[b"x" * 20_000], headers=kind).status == 413
    many = "&".join([f"key={key}", *("a=1" for _ in range(100))])
    assert client.post("/ballot", body=[many.encode()], headers=kind).status == 400
    assert client.post("/ballot", body=[b"key=\xff\xfe"], headers=kind).status == 400
    assert saved(room, "ann") is None


def test_a_slow_form(client, room, monkeypatch):
    key = enter(client, room, "ann")
    monkeypatch.setattr(guard, "FORM_TIMEOUT_SECONDS", 0.05)

    class Slow(small.Browser):
        def ask(self, *arguments):
            async def slowly(scope, receive, send):
                async def drip():
                    await asyncio.sleep(0.02)
                    return {"type": "http.request", "body": b"a=1&", "more_body": True}

                await client.application(scope, drip, send)

            self.application = slowly
            return super().ask(*arguments)

    slow = Slow(None)
    slow.cookies = client.cookies
    assert vote(slow, key, room.artifacts["eve"]).status == 408


@contextmanager
def served(most):
    """Yield the port of a server that answers "here" and allows so many connections."""
    import uvicorn

    async def here(scope, receive, send):
        headers = [(b"content-length", b"4")]
        await send({"type": "http.response.start", "status": 200, "headers": headers})
        await send({"type": "http.response.body", "body": b"here"})

    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        kind = serve.limited(most)
        config = uvicorn.Config(
            here, http=kind, ws="none", lifespan="off", log_config=None, log_level="critical"
        )
        server = uvicorn.Server(config)
        thread = threading.Thread(target=asyncio.run, args=(server.serve([listening]),))
        thread.start()
        try:
            while not server.started:
                threading.Event().wait(0.005)
            yield listening.getsockname()[1]
        finally:
            server.should_exit = True
            thread.join()


def ask(port, text=b"GET / HTTP/1.1\r\nhost: a\r\n\r\n"):
    """Send bytes on a new connection, and return it."""
    connection = socket.create_connection(("127.0.0.1", port), timeout=20)
    connection.sendall(text)
    return connection


def closed(connection):
    """Return what the server sends before it closes a connection."""
    data = b""
    with connection:
        try:
            piece = connection.recv(4096)
            while piece:
                data += piece
                piece = connection.recv(4096)
        except ConnectionResetError:
            pass
    return data


HALF = {
    "nothing": b"",
    "a letter": b"G",
    "a line": b"GET / HTTP/1.1\r\n",
    "half a header": b"GET / HTTP/1.1\r\nhost: a\r\ncookie: x",
    "half a form": b"POST /ballot HTTP/1.1\r\nhost: a\r\ncontent-length: 900\r\n\r\nkey=",
    "half a piece": b"POST / HTTP/1.1\r\nhost: a\r\ntransfer-encoding: chunked\r\n\r\nff\r\nkey=",
}


@pytest.mark.parametrize("sent", HALF.values(), ids=HALF)
def test_half_a_request(sent, monkeypatch):
    monkeypatch.setattr(serve, "REQUEST_TIMEOUT_SECONDS", 0.2)
    with served(50) as port:
        data = closed(ask(port, sent))  # returns: the server does not wait for the rest
        # the server answers a form without reading it
        assert data.count(b"200 OK") == sent.startswith(b"POST")
        whole = ask(port)
        assert closed(whole).endswith(b"here")  # the server closes the connection


def answer(connection):
    """Return an answer of the small server, whose head and body may arrive separately."""
    received = connection.recv(4096)
    while not received.endswith(b"here"):
        piece = connection.recv(4096)
        if not piece:
            break
        received += piece
    return received


def test_a_full_server_closes_the_oldest_incomplete_request(monkeypatch, caplog):
    monkeypatch.setattr(serve, "REQUEST_TIMEOUT_SECONDS", 600.0)
    with served(8) as port:
        waiting = [ask(port, b"GET / HT") for _ in range(8)]
        voters = []
        for k in range(4):
            voters.append(ask(port))
            assert answer(voters[k]).endswith(b"here")
            assert closed(waiting[k]) == b""  # the oldest has gone
        waiting[-1].sendall(b"TP/1.1\r\nhost: a\r\n\r\n")  # who was slow and is whole is answered
        assert answer(waiting[-1]).endswith(b"here")
        for connection in (*voters, *waiting[4:]):
            connection.close()
    assert [
        record.message.split(":")[0] for record in caplog.records if record.name == "hdrlab.gallery"
    ] == ["full"]


def test_a_full_log(tmp_path):
    root = logging.getLogger()
    handlers = root.handlers[:]
    level = root.level
    try:
        serve.keep_log(tmp_path)
        for _ in range(300):
            serve.log.warning("x" * 20_000)
        sizes = [path.stat().st_size for path in tmp_path.iterdir()]
        assert len(sizes) == 1 + serve.KEPT_OLD_LOGS
        assert max(sizes) <= serve.MAX_LOG_BYTES
        assert sum(sizes) > serve.MAX_LOG_BYTES
    finally:
        for handler in root.handlers:
            handler.close()
        root.handlers[:] = handlers
        root.setLevel(level)


def test_the_connection_limit_leaves_file_descriptors_for_the_rest(monkeypatch):
    resource = pytest.importorskip("resource")
    limits = [(1024, 1024), (256, 4096), (20_000, 20_000), (1024, resource.RLIM_INFINITY)]
    for soft, hard in limits:
        set_to = []
        monkeypatch.setattr(resource, "getrlimit", lambda which, pair=(soft, hard): pair)
        monkeypatch.setattr(resource, "setrlimit", lambda which, to, kept=set_to: kept.append(to))
        most = serve.connection_limit()
        open_files = (set_to or [(soft, hard)])[-1][0]
        assert 300 < most <= serve.MAX_CONNECTIONS
        assert most + serve.BACKLOG_CONNECTIONS + serve.OTHER_DESCRIPTORS <= open_files
    monkeypatch.setattr(resource, "getrlimit", lambda which: (300, 300))
    with pytest.raises(ValueError, match="ulimit"):
        serve.connection_limit()


def test_csrf(client, room):
    key = enter(client, room, "ann")
    eve = room.artifacts["eve"]
    cookie = client.cookies["gallery"]
    form = {"key": key, "mark": eve}
    assert client.post("/ballot", form).status == 403
    for origin in (
        "http://evil.test",
        "null",
        "http://vote.test.evil.test",
        "https://vote.test",
        "",
    ):
        assert client.post("/ballot", form, headers={"origin": origin}).status == 403
    assert vote(client, key, eve, **{"sec-fetch-site": "cross-site"}).status == 403
    for wrong in ("", "0" * 64, key[::-1]):
        assert vote(client, wrong, eve).status == 403
    other = enter(client, room, "cy")  # the key of another session
    assert client.post(
        "/ballot", {"key": other, "mark": eve}, headers=ORIGIN | {"cookie": f"gallery={cookie}"}
    )
    client.cookies.clear()
    mixed = {"cookie": f"gallery={cookie}"} | ORIGIN
    assert client.post("/ballot", {"key": other, "mark": eve}, headers=mixed).status == 403
    plain = mixed | {"content-type": "text/plain"}
    assert (
        client.post("/ballot", body=[f"key={key}&mark={eve}".encode()], headers=plain).status == 415
    )
    assert client.get(f"/ballot?key={key}&mark={eve}", headers=mixed).status == 405
    assert saved(room, "ann") is None


def test_sql_injection(client, room):
    key = enter(client, room, "ann")
    for text in ("' OR '1'='1", "x'; DROP TABLE ballots; --", '" UNION SELECT link FROM voters --'):
        assert vote(client, key, text).status == 409
        assert client.get(f"/look/{quote(text)}").status == 404
        assert (
            client.get(
                f"/compare?{urlencode({'with': [text, room.artifacts['eve']]}, doseq=True)}"
            ).status
            == 400
        )
        assert client.get(f"/enter/{quote(text)}").status == 404
        assert client.get("/", headers={"cookie": f"gallery={text.replace(';', '')}"}).status in (
            200,
            401,
        )
    assert vote(client, key, room.artifacts["eve"]).status == 303
    assert saved(room, "ann") == {room.artifacts["eve"]}


def test_clickjacking(client, room):
    enter(client, room, "ann")
    for path in ("/", "/nothing", "/static/wall.js", f"/picture/{room.artifacts['eve']}/small"):
        headers = client.get(path).headers
        assert "frame-ancestors 'none'" in headers["content-security-policy"]
        assert headers["x-frame-options"] == "DENY"
        assert headers["x-content-type-options"] == "nosniff"


def test_enumeration(client, room, tmp_path):
    again = tmp_path / "again"
    again.mkdir()
    # same pictures
    assert not set(small.make_gallery(again).artifacts.values()) & set(room.artifacts.values())
    unknown = client.get(f"/enter/{'A' * 55}")
    known = client.get(f"/enter/{room.links['ann'][:12]}{'A' * 43}")
    assert (unknown.status, unknown.text) == (known.status, known.text)
    for path in ("/", f"/picture/{room.artifacts['eve']}/small", f"/look/{room.artifacts['eve']}"):
        assert client.get(path).status == 401  # nothing of the class is public
    wall = enter(client, room, "cy") and client.get("/").text
    assert not any(
        f">{name}<" in wall or f"{name}@" in wall for name in ("ann", "Ann", "ben", "eve")
    )


def test_header_injection(client, room):
    link = room.links["ann"]
    for host in ("evil.test", "vote.test.evil.test", "vote.test:81", "vote.test@evil.test", ""):
        answer = client.get(f"/enter/{link}", headers={"host": host})
        assert answer.status == 421 and "evil" not in answer.text
    answer = client.get("/enter/x%0d%0aSet-Cookie:%20gallery=planted")
    assert "set-cookie" not in answer.headers and answer.status == 404
    answer = client.post(f"/enter/{link}", headers=ORIGIN | {"x-forwarded-host": "evil.test"})
    assert answer.headers["location"] == "/"
    cookie = answer.headers["set-cookie"].lower()
    assert "httponly" in cookie and "samesite=lax" in cookie and "domain" not in cookie
    with browser(room, "https://vote.test") as secure:
        renewed = store.connect(room.folder)
        with closing(renewed) as db, store.transaction(db):
            fresh = tokens.new_link(db, "ann")
        answer = secure.post(f"/enter/{fresh}", headers={"origin": "https://vote.test"})
        assert answer.headers["set-cookie"].startswith("__Host-gallery=")
        assert "Secure" in answer.headers["set-cookie"]
        assert answer.headers["strict-transport-security"]


def test_a_forged_client_address(client, room):
    for k in range(60):
        forged = {
            "x-forwarded-for": f"10.0.0.{k}",
            "forwarded": f"for=10.0.0.{k}",
            "x-real-ip": f"10.0.0.{k}",
        }
        last = client.get(f"/enter/{k:055d}", headers=forged).status
    assert last == 429


def test_a_flood(client, room):
    key = enter(client, room, "ann")
    codes = [vote(client, key, room.artifacts["eve"]).status for _ in range(40)]
    assert codes[:25] == [303] * 25 and codes[-1] == 429
    enter(client, room, "cy")  # other voters are not blocked
    assert vote(client, small.form_key(client.get("/").text), room.artifacts["eve"]).status == 303


def test_a_flood_of_clients_is_remembered_up_to_a_limit():
    rates = guard.Rates(most=10)
    once = guard.Rate(1, 0)
    assert all(rates.take("requests", str(k), once) for k in range(1000))
    assert not rates.take("requests", "999", once)  # among the last ten
    assert rates.take("requests", "989", once)  # forgotten


def test_formulas_in_a_table(tmp_path):
    room = small.make_gallery(tmp_path, names={"ann": "=cmd|' /C calc'!A0"}, title="@SUM(A1)")
    with closing(store.connect(room.folder)) as db:
        rows = list(ballots.gradebook(db))
    text = csv_tables.csv_text(ballots.GRADEBOOK_COLUMNS, rows)
    assert "'=cmd|" in text and "'@SUM(A1)" in text and not re.search(r"(^|,)\"?[=@]", text, re.M)


def test_a_write_in_progress_is_finished_when_the_gallery_stops(room):
    begun = threading.Event()

    def slowly(db):
        begun.set()
        time.sleep(0.2)
        db.execute("UPDATE voters SET name = 'Written' WHERE id = (SELECT min(id) FROM voters)")

    async def asked_and_gone():
        writer = Writer(room.folder)
        asking = asyncio.create_task(writer.do(slowly))
        await asyncio.to_thread(begun.wait)
        asking.cancel()
        await writer.close()

    asyncio.run(asked_and_gone())
    with closing(store.connect(room.folder)) as db:
        assert "Written" in [voter.name for voter in store.voters(db)]
