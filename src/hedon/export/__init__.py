"""Exports the records of a run to other tools: tables as files, and pedigrees in phylogenetic formats."""
