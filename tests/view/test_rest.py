"""An idle page draws nothing; anything that changes the picture redraws it."""

from view_page import run_server, serving

pytest_plugins = ("view_fixture",)

COUNTED = """
(() => {
  window.drawn = 0;
  const draw = WebGL2RenderingContext.prototype.drawArraysInstanced;
  WebGL2RenderingContext.prototype.drawArraysInstanced = function (...given) {
    window.drawn++;
    return draw.apply(this, given);
  };
})()
"""
CHANGES = {
    "another moment": "hedon.seek(704)",
    "another view": "hedon.arena.drag([100, 100], [120, 90])",
    "a closer view": "hedon.arena.drag([100, 100], [100, 100], 2)",
    "an agent": "hedon.choose(hedon.frame.id[0])",
    "its rays": "hedon.arena.showRays = false",
    "colors": "hedon.colors.choose('age')",
    "the ground": "document.querySelector('#theme').click()",
    "a branch": "hedon.arena.marked = new Set(hedon.frame.id)",
}


def still(watched) -> None:
    """Waits until the page draws nothing for a while."""
    for _ in range(20):
        drawn, pictures = watched.get("[drawn, hedon.pictures]")
        watched.until(f"hedon.pictures > {pictures} + 20")
        if watched.get("drawn") == drawn:
            return
    raise AssertionError("the page draws though nothing changes")


def test_a_change_redraws_the_picture_and_then_the_page_rests(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        watched = watch(server.link)
        watched.get(COUNTED)
        watched.rest_at(640)
        still(watched)
        for what, change in CHANGES.items():
            drawn = watched.get("drawn")
            watched.get(f"({change}, 0)")
            watched.until(f"{what!r} && drawn > {drawn}")  # so that a failure names the change
            still(watched)
        drawn = watched.get("drawn")
        watched.get("hedon.play(true)")
        watched.until(f"drawn > {drawn} + 10")
