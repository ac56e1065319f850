"""Genomes and networks: how founders draw them, and what a child gets from its parents."""

import math

import numpy as np
from reference.draw import cauchy, normals, open_uniform, student_t, uniform
from reference.setting import Rules, Species


def first_genome(rules: Rules, species: Species, of: int, purpose: str) -> np.ndarray:
    genome = []
    for i, (law, mutation) in enumerate(zip(species.laws, species.mutations, strict=True)):
        noise = normals(*rules.draw(purpose, of, 0, i)[:2])[0]
        genome.append(clipped(law.initial_mean + law.initial_sd * noise, mutation.limit))
    return np.array(genome)


def mutated(rules: Rules, species: Species, genome: np.ndarray, child_id: int, births: int, index: int) -> np.ndarray:
    """A child's genome. Tabulated noise depends on the number of births in a window and on the index of this one."""
    frozen = rules.mutation_noise == "tabulated"
    stream = ("frozen_mutation", index, births) if frozen else ("mutation", child_id, 0)
    child = []
    for i, (gene, mutation) in enumerate(zip(genome, species.mutations, strict=True)):
        words = rules.draw(*stream, i)
        mutates = uniform(words[2]) < mutation.probability
        child.append(clipped(gene + mutates * mutation.scale * noise_of(mutation, words), mutation.limit))
    return np.array(child)


def noise_of(mutation, words: tuple[int, int, int, int]) -> float:
    """Noise of scale 1."""
    if mutation.law == "cauchy":
        return cauchy(words[0])
    if mutation.law == "student_t":
        return student_t(mutation.df, *words[:2])
    return normals(*words[:2])[0] if mutation.law == "normal" else 2 * open_uniform(words[0]) - 1


def clipped(gene: float, limit: float) -> float:
    return min(max(gene, -limit), limit)


def recombined(rules: Rules, first: np.ndarray, second: np.ndarray, child_id: int) -> np.ndarray:
    """Each gene from either parent, chosen by the first bit of a draw."""
    from_second = [rules.draw("recombination", child_id, 0, i)[0] >= 2**31 for i in range(len(first))]
    return np.where(from_second, second, first)


def inherited_network(rules: Rules, species: Species, parent: np.ndarray, child_id: int) -> np.ndarray:
    """A parent's network with noise added to each parameter."""
    noise = []
    for i in range(math.ceil(len(parent) / 4)):
        words = rules.draw("inherited_network", child_id, 0, i)
        noise += [*normals(*words[:2]), *normals(*words[2:])]
    return parent + species.birth.network_noise * np.array(noise[: len(parent)])


def first_log_sd(species: Species, genome: np.ndarray) -> float:
    """The log standard deviation of the actions of a new network."""
    return species.gene(genome, "g_action_sd") * math.log(10) if "action_sd" in species.genome.learning else 0.0
