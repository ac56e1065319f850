"""The study of the sequel."""

from hedon.study import Study
from hedon_studies.fear.claim import SEQUEL_CLAIMS, SEQUEL_ORDERS
from hedon_studies.fear.item import SEQUEL
from hedon_studies.fear.program import PROGRAM

STUDY = Study(
    "fear",
    "Fear and social rewards of prey that see predators",
    'Kanagawa & Doya, "Evolution of Fear and Social Rewards in Prey-Predator Relationship", arXiv 2507.09992, '
    "version 2: which rewards for seeing predators, obstacles and one another evolve in prey?",
    (*SEQUEL, PROGRAM),
    "Fear of predators often evolves, stronger where they hunt better; none of weak pitfalls. The rules were written "
    "after short assays and two worlds of 425,570 steps.",
    (*SEQUEL_CLAIMS, *SEQUEL_ORDERS),
)
