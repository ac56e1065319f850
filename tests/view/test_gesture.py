"""Two fingers move and zoom the view at once, and the point between them stays between them."""

import pytest
from view_page import run_server, serving, sized

pytest_plugins = ("view_fixture",)


def touch(watched, kind, *places):
    points = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(places)]
    watched.touches.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})


@pytest.fixture
def watched(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        page = watch(server.link, **sized(390))
        page.rest_at(640)
        page.touches = page.page.context.new_cdp_session(page.page)
        yield page


def test_a_pinch_zooms_about_its_middle(watched):
    box = watched.page.locator("#scene").bounding_box()
    x, y = box["x"] + box["width"] * 0.4, box["y"] + box["height"] * 0.5
    zoom = watched.get("hedon.arena.scene.zoom")
    before = watched.get(f"hedon.arena.scene.toWorld({x}, {y})")
    touch(watched, "touchStart", (x - 30, y))
    touch(watched, "touchStart", (x - 30, y), (x + 30, y))
    for gap in range(30, 65, 5):
        touch(watched, "touchMove", (x - gap, y), (x + gap, y))
    watched.until(f"hedon.arena.scene.zoom > 1.98 * {zoom}")
    assert watched.get("hedon.arena.scene.zoom") == pytest.approx(2 * zoom, rel=0.02)
    assert watched.get(f"hedon.arena.scene.toWorld({x}, {y})") == pytest.approx(before, abs=1.5)
    touch(watched, "touchEnd", (x + 60, y))  # one finger stays down and keeps dragging
    touch(watched, "touchEnd")
    assert watched.get(f"hedon.arena.scene.toWorld({x}, {y})") == pytest.approx(before, abs=1.5)
    assert watched.get("hedon.chosen") == -1


def test_a_drag_moves_the_world_with_the_finger(watched):
    box = watched.page.locator("#scene").bounding_box()
    x, y = box["x"] + 150, box["y"] + 100
    before = watched.get(f"hedon.arena.scene.toWorld({x}, {y})")
    touch(watched, "touchStart", (x, y))
    for d in range(0, 65, 5):
        touch(watched, "touchMove", (x + d, y + d / 2))
    touch(watched, "touchEnd")
    assert watched.get(f"hedon.arena.scene.toWorld({x + 60}, {y + 30})") == pytest.approx(before, abs=1.0)


@pytest.mark.long
def test_a_view_survives_a_resize_and_a_reload(watched):
    watched.get("hedon.arena.look(hedon.source, [240, 180, 3])")
    watched.get("hedon.viewed()")
    watched.page.set_viewport_size({"width": 600, "height": 844})
    watched.until("hedon.arena.scene.canvas.clientWidth === 600")
    watched.until("hedon.arena.view(hedon.source)?.map(Math.round).join() === '240,180,3'")
    watched.page.reload()
    watched.until("window.hedon && hedon.pictures > 3")
    assert watched.get("hedon.arena.view(hedon.source)") == pytest.approx([240, 180, 3], rel=1e-3)
