"""Commands on configs: list the presets, show a config, compare two, check one."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from hedon.cli.console import make_console

if TYPE_CHECKING:
    from hedon.config import Config

app = typer.Typer(no_args_is_help=True, rich_markup_mode=None, help="Show, compare and check configs.")

Source = Annotated[str, typer.Argument(help="A preset, or a file that ends with .toml.", show_default=False)]
Fidelity = Annotated[
    str | None,
    typer.Option("--fidelity", "-f", help="corrected, released or as_printed; replaces the one in the file."),
]
Overrides = Annotated[
    list[str] | None,
    typer.Option("--set", "-s", help="section.name=value, as in TOML; can be repeated.", metavar="SETTING"),
]


def presets() -> None:
    """List the presets, and the fidelities that can be combined with them."""
    from hedon.cli.display.table import PrintedTable
    from hedon.config.load import (
        FIDELITIES,
        OUR_PRESETS,
        PAPER_PRESETS,
        SEQUEL_PRESETS,
        describe_fidelity,
        describe_preset,
        load_config,
    )

    console = make_console()
    for names in (PAPER_PRESETS, SEQUEL_PRESETS, OUR_PRESETS):
        rows = []
        for name in names:
            config = load_config(name)
            size = f"{config.arena.width:g} x {config.arena.height:g}"
            rows.append((name, describe_preset(name), size, "\n".join(_food_lines(config))))
        console.print(PrintedTable(("preset", "what it is", "arena [u]", "food"), rows, text=range(4)))
    fidelities = [(name, describe_fidelity(name)) for name in FIDELITIES]
    console.print(PrintedTable(("fidelity", "what it is"), fidelities, text=range(2)))


@app.command()
def show(
    source: Source,
    fidelity: Fidelity = None,
    overrides: Overrides = None,
    path: Annotated[str | None, typer.Option("--path", "-p", help="Only this section, as in food.normal.")] = None,
) -> None:
    """Print a config as a complete TOML file.

    \b
    Examples:
      hedon config show baseline
      hedon config show poison --fidelity as_printed --path food.poison
      hedon config show my.toml --set energy.initial=20 --set sensor.scaling=unit > run.toml
    """
    from hedon.config import ConfigError, Problem, load_config
    from hedon.config.dump import dump_toml, section_paths
    from hedon.config.problem import format_value, nearest

    config = load_config(source, fidelity, overrides or ())
    paths = section_paths(config)
    if path is not None and path not in paths:
        near = nearest(path, paths)
        raise ConfigError(source, [Problem("--path", "there is no such section", format_value(path), near)])
    typer.echo(dump_toml(config, path), nl=False)


@app.command()
def diff(
    a: Source,
    b: Source,
    fidelity_a: Annotated[str | None, typer.Option(help="Fidelity of the first config.")] = None,
    fidelity_b: Annotated[str | None, typer.Option(help="Fidelity of the second config.")] = None,
) -> None:
    """Print the settings in which two configs differ.

    \b
    Examples:
      hedon config diff baseline relocation
      hedon config diff baseline baseline --fidelity-b released
    """
    from hedon.config.dump import diff as compare
    from hedon.config.load import load_config

    rows = [
        (path, _text(x), _text(y)) for path, x, y in compare(load_config(a, fidelity_a), load_config(b, fidelity_b))
    ]
    if not rows:
        typer.echo("no setting differs")
        return
    widths = [max(len(row[column]) for row in rows) for column in range(2)]
    for path, x, y in rows:
        typer.echo(f"{path:{widths[0]}}  {x:>{widths[1]}} -> {y}")


@app.command()
def check(source: Source, fidelity: Fidelity = None, overrides: Overrides = None) -> None:
    """Check a config: print its digest, or everything that is wrong.

    Rule files are executed, as in a run, and their text enters the digest.

    \b
    Example:
      hedon config check my.toml
    """
    from hedon.config import digest, load_config
    from hedon.experiment.rule import pinned, rules, rules_beside

    config = load_config(source, fidelity, overrides or ())
    found = rules(config, rules_beside(source))
    for rule in found:
        _ = rule.compiled  # reports any problem with the rule's file
    typer.echo(f"{source}: valid (preset {config.preset}, fidelity {config.fidelity})")
    typer.echo(f"digest {digest(pinned(config, found))}")


def _food_lines(config: "Config") -> list[str]:
    lines = []
    for kind, food in config.food.items():
        amounts = ", ".join(f"{name} {amount:g}" for name, amount in food.gives.items()) or "nothing"
        lines.append(f"{kind}: {amounts}, at most {food.capacity}, {food.placement.form}")
    return lines


def _text(value: Any) -> str:
    from hedon.config.problem import format_value

    return "(absent)" if value is None else format_value(value)
