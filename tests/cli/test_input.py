"""Input that only programs would produce: it gets one message and exit code 2, quickly."""

import os
import subprocess
import time
from pathlib import Path

import pytest
from command import hedon

FILES = {
    "digits": ('preset = "small"\n[energy]\ninitial = ' + "9" * 5000, "more than 1,000 digits"),
    "tables": ("[" + ".".join(["a"] * 500) + "]\nx = 1", "nested deeper than"),
    "lists": ("x = " + "[" * 200 + "]" * 200, "nested deeper than"),
    "more lists": ("x = " + "[" * 20_000 + "]" * 20_000, "nested deeper than"),
    "sections": ("".join(f"[s{i}]\nx = 1\n" for i in range(20_000)), "more than 5,000 names"),
    "unknown": ("".join(f"[initial{i}]\n" for i in range(4000)), "and 3,980 more"),
    "kinds": ("".join(f"[food.normol{i}]\nx = 1\n" for i in range(2000)), "and 1,980 more"),
    "size": ("x" * 50_000_000 + " = 1", "too large for a config"),
    "a long name": ('name = "' + "x" * 900_000 + '"', "(900,002 characters)"),
    "bidirectional": ('"a\u202eb" = 1', r"a\u202eb: unknown name"),
    "escape": ('"a\\u001b[31mb" = 1', r"a\x1b[31mb: unknown name"),
    "null": ("x = \0", "is not valid TOML"),
}


@pytest.mark.parametrize("name", FILES)
def test_a_file_that_is_not_a_config_gets_one_message_quickly(tmp_path: Path, name: str) -> None:
    text, words = FILES[name]
    path = tmp_path / "my.toml"
    path.write_text(text, encoding="utf-8")
    begun = time.monotonic()
    answer = hedon("config", "check", str(path))
    assert answer.returncode == 2
    assert words in answer.stderr
    assert "Traceback" not in answer.stderr
    assert len(answer.stderr) < 6000
    assert time.monotonic() - begun < 20, "should take about a second on an idle machine"


def test_a_byte_order_mark_and_carriage_returns_are_read(tmp_path: Path) -> None:
    path = tmp_path / "my.toml"
    path.write_bytes(b'\xef\xbb\xbfpreset = "small"\r\n[energy]\r\ninitial = 20.0\r\n')
    assert hedon("config", "check", str(path)).returncode == 0


@pytest.mark.parametrize(
    ("seeds", "words"),
    [("9" * 5000, "a seed of 5,000 digits"), ("-3", "-3 is negative"), ("1-" + "9" * 5000, "5,000 digits")],
)
def test_invalid_seeds_get_one_line(seeds: str, words: str) -> None:
    answer = hedon("run", "small", f"--seeds={seeds}")
    assert answer.returncode == 2
    assert words in answer.stderr
    assert len(answer.stderr.splitlines()) == 1


@pytest.mark.parametrize("value", ["[" * 50_000, "9" * 5000, "9" * 900, '"' + "x" * 100_000])
def test_invalid_values_of_settings_get_a_short_message(value: str) -> None:
    answer = hedon("config", "check", "small", "--set", f"energy.initial={value}")
    assert answer.returncode == 2
    assert "energy.initial = " in answer.stderr
    assert len(answer.stderr) < 500
    for override in (".".join(["a"] * 500) + "=1", "energy.initial=0x" + "f" * 5000):
        answer = hedon("config", "check", "small", "--set", override)
        assert (answer.returncode, "Traceback" in answer.stderr) == (2, False)


def test_commands_work_with_ascii_output() -> None:
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    for command in (["forecast", "baseline"], ["config", "show", "baseline"]):
        answer = subprocess.run(["hedon", *command], capture_output=True, text=True, check=False, env=environment)
        assert (answer.returncode, answer.stderr) == (0, "")


def test_a_limit_on_address_space_is_reported_before_libraries_abort() -> None:
    script = "ulimit -v 800000; exec hedon run baseline --steps 64"
    answer = subprocess.run(["sh", "-c", script], capture_output=True, text=True, check=False, timeout=60)
    assert answer.returncode == 2
    assert answer.stderr.startswith("hedon: `ulimit -v` allows this process 0.8 GB of addresses")
    assert len(answer.stderr.splitlines()) == 1
