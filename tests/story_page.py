"""What tests of the article share: its scenes, and the same worlds by the engine in Python."""

from collections.abc import Callable
from typing import Any

from view_page import Watched

from hedon import Simulation, load_config
from hedon.view.story import SCENES

STAGES = ("creature", "learning", "family", "evolve", "contest", "sandbox")
"""The scenes that have a world."""


def stage(name: str) -> str:
    """The stage of a scene, as code of the page."""
    return f"hedon.scenes.{name}.stage"


def run_to(watched: Watched, name: str, step: int) -> None:
    """Runs the world of a scene to a step, as fast as it can."""
    watched.get(f"void {stage(name)}.runTo({step})")
    watched.until(f"!{stage(name)}.running && {stage(name)}.live.last >= {step}", 200)


def set_knob(watched: Watched, name: str, path: str, value: str) -> None:
    """Moves a slider to a value, as a reader does, and lets it go."""
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
    """The backend of Python whose bits are those of the page."""
    return "" if watched.get(f"{stage(name)}.live.fused") else "portable"


def native(watched: Watched, name: str, file: str, step: int, *changes: str, seed: int = 1) -> Any:
    """The same world by the engine in Python."""
    config = load_config(SCENES / f"{file}.toml", overrides=changes)
    simulation = Simulation(config, seeds=[seed], backend=backend(watched, name))
    simulation.run(step)
    return simulation.worlds[0]


def address_of(watched: Watched, name: str) -> str:
    """The address of the scene's link, once it tells of the digest of now."""
    digest = f"{stage(name)}.live.digest()"
    watched.until(f"{digest} && document.querySelector('#{name} .permalink').href.endsWith({digest}.slice(0, 8))")
    return watched.get(f"new URL(document.querySelector('#{name} .permalink').href).hash")


def opened(article: Callable[..., Watched], name: str, address: str) -> Watched:
    """A second reader, who opens the link."""
    other = article(name, address)
    other.until("hedon.opened !== ''", 200)
    other.until(f"document.querySelector('#{name} .digest').textContent.includes('as in the link')")
    return other


def click_agent(watched: Watched, some: int) -> None:
    """Clicks an agent of the scene with families, where it is now."""
    x, y = watched.get(
        f"""(() => {{
          const {{ frame, arena }} = {stage("family")};
          const i = [...frame.id].indexOf({some});
          return arena.scene.toPage(frame.x[i], frame.y[i]);
        }})()"""
    )
    watched.page.mouse.click(x, y)
