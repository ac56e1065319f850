"""Options of assays: the genes, the distribution of founders, and the runs."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from hedon.assay.contest import points_of
from hedon.assay.landscape import NEUTRAL, AssayError, Spread
from hedon.config.config import Config
from hedon.config.dump import digest
from hedon.config.layout import choose_species
from hedon.config.schema.evolution import GenomeConfig
from hedon.ensemble.demand import Demand, Past
from hedon.experiment.branch import plan_branch
from hedon.experiment.plan import RunPlan
from hedon.record.folder import CONFIG
from hedon.record.founder import Founders, column_of, join, unknown_gene
from hedon.record.founder_source import read_source, source_label
from hedon.record.reader import open_run
from hedon.text import brief


def choose_genes(text: str | None, config: Config, species: str | None = None) -> tuple[str, str]:
    """The genome columns of two genes of a species, from a text such as "food,action".

    Args:
        text: The two genes; None for food and action.
        config: Config of the worlds.
        species: Species that has the genes.

    Raises:
        AssayError: The text does not name two genes of the config.
    """
    names = [name.strip() for name in (text if text is not None else "food,action").split(",")]
    species_name = choose_species(species, config)
    columns = [column_of(config, name, species_name) for name in names]
    for name, column in zip(names, columns, strict=True):
        if column is None:
            raise AssayError(f"--genes {brief(str(text))}: {unknown_gene(config, name, species_name)}")
    first, second = columns if len(columns) == 2 else (None, None)
    if first is None or second is None or first == second:
        raise AssayError(f"--genes {brief(str(text))}: must be two different genes, as in food,action")
    return first, second


def parse_spread(text: str, sd: float | None, genome: GenomeConfig) -> Spread:
    """The distribution of founders: even over a range such as "-8:8", or normal if `sd` is given.

    Args:
        text: The range.
        sd: Standard deviation of a normal distribution; None for an even one.
        genome: Settings of the genome, with the weight limit.

    Raises:
        AssayError: The text is not a range within the weight limit, or the standard deviation is not above 0.
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


def assay_worlds(
    config: Config, seeds: Sequence[int], steps: int, founders: Founders | None, part: str = "run"
) -> Demand:
    """Specifies and checks worlds that an assay needs.

    Args:
        config: Settings of the worlds.
        seeds: Seeds of the worlds.
        steps: Length of each world [step].
        founders: Genomes of the founders; None to draw them from the config's distributions.
        part: Name of the folder of their run.
    """
    plan = RunPlan(config, seeds, steps, part, founders=founders)
    return _demand(plan, plan.seeds, part)


def _demand(plan: RunPlan, seeds: Sequence[int], name: str) -> Demand:
    steps_by_seed = dict.fromkeys(seeds, plan.steps)
    return Demand(plan.config, digest(plan.config), steps_by_seed, 0, plan.founders, plan.networks, plan.rules, name)


def assay_folder(kind: str, first: Demand) -> Path:
    """The folder of an assay. It is the same for any seeds and steps, so that assays can be extended.

    Args:
        kind: Kind of assay.
        first: Specification of its first worlds, which determines the folder's name.
    """
    return Path("assays") / f"{kind}-{first.config.name}-{first.config.fidelity}-{first.digest[:8]}"


def competitors(
    sources: Sequence[str], shares: Sequence[float], config: Config, species: str
) -> tuple[Founders, tuple[str, str]]:
    """Founders from two sources, and the names of their groups.

    Args:
        sources: The two sources, as for `--founders`.
        shares: Share of each source among the founders.
        config: Config of the worlds.
        species: Species that competes.

    Raises:
        AssayError: A source has no gene of the species, or the groups could not be distinguished.
        FounderError: A source cannot be used.
        RecordError: A run cannot be read.
    """
    tables = [_source(source, config, species) for source in sources]
    first, second = (source_label(source) for source in sources)
    names = (first, second if second != first else f"{second} (2)")
    return _joined(tables, names, shares, config, species), names


def _joined(
    tables: Sequence[Founders], names: tuple[str, str], shares: Sequence[float], config: Config, species: str
) -> Founders:
    founders = join(tables, names, shares)
    if config.species[species].birth.mating == "pairs":
        points_of(founders, names, species)  # raises if genes could not distinguish the groups
    return founders


def _source(source: str, config: Config, species: str) -> Founders:
    """The genes of one species; with several species, the names of genes include it."""
    if len(config.species) == 1:
        return read_source(source, config)
    if "=" in source and not source.endswith(".csv"):
        parts = (part.strip() for part in source.split(","))
        source = ",".join(part if "." in part.partition("=")[0] else f"{species}.{part}" for part in parts)
    founders = read_source(source, config)
    species_founders = founders.only_for(species)
    if not species_founders.genes:
        raise AssayError(f"{brief(source)}: has no gene of the species {species}, but {', '.join(founders.genes)}")
    species_founders.require(config, source)
    return species_founders


def parse_shares(text: str, config: Config, species: str) -> tuple[float, ...]:
    """The shares of a group among the founders, in ascending order, from a text such as "0.05,0.5,0.95".

    Raises:
        AssayError: There are fewer than two different shares, or one leaves a group without founders.
    """
    count = config.species[species].population.initial_count
    try:
        shares = sorted({float(part) for part in text.split(",")})
    except ValueError:
        shares = []
    if len(shares) < 2 or not all(0 < share < 1 for share in shares):
        raise AssayError(f"--shares {brief(text)}: must be two or more different shares between 0 and 1, as in 0.1,0.9")
    for share in shares:
        if round(min(share, 1.0 - share) * count, 6) < 1:
            raise AssayError(
                f"--shares {brief(text)}: with {count} founders {share:g} leaves a group without any: take shares from "
                f"{1 / count:g} to {1 - 1 / count:g}, or raise population.initial_count"
            )
    return tuple(shares)


def knocked_out(source: str, gene: str, config: Config, species: str) -> tuple[Founders, tuple[str, str]]:
    """Founders for a knockout: the living of a run with one gene set to 0, against the same agents unchanged.

    Args:
        source: The run, as RUN or RUN@STEP.
        gene: The gene to set to 0.
        config: Config of the worlds.
        species: Species that competes.

    Returns:
        The founders, and the names of both groups.

    Raises:
        AssayError: The run has no such gene, or the groups could not be distinguished.
        FounderError: No agent was alive then.
        RecordError: The source is not a run, or cannot be read.
    """
    column = column_of(config, gene if len(config.species) == 1 else f"{species}.{gene}")
    wild_type = _source(source, config, species)
    if column is None or column not in wild_type.genes:
        raise AssayError(f"knockout {brief(source)}: {unknown_gene(config, gene, species)}")
    names = (f"{column.rpartition('.')[2].removeprefix('w_')} = 0", source_label(source))
    return _joined([wild_type.changed(column, 0.0), wild_type], names, (1.0, 1.0), config, species), names


def condition_of(given: str | None, sources: Sequence[str]) -> str:
    """The preset or config file of an assay: the given one, or that of the first run, or baseline.

    Args:
        given: The preset or file that the user gave; None for none.
        sources: Sources of founders, some of which may be runs.
    """
    if given is not None:
        return given
    folders = [Path(source.rpartition("@")[0] or source) for source in sources]
    folders += [Path(source) for source in sources]
    return next((str(folder / CONFIG) for folder in folders if (folder / CONFIG).is_file()), "baseline")


def stability_config(config: Config, point: Mapping[str, float]) -> Config:
    """A config whose founders start around a point, with unchanged mutation and the assay's neutral genes.

    Args:
        config: The config to change.
        point: Mean of each gene among the founders, by column.

    Raises:
        AssayError: The point has a neutral gene; there are several species, whose genes `--at` cannot name; or children
            have two parents, while drift is computed along pedigrees with one.
    """
    if len(config.species) > 1:
        species_names = ", ".join(config.species)
        raise AssayError(f"stability: needs a world of one species, and {config.name} has {species_names}")
    if next(iter(config.species.values())).birth.mating == "pairs":
        raise AssayError(
            'stability: needs children of one parent, since drift is computed along their pedigree: birth.mating="none"'
        )
    assay_config = config.with_("genome.neutral_count", NEUTRAL).with_("world.founders", "")
    for column, value in point.items():
        kind = column.removeprefix("w_")
        if column == "w_action":
            assay_config = assay_config.with_("genome.action.initial_mean", value)
        elif kind in config.food:
            assay_config = assay_config.with_(f"food.{kind}.gene.initial_mean", value)
        else:
            raise AssayError(f"--at {column}={value:g}: a neutral gene is the control, so give food kinds and action")
    return assay_config


def contingency_worlds(
    sources: Sequence[str], of: Sequence[int] | None, seeds: Sequence[int], fresh: Sequence[int], steps: int
) -> list[Demand]:
    """The worlds of a contingency assay: fresh worlds first, then the futures of each world of each run.

    Args:
        sources: Runs, each as RUN or RUN@STEP.
        of: Seeds of the worlds whose futures are run; None for all worlds of the runs.
        seeds: Seeds of each world's futures.
        fresh: Seeds of fresh worlds.
        steps: Total length of each world [step].

    Raises:
        AssayError: The runs differ in their settings, one of them is a branch, or a seed is used twice.
        RecordError: A run cannot be read, or lacks the checkpoint.
        ArgumentError: A world cannot have several futures, or does not exist.
    """
    demands: list[Demand] = []
    for source in sources:
        folder, step = _run_and_step(source)
        run = open_run(folder)
        if run.manifest.parent is not None:
            raise AssayError(f"{brief(source)}: is a branch, whose worlds did not begin as fresh ones do")
        for seed in run.manifest.seeds if of is None else of:
            plan = plan_branch(folder, folder / "futures", (), step, steps, seeds=seeds, of=seed)
            if seed in {*seeds, *fresh}:
                raise AssayError(
                    f"seed {seed}: is that of a world of {brief(source)}, so its future would be that world itself: "
                    "choose other --seeds and --fresh"
                )
            past = Past(folder.resolve(), plan.parent.step, seed)
            if not demands:
                demands.append(_demand(plan.run, fresh, "fresh"))
            if plan.parent.config_digest != demands[0].digest:
                raise AssayError(f"{brief(source)}: has other settings than {brief(sources[0])}")
            futures = _demand(plan.run, seeds, f"seed-{seed}-at-{past.step}")
            demands.append(replace(futures, past=past))
    return demands


def _run_and_step(source: str) -> tuple[Path, int | None]:
    """The run in RUN or RUN@STEP, and the step of its checkpoint."""
    folder, at, step = source.rpartition("@")
    if not at or Path(source).is_dir():
        return Path(source), None
    if not step.isdecimal() or len(step) > 12:
        raise AssayError(f"{brief(source)}: {brief(step)} is not a step: give RUN or RUN@STEP, as in runs/past@102400")
    return Path(folder), int(step)
