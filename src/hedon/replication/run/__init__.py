"""Makes the missing runs that items need: one process per run, with one progress display for all."""
