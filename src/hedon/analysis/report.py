"""Makes a run's `summary.json` and figures from its folder alone, as often as one likes."""

import json
from pathlib import Path

from matplotlib.figure import Figure

from hedon.analysis.figure_history import draw_history
from hedon.analysis.figure_population import draw_population
from hedon.analysis.figure_weights import draw_weights
from hedon.analysis.figure_world import draw_world, telling_agent
from hedon.analysis.style import food_colors, save_figure
from hedon.analysis.summary import summarize
from hedon.record.atomic import write_atomically
from hedon.record.error import RecordError
from hedon.record.folder import FIGURES, SUMMARY
from hedon.record.reader import Run
from hedon.record.snapshot import load_snapshot


def write_report(run: Run) -> list[Path]:
    """Writes the summary and the figures of a run into its folder, over those that are there.

    Damaged parts are left out; the summary names them. The picture of the world needs `final.npz`.

    Returns:
        The files written: `summary.json`, then `figures/*.png`.

    Raises:
        RecordError: the folder cannot be written, or `final.npz` is damaged; all other files are there then.
    """
    text = json.dumps(summarize(run), indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    agents, population = run.agents(skip_damaged=True), run.population(skip_damaged=True)
    kinds, neutral = run.food_kinds, run.neutral_names
    colors = food_colors(kinds, run.manifest.food_colors)
    try:
        write_atomically(run.path / SUMMARY, lambda file: file.write(text.encode()))
        (run.path / FIGURES).mkdir(exist_ok=True)
        files = [
            run.path / SUMMARY,
            _save(run, "weights", draw_weights(agents, kinds, neutral)),
            _save(run, "history", draw_history(population, kinds, neutral, colors)),
            _save(run, "population", draw_population(population, kinds, colors)),
        ]
        snapshot = load_snapshot(run.path)
        if snapshot is not None:
            focus = telling_agent(snapshot)
            files.append(_save(run, "world", draw_world(snapshot, colors, [] if focus is None else [focus])))
    except OSError as error:
        raise RecordError(f"cannot write the report into {run.path}: {error}") from error
    return files


def _save(run: Run, name: str, figure: Figure) -> Path:
    return save_figure(figure, run.path / FIGURES / f"{name}.png")
