"""Pages, tables and files that tell what runs hold: of a report, and of a replication of the paper."""
