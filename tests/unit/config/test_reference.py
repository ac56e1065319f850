from pathlib import Path

from hedon.config.reference import reference

PAGE = Path(__file__).parents[3] / "docs" / "config.md"


def test_the_committed_page_is_current() -> None:
    current = PAGE.read_text(encoding="utf-8")
    assert current == reference(), "run: uv run python -m hedon.config.reference > docs/config.md"
