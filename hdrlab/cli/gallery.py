"""The commands for a class's vote on its artifacts: `gallery init`, `add`, `links`, `serve` ..."""

import time
from contextlib import closing
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hdrlab.cli import common
from hdrlab.errors import HdrlabError, InputError

if TYPE_CHECKING:
    from sqlite3 import Connection

    from hdrlab.course.gallery.collect import Entry

SERVER_MODULES = ("starlette", "uvicorn")
MAX_TITLE_LENGTH = 80
DEFAULT_MARKS = 3
MAX_NOTE_LENGTH = 300

folder_argument = click.argument("folder", type=common.INPUT_PATH)


@click.group(cls=common.Group)
def gallery() -> None:
    """Let the class vote on its project images."""


@gallery.command()
@folder_argument
@click.option("--title", default="Which artifact is best?", help="Title of the gallery.")
@click.option(
    "--closes",
    required=True,
    metavar="TIME",
    help="End of the vote, such as 2026-12-01T23:59+01:00.",
)
@click.option(
    "--marks",
    type=click.IntRange(1, 20),
    help="Largest number of votes of one student.  [default: 3]",
)
@click.option(
    "--pairs",
    type=click.IntRange(1, 200),
    help="Largest number of pairs of one student, such as 20. With it, students do not mark images "
    "but choose the better one of two.",
)
def init(*, folder: Path, title: str, closes: str, marks: int | None, pairs: int | None) -> None:
    """Create a gallery in FOLDER.

    Students mark the images that they like best, and hdrlab counts their votes. With --pairs, they
    see two images at a time and choose the better one. hdrlab then estimates the strength of each
    image with an interval, and compares the votes with TMQI and PU-SSIM.
    """
    from hdrlab.course.gallery import store
    from hdrlab.course.sanitize import sanitize_line

    try:
        end = datetime.fromisoformat(closes)
    except ValueError:
        raise InputError(
            f"--closes: expected a time such as 2026-12-01T23:59+01:00, got {closes!r}"
        ) from None
    if marks is not None and pairs is not None:
        raise InputError("--marks and --pairs exclude each other; pass one of them")
    name = sanitize_line(title, MAX_TITLE_LENGTH)
    if pairs is not None:
        store.create(folder, name, end, pairs=pairs)
        limit = f"{pairs} pairs"
    else:
        votes = marks or DEFAULT_MARKS
        store.create(folder, name, end, votes)
        limit = f"{votes} votes"
    click.echo(
        f"{folder}: gallery created; vote open until {store.format_time(end)}, "
        f"up to {limit} for each student"
    )


@gallery.command()
@folder_argument
@click.option(
    "--roster",
    required=True,
    type=common.INPUT_PATH,
    help="Class list: a CSV file with the column student, and optionally name, email and team.",
)
@click.option(
    "--map",
    "radiance_map",
    type=common.EXISTING_FILE,
    help="Radiance map that all images show, for TMQI and PU-SSIM in a gallery with --pairs. An "
    "archive of hdrlab submit has its own.",
)
@click.argument("artifacts", nargs=-1, type=common.INPUT_PATH)
def add(
    *, folder: Path, roster: Path, radiance_map: Path | None, artifacts: tuple[Path, ...]
) -> None:
    """Add voters and project images (ARTIFACTS) to the gallery in FOLDER.

    The voters are the students of the roster. ARTIFACTS are files or folders. The name of a
    file, or of its folder, starts with the team or the student: team7.jpg, b0123/submission.zip. A
    text file with the name of the image, such as team7.txt, contains its title in the first line
    and a caption below. Archives of `hdrlab submit` contain both. hdrlab lists the artifacts that
    it cannot add, and adds the others.
    """
    from hdrlab.course.gallery import collect, store
    from hdrlab.course.scratch import temporary_folder
    from hdrlab.course.students import roster as rosters

    students = rosters.read(roster)
    added = 0
    scored = 0
    refused = 0
    with temporary_folder(), closing(store.connect(folder)) as db:
        with store.transaction(db):
            has_pairs = store.settings(db).pairs > 0
            for student in students.students:
                store.admit(db, store.Voter(student.id, student.name, student.team))
        for source, name in common.progress(collect.sources(artifacts), "adding"):
            try:
                with collect.entry(source, students, name) as entry:
                    lost_votes = collect.hang(db, folder, entry, source.name)
                    if has_pairs:
                        scored += _score(db, source.name, entry, radiance_map)
            except HdrlabError as error:
                refused += 1
                _echo_note(f"{source.name}: {error}")
                continue
            added += 1
            if lost_votes:
                _echo_note(
                    f"{source.name}: replaces the earlier artifact of {entry.team}, "
                    f"whose {lost_votes} votes no longer count"
                )
    refusals = f", {refused} refused" if refused else ""
    scores = f", {scored} of them with TMQI and PU-SSIM" if has_pairs else ""
    click.echo(
        f"{folder}: {len(students.students)} voters, {added} artifacts added{scores}{refusals}"
    )


def _score(db: "Connection", name: str, entry: "Entry", radiance_map: Path | None) -> bool:
    """Score an artifact against its radiance map; note why if that fails, and return whether."""
    from hdrlab.course.gallery import collect

    try:
        return collect.score_entry(db, entry, radiance_map)
    except HdrlabError as error:
        _echo_note(f"{name}: no TMQI and PU-SSIM: {error}")
        return False


def _echo_note(text: str) -> None:
    """Print a note that contains text from a submission, without control characters."""
    from hdrlab.course.sanitize import sanitize_line

    common.echo_notes([sanitize_line(text, MAX_NOTE_LENGTH)])


def _require_no_gallery_file(folder: Path, out: Path) -> None:
    """Raise an InputError if an output would replace a file of the gallery itself."""
    from hdrlab.course.gallery import store

    target = out.resolve()
    home = folder.resolve()
    is_database = target.parent == home and target.name.startswith(store.DATABASE)
    if is_database or target.parent == home / store.PICTURES:
        raise InputError(f"{out}: writing would overwrite the gallery itself; pass another name")


@gallery.command()
@folder_argument
@click.option(
    "-o",
    "--out",
    required=True,
    type=common.OUTPUT_FILE,
    help="CSV file for the links. Keep it secret.",
)
@click.option(
    "--address",
    required=True,
    help="Address where voters reach the gallery, such as https://vote.example.edu.",
)
@click.option(
    "--roster",
    type=common.INPUT_PATH,
    help="Class list. hdrlab copies its column email to the table of links.",
)
@click.option(
    "--renew",
    multiple=True,
    metavar="STUDENT",
    help="Make a new link only for this student. Repeatable.",
)
@click.option("--all-anew", is_flag=True, help="Replace the links of all students with new ones.")
def links(
    *,
    folder: Path,
    out: Path,
    address: str,
    roster: Path | None,
    renew: tuple[str, ...],
    all_anew: bool,
) -> None:
    """Make a personal link for each student. Each link works in one browser only.

    hdrlab stores the links nowhere else, so keep the file. Students who have a link keep it, unless
    --renew or --all-anew replaces it.
    """
    from hdrlab.course.gallery import store, tokens
    from hdrlab.course.students import csv_tables, roster as rosters

    if renew and all_anew:
        raise InputError("--renew and --all-anew exclude each other; pass one of them")
    emails = {}
    if roster:
        emails = {student.id: student.email for student in rosters.read(roster).students}
    _require_no_gallery_file(folder, out)
    with closing(store.connect(folder)) as db, store.transaction(db):
        if renew:
            students = list(renew)
        elif all_anew:
            students = [voter.id for voter in store.voters(db)]
        else:
            query = "SELECT id FROM voters WHERE link IS NULL ORDER BY id"
            students = [row[0] for row in db.execute(query)]
        rows = tokens.links(db, address, students, emails)
        # before the transaction ends: until the new links are safe, the older ones stay valid
        csv_tables.write_csv(out, tokens.LINK_COLUMNS, rows, private=True)
    click.echo(
        f"{out}: {len(rows)} personal links; send each link only to its student, "
        "because anybody who has it can vote with it"
    )


@gallery.command()
@folder_argument
@click.option("--host", default="127.0.0.1", help="Address to listen on.")
@click.option("--port", type=click.IntRange(1, 65535), default=8044, help="Port to listen on.")
@click.option(
    "--address",
    help="Address where voters reach the gallery.  [default: http://HOST:PORT]",
)
@click.option(
    "--behind-proxy",
    is_flag=True,
    help="Accept clients' addresses and TLS from a proxy on this machine.",
)
def serve(*, folder: Path, host: str, port: int, address: str | None, behind_proxy: bool) -> None:
    """Serve the gallery in FOLDER until Ctrl-C."""
    common.require_modules("class", SERVER_MODULES)
    from hdrlab.course.gallery.web.serve import serve as serve_gallery

    address = address or f"http://{host}:{port}"
    is_local = host in ("127.0.0.1", "localhost", "::1")
    if not address.startswith("https://") and not is_local:
        common.echo_warnings(
            ["without https://, everybody on the same network can read the personal links"]
        )
    click.echo(
        f"{address}: serving the gallery of {folder}; stop it with Ctrl-C; errors go to gallery.log"
    )
    serve_gallery(folder, address, host=host, port=port, behind_proxy=behind_proxy)


@gallery.command()
@folder_argument
def close(*, folder: Path) -> None:
    """End the vote now, even while the gallery is being served."""
    from hdrlab.course.gallery import store

    with store.writing(folder) as db:
        now = datetime.now().astimezone()
        if not store.settings(db).is_open(now.timestamp()):
            raise InputError(f"{folder}: the vote has already ended")
        store.close(db, now)
    click.echo(f"{folder}: closed")


@gallery.command()
@folder_argument
@click.option(
    "-o", "--out", required=True, type=common.OUTPUT_FILE, help="CSV file for the gradebook."
)
def results(*, folder: Path, out: Path) -> None:
    """Write the results, after the end of the vote.

    For each student, the CSV file shows whether they voted, and how many votes their image got. In
    a gallery with --pairs, it also has the chance in percent that a student prefers this image to
    an average one, with a 95 % interval.
    """
    from hdrlab.course.gallery import ballots, pairs, store
    from hdrlab.course.students import csv_tables

    _require_no_gallery_file(folder, out)
    with closing(store.connect(folder)) as db:
        settings = store.settings(db)
        if settings.is_open(time.time()):
            raise InputError(
                f"{folder}: the vote is open until {settings.closes}; "
                "wait, or run hdrlab gallery close"
            )
        if settings.pairs:
            columns: tuple[str, ...] = pairs.GRADEBOOK_COLUMNS
            rows = list(pairs.gradebook(db))
            method = pairs.METHOD.format(pairs=settings.pairs)
        else:
            columns = ballots.GRADEBOOK_COLUMNS
            rows = list(ballots.gradebook(db))
            method = ballots.METHOD.format(marks=settings.marks)
        changes = store.changes(db)
    common.echo_notes(changes)
    csv_tables.write_csv(out, columns, rows, private=True)
    click.echo(f"{out}: {len(rows)} students. {method}")
