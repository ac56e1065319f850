"""Text from outside in messages: a path in a command that a user copies."""

import os

import pytest

from hedon.text import command_word


@pytest.mark.skipif(os.name == "nt", reason="as the shells of Unix read it")
def test_a_path_is_one_word_of_a_command():
    assert command_word("runs/one") == "runs/one"
    assert command_word("my runs/one") == "'my runs/one'"


def test_on_windows_a_path_has_double_quotes_or_none(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("hedon.text.os.name", "nt")
    assert command_word("C:\\Users\\me\\größe-1") == "C:\\Users\\me\\größe-1"
    assert command_word("C:\\my runs & more") == '"C:\\my runs & more"'
