"""The commands with which a student hands in a project: `report` and `submit`."""

import dataclasses
from pathlib import Path

import click

from hdrlab.cli import common
from hdrlab.errors import InputError

# columns in front of the words of a finding, in the list that `submit` prints
FINDING_INDENT = 24

project_argument = click.argument("project", type=common.INPUT_PATH, default=".")


@click.command(cls=common.Command)
@project_argument
@click.option(
    "--example", is_flag=True, help="Write a report.md with the required headings, to start from."
)
def report(*, project: Path, example: bool) -> None:
    """Make report.html from PROJECT's report.md or report.ipynb.

    hdrlab inserts the final image (artifact.jpg), the bracket (photographs/), the response
    (response.csv) and the radiance map (map.hdr). It writes the page as a single file.
    """
    from hdrlab.cli.terminal import elapsed
    from hdrlab.course.projects import project as projects, report as reports
    from hdrlab.io import files

    if example:
        source = project / projects.REPORT_SOURCES[0]
        if source.exists():
            raise InputError(f"{source}: already exists; edit it, or remove it first")
        files.write(source, reports.example())
        click.echo(source)
        return
    with elapsed("report"):
        written = reports.write_report(projects.read_project(project))
    common.echo_notes(written.notes)
    content = ", ".join(written.placed) or "text only"
    click.echo(f"{written.page}: with {content}")


@click.command(cls=common.Command)
@project_argument
@click.option(
    "-o", "--out", type=common.OUTPUT_FILE, default="submission.zip", help="Archive to write."
)
@click.option(
    "--keep-metadata", is_flag=True, help="Keep location and serial numbers in the photos."
)
@click.option("--force", is_flag=True, help="Write the archive even if something is missing.")
def submit(*, project: Path, out: Path, keep_metadata: bool, force: bool) -> None:
    """Check PROJECT, and pack it into one archive.

    hdrlab reports what is missing. It removes location, serial numbers and maker notes from the
    photos. It does not change pixels or exposure data.
    """
    from hdrlab.course.projects import project as projects, review, submit as packing

    if out.exists() and not packing.is_archive(out):
        raise InputError(f"{out}: not an archive of hdrlab submit; pass another name with --out")
    found = projects.read_project(project)
    other_files = tuple(file for file in found.files if file.resolve() != out.resolve())
    found = dataclasses.replace(found, files=other_files)
    findings = review.review(found)
    for finding in findings:
        status = "ok" if finding.good else "MISSING"
        words = finding.said.replace("\n", "\n" + " " * FINDING_INDENT).rstrip()
        click.echo(f"  {status:<8} {finding.part:<12} {words}")
    missing = sum(not finding.good for finding in findings)
    if missing and not (force and found.artifact):
        raise InputError(
            f"{missing} problems to fix, and no archive written; pass --force to write it anyway"
        )
    packed = packing.pack(found, keep=keep_metadata)
    files = list(common.progress(packed, "packing", len(found.files)))
    digest = packing.write(found, out, files)
    removed = [file.removed for file in files if file.removed]
    if removed:
        kinds = ", ".join(sorted(set().union(*removed)))
        click.echo(f"removed from {len(removed)} photos: {kinds}")
    common.echo_warnings(f"{file.name}: {file.remaining}" for file in files if file.remaining)
    megabytes = out.stat().st_size / 1e6
    click.echo(f"{out}: {len(files)} files, {megabytes:.1f} MB, {digest[:12]}")
