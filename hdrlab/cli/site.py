"""The command that makes the course's site."""

import os
from pathlib import Path

import click

from hdrlab.cli import common, grading

NEEDS = ("sphinx", "myst_nb", "numpydoc", "ziamath")


@common.command()
@click.option("--out", type=common.OUT, default="site", help="Folder for the site: empty, or one of before.")
@click.option(
    "--notebooks", metavar="FILE", multiple=True, type=grading.FILE, help="One in place of all. Repeatable."
)
@click.option(
    "--jobs", type=click.IntRange(1), default=min(4, os.cpu_count() or 1), help="Notebooks at a time."
)
@click.option("--address", default="", help="Where it will stand, https:// and all, for a link's preview.")
def site(out: Path, notebooks: tuple[Path, ...], jobs: int, address: str) -> None:
    """Make a site of the course: notebooks that were run, guides, and the reference.

    Its pages need no server and nothing from elsewhere: open index.html, or put the folder on any web server.
    What has been run is kept beside it, in .NAME.cache, so that the next build runs only what has changed.
    """
    common.require("site", NEEDS)
    from hdrlab.cli.terminal import elapsed
    from hdrlab.course.material import materials
    from hdrlab.course.site import execute, pages

    chosen = list(notebooks) or sorted(materials.folder("notebooks").glob("*.ipynb"))
    handouts = [] if notebooks else sorted(materials.folder("assignments").glob("*.ipynb"))
    if len({one.stem for one in chosen} | {pages.FRONT.stem}) <= len(chosen):
        raise ValueError(f"expected notebooks of different names, and none called {pages.FRONT.name}")
    os.getcwd()  # Jupyter needs one: where it is gone, nothing is begun
    cache = pages.claim(out)
    running = execute.run_steps([pages.FRONT, *chosen], cache, jobs=jobs)
    try:
        done = list(common.progress(running, "notebooks", len(chosen) + 1))
    except execute.NotebookError as error:
        raise click.ClickException(str(error)) from None
    in_order = sorted(done, key=lambda one: one.source.stem)
    with elapsed("pages"):
        made = pages.build(out, in_order, handouts, {"commands.md": _commands()}, address=address)
    common.say("note", made.complaints)
    fresh = sum(one.fresh for one in done)
    counts = f"{made.pages} pages, {made.widgets} widgets, {len(chosen)} notebooks"
    click.echo(f"{made.front}: {counts}; run now: {fresh}")


def _commands() -> str:
    """Return a page with the help of every command."""
    from hdrlab.course.site import pages

    text = (pages.PAGES / "commands.md").read_text("utf-8")
    for name, command in sorted(common.main.commands.items()):
        context = click.Context(command, info_name=f"hdrlab {name}", terminal_width=88, max_content_width=88)
        text += f"\n## {name}\n\n```text\n{command.get_help(context)}\n```\n"
    return text
