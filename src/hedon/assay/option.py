"""The options of assays: which genes, how founders are spread, which runs."""

from collections.abc import Sequence
from pathlib import Path

from hedon.assay.landscape import AssayError, Spread
from hedon.config.config import Config
from hedon.config.dump import digest
from hedon.experiment.plan import RunPlan, seed_span
from hedon.record.founder import Founders, column_of, unknown_gene
from hedon.text import brief


def choose_genes(text: str | None, config: Config) -> tuple[str, str]:
    """The columns of two genes from a text such as "food,action", which is also the default.

    Raises:
        AssayError: They are not two genes of the config.
    """
    names = [name.strip() for name in (text if text is not None else "food,action").split(",")]
    columns = [column_of(config, name) for name in names]
    for name, column in zip(names, columns, strict=True):
        if column is None:
            raise AssayError(f"--genes {brief(str(text))}: {unknown_gene(config, name)}")
    first, second = columns if len(columns) == 2 else (None, None)
    if first is None or second is None or first == second:
        raise AssayError(f"--genes {brief(str(text))}: must be two different genes, as in food,action")
    return first, second


def parse_spread(text: str, sd: float | None, config: Config) -> Spread:
    """How founders are spread, from a range such as "-8:8", or normally if `sd` is given.

    Raises:
        AssayError: It is not a range within the weight limit, or the standard deviation is not above 0.
    """
    limit = config.genome.weight_limit
    if sd is not None:
        if not 0 < sd <= limit:
            raise AssayError(f"--sd {sd:g}: must be above 0 and at most genome.weight_limit = {limit:g}")
        return Spread(-limit, limit, sd)
    low, _, high = text.partition(":")
    try:
        spread = Spread(float(low), float(high))
    except ValueError:
        spread = Spread(1.0, 0.0)
    if not -limit <= spread.low < 0 < spread.high <= limit:
        raise AssayError(f"--range {brief(text)}: must be LOW:HIGH around 0, within {-limit:g}:{limit:g}, as in -8:8")
    return spread


def assay_plan(
    kind: str,
    config: Config,
    seeds: Sequence[int],
    steps: int,
    out: Path | None,
    threads: int,
    checkpoint: float,
    founders: Founders | None,
    part: str = "run",
) -> RunPlan:
    """A run of an assay, in a folder of its own within the assay's.

    Args:
        kind: of the assay, for the name of its folder.
        config: of the worlds.
        seeds: of the worlds.
        steps: of each world [step].
        out: the assay's folder; None for one whose name depends on what is asked, so that the same command finds it.
        threads: as for a run.
        checkpoint: as for a run [s].
        founders: to begin with; None for those that the config draws.
        part: name of the run's folder.
    """
    plan = RunPlan(config, seeds, steps, Path("unnamed"), threads, 0, checkpoint, founders)
    name = f"{kind}-{config.name}-{config.fidelity}-{seed_span(plan.seeds)}-{digest(plan.config)[:8]}"
    folder = (out or Path("assays") / name) / part
    return RunPlan(plan.config, seeds, steps, folder, threads, 0, checkpoint, founders)
