"""Makes worlds that a program drives."""

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
    """Makes worlds that a program drives, as arrays: how other programs train agents in hedon.

    Args:
        config: Settings of the worlds: a config, the name of a preset, or the path of a file.
        worlds: How many worlds advance together.
        seed: Of the first world, whose followers have the next numbers; a list with one for each world; or None for a
            first one drawn by chance (`simulation.seeds` tells them).
        species: Whose agents the caller drives: a name, several, or by default those whose policy is `external`, or
            all where there are none. A config without `[species]` has the species `agent`. All others act by their
            `learning.policy`.
        actions: What the numbers of actions are: `unit`, from −1, the least force of a motor, to 1, the greatest;
            `force`, the force itself [mass·u/s²]; or `logit`, what the networks of the engine give: any number, before
            the sigmoid.
        repeat: Steps of the worlds in one step, with the same actions.
        max_steps: Steps of a world after which its agents are truncated; 0 for no end. A world goes on if it is not
            begun again.
        render_mode: `rgb_array` to have pictures by `render`; `human` to see world 0 in a window, with pygame.
        threads: As in `hedon.Simulation`; changes no result.
        backend: As in `hedon.Simulation`.
        record: Folder for what `hedon run` would write, which reports, analyses and the page then read; None for none.
            Worlds that begin again are a new run, in a folder with a number after its name. Call `close` at the end, or
            use `with`.
        frames: Steps of the worlds between two frames of the records, for the page; 0 for none.
        world: What `VectorEnv.save` gave of one world with the same config, driven in the same way. All worlds begin as
            it was, and do so again at each reset; from there each goes its own way by its seed.
        overrides: Settings that differ from those of the preset or file, as for `load_config`; of a `Config` use
            `Config.with_`.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: Another argument is wrong.
        EngineError: As in `hedon.Simulation`.
        RecordError: The folder holds a run already, is in use, or cannot be written.
    """
    config = loaded(config, overrides)
    return VectorEnv(
        config, worlds, seed, species, actions, repeat, max_steps, render_mode, threads, backend, record, frames, world
    )
