"""The figures of a report: what each asks, and how it is read."""

from hedon.figure.named import FigureKind
from hedon.statistic.minimum import FOR_INTERVAL

HISTORY = FigureKind(
    "history",
    "When did they evolve, and how much of it is drift?",
    "Mean weight of the living over time, and that of each neutral gene, which nothing depends on. Thin lines are "
    "worlds, the thick line is their mean, and the band around it its 95 % interval, from five worlds on. Shaded in "
    "gray is where drift alone would have this weight in 95 % of worlds: neutral genes with its own founders and "
    "mutations, walked down the pedigrees of these worlds. A cross marks where a world died out. A weight that stays "
    "within the gray may have drifted.",
)
WEIGHTS = FigureKind(
    "weights",
    "Which rewards evolved?",
    "A dot is an agent alive at the end, or when anybody last was in a world that died out: its weight of food against "
    "its weight of action, a panel per kind of food. Colors tell seeds apart, or the time of birth where there is one "
    "world. The axes reach as far as nearly all agents; crosses at the edge stand for the few beyond. Above and beside "
    "the axes: how the weight is distributed over all agents, filled, and how it would be by drift alone, outlined: "
    "neutral genes with its own founders and mutations, walked down the same pedigrees. Agents of one world are "
    "relatives, so only the mean tells selection from drift, in the figure before.",
)
POPULATION = FigureKind(
    "population",
    "How do the worlds fare?",
    "Agents alive, births and deaths, births that failed and why, energy, food eaten and generation over time. Births "
    "fail where the world is full or where there is no free place near the parent. Thin lines are worlds, thick "
    "lines are means over worlds, and bands are their 95 % intervals, from five worlds on. Where births balance "
    "deaths, the population has settled.",
)
REGIME = FigureKind(
    "regime",
    "What limits them?",
    "A row per world over time, colored by what keeps its population from growing: room for children, food, or "
    "nothing but the capacity of the world. Selection means something else in each: worlds that starve drift, those "
    "limited by food compete, idle ones stand still.",
)
SURVIVAL = FigureKind(
    "survival",
    "How long do agents live?",
    "Share of the newborn that lives on at each age, those who still live counted up to their age; a color per world, "
    "with the 95 % interval at each age. Right, the same on a logarithmic scale. There a constant chance of death is "
    "a straight line, dashed: a curve that bends down below it means that chances of death rise with age.",
)
SELECTION = FigureKind(
    "selection",
    "Which weights are selected?",
    "How many more children, above, or how much longer a life, below, an agent has per standard deviation of a "
    "weight, as a share of the mean, with the other weights held fixed: the standardized selection gradient, by time "
    "of birth. Points with bars are means over worlds with their 95 % interval, and thin lines are worlds. With fewer "
    f"than {FOR_INTERVAL} worlds each world is shown, without an interval; hollow points are cohorts that have not all "
    "died. Where the bars hold 0, there is no evidence of selection.",
)
LINEAGE = FigureKind(
    "lineage",
    "Whose descendants are left?",
    "Left, the number of lines that lead to those alive at the end, a line per world: few lines early on mean that "
    "few agents of that time have descendants. Right of it, the mean weight over these lines, thick, with its 95 % "
    "interval from five worlds on, and over all alive at that time, thin and gray. Where the thick line lies above "
    "the thin one, the ancestors of the survivors had more of the weight than others of their time.",
)
DEMOGRAPHY = FigureKind(
    "demography",
    "What is energy worth?",
    "Children tried in a life and mean life at constant energy, from the settings alone. Shaded are the energies of "
    "the middle half of the living in the last tenth of the run, with their median: where the curves are steep there, "
    "a little more energy makes a large difference. Below R0 = 1 a lineage dies out.",
)
WORLD = FigureKind(
    "world",
    "What does a world look like?",
    "The last state of one world. A disc is an agent: darker with more energy, a line to its front, a thick arc for "
    "its mouth. One agent is circled, and its rays end at what they see, in that thing's color.",
)
FIGURES = (HISTORY, WEIGHTS, POPULATION, REGIME, SURVIVAL, SELECTION, LINEAGE, DEMOGRAPHY, WORLD)
"""In the order in which a report shows them."""
