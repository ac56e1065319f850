"""Paths in commands that users copy from messages."""

from types import SimpleNamespace

import pytest

from hedon.text import command_word


@pytest.mark.parametrize(
    ("system", "path", "word"),
    [
        ("posix", "runs/one", "runs/one"),
        ("posix", "my runs/one", "'my runs/one'"),
        ("nt", "C:\\Users\\me\\größe-1", "C:\\Users\\me\\größe-1"),
        ("nt", "C:\\my runs & more", '"C:\\my runs & more"'),
    ],
)
def test_a_path_is_one_word_to_the_shells_of_each_system(
    system: str, path: str, word: str, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("hedon.text.os", SimpleNamespace(name=system))
    assert command_word(path) == word
