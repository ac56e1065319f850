from .run import check_run as check_run
