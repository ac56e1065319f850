"""The command line: each command parses, calls and prints. Commands import large libraries when they run."""
