"""Who descends from whom, and what a gene does that only follows the pedigree."""
