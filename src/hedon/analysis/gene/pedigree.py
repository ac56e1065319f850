"""What shows drift: pedigrees down which neutral genes can walk, and recorded neutral genes of the same law."""

from collections.abc import Mapping

from hedon.analysis.descent.genealogy import Genealogy, genealogy
from hedon.analysis.world.record import WorldRecord, shares_noise


def walked_pedigree(world: WorldRecord) -> Genealogy | None:
    """The pedigree of a world, where neutral genes that walk down it show what drift does.

    Returns:
        None where there is no pedigree, or one with gaps, whose walks would have no beginning; where the founders come
        from a table, whose law the walks do not know; where children have two parents; and where noise is fixed by the
        number of a birth among those of several species.
    """
    if world.config.world.founders or world.own.birth.mating == "pairs" or shares_noise(world):
        return None
    tree = genealogy(world.agents)
    return tree if tree.size and not tree.gaps else None


def like_neutral(world: WorldRecord) -> Mapping[str, list[str]]:
    """For each gene the recorded neutral genes that begin and mutate like it; none if a table gives the founders.

    Returns:
        By genome column; a neutral gene is not among its own.
    """
    if world.config.world.founders:
        return {name: [] for name in world.weight_names}
    genes = {name: world.gene(name) for name in world.weight_names}
    return {
        name: [
            each
            for each in world.neutral_names
            if each != name and (genes[each].law, genes[each].mutation) == (gene.law, gene.mutation)
        ]
        for name, gene in genes.items()
    }
