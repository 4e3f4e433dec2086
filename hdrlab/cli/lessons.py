"""The commands for a first look and for the notebooks: `demo`, `lab` and `site`."""

import os
from pathlib import Path

import click

from hdrlab.cli import common
from hdrlab.errors import InputError

FIRST_NOTEBOOK = "notebooks/00_welcome.ipynb"
SITE_MODULES = ("sphinx", "myst_nb", "numpydoc", "ziamath")
LITE_MODULES = ("jupyterlite_core", "jupyterlite_pyodide_kernel")

# characters a line, of the help texts on the site's page about the commands
HELP_WIDTH = 88


@click.command(cls=common.Command)
@click.option(
    "-o", "--out", type=common.INPUT_PATH, default="hdrlab-demo", help="Folder for the results."
)
@click.option("--seed", default=1, help="Seed of the noise and the camera shake.")
@click.option("--real", is_flag=True, help="Use twelve real photos of a room instead.")
def demo(*, out: Path, seed: int, real: bool) -> None:
    """Simulate a bracket of a dark chapel, and assemble it."""
    from hdrlab import demo as demo_steps

    steps = demo_steps.real_steps(out) if real else demo_steps.demo_steps(out, seed=seed)
    for line in common.progress(steps, "demo", demo_steps.STEP_COUNT):
        click.echo(line)


@click.command(cls=common.Command)
@click.option(
    "-o",
    "--out",
    type=common.INPUT_PATH,
    default="hdrlab-course",
    help="Folder for your copy of the notebooks.",
)
@click.option("--copy-only", is_flag=True, help="Copy the notebooks without starting JupyterLab.")
@click.option("--no-browser", is_flag=True, help="Print the address, and open no browser.")
@click.argument("options", nargs=-1, type=click.UNPROCESSED, metavar="[-- JUPYTERLAB_OPTIONS]")
def lab(*, out: Path, copy_only: bool, no_browser: bool, options: tuple[str, ...]) -> None:
    """Open JupyterLab on your own copy of the notebooks.

    hdrlab copies the notebooks and assignments to the folder of --out, and opens the first
    notebook. It never overwrites files in that folder. A notebook of hdrlab runs when you open it
    for the first time, if you have not changed its code. JupyterLab saves the state of the widgets,
    unless your own settings disable that. hdrlab passes JUPYTERLAB_OPTIONS on to JupyterLab.
    """
    from hdrlab.course import materials

    new = materials.copy_course(out)
    click.echo(f"{out}: {len(new)} new notebooks")
    if copy_only:
        return
    from jupyterlab.labapp import LabApp

    config_folders = [str(materials.JUPYTER)]
    own_folders = os.environ.get("JUPYTER_CONFIG_PATH")
    if own_folders:
        config_folders.append(own_folders)
    os.environ["JUPYTER_CONFIG_PATH"] = os.pathsep.join(config_folders)
    place = [
        f"--notebook-dir={out}",
        f"--LabApp.default_url=/lab/tree/{FIRST_NOTEBOOK}",
        f"--LabApp.workspaces_dir={_workspaces_folder(out)}",
    ]
    if no_browser:
        place.append("--no-browser")
    LabApp.launch_instance([*place, *options])


@click.command(cls=common.Command)
@click.option(
    "-o",
    "--out",
    type=common.OUTPUT_PATH,
    default="site",
    help="Folder for the site: new, empty, or with an earlier site.",
)
@click.option(
    "--notebooks",
    multiple=True,
    type=common.EXISTING_FILE,
    help="Notebook for the site, instead of all notebooks of hdrlab. Repeatable.",
)
@click.option(
    "--jobs",
    type=click.IntRange(1),
    default=min(4, os.cpu_count() or 1),
    help="Number of notebooks to run at the same time.",
)
@click.option(
    "--address",
    default="",
    show_default=False,
    help="Address of the published site, https://..., for link previews.",
)
@click.option(
    "--lite",
    default="",
    show_default=False,
    metavar="PYODIDE",
    help="Let readers run the pages in their browsers, with Pyodide from this folder or address.",
)
def site(*, out: Path, notebooks: tuple[Path, ...], jobs: int, address: str, lite: str) -> None:
    """Build a website of the course.

    It contains the executed notebooks, the guides and the reference. The pages need no server and
    load nothing from other sites: open index.html, or copy the folder to any web server.

    hdrlab keeps the executed notebooks in .NAME.cache next to the site. The next
    build runs only notebooks that have changed.

    With --lite, readers open each notebook and assignment in JupyterLite, with check()
    and nothing to install. PYODIDE is a folder with Pyodide 0.27, which is copied to the
    site, or the address of one, such as https://cdn.jsdelivr.net/pyodide/v0.27.7/full/.
    Such a site needs a web server; python -m http.server is enough.
    """
    common.require_modules("site", SITE_MODULES)
    if lite:
        common.require_modules("lite", LITE_MODULES)
    from hdrlab.cli.terminal import elapsed
    from hdrlab.course import materials
    from hdrlab.course.authoring import execute
    from hdrlab.course.classroom.jobs import lock_folder
    from hdrlab.course.scratch import temporary_folder
    from hdrlab.course.site import pages
    from hdrlab.course.site.lite import build as jupyterlite

    chosen = list(notebooks) or sorted(materials.folder("notebooks").glob("*.ipynb"))
    handouts = [] if notebooks else sorted(materials.folder("assignments").glob("*.ipynb"))
    names = {notebook.stem for notebook in chosen}
    if len(names) < len(chosen) or pages.STORY.stem in names:
        raise InputError(
            f"--notebooks: pass notebooks with different names, and none named {pages.STORY.name}"
        )
    pyodide = jupyterlite.find_pyodide(lite) if lite else None
    edition = jupyterlite.edition_of(chosen, handouts) if lite else ""
    # Jupyter needs a working folder; if it is gone, stop here and not in the middle
    os.getcwd()
    cache = pages.claim(out)
    with temporary_folder(), lock_folder(cache):
        steps = execute.run_steps([pages.STORY, *chosen], cache, jobs=jobs)
        try:
            executed = list(common.progress(steps, "notebooks", len(chosen) + 1))
        except execute.NotebookError as error:
            raise click.ClickException(str(error)) from None
        executed.sort(key=lambda notebook: notebook.source.stem)
        more_pages = {"commands.md": _commands_page()}
        with elapsed("pages"):
            made = pages.build(
                out, executed, handouts, more_pages, address=address, edition=edition
            )
        if pyodide is None:
            jupyterlite.remove(out)
        else:
            with elapsed("JupyterLite"):
                jupyterlite.build(out, cache, chosen, handouts, pyodide)
    common.echo_notes(made.complaints)
    if pyodide is not None and pyodide.lacking:
        lacking = ", ".join(pyodide.lacking)
        common.echo_notes([f"{lite} has no {lacking}: cells that need it fail in a browser"])
    fresh = sum(notebook.fresh for notebook in executed)
    counts = f"{made.pages} pages, {made.widgets} widgets, {len(chosen)} notebooks"
    click.echo(f"{made.front}: {counts}; run now: {fresh}")


def _workspaces_folder(course: Path) -> Path:
    """Return the folder of JupyterLab's workspaces in the reader's copy of the course.

    At first it has one workspace, which shows the table of contents. JupyterLab then stores there how
    the reader arranges the window, apart from the workspaces of other projects.
    """
    from jupyterlab_server import WORKSPACE_EXTENSION, slugify

    from hdrlab.course import materials
    from hdrlab.io import files

    folder = course.resolve() / ".jupyter" / "workspaces"
    workspace = folder / f"{slugify('default')}{WORKSPACE_EXTENSION}"
    if not workspace.exists():
        folder.mkdir(parents=True, exist_ok=True)
        files.write(workspace, materials.WORKSPACE.read_bytes())
    return folder


def _commands_page() -> str:
    """Return the guide to the commands, followed by the help of every command."""
    from hdrlab.course.site import pages

    text = (pages.PAGES / "commands.md").read_text("utf-8")
    main = click.get_current_context().find_root().command
    if not isinstance(main, click.Group):
        return text
    for name, command in sorted(main.commands.items()):
        context = click.Context(
            command,
            info_name=f"hdrlab {name}",
            terminal_width=HELP_WIDTH,
            max_content_width=HELP_WIDTH,
        )
        text += f"\n## {name}\n\n```text\n{command.get_help(context)}\n```\n"
    return text
