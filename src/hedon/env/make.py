"""Creates worlds that a program drives."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from hedon.config.config import Config
from hedon.env.argument import loaded
from hedon.env.group import Form
from hedon.env.vector import VectorEnv


def make(
    config: Config | str | Path,
    worlds: int = 1,
    seed: int | Sequence[int] | None = None,
    species: str | Sequence[str] | None = None,
    actions: Form = "unit",
    repeat: int = 1,
    max_steps: int = 0,
    render_mode: str | None = None,
    threads: int = 0,
    backend: str = "",
    record: Path | str | None = None,
    frames: int = 0,
    world: bytes | None = None,
    overrides: Iterable[str] = (),
) -> VectorEnv:
    """Creates worlds that a program drives, as arrays, so that other programs can train agents in hedon.

    Args:
        config: Settings of the worlds: a config, the name of a preset, or the path of a file.
        worlds: Number of worlds that advance together.
        seed: Seed of the first world, with the following numbers for the others; a list with one seed per world; or
            None for a random first one (`simulation.seeds` lists them).
        species: Species whose agents the caller drives: a name or several; by default those whose policy is `external`,
            or all if there are none. A config without `[species]` has the species `agent`. All others act according to
            their `learning.policy`.
        actions: Meaning of the numbers in an action: `unit`, from −1, a motor's smallest force, to 1, its largest;
            `force`, the force itself [mass·u/s²]; or `logit`, like the output of the engine's networks: any number,
            before the sigmoid.
        repeat: World steps per environment step, all with the same actions.
        max_steps: World steps after which agents are truncated; 0 for no limit. The world continues until it is reset.
        render_mode: `rgb_array` for pictures from `render`; `human` for a window that shows world 0, with pygame.
        threads: Number of threads; 0 for one per 150 slots, or for all processors if the engine computes networks of
            some agents. Changes no result.
        backend: As in `hedon.Simulation`.
        record: Folder for the files that `hedon run` would write, which reports, analyses and the page can read; None
            for no records. Each restart of worlds begins a new run, in a folder with a number after its name. Call
            `close` at the end, or use `with`.
        frames: World steps between two recorded frames, for the page; 0 for none.
        world: One world from `VectorEnv.save`, with the same config and driven in the same way. All worlds start from
            it, and do so again at each reset; from there each diverges according to its seed.
        overrides: Settings that replace those of the preset or file, as for `load_config`; for a `Config` use
            `Config.with_`.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: Another argument is wrong.
        EngineError: As in `hedon.Simulation`.
        RecordError: The folder already holds a run, is in use, or cannot be written.
    """
    config = loaded(config, overrides)
    return VectorEnv(
        config, worlds, seed, species, actions, repeat, max_steps, render_mode, threads, backend, record, frames, world
    )
