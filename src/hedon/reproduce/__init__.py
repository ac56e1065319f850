"""Makes the runs that items of the paper need: what is missing, one process per run, with progress over all."""
