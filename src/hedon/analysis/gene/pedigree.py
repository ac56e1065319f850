"""The pedigrees down which neutral genes can walk."""

from hedon.analysis.descent.genealogy import Genealogy, genealogy
from hedon.analysis.world.record import WorldRecord, shares_noise


def walked_pedigree(world: WorldRecord) -> Genealogy | None:
    """The pedigree of a world, where neutral genes that walk down it show what drift does.

    Args:
        world: Its records.

    Returns:
        None where there is no pedigree, or one with gaps, whose walks would have no beginning; where the founders come
        from a table, whose law the walks do not know; where children have two parents; and where noise is fixed by the
        number of a birth among those of several species.
    """
    if world.config.world.founders or world.own.birth.mating == "pairs" or shares_noise(world):
        return None
    tree = genealogy(world.agents)
    return tree if tree.size and not tree.gaps else None
