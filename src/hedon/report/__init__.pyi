from .analysis import analyze as analyze
from .run import write_report as write_report
