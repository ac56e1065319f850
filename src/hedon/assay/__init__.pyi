from .contest import Lines as Lines
from .contest import by_gene as by_gene
from .contest import world_lines as world_lines
from .frequency import AtShare as AtShare
from .frequency import Frequency as Frequency
from .frequency import estimate_frequency as estimate_frequency
from .report_frequency import draw_frequency as draw_frequency
from .report_frequency import frequency_tables as frequency_tables
