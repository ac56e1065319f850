"""Keys and buttons do what they say, and lists, buttons and tabs keep their own keys."""

import pytest
from view_page import run_server, serving

pytest_plugins = ("view_fixture",)


@pytest.fixture
def watched(run_folder, watch):
    with serving(run_server(run_folder)) as server:
        page = watch(server.link)
        page.rest_at(640)
        yield page


def test_shift_and_an_arrow_move_by_ten_frames(watched):
    watched.page.keyboard.press("Shift+ArrowRight")
    watched.until("hedon.frame.step === 640 + 10 * 64")
    watched.page.keyboard.press("Shift+ArrowLeft")
    watched.until("hedon.frame.step === 640")


def test_escape_closes_the_help_and_keeps_the_agent(watched):
    watched.page.keyboard.press("n")
    watched.until("hedon.chosen >= 0")
    watched.page.keyboard.press("?")
    watched.until("document.querySelector('#help').open")
    assert "Tab" not in watched.page.locator("#help").inner_text()
    watched.page.keyboard.press("Escape")
    watched.until("!document.querySelector('#help').open")
    assert watched.get("[hedon.chosen >= 0, hedon.playing]") == [True, False]


def test_the_space_bar_opens_a_group_of_settings_and_does_not_pause_the_world(watched):
    watched.page.locator("#world").select_option("live 0")
    watched.until("hedon.source.live && hedon.frame && hedon.playing")
    watched.get("hedon.tab('settings')")
    group = watched.page.locator("#settings summary").first
    group.focus()
    watched.page.keyboard.press(" ")
    watched.until("document.querySelector('#settings details').open")
    assert watched.get("hedon.playing")


def test_arrows_go_from_tab_to_tab_and_not_through_time(watched):
    watched.page.locator("#tab-agent").focus()
    for name in ("agents", "plots", "tree", "settings", "world-panel", "agent"):
        watched.page.keyboard.press("ArrowRight")
        assert watched.get("document.activeElement.id") == f"tab-{name}"
        panels = (
            "[...document.querySelectorAll('[role=tabpanel]')].filter((each) => !each.hidden).map((each) => each.id)"
        )
        assert watched.get(panels) == [name]
    watched.page.keyboard.press("End")
    assert watched.get("document.activeElement.id") == "tab-world-panel"
    assert watched.get("hedon.frame.step") == 640


def test_the_tab_key_reaches_every_control(watched):
    """With the keyboard only: whatever can be clicked can be focused, and the focus is visible."""
    bars = "[...document.querySelectorAll('header *, footer *, #look *')]"
    wanted = set(
        watched.get(f"{bars}.filter((each) => each.tabIndex >= 0 && each.offsetParent).map((each) => each.id)")
    )
    assert {"play", "look-whole", "timeline", "theme"} <= wanted
    reached = set()
    for _ in range(100):  # each plot has three controls
        watched.page.keyboard.press("Tab")
        name, outline = watched.get(
            "[document.activeElement.id, getComputedStyle(document.activeElement).outlineStyle]"
        )
        assert name == "" or outline != "none"  # after the last control, the page itself has the focus
        reached.add(name)
    assert wanted <= reached


@pytest.mark.long
def test_buttons_show_the_whole_arena_choose_and_follow(watched):
    whole = watched.get("hedon.arena.scene.zoom")
    box = watched.page.locator("#scene").bounding_box()
    watched.page.mouse.move(box["x"] + 200, box["y"] + 200)
    watched.page.mouse.wheel(0, -600)
    watched.until(f"hedon.arena.scene.zoom > 1.5 * {whole}")
    watched.page.get_by_role("button", name="Whole").click()
    assert watched.get("hedon.arena.scene.zoom") == pytest.approx(whole)
    watched.page.get_by_role("button", name="Next").click()
    watched.until("hedon.chosen === hedon.frame.id[0]")
    watched.page.get_by_role("button", name="Follow").click()
    watched.until("document.querySelector('#look-follow').ariaPressed === 'true'")
    watched.until("Math.abs(hedon.arena.scene.centerX - hedon.frame.x[0]) < 1e-6")
    watched.page.get_by_role("button", name="Full").click()
    watched.until("document.fullscreenElement?.id === 'stage'")
