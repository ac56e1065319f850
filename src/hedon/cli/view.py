"""`hedon view`: shows a run, or a live world, in the browser."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hedon.error import HedonError
from hedon.text import printable

if TYPE_CHECKING:
    from hedon.view.index import RunIndex
    from hedon.view.server import Server


class ViewArgumentError(HedonError):
    """Incompatible arguments of `hedon view`."""


def view(
    run: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="RUN",
            help="Folder of a run, and of up to three others whose curves are added to its plots; with --live a preset "
            "or a file.",
            show_default=False,
        ),
    ] = None,
    live: Annotated[bool, typer.Option("--live", help="Simulate in the browser: a preset, or a file (.toml).")] = False,
    article: Annotated[
        bool, typer.Option("--story", help="The interactive article: where do rewards come from?")
    ] = False,
    step: Annotated[int | None, typer.Option(help="Open a recorded run at this step.", min=0)] = None,
    seed: Annotated[int | None, typer.Option(help="Show the world of this seed of the run.", min=0)] = None,
    agent: Annotated[int | None, typer.Option(help="Choose the agent with this agent_id.", min=0)] = None,
    export: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR|FILE.html",
            help="Write a site for any web server instead of opening the page; with only --story, also one file.",
        ),
    ] = None,
    port: Annotated[
        int,
        typer.Option(
            help="Port of the local server, which then keeps its address; 0 for any free one.", min=0, max=65535
        ),
    ] = 0,
    open_browser: Annotated[bool, typer.Option("--open/--no-open", help="Open the browser.")] = True,
) -> None:
    """Watch a run in the browser, or a world that the browser simulates itself.

    Shows positions if the run was made with --frames, and plots for any run. A run in progress is followed. Ctrl-C
    stops the server, which prints its link and can be reached only from this machine.

    \b
    Examples:
      hedon run baseline --frames 64 --out runs/seen
      hedon view runs/seen
      hedon view runs/seen --step 40000 --seed 2
      hedon view runs/seen runs/other
      hedon view --live
      hedon view --live poison
      hedon view --story
      hedon view --story --export article.html
      hedon view runs/seen --export site
      hedon view runs/seen --story --export site
    """
    from concurrent.futures import ThreadPoolExecutor

    from hedon.config.load import DEFAULT_PRESET, load_config
    from hedon.record.reader import open_run
    from hedon.view.export import export as write_site
    from hedon.view.index import RunIndex
    from hedon.view.live import require_live
    from hedon.view.moment import fragment
    from hedon.view.server import Server
    from hedon.view.single import write_single
    from hedon.view.story import PAGE, story

    runs = run or []
    if not runs and not live and not article:
        raise ViewArgumentError("give the folder of a run, --live for a world in the browser, or --story to read")
    if live and len(runs) > 1:
        raise ViewArgumentError(f"--live {' '.join(runs)}: give one preset or file")
    if {step, seed, agent} != {None} and (not runs or live or article or export is not None):
        raise ViewArgumentError(
            "--step, --seed and --agent: only with the folder of a run, without --live, --story, --export"
        )
    source = (runs[0] if runs else DEFAULT_PRESET) if live else ""
    if source:
        require_live(load_config(source), source)  # reports any problem with it here
    if export is not None and export.suffix == ".html":
        if runs or live or not article:
            raise ViewArgumentError(
                f"--export {export}: only the article alone fits into one file; give a folder instead"
            )
        size = write_single(export, story())
        typer.echo(f"wrote {printable(str(export))}, {size / 1e6:.1f} MB: open it in any browser")
        return
    index = None if live or not runs else RunIndex(Path(runs[0]), [Path(other) for other in runs[1:]])
    front = PAGE if article else "index.html"
    place = front.removeprefix("index.html")
    if index is not None:
        place += fragment(open_run(index.folder), step, seed, agent)
    with ThreadPoolExecutor(1) as pool:
        # Describing the worlds of all presets takes seconds; meanwhile the link and the article are available.
        scenes = pool.submit(story) if article else None
        worlds = pool.submit(_worlds, source)
        data: dict[str, Any] = {"page": lambda: {"run": index is not None, "worlds": worlds.result()}}
        if index is not None:
            data["run"] = index.describe
        if scenes is not None:
            data["story"] = scenes.result
        if export is None:
            _serve(Server(data, index.files if index else dict, port), place, index, open_browser)
            return
        _say_damage(index)
        size = write_site(export, {name: tell() for name, tell in data.items()}, index.files() if index else {})
        typer.echo(f"wrote {printable(str(export))}, {size / 1e6:.1f} MB: open its {front} through any web server")


def _worlds(source: str) -> list[dict[str, Any]]:
    from hedon.view.live import live_worlds

    return live_worlds(source)


def _say_damage(index: "RunIndex | None") -> None:
    for name in index.damaged() if index else ():
        typer.echo(f"hedon: {name} is damaged, and left out", err=True)


def _serve(server: "Server", place: str, index: "RunIndex | None", open_browser: bool) -> None:
    """Serves until Ctrl-C. The link ends with `place`."""
    import webbrowser

    link = server.link + place
    typer.echo(f"hedon: {link}")
    typer.echo("Open this link in a browser on this machine. Ctrl-C ends.")
    _say_damage(index)
    if open_browser:
        webbrowser.open(link)
    try:
        server.serve_forever()
    except KeyboardInterrupt:
        typer.echo("ended")
    finally:
        server.server_close()
