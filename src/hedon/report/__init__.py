"""Pages, tables and files about runs: of a report, and of a replication of the paper."""
