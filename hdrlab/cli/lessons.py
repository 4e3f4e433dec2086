"""Commands that begin with nothing: a demonstration, the notebooks, and the site that is made of them."""

import os
from pathlib import Path

import click

from hdrlab.cli import common, grading
from hdrlab.errors import InputError

FIRST = "notebooks/00_welcome.ipynb"
NEEDS = ("sphinx", "myst_nb", "numpydoc", "ziamath")


@common.command()
@click.option("--out", type=common.FILE, default="hdrlab-demo", help="Folder for the results.")
@click.option("--seed", default=1, help="Of noise and hand shake.")
@click.option("--real", is_flag=True, help="Take six real photographs, from a telephone, instead.")
def demo(out: Path, seed: int, real: bool) -> None:
    """Photograph a dark chapel with bright windows, and assemble the photographs again."""
    from hdrlab import demo as room

    steps = room.real_steps(out) if real else room.demo_steps(out, seed=seed)
    for line in common.progress(steps, "demo", room.STEPS):
        click.echo(line)


@common.command()
@click.option(
    "--folder", type=common.FILE, default="hdrlab-course", help="Your copy of the notebooks."
)
@click.option("--copy-only", is_flag=True, help="Copy the notebooks and do not start JupyterLab.")
@click.argument("options", nargs=-1, type=click.UNPROCESSED)
def lab(folder: Path, copy_only: bool, options: tuple[str, ...]) -> None:
    """Open JupyterLab on a copy of the notebooks and the assignments, at the first notebook.

    What you changed in your copy stays. JupyterLab saves what the widgets show, unless your own
    settings say otherwise. OPTIONS go to JupyterLab.
    """
    from hdrlab.course.material import materials

    new = materials.copy_course(folder)
    click.echo(f"{folder}: {len(new)} new notebooks")
    if not copy_only:
        from jupyterlab.labapp import LabApp

        own = os.environ.get("JUPYTER_CONFIG_PATH")
        os.environ["JUPYTER_CONFIG_PATH"] = os.pathsep.join(
            filter(None, [str(materials.JUPYTER), own])
        )
        where = [f"--notebook-dir={folder}", f"--LabApp.default_url=/lab/tree/{FIRST}"]
        LabApp.launch_instance([*where, *options])


@common.command()
@click.option(
    "--out", type=common.OUT, default="site", help="Folder for the site: empty, or one of before."
)
@click.option(
    "--notebooks", multiple=True, type=grading.FILE, help="One in place of all. Repeatable."
)
@click.option(
    "--jobs", type=click.IntRange(1), default=min(4, os.cpu_count() or 1), help="Runs at a time."
)
@click.option(
    "--address", default="", help="Where it will stand, https:// and all, for a link's preview."
)
def site(out: Path, notebooks: tuple[Path, ...], jobs: int, address: str) -> None:
    """Make a site of the course: notebooks that were run, guides, and the reference.

    Its pages need no server and nothing from elsewhere: open index.html, or put the folder on any
    web server. What has been run is kept beside it, in .NAME.cache, so that the next build runs
    only what has changed.
    """
    common.require("site", NEEDS)
    from hdrlab.cli.terminal import elapsed
    from hdrlab.course.material import materials
    from hdrlab.course.site import execute, pages

    chosen = list(notebooks) or sorted(materials.folder("notebooks").glob("*.ipynb"))
    handouts = [] if notebooks else sorted(materials.folder("assignments").glob("*.ipynb"))
    if len({one.stem for one in chosen} | {pages.FRONT.stem}) <= len(chosen):
        raise InputError(
            f"expected notebooks of different names, and none called {pages.FRONT.name}"
        )
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
        context = click.Context(
            command, info_name=f"hdrlab {name}", terminal_width=88, max_content_width=88
        )
        text += f"\n## {name}\n\n```text\n{command.get_help(context)}\n```\n"
    return text
