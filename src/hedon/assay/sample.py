"""The worlds of an assay, by the setting that they begin with."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from hedon.analysis.world.record import WorldRecord
from hedon.jobs.requirement import RunRequirement, find_runs, read_required
from hedon.record.reader import Run
from hedon.text import count


@dataclass(frozen=True, eq=False)
class Sample:
    """Worlds that begin alike but for their seeds.

    Attributes:
        need: which worlds they are.
        runs: that hold them.
        worlds: one record for each seed and species, as long as they need be.
    """

    need: RunRequirement
    runs: tuple[Run, ...]
    worlds: tuple[WorldRecord, ...]

    @property
    def steps(self) -> int:
        """Of each world [step]."""
        return max(self.need.steps.values())

    def of_species(self, species: str | None) -> list[WorldRecord]:
        """The records of one species, by seed; of all, where it is None."""
        return [world for world in self.worlds if species in (None, world.species)]

    def describe(self) -> str:
        """How many worlds there are, how long they lived, and which died out, as a sentence."""
        pairs = [pair for run in self.runs for pair in zip(run.manifest.seeds, run.manifest.extinct_steps, strict=True)]
        died = {seed: step for seed, step in pairs if seed in self.need.steps and step is not None}
        said = [f"seed {seed} at step {step:,}" for seed, step in died.items() if step <= self.steps]
        return (
            f"`{self.need.name}`: {count(len(self.need.steps), 'world')}, {self.steps:,} steps; "
            f"died out: {', '.join(said) or 'none'}."
        )


def read_samples(wanted: Sequence[RunRequirement], folder: Path) -> list[Sample]:
    """Reads the worlds of an assay whose runs are there.

    Raises:
        RecordError: a run cannot be read.
    """
    runs, _ = find_runs(folder, wanted)
    found = read_required(wanted, runs)
    samples = []
    for need in wanted:
        keys = [(need.digest, seed, species) for seed in need.steps for species in need.config.species]
        worlds = tuple(found[key].until(need.steps[key[1]]) for key in keys if key in found)
        used = {world.run for world in worlds}
        samples.append(Sample(need, tuple(run for run in runs if run.path.name in used), worlds))
    return samples
