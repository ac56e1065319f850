"""What commands print: tables that fit a terminal, summaries, and the progress of runs. The only place of rich."""
