"""All items of the reproduction, by name and in the order in which they are shown."""

from hedon.replication.item.evolved_weight import WEIGHTS
from hedon.replication.item.extinction import EXTINCTIONS
from hedon.replication.item.item import Item
from hedon.replication.item.law import LAWS
from hedon.replication.item.life import LIVES
from hedon.replication.item.parameter import PARAMETERS
from hedon.replication.item.picture import PICTURES
from hedon.replication.item.weight_history import HISTORIES
from hedon.replication.study.acting import ACTING
from hedon.replication.study.drift import DRIFT
from hedon.replication.study.entropy import ENTROPY
from hedon.replication.study.fault import FAULTS
from hedon.replication.study.noise import NOISE
from hedon.replication.study.released import RELEASED
from hedon.replication.study.sequel import SEQUEL
from hedon.replication.study.supply import SUPPLY

_PAPER = (*PICTURES, *LAWS, *EXTINCTIONS, *WEIGHTS, *HISTORIES, *LIVES, *PARAMETERS)
_STUDIES = (*DRIFT, *FAULTS, *SUPPLY, *RELEASED, *NOISE, *ENTROPY, *ACTING)

ITEMS: dict[str, Item] = {item.name: item for item in (*_PAPER, *SEQUEL, *_STUDIES)}
