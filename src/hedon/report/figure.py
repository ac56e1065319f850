"""The figures of a report: the question that each answers, and how to read it."""

from hedon.figure.named import FigureKind

HISTORY = FigureKind(
    "history",
    "When did they evolve, and how much of it is drift?",
    "Mean weight of the living over time: thin lines are worlds, the thick line is their mean. The gray band shows "
    "where drift alone would leave this weight in 95 % of worlds; a weight that stays within it may have drifted. "
    "The last panel shows the neutral genes. A cross marks where a world died out.",
)
WORLD = FigureKind(
    "world",
    "What does a world look like?",
    "The last state of one world. Agents are darker the more energy they have; a line marks the front, a thick arc "
    "the mouth. The rays of the circled agent end at what they see, in its color.",
)
WEIGHTS = FigureKind(
    "weights",
    "Which rewards evolved?",
    "Each dot is an agent alive at the end, placed by its weights of food and of action. Colors stand for seeds or, "
    "with one world, for the time of birth. Crosses at the edge lie beyond the axes. Histograms: all agents, filled, "
    "and drift alone, outlined. Agents of one world are relatives: only their mean tells selection from drift.",
)
POPULATION = FigureKind(
    "population",
    "How do the worlds fare?",
    "When births balance deaths, the population has settled. Births fail when the world is full or when no place "
    "near the parent is free. Thin lines are worlds, thick lines are their means.",
)
REGIME = FigureKind(
    "regime",
    "What limits them?",
    "One row per world: what keeps the population from growing over time. Worlds that starve drift, worlds limited by"
    " food compete, and idle worlds hardly change.",
)
SURVIVAL = FigureKind(
    "survival",
    "How long do agents live?",
    "Share of newborns that reach each age, with those still alive counted up to their age; right, on a logarithmic "
    "scale. A curve that bends below the dashed line shows that the chance of death rises with age.",
)
SELECTION = FigureKind(
    "selection",
    "Which weights are selected?",
    "Standardized selection gradients by time of birth: how many more children (top) or how much longer a life "
    "(bottom) goes with one standard deviation more of a weight, as a share of the mean, with the other weights held "
    "fixed. Bars that include 0 show no evidence of selection. Hollow points: not all have died yet.",
)
LINEAGE = FigureKind(
    "lineage",
    "Whose descendants are left?",
    "Left: how many lines lead to those alive at the end. Right: the mean weight of these ancestors, thick, and of "
    "all agents of the time, gray. If they differ, agents with more or less of the weight left more descendants.",
)
DEMOGRAPHY = FigureKind(
    "demography",
    "What is energy worth?",
    "Children tried and mean life at constant energy, computed from the settings. The middle half of the living is "
    "shaded: if the curves are steep there, a little energy matters much. Below R0 = 1 a lineage dies out.",
)
FIGURES = (HISTORY, WORLD, WEIGHTS, POPULATION, REGIME, SURVIVAL, SELECTION, LINEAGE, DEMOGRAPHY)
"""All figures, in the order of a report."""
