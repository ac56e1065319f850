"""The help of `hedon` lists each command once, by group, on one screen."""

from command import hedon

from hedon.cli.main import GROUPS, app


def test_every_command_is_in_one_group():
    listed = [name for commands in GROUPS.values() for name in commands]
    commands = [each.callback.__name__ for each in app.registered_commands if each.callback]
    groups = [each.name for each in app.registered_groups]
    assert sorted(listed) == sorted(map(str, [*commands, *groups]))
    assert len(listed) <= 16


def test_the_help_fits_one_screen():
    lines = hedon("--help").stdout.splitlines()
    assert len(lines) <= 45
    assert not [line for line in lines[2:] if line.endswith("...")], "descriptions are cut off"


def test_the_command_alone_shows_its_help():
    alone = hedon()
    assert (alone.stdout, alone.returncode) == ("", 2)
    assert alone.stderr.splitlines()[1:] == hedon("--help").stdout.splitlines()[1:]
