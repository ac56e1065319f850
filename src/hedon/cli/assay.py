"""`hedon assay`: measures fitness directly, with founders that have chosen genes."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hedon.cli.assay_option import (
    SOURCES,
    AssayOptions,
    ContestOptions,
    ContingencyOptions,
    Source,
    Species,
    StabilityOptions,
)
from hedon.cli.option import with_options

if TYPE_CHECKING:
    from hedon.config.config import Config
    from hedon.record.founder import Founders

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Measure fitness directly: founders with chosen genes compete. docs/guide/fitness.md explains each assay.",
)

SHARES = "0.05,0.25,0.5,0.75,0.95"
First = Annotated[str, typer.Argument(metavar="A", help=f"Genomes: {SOURCES}.")]
Second = Annotated[str, typer.Argument(metavar="B", help="Genomes, given as for A.")]


@app.command()
@with_options(AssayOptions)
def landscape(
    source: Source,
    spread: Annotated[
        str, typer.Option("--range", metavar="LOW:HIGH", help="Founders' genes are spread evenly between these.")
    ] = "-8:8",
    sd: Annotated[float | None, typer.Option(help="Founders' genes are normal with this sd instead.", min=0.0)] = None,
    genes: Annotated[
        str | None, typer.Option(metavar="GENE,GENE", help="The two genes of the surface; by default food,action.")
    ] = None,
    species: Species = None,
    ends: Annotated[
        list[Path] | None,
        typer.Option(metavar="RUN|FILE", help="Show where these runs, summary.json or study.json ended."),
    ] = None,
    *,
    options: AssayOptions,
) -> None:
    """Fitness as a surface over two genes.

    Founders are spread over all genes, and there is no mutation: descendants have the genes of their founder, or
    half of them with two parents. Their numbers, children, food and lifespans, relative to their world's mean, give a
    surface over two genes, with its optimum, its slope at 0 and its curvature. Sixteen neutral genes show what chance
    alone gives.

    After Ctrl-C, the same command continues. A finished assay is only read.

    \b
    Examples:
      hedon assay landscape baseline
      hedon assay landscape poison --genes poison,action --seeds 1-20
      hedon assay landscape predator --species prey --genes see_predator,see_prey
      hedon assay landscape baseline --set population.initial_count=100 --ends runs/baseline-corrected-s1-5
    """
    from hedon.assay.end import read_ends, reported_ends
    from hedon.assay.landscape import assay_config, spread_founders
    from hedon.assay.option import choose_genes, parse_spread
    from hedon.assay.report_landscape import landscape_answer
    from hedon.config.layout import choose_species

    config = assay_config(options.config(source))
    own = choose_species(species, config)
    pair = choose_genes(genes, config, own)
    found = [] if len(config.species) > 1 else reported_ends(config)
    found += [end for path in ends or () for end in read_ends(path, config, own)]
    founders = spread_founders(config, parse_spread(spread, sd, config.species[own].genome), own)
    options.answer("landscape", [options.worlds(config, founders)], partial(landscape_answer, pair, own, found))


@app.command()
@with_options(ContestOptions)
def compete(a: First, b: Second, *, options: ContestOptions) -> None:
    """Two groups in one world, in equal numbers: which one grows?

    Half of the founders come from A and half from B; nothing mutates. Prints the selection coefficient of A per
    generation with an interval over worlds, and the log ratio of the numbers over time. After Ctrl-C, the same command
    continues.

    \b
    Examples:
      hedon assay compete food=5,action=5 food=0.5,action=0
      hedon assay compete runs/a@1000000 runs/b@1000000 --in baseline --seeds 1-20
      hedon assay compete food=1 food=0 --set population.initial_count=100
      hedon assay compete see_predator=-5 see_predator=0 --in predator --species prey
    """
    from hedon.assay.option import competitors

    config, own = options.setting(a, b)
    _contest("compete", config, own, *competitors((a, b), (0.5, 0.5), config, own), options)


@app.command()
@with_options(ContestOptions)
def invade(
    resident: Annotated[str, typer.Argument(metavar="RESIDENT", help=f"Genomes: {SOURCES}.")],
    mutant: Annotated[str, typer.Argument(metavar="MUTANT", help="Genomes, given as for RESIDENT.")],
    share: Annotated[float, typer.Option(help="Share of the mutant among the founders.", min=0.001, max=0.999)] = 0.1,
    *,
    options: ContestOptions,
) -> None:
    """A few mutants among many residents: do they spread?

    Like compete, but the mutant starts with a small share. Numbers compare the mutant with the resident.

    \b
    Example:
      hedon assay invade food=0.5,action=0 food=5,action=5 --share 0.06
    """
    from hedon.assay.option import competitors

    config, own = options.setting(resident, mutant)
    _contest("invade", config, own, *competitors((mutant, resident), (share, 1.0 - share), config, own), options)


@app.command()
@with_options(ContestOptions)
def knockout(
    run: Annotated[str, typer.Argument(metavar="RUN[@STEP]", help="A run; its living, at the end or at a step.")],
    gene: Annotated[str, typer.Argument(metavar="GENE", help="The gene to set to 0, such as food or action.")],
    *,
    options: ContestOptions,
) -> None:
    """Living agents of a run against copies with one gene at 0: what is the gene worth?

    Like compete. A selection coefficient below 0 means that the gene is worth having.

    \b
    Example:
      hedon assay knockout runs/baseline-corrected-s1-5 action --seeds 1-20
    """
    from hedon.assay.option import knocked_out

    config, own = options.setting(run)
    _contest("knockout", config, own, *knocked_out(run, gene, config, own), options)


def _contest(
    kind: str, config: "Config", species: str, founders: "Founders", groups: tuple[str, str], options: ContestOptions
) -> None:
    from hedon.assay.report_contest import contest_answer

    options.answer(kind, [options.worlds(config, founders)], partial(contest_answer, kind, groups, species))


@app.command()
@with_options(ContestOptions)
def frequency(
    a: First,
    b: Second,
    shares: Annotated[
        str, typer.Option(metavar="SHARE,…", help="Shares of A among the founders, at least two; one run for each.")
    ] = SHARES,
    *,
    options: ContestOptions,
) -> None:
    """Fitness against frequency: is the rarer of two groups the fitter one?

    Like compete, but from several shares of A. Prints A's selection coefficient per generation at each share, its slope
    over the share, and the share at which neither grows, all with intervals over seeds. If each group grows when it is
    rare, the two can coexist. After Ctrl-C, the same command continues; further shares are added to the existing
    ones if the first is the same or --out is given.

    \b
    Examples:
      hedon assay frequency food=5,action=0 food=0,action=5
      hedon assay frequency runs/a@1000000 runs/b@1000000 --shares 0.1,0.5,0.9 --seeds 1-30
      hedon assay frequency see_prey=2 see_prey=-2 --in predator --species prey
    """
    from hedon.assay.option import competitors, parse_shares
    from hedon.assay.report_frequency import frequency_answer

    config, own = options.setting(a, b)
    parts, wanted, groups = parse_shares(shares, config, own), [], (a, b)
    for share in parts:
        founders, groups = competitors((a, b), (share, 1.0 - share), config, own)
        wanted.append(options.worlds(config, founders, f"share-{share:g}"))
    options.answer("frequency", wanted, partial(frequency_answer, groups, own, parts))


@app.command()
@with_options(StabilityOptions)
def stability(
    source: Source,
    at: Annotated[str, typer.Option("--at", metavar="GENE=VALUE,…", help="Where founders start: food=5,action=5.")],
    beside: Annotated[
        str | None, typer.Option(metavar="GENE=VALUE,…", help="Another start to compare with: food=0,action=0.")
    ] = None,
    *,
    options: StabilityOptions,
) -> None:
    """Start evolution at a claimed end point, and see whether it stays.

    Founders have the condition's own spread around the point, and mutation is on. Prints where each weight went,
    compared with neutral genes that start alike and mutate along the same pedigrees. After Ctrl-C, the same command
    continues.

    \b
    Examples:
      hedon assay stability baseline --at food=5,action=5
      hedon assay stability baseline --at food=5,action=-5 --beside food=0,action=0 --steps 1024000
    """
    from hedon.assay.option import stability_config
    from hedon.assay.report_stability import stability_answer
    from hedon.record.founder_source import parse_point

    config = options.config(source)
    points = {"start": at} | ({} if beside is None else {"beside": beside})
    configs = {part: stability_config(config, parse_point(point, config)) for part, point in points.items()}
    wanted = [options.worlds(each, None, part) for part, each in configs.items()]
    options.answer("stability", wanted, partial(stability_answer, list(points.values())))


@app.command()
@with_options(ContingencyOptions)
def contingency(
    runs: Annotated[
        list[str], typer.Argument(metavar="RUN[@STEP]", help="Runs, each at its end or at one of its checkpoints.")
    ],
    of: Annotated[
        str | None,
        typer.Option(metavar="SEEDS", help="Seeds of the worlds that get futures; by default all worlds of the runs."),
    ] = None,
    fresh: Annotated[
        str | None, typer.Option(metavar="SEEDS", help="Seeds of fresh worlds to compare with; by default --seeds.")
    ] = None,
    *,
    options: ContingencyOptions,
) -> None:
    """Replay the tape: was the outcome settled, or left to chance?

    Each world of the runs gets several futures, one for each of --seeds, and the worlds of --fresh start from the
    beginning. If futures of one world end as far apart as fresh worlds do, nothing was settled when they parted. Prints
    the ratio of both distances for weights, numbers and lineages, with intervals, and whether the same agents have
    descendants in all futures. --steps is the total, including the past. To interrupt it, press Ctrl-C; the same
    command continues. A run keeps its two newest checkpoints.

    \b
    Examples:
      hedon assay contingency runs/past --steps 204800
      hedon assay contingency runs/early runs/late --of 1-4 --seeds 101-110 --fresh 101-130 --steps 204800
    """
    from hedon.assay.option import contingency_worlds
    from hedon.assay.report_contingency import contingency_answer
    from hedon.experiment.argument import parse_seeds

    chosen = None if of is None else parse_seeds(of, "--of")
    seeds = parse_seeds(options.seeds, "--seeds")
    begun = seeds if fresh is None else parse_seeds(fresh, "--fresh")
    options.answer("contingency", contingency_worlds(runs, chosen, seeds, begun, options.steps), contingency_answer)
