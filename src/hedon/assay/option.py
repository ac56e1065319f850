"""The options of assays: which genes, how founders are spread, which runs."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from hedon.assay.landscape import NEUTRAL, AssayError, Spread
from hedon.config.config import Config
from hedon.config.dump import digest
from hedon.config.evolution import GenomeConfig
from hedon.config.layout import choose_species
from hedon.experiment.plan import RunPlan, seed_span
from hedon.record.folder import CONFIG
from hedon.record.founder import Founders, column_of, join, unknown_gene
from hedon.record.founder_source import read_source, source_label
from hedon.text import brief


def choose_genes(text: str | None, config: Config, species: str | None = None) -> tuple[str, str]:
    """The columns of two genes of a species from a text such as "food,action", which is also the default.

    Args:
        text: two names with a comma between them; None for the default.
        config: that has the genes.
        species: by default the first.

    Raises:
        AssayError: They are not two genes of the config.
    """
    names = [name.strip() for name in (text if text is not None else "food,action").split(",")]
    own = choose_species(species, config)
    columns = [column_of(config, name, own) for name in names]
    for name, column in zip(names, columns, strict=True):
        if column is None:
            raise AssayError(f"--genes {brief(str(text))}: {unknown_gene(config, name)}")
    first, second = columns if len(columns) == 2 else (None, None)
    if first is None or second is None or first == second:
        raise AssayError(f"--genes {brief(str(text))}: must be two different genes, as in food,action")
    return first, second


def parse_spread(text: str, sd: float | None, genome: GenomeConfig) -> Spread:
    """How founders are spread, from a range such as "-8:8", or normally if `sd` is given.

    Args:
        text: LOW:HIGH.
        sd: standard deviation of a normal law around 0, which then holds instead of the range; or None.
        genome: with the limit of weights.

    Raises:
        AssayError: It is not a range within the weight limit, or the standard deviation is not above 0.
    """
    limit = genome.weight_limit
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
    return RunPlan(plan.config, seeds, steps, folder, threads, 0, checkpoint, founders, rules=plan.rules)


def competitors(sources: Sequence[str], shares: Sequence[float], config: Config) -> tuple[Founders, tuple[str, str]]:
    """Founders from two sources, and the names of their groups.

    Args:
        sources: two, each as `hedon run --founders` takes it.
        shares: of both among the founders.
        config: of the world that they compete in.

    Raises:
        FounderError: A source cannot be used.
        RecordError: A run cannot be read.
    """
    tables = [read_source(source, config) for source in sources]
    first, second = (source_label(source) for source in sources)
    names = (first, second if second != first else f"{second} (2)")
    return join(tables, names, shares), names


def knocked_out(source: str, gene: str, config: Config) -> tuple[Founders, tuple[str, str]]:
    """The living of a run with one gene set to 0, against themselves, and the names of both groups.

    Args:
        source: the living of a run, RUN or RUN@STEP.
        gene: its column, its kind of food, or `action`.
        config: of the world that they compete in.

    Raises:
        AssayError: The run has no such gene.
        FounderError: Nobody lived then.
        RecordError: It is not a run, or cannot be read.
    """
    column = column_of(config, gene)
    wild = read_source(source, config)
    if column is None or column not in wild.genes:
        raise AssayError(f"knockout {brief(source)}: {unknown_gene(config, gene)}")
    names = (f"{column.removeprefix('w_')} = 0", source_label(source))
    return join([wild.changed(column, 0.0), wild], names, [1.0, 1.0]), names


def condition_of(given: str | None, sources: Sequence[str]) -> str:
    """The preset or file that an assay takes place in: the given one, else that of the first run, else baseline.

    Args:
        given: a preset or a file; None if the user gave none.
        sources: of the founders; some may be runs.
    """
    if given is not None:
        return given
    folders = [Path(source.rpartition("@")[0] or source) for source in sources]
    folders += [Path(source) for source in sources]
    return next((str(folder / CONFIG) for folder in folders if (folder / CONFIG).is_file()), "baseline")


def stability_config(config: Config, point: Mapping[str, float]) -> Config:
    """A config whose founders begin around a point, with mutation as it is and the assay's neutral markers.

    Args:
        config: of the condition.
        point: means of the founders' genes, by column; other genes keep theirs.

    Raises:
        AssayError: The point has a neutral marker.
    """
    changed = config.with_("genome.neutral_count", NEUTRAL).with_("world.founders", "")
    for column, value in point.items():
        kind = column.removeprefix("w_")
        if column == "w_action":
            changed = changed.with_("genome.action.initial_mean", value)
        elif kind in config.food:
            changed = changed.with_(f"food.{kind}.gene.initial_mean", value)
        else:
            raise AssayError(f"--at {column}={value:g}: a neutral marker is the control, so give food kinds and action")
    return changed
