"""A pytest plugin that opens the article at a scene."""

import pytest
from story_page import STAGES, stage
from view_page import serving, story_server

from hedon.view.story import PAGE


@pytest.fixture(scope="module")
def story_site():
    with serving(story_server()) as running:
        yield running


@pytest.fixture
def article(story_site, watch):
    """Opens the article at a scene or a link's address; keyword arguments go to Playwright's context."""

    def open_at(scene, address="", **how):
        watched = watch(f"{story_site.link}{PAGE}{address}", **how)
        watched.until(f"hedon.scenes.sandbox && hedon.scenes.{scene}")
        if not address:
            watched.get(f"hedon.scenes.{scene}.section.scrollIntoView({{ behavior: 'instant' }})")
            if scene in STAGES:
                watched.until(f"{stage(scene)}.live?.ready")
        return watched

    return open_at
