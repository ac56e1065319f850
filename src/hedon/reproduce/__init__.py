"""Makes the missing runs that items of the paper need: one process per run, with one progress display for all."""
