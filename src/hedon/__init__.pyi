from . import callback as callback
from . import env as env
from .config import Config as Config
from .config import ConfigError as ConfigError
from .config import diff as diff
from .config import dump_toml as dump_toml
from .config import layouts as layouts
from .config import load_config as load_config
from .env import make as make
from .error import ArgumentError as ArgumentError
from .error import EngineError as EngineError
from .error import HedonError as HedonError
from .experiment.branch import branch as branch
from .experiment.memory import MemoryNeedError as MemoryNeedError
from .experiment.plan import Moment as Moment
from .experiment.plan import RunPlan as RunPlan
from .experiment.resume import resume as resume
from .experiment.rule import rules as rules
from .experiment.run import run as run
from .experiment.simulation import Simulation as Simulation
from .experiment.world import World as World
from .record.error import RecordError as RecordError
from .record.founder import Founders as Founders
from .record.manifest import RuleSource as RuleSource
from .record.network import Networks as Networks
from .record.reader import Run as Run
from .record.reader import open_run as open_run

__all__: list[str]
__version__: str
