"""Figures that only this study draws, one question per file."""
