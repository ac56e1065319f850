"""Controls for drift: pedigrees that neutral genes can walk down, and recorded neutral genes with the same law."""

from collections.abc import Mapping

from hedon.analysis.descent.genealogy import Genealogy, genealogy
from hedon.analysis.world.record import WorldRecord, shares_noise


def walked_pedigree(world: WorldRecord) -> Genealogy | None:
    """Pedigree of a world, if neutral genes that walk down it show the effect of drift.

    Returns:
        None in these cases: there is no pedigree, or it has gaps, so that walks would have no start; the founders come
        from a table, whose law is unknown; children have two parents; or noise depends on a birth's number among births
        of several species.
    """
    if world.config.world.founders or world.species_config.birth.mating == "pairs" or shares_noise(world):
        return None
    tree = genealogy(world.agents)
    return tree if tree.size and not tree.gaps else None


def like_neutral(world: WorldRecord) -> Mapping[str, list[str]]:
    """For each gene, the recorded neutral genes that start and mutate like it; none if a table gives the founders.

    Returns:
        By genome column; a neutral gene does not include itself.
    """
    if world.config.world.founders:
        return {name: [] for name in world.weight_names}
    genes = {name: world.gene(name) for name in world.weight_names}
    return {
        name: [
            neutral
            for neutral in world.neutral_names
            if neutral != name and (genes[neutral].law, genes[neutral].mutation) == (gene.law, gene.mutation)
        ]
        for name, gene in genes.items()
    }
