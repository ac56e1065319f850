"""Output of commands: tables that fit a terminal, summaries, and the progress of runs. Only this package uses rich."""
