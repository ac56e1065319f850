"""The worlds of an assay, grouped by their initial condition."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from hedon.analysis.world.record import WorldRecord
from hedon.ensemble.demand import Demand
from hedon.ensemble.ensemble import find_ensemble
from hedon.record.reader import Run
from hedon.text import count


@dataclass(frozen=True, eq=False)
class Sample:
    """Worlds that differ only in their seeds.

    Attributes:
        demand: The specification of the worlds.
        runs: The runs that contain them.
        worlds: One record for each seed and species, cut at the required length.
    """

    demand: Demand
    runs: tuple[Run, ...]
    worlds: tuple[WorldRecord, ...]

    @property
    def steps(self) -> int:
        """The length of each world [step]."""
        return max(self.demand.steps.values())

    def of_species(self, species: str | None) -> list[WorldRecord]:
        """The records of one species, by seed; those of all species for None."""
        return [world for world in self.worlds if species in (None, world.species)]

    def describe(self) -> str:
        """A sentence on how many worlds there are, how long they lived, and which died out."""
        pairs = [pair for run in self.runs for pair in zip(run.manifest.seeds, run.manifest.extinct_steps, strict=True)]
        extinction_steps = {seed: step for seed, step in pairs if seed in self.demand.steps and step is not None}
        extinctions = [f"seed {seed} at step {step:,}" for seed, step in extinction_steps.items() if step <= self.steps]
        return (
            f"`{self.demand.name}`: {count(len(self.demand.steps), 'world')}, {self.steps:,} steps; "
            f"died out: {', '.join(extinctions) or 'none'}."
        )


def read_samples(demands: Sequence[Demand], folder: Path) -> list[Sample]:
    """Reads the worlds of an assay from existing runs.

    Raises:
        RecordError: A run cannot be read.
    """
    samples = []
    for demand in demands:  # separately, since futures and fresh worlds may have equal settings and seeds
        ensemble = find_ensemble([demand], folder)
        keys = [(demand.digest, seed, species) for seed in demand.steps for species in demand.config.species]
        worlds = tuple(ensemble.worlds[key].until(demand.steps[key[1]]) for key in keys if key in ensemble.worlds)
        samples.append(Sample(demand, ensemble.runs_of(worlds), worlds))
    return samples
