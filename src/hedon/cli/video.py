"""`hedon video`: the frames of a run as a video."""

from pathlib import Path
from typing import Annotated

import typer


def video(
    run: Annotated[Path, typer.Argument(metavar="RUN", help="Folder of a run that was made with --frames.")],
    out: Annotated[Path, typer.Argument(metavar="OUT", help="The new file: .mp4 or .gif.")],
    first: Annotated[int | None, typer.Option("--from", metavar="STEP", help="Where to begin.", min=0)] = None,
    last: Annotated[int | None, typer.Option("--to", metavar="STEP", help="Where to end.", min=0)] = None,
    speed: Annotated[int, typer.Option(metavar="STEPS", help="Steps from one picture to the next.", min=1)] = 8,
    follow: Annotated[
        int | None, typer.Option(metavar="AGENT", help="Keep this agent in the middle, by default for all of its life.")
    ] = None,
    world: Annotated[
        int | None, typer.Option(metavar="SEED", help="Which world, by its seed; by default the first.")
    ] = None,
    width: Annotated[int, typer.Option(help="Of a picture [pixel].", min=160, max=3840)] = 960,
    rate: Annotated[int, typer.Option(help="Pictures per second.", min=1, max=60)] = 25,
) -> None:
    """Make a video of a run.

    Agents are drawn as in the figure of the world: the darker, the more energy. Between two frames they move evenly.
    Needs ffmpeg, which comes with the optional packages hedon[video].

    \b
    Examples:
      hedon run baseline --frames 64 --out runs/seen
      hedon video runs/seen seen.mp4
      hedon video runs/seen start.gif --to 2048 --speed 16 --width 480
      hedon video runs/seen life.mp4 --follow 120 --speed 4
    """
    from hedon.cli.console import make_console
    from hedon.cli.display.film import FilmDisplay
    from hedon.video.make import choose_range, make_video
    from hedon.video.moment import open_footage

    footage = open_footage(run, world)
    shown = choose_range(footage, first, last, speed, follow)
    console = make_console()
    with FilmDisplay(console, rate) as display:
        make_video(footage, shown, out, width, rate, display.update)
    console.print(f"wrote {out}: {shown.pictures:,} pictures, {out.stat().st_size / 1e6:.1f} MB")
