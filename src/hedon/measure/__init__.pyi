from .catalogue import MEASURES as MEASURES
from .catalogue import gene_mean as gene_mean
from .catalogue import last_born_mean as last_born_mean
from .catalogue import world_row as world_row
from .measure import Measure as Measure
from .measure import WorldNumber as WorldNumber
from .response import RESPONSES as RESPONSES
from .response import common_age as common_age
