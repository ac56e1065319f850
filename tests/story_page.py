"""Helpers for tests of the article: its scenes, and the same worlds run by the engine in Python."""

from collections.abc import Callable
from typing import Any

from view_page import Watched

from hedon import Simulation, load_config
from hedon.view.story import SCENES

STAGES = ("creature", "learning", "family", "evolve", "contest", "sandbox")
"""The scenes with a world."""


def stage(name: str) -> str:
    """JavaScript for the stage of a scene on the page."""
    return f"hedon.scenes.{name}.stage"


def run_to(watched: Watched, name: str, step: int) -> None:
    """Runs the world of a scene to a step as fast as possible."""
    watched.get(f"void {stage(name)}.runTo({step})")
    watched.until(f"!{stage(name)}.running && {stage(name)}.live.last >= {step}", 200)


def set_knob(watched: Watched, name: str, path: str, value: str) -> None:
    """Moves a slider to a value and releases it, like a reader."""
    watched.get(
        f"""(() => {{
          const knob = document.querySelector(`#{name} input[data-path="{path}"]`);
          knob.value = "{value}";
          knob.dispatchEvent(new Event("input", {{ bubbles: true }}));
          knob.dispatchEvent(new Event("change", {{ bubbles: true }}));
        }})()"""
    )
    watched.until(f"{stage(name)}.live.ready")


def backend(watched: Watched, name: str) -> str:
    """The Python backend that gives the same bits as the page."""
    return "" if watched.get(f"{stage(name)}.live.fused") else "portable"


def native(watched: Watched, name: str, file: str, step: int, *changes: str, seed: int = 1) -> Any:
    """The same world, run by the engine in Python."""
    config = load_config(SCENES / f"{file}.toml", overrides=changes)
    simulation = Simulation(config, seeds=[seed], backend=backend(watched, name))
    simulation.run(step)
    return simulation.worlds[0]


def address_of(watched: Watched, name: str) -> str:
    """The address of the scene's link, once it contains the current digest."""
    digest = f"{stage(name)}.live.digest()"
    watched.until(f"{digest} && document.querySelector('#{name} .permalink').href.endsWith({digest}.slice(0, 8))")
    return watched.get(f"new URL(document.querySelector('#{name} .permalink').href).hash")


def opened(article: Callable[..., Watched], name: str, address: str) -> Watched:
    """The page as opened from the link by a second reader."""
    other = article(name, address)
    other.until("hedon.opened !== ''", 200)
    other.until(f"document.querySelector('#{name} .digest').textContent.includes('as in the link')")
    return other


def click_agent(watched: Watched, some: int) -> None:
    """Clicks an agent of the family scene at its current place."""
    x, y = watched.get(
        f"""(() => {{
          const {{ frame, arena }} = {stage("family")};
          const i = [...frame.id].indexOf({some});
          return arena.scene.toPage(frame.x[i], frame.y[i]);
        }})()"""
    )
    watched.page.mouse.click(x, y)
