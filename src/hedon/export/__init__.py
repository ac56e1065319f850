"""Takes the records of a run into other tools: tables as files, and pedigrees in the formats of phylogenetics."""
