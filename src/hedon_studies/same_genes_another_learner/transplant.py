"""Parts C and D: worlds whose founders have genomes that evolved in part B, without mutation.

The founders of a pair come from the agents alive at the end of its two worlds in part B, the rows of `living.parquet`.
Each part is a program with three verbs, where EVOLUTION is the folder with the tables of part B:

- `run EVOLUTION RUNS` simulates the worlds of all treatments, or only of the ones in `--only`;
- `worlds EVOLUTION RUNS FOLDER` reduces these runs to `worlds.csv`, a row per world;
- `tests FOLDER` prints the tests named in expected.md.
"""

import argparse
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import polars as pl

import hedon
from hedon.analysis import WorldRecord, read_worlds
from hedon.config import Config, load_config
from hedon.record import Founders, make_founders, open_run
from hedon_studies.same_genes_another_learner.answer import Expected, answer_table
from hedon_studies.same_genes_another_learner.evolution import (
    ARMS,
    EVOLVING,
    LIVING,
    PRESET,
    WORLDS,
    provenance,
    require_files,
    require_groups,
)


@dataclass(frozen=True)
class Treatment:
    """A learner, and the founders and settings of its worlds.

    Attributes:
        learner: Arm of part B that sets the learning rate.
        genes: Arms of part B in which the founders' genomes evolved, each with an equal share.
        settings: Further settings, as for `--set`.
    """

    learner: str
    genes: tuple[str, ...]
    settings: tuple[str, ...] = ()

    def config(self) -> Config:
        """The settings of part B under this learner, without mutation, and with its own settings."""
        rate = f"learning.learning_rate={ARMS[self.learner]:g}"
        return load_config(PRESET, overrides=[*EVOLVING, rate, "genome.mutation_scale=0", *self.settings])

    def founders(self, living: pl.DataFrame, pair: int) -> Founders:
        """The founders of one pair; their groups are the arms in which they evolved.

        Args:
            living: Rows of `living.parquet`.
            pair: Seed of the pair.
        """
        genes = [name for name in living.columns if name not in ("learning_rate", "seed")]
        of_pair = living.filter(pl.col("seed") == pair)
        tables = [of_pair.filter((pl.col("learning_rate") / ARMS[arm] - 1).abs() < 1e-6) for arm in self.genes]
        groups = [arm for arm, table in zip(self.genes, tables, strict=True) for _ in range(table.height)]
        return make_founders(genes, pl.concat(tables).select(genes).to_numpy(), groups, dict.fromkeys(self.genes, 1.0))


@dataclass(frozen=True)
class Part:
    """A part of the study whose founders evolved in part B.

    Attributes:
        treatments: Its treatments, by name.
        pairs: Number of pairs: the first ones in which both worlds survived.
        steps: Length of each world [step].
        seed_shift: Seed of a world minus the seed of its pair in part B.
        measure: The measures of a world, given its record and its founders.
        named_tests: The tests of all worlds, the rows of `worlds.csv`.
        expected: What is expected of each test.
    """

    treatments: Mapping[str, Treatment]
    pairs: int
    steps: int
    seed_shift: int
    measure: Callable[[WorldRecord, Founders], Mapping[str, Any]]
    named_tests: Callable[[pl.DataFrame], pl.DataFrame]
    expected: Mapping[str, Expected]

    def main(self, description: str, arguments: Sequence[str] | None = None) -> None:
        """The program of the part; see the top of this file."""
        parser = argparse.ArgumentParser(description=description)
        verbs = parser.add_subparsers(dest="verb", required=True)
        for verb in ("run", "worlds"):
            child = verbs.add_parser(verb)
            child.add_argument("evolution", type=Path)
            child.add_argument("runs", type=Path)
        verbs.choices["run"].add_argument("--only", choices=self.treatments, nargs="+", default=list(self.treatments))
        verbs.choices["worlds"].add_argument("folder", type=Path)
        verbs.add_parser("tests").add_argument("folder", type=Path)
        options = parser.parse_args(arguments)
        if options.verb == "tests":
            require_files(parser, [options.folder / WORLDS])
        else:
            require_files(parser, [options.evolution / LIVING, options.evolution / WORLDS])
        if options.verb == "run":
            self.run(options.evolution, options.runs, options.only)
        elif options.verb == "worlds":
            self.reduce(options.evolution, options.runs, options.folder)
        else:
            worlds = pl.read_csv(options.folder / WORLDS)
            require_groups(parser, worlds["treatment"], self.treatments)
            with pl.Config(tbl_rows=20, tbl_cols=12, fmt_str_lengths=60, tbl_width_chars=200):
                print(self.answers(worlds))

    def answers(self, worlds: pl.DataFrame) -> pl.DataFrame:
        """The tests, and whether each came out as expected; open until all worlds have run.

        Args:
            worlds: Rows of `worlds.csv`.
        """
        complete = worlds.height == self.pairs * len(self.treatments)
        return answer_table("tests", self.named_tests(worlds), self.expected, complete=complete).rows

    def run(self, evolution: Path, runs: Path, names: Sequence[str]) -> None:
        """Simulates the worlds of some treatments, pair by pair on one thread, except those whose folder exists.

        Args:
            evolution: Folder with the tables of part B.
            runs: Folder of the runs.
            names: Names of the treatments.
        """
        living = pl.read_parquet(evolution / LIVING)
        configs = {name: self.treatments[name].config() for name in names}
        for pair in self._pairs(evolution):
            for name, config in configs.items():
                out = runs / f"{name}-{pair}"
                if not out.exists():
                    founders = self.treatments[name].founders(living, pair)
                    plan = hedon.RunPlan(
                        config, [pair + self.seed_shift], self.steps, out, threads=1, founders=founders
                    )
                    if hedon.run(plan).status == "interrupted":
                        return

    def reduce(self, evolution: Path, runs: Path, folder: Path) -> None:
        """Reduces runs to `worlds.csv`.

        Args:
            evolution: Folder with the tables of part B.
            runs: Folder of the runs.
            folder: Folder of the table.

        Raises:
            ValueError: A run has other founders, or was interrupted.
        """
        living = pl.read_parquet(evolution / LIVING)
        rows = []
        for name, treatment in self.treatments.items():
            for path in sorted(runs.glob(f"{name}-[0-9]*")):
                run = open_run(path)
                for world in read_worlds([run]):
                    if world.extinct_step is None and world.last_step < self.steps:
                        raise ValueError(f"{path}: ends at step {world.last_step:,}; `hedon resume` continues it")
                    pair = world.seed - self.seed_shift
                    founders = treatment.founders(living, pair)
                    if world.config.world.founders != founders.digest:
                        raise ValueError(f"{path}: pair {pair} has other founders")
                    ends = {"steps": world.last_step, "extinct_step": world.extinct_step}
                    measures = self.measure(world, founders)
                    rows.append({"treatment": name, "pair": pair, **ends, **measures, **provenance(world, run)})
        folder.mkdir(parents=True, exist_ok=True)
        pl.DataFrame(rows, infer_schema_length=None).write_csv(folder / WORLDS)

    def _pairs(self, evolution: Path) -> list[int]:
        worlds = pl.read_csv(evolution / WORLDS).filter(pl.col("extinct_step").is_null())
        both = worlds.group_by("seed").len().filter(pl.col("len") == len(ARMS))
        return both["seed"].sort().to_list()[: self.pairs]
