"""Analyses of this study, one question per file."""
