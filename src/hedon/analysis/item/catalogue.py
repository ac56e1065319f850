"""All items of the reproduction, by name and in the order in which they are shown."""

from hedon.analysis.item.acting import ACTING
from hedon.analysis.item.drift import DRIFT
from hedon.analysis.item.entropy import ENTROPY
from hedon.analysis.item.evolved_weight import WEIGHTS
from hedon.analysis.item.extinction import EXTINCTIONS
from hedon.analysis.item.fault import FAULTS
from hedon.analysis.item.item import Item
from hedon.analysis.item.law import LAWS
from hedon.analysis.item.life import LIVES
from hedon.analysis.item.noise import NOISE
from hedon.analysis.item.parameter import PARAMETERS
from hedon.analysis.item.picture import PICTURES
from hedon.analysis.item.released import RELEASED
from hedon.analysis.item.supply import SUPPLY
from hedon.analysis.item.weight_history import HISTORIES

_PAPER = (*PICTURES, *LAWS, *EXTINCTIONS, *WEIGHTS, *HISTORIES, *LIVES, *PARAMETERS)
_STUDIES = (*DRIFT, *FAULTS, *SUPPLY, *RELEASED, *NOISE, *ENTROPY, *ACTING)

ITEMS: dict[str, Item] = {item.name: item for item in (*_PAPER, *_STUDIES)}
