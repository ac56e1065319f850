"""Numbers that only this study needs, one question per file."""
