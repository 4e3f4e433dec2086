"""The commands with which a class votes on its artifacts."""

import time
from contextlib import closing
from datetime import datetime
from pathlib import Path

import click

from hdrlab.cli import common
from hdrlab.course.classroom import roster as lists
from hdrlab.course.gallery import store
from hdrlab.course.reports import csv_tables
from hdrlab.course.sanitize import sanitize_line
from hdrlab.errors import InputError

FOLDER = click.argument("folder", type=common.FILE)
NEEDS = ("starlette", "uvicorn")


@common.main.group()
def gallery() -> None:
    """Let the class vote on its artifacts: init, add, links, serve, close, results."""


@gallery.command()
@FOLDER
@click.option("--title", default="Which artifact is best?", help="Over the wall.")
@click.option(
    "--closes", required=True, metavar="TIME", help="Of the vote, as 2026-12-01T23:59+01:00."
)
@click.option("--marks", type=click.IntRange(1, 20), default=3, help="Votes on a ballot, at most.")
def init(folder: Path, title: str, closes: str, marks: int) -> None:
    """Make a gallery in FOLDER."""
    try:
        end = datetime.fromisoformat(closes)
    except ValueError:
        said = f"--closes: expected a time such as 2026-12-01T23:59+01:00, got {closes!r}"
        raise InputError(said) from None
    store.create(folder, sanitize_line(title, 80), end, marks)
    click.echo(
        f"{folder}: a gallery, open until {store.format_time(end)}, {marks} votes on a ballot"
    )


@gallery.command()
@FOLDER
@click.option(
    "--roster", required=True, type=common.FILE, help="CSV: student, and name, email, team."
)
@click.argument("artifacts", nargs=-1, type=common.FILE)
def add(folder: Path, roster: Path, artifacts: tuple[Path, ...]) -> None:
    """Admit the students of a roster, and hang ARTIFACTS (files or folders) in the gallery of FOLDER.

    A file, or its folder, is named after its team or student: team7.jpg, b0123/submission.zip. A
    text beside a picture, team7.txt, holds its title and then a caption; archives of `hdrlab
    submit` hold both themselves. What cannot hang is named, and the rest hangs.
    """
    from hdrlab.course.gallery import collect

    students = lists.read(roster)
    hung, refused = 0, 0
    with closing(store.connect(folder)) as db:
        with store.transaction(db):
            for one in students.students:
                store.admit(db, store.Voter(one.id, one.name, one.team))
        for source, name in common.progress(collect.sources(artifacts), "hanging"):
            try:
                with collect.entry(source, students, name) as entry:
                    votes = collect.hang(db, folder, entry, source.name)
                hung += 1
                if votes:
                    said = f"{entry.team} hung another before, whose {votes} votes do not count any longer"
                    click.echo(f"note: {sanitize_line(f'{source.name}: {said}', 300)}", err=True)
            except ValueError as error:
                refused += 1
                click.echo(f"note: {sanitize_line(f'{source.name}: {error}', 300)}", err=True)
    said = f", {refused} refused" if refused else ""
    click.echo(f"{folder}: {len(students.students)} voters, {hung} artifacts hung{said}")


@gallery.command()
@FOLDER
@click.option(
    "-o", "--out", required=True, type=common.OUT, help="CSV of links, for your eyes alone."
)
@click.option(
    "--address", required=True, help="Where voters reach the gallery: https://vote.example.edu."
)
@click.option("--roster", type=common.FILE, help="Adds the addresses of its column email.")
@click.option(
    "--renew", multiple=True, metavar="STUDENT", help="A new link for this one alone. Repeatable."
)
@click.option("--all-anew", is_flag=True, help="New links for everybody, though some have theirs.")
def links(
    folder: Path,
    out: Path,
    address: str,
    roster: Path | None,
    renew: tuple[str, ...],
    all_anew: bool,
) -> None:
    """Make the personal links, each good for one browser.

    They are written once and kept nowhere else. Who has a link keeps it, unless --renew or
    --all-anew ends it.
    """
    from hdrlab.course.gallery import tokens

    emails = {one.id: one.email for one in lists.read(roster).students} if roster else {}
    with closing(store.connect(folder)) as db:
        without = [
            id for (id,) in db.execute("SELECT id FROM voters WHERE link IS NULL ORDER BY id")
        ]
        everybody = [voter.id for voter in store.voters(db)]
        wanted = list(renew) or (everybody if all_anew else without)
        rows = tokens.links(db, address, wanted, emails)
    csv_tables.write_csv(out, tokens.LINKS, rows, private=True)
    click.echo(
        f"{out}: {len(rows)} personal links; who has one can vote with it, so send each to its owner"
    )


@gallery.command()
@FOLDER
@click.option("--host", default="127.0.0.1", help="Where to listen.")
@click.option("--port", type=click.IntRange(1, 65535), default=8044)
@click.option("--address", help="Where voters reach the gallery.  [default: http://HOST:PORT]")
@click.option(
    "--behind-proxy", is_flag=True, help="A proxy on this machine ends TLS and names its clients."
)
def serve(folder: Path, host: str, port: int, address: str | None, behind_proxy: bool) -> None:
    """Serve the gallery of FOLDER until Ctrl-C. Ballots that were acknowledged are on the disk."""
    common.require("class", NEEDS)
    from hdrlab.course.gallery.web.serve import serve as run

    address = address or f"http://{host}:{port}"
    if not address.startswith("https://") and host not in ("127.0.0.1", "localhost", "::1"):
        click.echo(
            "warning: without https:// whoever shares the network can read the links", err=True
        )
    click.echo(
        f"{address}: the gallery of {folder}; Ctrl-C ends it, and what goes wrong is in gallery.log"
    )
    run(folder, address, host=host, port=port, behind_proxy=behind_proxy)


@gallery.command()
@FOLDER
def close(folder: Path) -> None:
    """End the vote now, also while the gallery is being served."""
    with store.writing(folder) as db:
        now = datetime.now().astimezone()
        if not store.settings(db).is_open(now.timestamp()):
            raise InputError(f"{folder}: expected an open vote, it has ended")
        store.close(db, now)
    click.echo(f"{folder}: closed")


@gallery.command()
@FOLDER
@click.option("-o", "--out", required=True, type=common.OUT, help="CSV for the gradebook.")
def results(folder: Path, out: Path) -> None:
    """Write who voted and how each artifact fared, after the end of the vote."""
    from hdrlab.course.gallery import ballots

    with closing(store.connect(folder)) as db:
        set_up = store.settings(db)
        if set_up.is_open(time.time()):
            raise InputError(
                f"{folder}: expected a vote that has ended, it is open until {set_up.closes}"
            )
        rows, changes = list(ballots.gradebook(db)), store.changes(db)
    common.say("note", changes)
    csv_tables.write_csv(out, ballots.GRADEBOOK, rows, private=True)
    click.echo(f"{out}: {len(rows)} students. {ballots.METHOD.format(marks=set_up.marks)}")
