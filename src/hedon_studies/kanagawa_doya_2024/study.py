"""The study that reproduces the paper, and the study of its open questions."""

from hedon.study import Study
from hedon_studies.kanagawa_doya_2024.acting import ACTING
from hedon_studies.kanagawa_doya_2024.claim import CLAIMS
from hedon_studies.kanagawa_doya_2024.drift import DRIFT
from hedon_studies.kanagawa_doya_2024.entropy import ENTROPY
from hedon_studies.kanagawa_doya_2024.evolved_weight import WEIGHTS
from hedon_studies.kanagawa_doya_2024.extinction import EXTINCTIONS
from hedon_studies.kanagawa_doya_2024.fault import FAULTS
from hedon_studies.kanagawa_doya_2024.law import LAWS
from hedon_studies.kanagawa_doya_2024.life import LIVES
from hedon_studies.kanagawa_doya_2024.noise import NOISE
from hedon_studies.kanagawa_doya_2024.order import ORDERS
from hedon_studies.kanagawa_doya_2024.paper import reported
from hedon_studies.kanagawa_doya_2024.parameter import PARAMETERS
from hedon_studies.kanagawa_doya_2024.picture import PICTURES
from hedon_studies.kanagawa_doya_2024.released import RELEASED
from hedon_studies.kanagawa_doya_2024.supply import SUPPLY
from hedon_studies.kanagawa_doya_2024.weight_history import HISTORIES

STUDY = Study(
    "kanagawa-doya-2024",
    "Evolution of rewards for food and motor action",
    "Kanagawa & Doya, ALIFE 2024: agents that are born with rewards for food and for action, learn by them within "
    "their lives, and pass them on. Which rewards evolve, and does the abundance of food decide it?",
    (*PICTURES, *LAWS, EXTINCTIONS, *WEIGHTS, *HISTORIES, *LIVES, PARAMETERS),
    "What the paper shows: food becomes rewarding, action goes two ways, and in plenty hardly anything evolves. The "
    "rules were fixed before runs of the paper's length.",
    (*CLAIMS, *ORDERS),
    reported(),
)

OPEN = Study(
    "kanagawa-doya-2024-open",
    "What the paper leaves open",
    "Do the paper's weights go further than drift; what do the faults of its released program do, which of its worlds "
    "last, and could agents eat what it reports?",
    (DRIFT, FAULTS, SUPPLY, RELEASED, NOISE, ENTROPY, ACTING),
    "Each item says in its module what would count as an effect; it was written before anybody looked at the runs.",
)
