"""Commands that begin with nothing: a demonstration, and the notebooks."""

import os
from pathlib import Path

import click

from hdrlab.cli import common

FIRST = "notebooks/00_welcome.ipynb"


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
@click.option("--folder", type=common.FILE, default="hdrlab-course", help="Your copy of the notebooks.")
@click.option("--copy-only", is_flag=True, help="Copy the notebooks and do not start JupyterLab.")
@click.argument("options", nargs=-1, type=click.UNPROCESSED)
def lab(folder: Path, copy_only: bool, options: tuple[str, ...]) -> None:
    """Open JupyterLab on a copy of the notebooks and the assignments, at the first notebook.

    What you changed in your copy stays. JupyterLab saves what the widgets show, unless your own settings say
    otherwise. OPTIONS go to JupyterLab.
    """
    from hdrlab.course.material import materials

    new = materials.copy_course(folder)
    click.echo(f"{folder}: {len(new)} new notebooks")
    if not copy_only:
        from jupyterlab.labapp import LabApp

        own = os.environ.get("JUPYTER_CONFIG_PATH")
        os.environ["JUPYTER_CONFIG_PATH"] = os.pathsep.join(filter(None, [str(materials.JUPYTER), own]))
        where = [f"--notebook-dir={folder}", f"--LabApp.default_url=/lab/tree/{FIRST}"]
        LabApp.launch_instance([*where, *options])
