"""The commands with which a student hands in a project: its report, and the archive."""

from pathlib import Path

import click

from hdrlab.cli import common
from hdrlab.errors import InputError

PROJECT = click.argument("project", type=common.FILE, default=".")


@common.command()
@PROJECT
@click.option(
    "--example", is_flag=True, help="Write report.md with the headings that are asked for."
)
def report(project: Path, example: bool) -> None:
    """Make report.html of PROJECT's report.md or report.ipynb.

    The artifact (artifact.jpg), the bracket (photographs/), the response (response.csv) and the
    radiance map (map.hdr) are placed by themselves. The page travels alone.
    """
    from hdrlab.cli.terminal import elapsed
    from hdrlab.course.projects import project as projects, report as reports

    words = project / projects.WORDS[0]
    if example:
        if words.exists():
            raise InputError(f"{words}: expected no report yet, it is there")
        words.write_text(reports.example(), encoding="utf8")
        click.echo(words)
        return
    with elapsed("report"):
        written = reports.write_report(projects.look(project))
    common.say("note", written.notes)
    click.echo(f"{written.page}: with {', '.join(written.placed) or 'words alone'}")


@common.command()
@PROJECT
@click.option("-o", "--out", type=common.OUT, default="submission.zip", help="The archive.")
@click.option(
    "--keep-metadata", is_flag=True, help="Leave location and serial numbers in the photographs."
)
@click.option("--force", is_flag=True, help="Make the archive though something is missing.")
def submit(project: Path, out: Path, keep_metadata: bool, force: bool) -> None:
    """Look at PROJECT, say what is missing, and make one archive of it.

    Pictures go in without location, serial numbers and the notes of their makers; their pixels and
    exposures stay as they are.
    """
    from hdrlab.course.projects import project as projects, review, submit as handing

    if out.exists() and not handing.is_archive(out):
        raise InputError(
            f"{out}: expected a new name or an archive of before, this is another file"
        )
    found = projects.look(project)
    found = found._replace(
        files=tuple(one for one in found.files if one.resolve() != out.resolve())
    )
    findings = review.review(found)
    for finding in findings:
        status = "  ok     " if finding.good else "  MISSING"
        indented = finding.said.replace("\n", "\n" + " " * 24).rstrip()
        click.echo(f"{status}  {finding.part:<12} {indented}")
    missing = sum(not finding.good for finding in findings)
    if missing and not (force and found.artifact):
        raise InputError(
            f"{missing} problems to fix; nothing was written (--force writes the archive anyway)"
        )
    files = list(
        common.progress(handing.pack(found, keep=keep_metadata), "packing", len(found.files))
    )
    digest, removed = (
        handing.write(found, out, files),
        [one.removed for one in files if one.removed],
    )
    if removed:
        click.echo(
            f"removed from {len(removed)} photos: {', '.join(sorted(set().union(*removed)))}"
        )
    common.say("warning", [f"{file.name}: {file.remaining}" for file in files if file.remaining])
    click.echo(f"{out}: {len(files)} files, {out.stat().st_size / 1e6:.1f} MB, {digest[:12]}")
