from .founder import Founders as Founders
from .founder import make_founders as make_founders
from .labelled import to_xarray as to_xarray
from .reader import LoadedRun as LoadedRun
from .reader import Run as Run
from .reader import open_run as open_run
from .snapshot import Snapshot as Snapshot
from .snapshot import load_snapshot as load_snapshot
