"""All items of the reproduction, by name and in the order in which they are shown."""

from hedon.study.item import Item
from hedon_studies.fear.item import SEQUEL
from hedon_studies.kanagawa_doya_2024.acting import ACTING
from hedon_studies.kanagawa_doya_2024.drift import DRIFT
from hedon_studies.kanagawa_doya_2024.entropy import ENTROPY
from hedon_studies.kanagawa_doya_2024.evolved_weight import WEIGHTS
from hedon_studies.kanagawa_doya_2024.extinction import EXTINCTIONS
from hedon_studies.kanagawa_doya_2024.fault import FAULTS
from hedon_studies.kanagawa_doya_2024.law import LAWS
from hedon_studies.kanagawa_doya_2024.life import LIVES
from hedon_studies.kanagawa_doya_2024.noise import NOISE
from hedon_studies.kanagawa_doya_2024.parameter import PARAMETERS
from hedon_studies.kanagawa_doya_2024.picture import PICTURES
from hedon_studies.kanagawa_doya_2024.released import RELEASED
from hedon_studies.kanagawa_doya_2024.supply import SUPPLY
from hedon_studies.kanagawa_doya_2024.weight_history import HISTORIES

_PAPER = (*PICTURES, *LAWS, *EXTINCTIONS, *WEIGHTS, *HISTORIES, *LIVES, *PARAMETERS)
_STUDIES = (*DRIFT, *FAULTS, *SUPPLY, *RELEASED, *NOISE, *ENTROPY, *ACTING)

ITEMS: dict[str, Item] = {item.name: item for item in (*_PAPER, *SEQUEL, *_STUDIES)}
