from typer.testing import CliRunner

from hedon.cli.main import app
from hedon.config import ConfigError


def test_forecast_prints_tables_and_warnings() -> None:
    result = CliRunner().invoke(app, ["forecast", "baseline", "--set", "food.normal.growth_rate=1.0"])
    assert result.exit_code == 0, result.output
    assert "life at constant energy" in result.output
    assert "births that find a place" in result.output
    assert "! It can live without eating: R0 is 1.02 at energy 0" in result.output
    assert "stand still" in result.output
    assert "within a factor of 3" in " ".join(result.output.split())
    assert "Generations in 204,800 steps" in " ".join(result.output.split())


def test_a_world_that_cannot_be_made_has_no_intake() -> None:
    law = 'food.normal.placement={form="gaussian", centers=[[240, 180]], sd=[2, 2]}'
    result = CliRunner().invoke(app, ["forecast", "baseline", "--set", law, "--steps", "1000"])
    assert result.exit_code == 0, result.output
    assert "! A run cannot start" in result.output
    assert "What is eaten" not in result.output


def test_a_wrong_setting_raises_a_hedon_error() -> None:
    result = CliRunner().invoke(app, ["forecast", "baseline", "--set", "hazard.kapa=1.0"])
    assert isinstance(result.exception, ConfigError)
